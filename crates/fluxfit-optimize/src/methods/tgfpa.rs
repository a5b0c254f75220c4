//! tGFPA: flower pollination with a t-distributed and a Gaussian perturbation, the paper's algorithm.
//!
//! Idea: FPA, started on a chaotic map, whose global moves are often perturbed by a t-distributed multiple of a difference of two
//! flowers (wide like Cauchy's at first, Gaussian later), and whose local moves are often replaced by two Gaussian multiples of
//! differences.
//!
//! ```text
//! start     logistic map, mu = 4                                                             (7) (8)
//! global    when rand > p:
//!           x' = x_i + gamma Levy (x_i - g)                          if rand < m             (4) (9)
//!           x' = x_i + gamma Levy (x_i - g) + T(t) (x_j - x_k)       otherwise
//! local     otherwise:
//!           x' = x_i + epsilon (x_j - x_k)                           if rand < q             (6) (10)
//!           x' = x_i + G (x_j - x_i) + G' (x_l - x_k)                otherwise
//! accept    x' when it is better than x_i
//! ```
//!
//! `t` is the iteration, from 1; `T(t)` is Student's t with `t` degrees of freedom; `G, G' ~ N(0, 1)` are two draws (the paper
//! prints one symbol twice); each is one number per flower. `g` and the partners `j, k, l`, distinct and not `i`, are those of
//! the last iteration. Every `rand` is a fresh U(0, 1).
//!
//! Gao, Wang, Jiang and Hu, "Parameters Identification of PMSM Based on Improved Flower Pollination Algorithm", 2023, equations
//! (4) to (10).
//!
//! When to use it: to search a bounded box of a few dimensions without derivatives. On a linear fitness, such as the
//! paper's (11), least squares is exact and this is not needed.

use super::fpa::Fpa;
use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    logistic_map::logistic_start,
    moves::Moves,
    population::Population,
    setting::check_probability,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of tGFPA.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Tgfpa {
    /// Settings of the pollination underneath.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub pollination: Fpa,
    /// `m`: a global move stays without the t perturbation with this probability. 0.2.
    pub plain_global: f64,
    /// `q`: a local move stays without the Gaussian perturbation with this probability. 0.2; measured, 0.5 ends four times worse
    /// on the paper's fitness (11), 1 ten thousand times.
    pub plain_local: f64,
    /// Where the flowers start.
    pub start: Start,
}

/// How the first population is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
pub enum Start {
    /// Logistic map, equations (7) and (8).
    Logistic,
    /// Uniform in the box.
    Uniform,
}

impl Default for Tgfpa {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Tgfpa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { pollination: Fpa::DEFAULT, plain_global: 0.2, plain_local: 0.2, start: Start::Logistic };

    /// Equation (9).
    fn global(&self, i: usize, iteration: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws) {
        let plain = draws.uniform() < self.plain_global;
        self.pollination.global(i, flowers, trial, draws);
        if !plain {
            let t = draws.student_t(iteration);
            let [j, k] = draws.partners(i, flowers.len());
            flowers.add_difference(trial, t, j, k);
        }
    }

    /// Equation (10).
    fn local(&self, i: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws) {
        if draws.uniform() < self.plain_local {
            self.pollination.local(i, flowers, trial, draws);
        } else {
            self.pollination.stand_at_base(i, flowers, trial);
            let (towards, across) = (draws.normal(), draws.normal());
            let [j, k, l] = draws.partners(i, flowers.len());
            flowers.add_difference(trial, towards, j, i);
            flowers.add_difference(trial, across, l, k);
        }
    }
}

