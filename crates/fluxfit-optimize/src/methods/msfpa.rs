//! Flower pollination with several strategies, after reference \[21\] of the paper, reconstructed from its abstract, which says little:
//! of all reconstructions this one is the least certain.
//!
//! ```text
//! global    when rand > p:   x' = w x_i + (1 - w) g + gamma Levy (x_i - g),  w = 0.9 - 0.5 t/T
//! local     otherwise, half: x' = x_i + e (x_j - x_k) + r (g - x_i)          e ~ U(0, 1) per flower, r per dimension
//!           the other half:  x' = g + F (x_j - x_k) where rand < 0.9 or the coordinate is the forced one, else x_i;  F ~ N(0.5, 0.3)
//! accept    x' when it is better than x_i
//! ```
//!
//! When to use it: to compare with what others report of such variants.

use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    levy::levy,
    moves::Moves,
    population::Population,
    setting::{check_factor, check_probability},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Mean and standard deviation of F.
const FACTOR: (f64, f64) = (0.5, 0.3);

/// `w` at the start, and how far it falls.
const INERTIA: (f64, f64) = (0.9, 0.5);

/// Settings of the pollination with several strategies.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Msfpa {
    /// `p`: a move is local with this probability. 0.8.
    pub switch_probability: f64,
    /// `gamma`: scale of the Lévy steps. 0.1.
    pub gamma: f64,
    /// A coordinate of a move of differential evolution is the moved one with this probability. 0.9.
    pub crossover: f64,
}

impl Msfpa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { switch_probability: 0.8, gamma: 0.1, crossover: 0.9 };

    /// A local move. Draws which half; e, j, k, then r per component; or F, j, k, the forced coordinate, one number per component.
    fn local(&self, i: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws) {
        if draws.uniform() < 0.5 {
            let epsilon = draws.uniform();
            let [j, k] = draws.partners(i, flowers.len());
            flowers.add_difference(trial, epsilon, j, k);
            for ((x, own), best) in trial.iter_mut().zip(flowers.position(i)).zip(flowers.best()) {
                *x += draws.uniform() * (best - own);
            }
        } else {
            let factor = FACTOR.0 + FACTOR.1 * draws.normal();
            let [j, k] = draws.partners(i, flowers.len()).map(|j| flowers.position(j));
            let forced = draws.index(trial.len());
            for (d, (x, best)) in trial.iter_mut().zip(flowers.best()).enumerate() {
                if draws.uniform() < self.crossover || d == forced {
                    *x = best + factor * (j[d] - k[d]);
                }
            }
        }
    }
}

impl Moves for Msfpa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_probability("switch_probability", self.switch_probability)?;
        check_factor("gamma", self.gamma)?;
        check_probability("crossover", self.crossover)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per flower. Draws per flower: `rand`; the Lévy steps, or what the local move needs.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let w = INERTIA.0 - INERTIA.1 * generation.progress();
        generation.try_each(|i, flowers, trial, draws| {
            flowers.copy_position(i, trial);
            if draws.uniform() > self.switch_probability {
                for (x, best) in trial.iter_mut().zip(flowers.best()) {
                    *x = w * *x + (1.0 - w) * best + self.gamma * levy(draws) * (*x - best);
                }
            } else {
                self.local(i, flowers, trial, draws);
            }
        });
    }
}
