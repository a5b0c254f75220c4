//! Salps in a normal cloud, after reference \[13\] of the paper, reconstructed from its abstract: an equation of the original may differ.
//!
//! Idea: the leaders of [`ssa`](super::ssa); most coordinates of the followers are drops of a cloud about the best place.
//!
//! ```text
//! leader     x' = g ± c1 ((U - L) r + L),  c1 = 2 exp(-(4 t/T)²)
//! follower   where rand < 0.8:  x' = g + En' N',  En' = En + He N,  He = En/10,  En = 0.1 (U - L) (1 - t/T)^4 + 0.5 |x_i - g|
//!            otherwise          x' = (x_i + x'_(i-1)) / 2
//! accept     x' when it is better than x_i
//! ```
//!
//! The normal cloud: D. Li and Y. Du, "Artificial Intelligence with Uncertainty", 2007. N, N' ~ N(0, 1) per dimension.
//! Not invariant to a shift, as SSA.
//!
//! When to use it: to compare with the salps that the paper cites.

use super::ssa::Ssa;
use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    setting::check_probability,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// He, as a part of En.
const HYPER_ENTROPY: f64 = 0.1;

/// Settings of the salps in a cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SsaCloud {
    /// A coordinate of a follower is a drop of the cloud with this probability. 0.8.
    pub drops: f64,
}

impl SsaCloud {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { drops: 0.8 };
}

/// How far a drop of a normal cloud of this entropy falls from its centre. Draws N, N'.
pub(crate) fn drop(entropy: f64, draws: &mut Draws) -> f64 {
    let wide = entropy + HYPER_ENTROPY * entropy * draws.normal();
    wide * draws.normal()
}

impl Moves for SsaCloud {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_probability("drops", self.drops)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per salp. Draws per component: of a leader r, the sign; of a follower whether it is a drop, then N, N' if so.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let (bounds, left) = (generation.bounds, 1.0 - generation.progress());
        let c1 = Ssa::distance(generation.progress());
        let mut ahead = vec![0.0; bounds.dimension()];
        generation.try_each(|i, salps, trial, draws| {
            let is_leader = i < salps.len() / 2;
            salps.copy_position(i, trial);
            for (((x, best), (lower, upper)), ahead) in trial.iter_mut().zip(salps.best()).zip(bounds.iter()).zip(&ahead) {
                *x = if is_leader {
                    let step = c1 * ((upper - lower) * draws.uniform() + lower);
                    best + draws.sign() * step
                } else if draws.uniform() < self.drops {
                    let entropy = 0.1 * (upper - lower) * left * left * left * left + 0.5 * (*x - best).abs();
                    best + drop(entropy, draws)
                } else {
                    (*x + ahead) / 2.0
                };
            }
            ahead.copy_from_slice(trial);
        });
    }
}
