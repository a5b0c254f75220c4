//! tGFPA: flower pollination with a t-distributed and a Gaussian perturbation, the paper's algorithm.
//!
//! Idea: FPA, started on a chaotic map, whose global moves are often stirred by a t-distributed multiple of a difference of two
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
//! When to use it: to search a bounded box of a few dimensions without derivatives. On the linear fitness (11) least squares is
//! exact and this is not needed.

use super::{bounds::Bounds, chaos::logistic_start, draws::Draws, fpa::Fpa, population::Population};
use serde::{Deserialize, Serialize};

/// Settings of tGFPA.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tgfpa {
    /// Settings of the pollination underneath.
    pub pollination: Fpa,
    /// `m`: a global move stays without the t perturbation with this probability. 0.2.
    pub plain_global: f64,
    /// `q`: a local move stays without the Gaussian perturbation with this probability. 0.2; measured, 0.5 ends four times worse
    /// on fitness (11), 1 ten thousand times.
    pub plain_local: f64,
    /// Where the flowers start.
    pub start: Start,
}

/// How the first population is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Start {
    /// Logistic map, equations (7) and (8).
    Logistic,
    /// Uniform in the box.
    Uniform,
}

impl Default for Tgfpa {
    fn default() -> Self {
        Self { pollination: Fpa::default(), plain_global: 0.2, plain_local: 0.2, start: Start::Logistic }
    }
}

impl Tgfpa {
    /// Smallest population: a flower and its three partners.
    pub const MIN_POPULATION: usize = 4;

    /// The first positions, row after row.
    pub(super) fn start(&self, population: usize, bounds: &Bounds, draws: &mut Draws) -> Vec<f64> {
        match self.start {
            Start::Logistic => logistic_start(population, bounds, draws),
            Start::Uniform => bounds.uniform_start(population, draws),
        }
    }

    /// One trial per flower. Draws per flower: `rand` (p), `rand` (m or q), then what the move needs, in the order of its
    /// equation, partners last.
    pub(super) fn propose(&self, iteration: usize, flowers: &mut Population, bounds: &Bounds, draws: &mut Draws) {
        flowers.propose_each(bounds, |i, flowers, trial| {
            if draws.uniform() > self.pollination.switch_probability {
                self.global(i, iteration, flowers, trial, draws);
            } else {
                self.local(i, flowers, trial, draws);
            }
        });
    }

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
