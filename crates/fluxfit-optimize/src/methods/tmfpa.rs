//! tMFPA, after reference \[22\] of the paper, reconstructed from its abstract: an equation of the original may differ.
//!
//! Idea: flower pollination whose global moves always have tGFPA's t perturbation, and whose local moves start at the best flower.
//!
//! ```text
//! start     logistic map, mu = 4
//! global    when rand > p:   x' = x_i + gamma Levy (x_i - g) + T(t) (x_j - x_k)
//! local     otherwise:       x' = g + e (x_j - x_k) + e' (x_l - x_m);  e, e' ~ U(0, 1), one each per flower
//!           then with probability 0.05 a quarter of the coordinates (at least one) are drawn anew in the box
//! accept    x' when it is better than x_i
//! ```
//!
//! When to use it: to compare with tGFPA, whose nearest relative it is; it beats tGFPA on the paper's fitness (11).

use super::fpa::Fpa;
use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    logistic_map::logistic_start,
    moves::Moves,
    population::Population,
    setting::{check_factor, check_probability},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// One coordinate in so many is drawn anew.
const RENEWED: usize = 4;

/// Settings of tMFPA.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Tmfpa {
    /// `p`: a move is local with this probability. 0.8.
    pub switch_probability: f64,
    /// `gamma`: scale of the Lévy steps. 0.1.
    pub gamma: f64,
    /// Coordinates of a local move are drawn anew with this probability. 0.05.
    pub renewed: f64,
}

impl Tmfpa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { switch_probability: 0.8, gamma: 0.1, renewed: 0.05 };
}

impl Moves for Tmfpa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_probability("switch_probability", self.switch_probability)?;
        check_factor("gamma", self.gamma)?;
        check_probability("renewed", self.renewed)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (logistic_start(setup.size, setup.bounds, setup.draws), ())
    }

    /// One trial per flower. Draws per flower: `rand`; then the Lévy steps, T(t), j, k; or e, e', j, k, l, m, whether coordinates are
    /// drawn anew, and if so a permutation of them, whose first quarter is, and their places.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let (bounds, number) = (generation.bounds, generation.number);
        let pollination = Fpa { gamma: self.gamma, ..Fpa::DEFAULT };
        let global = |i: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws| {
            pollination.global(i, flowers, trial, draws);
            let t = draws.student_t(number);
            let [j, k] = draws.partners(i, flowers.len());
            flowers.add_difference(trial, t, j, k);
        };
        let sides: Vec<(f64, f64)> = bounds.iter().collect();
        let local = |i: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws| {
            trial.copy_from_slice(flowers.best());
            let (first, second) = (draws.uniform(), draws.uniform());
            let [j, k, l, m] = draws.partners(i, flowers.len());
            flowers.add_difference(trial, first, j, k);
            flowers.add_difference(trial, second, l, m);
            if draws.uniform() < self.renewed {
                let renewed = (trial.len() / RENEWED).max(1);
                for d in draws.permutation(trial.len()).into_iter().take(renewed) {
                    trial[d] = sides[d].0 + draws.uniform() * (sides[d].1 - sides[d].0);
                }
            }
        };
        generation.try_each(|i, flowers, trial, draws| {
            if draws.uniform() > self.switch_probability {
                global(i, flowers, trial, draws);
            } else {
                local(i, flowers, trial, draws);
            }
        });
    }
}
