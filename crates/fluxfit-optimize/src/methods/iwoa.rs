//! Improved whales, after reference \[14\] of the paper, reconstructed from its abstract: an equation of the original may differ.
//!
//! Idea: the whales of [`woa`](super::woa), started on a chaotic map, taking only what is better, with trials about the best one.
//!
//! ```text
//! start     logistic map, mu = 4
//! whales    as WOA's, with a = 2 (1 - (t/T)²)
//! trials    five an iteration: g + 0.1 (U - L) (1 - t/T)³ Cauchy, each dimension with probability 1/2, for the best whale
//! accept    what is better
//! ```
//!
//! An iteration takes N + 5 evaluations. Drawn to the origin, as WOA. The source starts a neural network with it. That is not built: a
//! network of 4-10-4 neurons that is trained with simulated voltages at fixed currents and speed repeats, to some tenths of a per cent
//! and at that operating point only, a formula that is solved in microseconds (docs/study.md of the repository has the figures).
//!
//! When to use it: to compare with the whales that the paper cites.

use super::woa::Woa;
use crate::{
    error::Error,
    iteration::{Generation, Setup},
    logistic_map::logistic_start,
    moves::Moves,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Trials about the best whale in each iteration.
const TRIALS: usize = 5;

/// Settings of the improved whales.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Iwoa {
    /// Width of the trials about the best whale at the start, as a part of the box's. 0.1.
    pub width: f64,
}

impl Iwoa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { width: 0.1 };
}

impl Moves for Iwoa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        crate::setting::check_fraction_of_box("width", self.width)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (logistic_start(setup.size, setup.bounds, setup.draws), ())
    }

    /// One trial per whale, then those about the best one. Draws of those per component: whether it moves, the Cauchy number if so.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let (bounds, u, count) = (generation.bounds, generation.progress(), generation.population.len());
        let (a, left) = (2.0 * (1.0 - u * u), 1.0 - u);
        generation.try_some(count + TRIALS, |i, whales, trial, draws| {
            if i < count {
                Woa::swim(a, i, whales, trial, draws);
                return;
            }
            trial.copy_from_slice(whales.best());
            for (x, (lower, upper)) in trial.iter_mut().zip(bounds.iter()) {
                if draws.uniform() < 0.5 {
                    *x += self.width * (upper - lower) * left * left * left * draws.student_t(1);
                }
            }
        });
    }

    fn accept(&self, (): &mut (), generation: &mut Generation) {
        let population = &mut *generation.population;
        let best = population.ranking()[0];
        population.accept_better();
        for trial in population.len()..population.trial_costs().len() {
            population.take_if_better(best, trial);
        }
    }
}
