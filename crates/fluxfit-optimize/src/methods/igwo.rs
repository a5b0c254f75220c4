//! Improved grey wolves, after reference \[16\] of the paper, reconstructed from its abstract: an equation of the original may differ.
//!
//! Idea: the wolves of [`gwo`](super::gwo), started on a chaotic map, following alpha more than the others, and a cloud about it.
//!
//! ```text
//! start     logistic map, mu = 4
//! wolves    as GWO's, with a = 2 (1 - (t/T)²) and weights 0.5, 0.3, 0.2 of alpha, beta, delta
//! cloud     with probability 0.2 per dimension instead: a drop about alpha, En = |alpha - x_i|, He = En/10
//! accept    x' when it is better than x_i
//! ```
//!
//! Drawn to the origin, as GWO.
//!
//! When to use it: to compare with the wolves that the paper cites.

use super::{gwo::Leaders, ssa_cloud::drop};
use crate::{
    error::Error,
    iteration::{Generation, Setup},
    logistic_map::logistic_start,
    moves::Moves,
    population::Population,
    setting::check_probability,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Weights of alpha, beta and delta.
const WEIGHTS: [f64; 3] = [0.5, 0.3, 0.2];

/// Settings of the improved wolves.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Igwo {
    /// A coordinate is a drop of the cloud with this probability. 0.2.
    pub drops: f64,
}

impl Igwo {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { drops: 0.2 };
}

impl Moves for Igwo {
    type Memory = Leaders;

    fn check(&self) -> Result<(), Error> {
        check_probability("drops", self.drops)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Leaders) {
        let positions = logistic_start(setup.size, setup.bounds, setup.draws);
        let leaders = Leaders::none(&positions, setup.bounds.dimension());
        (positions, leaders)
    }

    fn begin(&self, leaders: &mut Leaders, generation: &mut Generation) {
        leaders.follow(generation.population);
    }

    /// One trial per wolf. Draws per component: whether it is a drop; N, N' of the drop, or per leader r of A, r' of C.
    fn propose(&self, leaders: &mut Leaders, generation: &mut Generation) {
        let u = generation.progress();
        let a = 2.0 * (1.0 - u * u);
        let leaders = leaders.places();
        generation.try_each(|i, wolves, trial, draws| {
            wolves.copy_position(i, trial);
            for (d, x) in trial.iter_mut().enumerate() {
                *x = if draws.uniform() < self.drops {
                    leaders[0][d] + drop((leaders[0][d] - *x).abs(), draws)
                } else {
                    let places = leaders.map(|leader| {
                        let near = 2.0 * a * draws.uniform() - a;
                        leader[d] - near * (2.0 * draws.uniform() * leader[d] - *x).abs()
                    });
                    WEIGHTS[0] * places[0] + WEIGHTS[1] * places[1] + WEIGHTS[2] * places[2]
                };
            }
        });
    }

    fn accept(&self, leaders: &mut Leaders, generation: &mut Generation) {
        generation.population.accept_better();
        leaders.follow(generation.population);
    }

    fn fits(leaders: &Leaders, wolves: &Population) -> bool {
        leaders.fit(wolves)
    }
}