impl Moves for Tgfpa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        self.pollination.check()?;
        check_probability("plain_global", self.plain_global)?;
        check_probability("plain_local", self.plain_local)
    }

    /// Flowers on the logistic map, or uniform in the box.
    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        let positions = match self.start {
            Start::Logistic => logistic_start(setup.size, setup.bounds, setup.draws),
            Start::Uniform => setup.uniform(),
        };
        (positions, ())
    }

    /// One trial per flower. Draws per flower: `rand` (p), `rand` (m or q), then what the move needs, in the order of its
    /// equation, partners last.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let number = generation.number;
        generation.try_each(|i, flowers, trial, draws| {
            if draws.uniform() > self.pollination.switch_probability {
                self.global(i, number, flowers, trial, draws);
            } else {
                self.local(i, flowers, trial, draws);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        bounds::Bounds,
        objective::{Objective, objective_from},
    };
    use proptest::prelude::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Not separable, lowest near 0.3 in each coordinate of the unit box; with holes, not a number at one side.
    fn valley(bounds: &Bounds, holes: bool) -> impl Objective {
        let sides: Vec<(f64, f64)> = bounds.iter().collect();
        objective_from(sides.len(), move |x| {
            let z: Vec<f64> = x.iter().zip(&sides).map(|(x, (lower, upper))| (x - lower) / (upper - lower) - 0.3).collect();
            let sum: f64 = z.iter().sum();
            if holes && z[0] > 0.45 { f64::NAN } else { z.iter().map(|z| z * z).sum::<f64>() + 20.0 * sum * sum }
        })
    }

    /// The populations of a start and some iterations.
    fn course(
        size: usize,
        limit: usize,
        (bounds, draws, objective): (&Bounds, &mut Draws, &dyn Objective),
        method: &impl Moves<Memory = ()>,
    ) -> Vec<Population> {
        let mut population = Population::laid_out(method.start(&mut Setup { size, bounds, draws }).0, bounds.dimension());
        population.evaluate(objective, size);
        population.accept_all();
        let mut populations = vec![population.clone()];
        for number in 1..=limit {
            let mut generation = Generation { number, limit, size, bounds, draws, population: &mut population };
            method.propose(&mut (), &mut generation);
            generation.population.evaluate(objective, size);
            method.accept(&mut (), &mut generation);
            populations.push(population.clone());
        }
        populations
    }

    proptest! {
        // Seeds of failures are printed; no file of them is kept beside the sources.
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// tGFPA asks for one number more per flower (that of m or q); with that one put in, it makes FPA's moves.
        #[test]
        fn without_perturbations_it_is_fpa(
            sides in prop::collection::vec((-3.0..3.0f64, -3.0..3.0f64), 1..5),
            (n, iterations, seed, run) in (4usize..12, 0usize..20, any::<u64>(), any::<u64>()),
            switch_probability in 0.2..0.9f64,
            holes: bool,
        ) {
            let d = sides.len();
            let side = |end: f64| sides.iter().map(|&(exponent, offset)| 10f64.powf(exponent) * (offset + end)).collect::<Vec<f64>>();
            let bounds = Bounds::new(side(0.0), side(1.0)).unwrap();
            let objective = valley(&bounds, holes);
            let fpa = Fpa { switch_probability, ..Fpa::default() };
            let tgfpa = Tgfpa { pollination: fpa, plain_global: 1.0, plain_local: 1.0, start: Start::Uniform };

            let mut source = Draws::seeded(seed, run);
            let mut for_fpa: Vec<f64> = (0..n * d).map(|_| source.uniform()).collect();
            let mut for_tgfpa = for_fpa.clone();
            for flower in 0..n * iterations {
                let rand = source.uniform();
                let moves: Vec<f64> = if rand > switch_probability {
                    (0..2 * d).map(|_| source.normal()).collect()
                } else {
                    let epsilon = source.uniform();
                    let [j, k] = source.partners(flower % n, n);
                    vec![epsilon, j as f64, k as f64]
                };
                for_fpa.push(rand);
                for_fpa.extend(&moves);
                for_tgfpa.extend([rand, source.uniform()]);
                for_tgfpa.extend(&moves);
            }

            let (mut for_fpa, mut for_tgfpa) = (Draws::replay(for_fpa), Draws::replay(for_tgfpa));
            let plain = course(n, iterations, (&bounds, &mut for_fpa, &objective), &fpa);
            let same = course(n, iterations, (&bounds, &mut for_tgfpa, &objective), &tgfpa);
            prop_assert_eq!(plain, same);
        }
    }

    /// Replayed numbers cannot show which distribution was asked for: T(t) must have as many degrees of freedom as the iteration, from 1.
    #[test]
    fn the_t_perturbation_follows_the_iteration() {
        // Each cost lower than all before: every trial is taken, so that the positions show the moves.
        let evaluations = AtomicU64::new(0);
        let objective = objective_from(2, |_| -(evaluations.fetch_add(1, Ordering::Relaxed) as f64));
        // Only global moves, none of them along the Lévy step, all of them perturbed.
        let pollination = Fpa { switch_probability: 0.0, gamma: 0.0, ..Fpa::default() };
        let tgfpa = Tgfpa { pollination, plain_global: 0.0, plain_local: 0.0, start: Start::Uniform };
        let bounds = Bounds::new(vec![-1.0, 3.0], vec![1.0, 7.0]).unwrap();
        let (d, n) = (2, 5);

        let mut own_draws = Draws::seeded(1, 0);
        let search = (&bounds, &mut own_draws, &objective as &dyn Objective);
        let populations = course(n, 10, search, &tgfpa);
        let mut draws = Draws::seeded(1, 0);
        for _ in 0..n * d {
            draws.uniform();
        }
        for (iteration, pair) in (1..).zip(populations.windows(2)) {
            let before = pair[0].positions();
            for (i, after) in pair[1].positions().chunks_exact(d).enumerate() {
                // rand of p, rand of m, and the Lévy step's u and v per dimension, which gamma = 0 makes idle.
                draws.uniform();
                draws.uniform();
                for _ in 0..2 * d {
                    draws.normal();
                }
                let t = draws.student_t(iteration);
                let [j, k] = draws.partners(i, n);
                let mut expected: Vec<f64> = (0..d).map(|c| before[i * d + c] + t * (before[j * d + c] - before[k * d + c])).collect();
                bounds.clamp(&mut expected);
                assert_eq!(after, expected, "iteration {iteration}, flower {i}");
            }
        }
    }
}
