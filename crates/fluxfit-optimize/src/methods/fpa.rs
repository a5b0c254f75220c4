//! FPA: the flower pollination algorithm.
//!
//! Idea: each flower either flies on a Lévy step scaled by its distance to the best flower (global), or moves along the
//! difference of two others (local); the better of the old and the new place is kept.
//!
//! ```text
//! start     x_i uniform in the box
//! global    when rand > p:   x' = x_i + gamma Levy (x_i - g)                       (4)
//! local     otherwise:       x' = x_i + epsilon (x_j - x_k)                        (6)
//! ```
//!
//! `g` is the best flower and `j`, `k` are partners of the last iteration; one Lévy step per dimension, one `epsilon ~ U(0, 1)` per flower.
//! X.-S. Yang, "Flower pollination algorithm for global optimization", UCNC 2012, doi:10.1007/978-3-642-32894-7_27. His article makes
//! a move global when `rand < p`; his program and the paper, when `rand > p`, as here.
//!
//! When to use it: as the baseline of [`tgfpa`](super::tgfpa).

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

/// Settings of FPA.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Fpa {
    /// `p`: a move is local with this probability. 0.8; measured, 0.2 ends ten thousand times worse on the paper's fitness (11).
    pub switch_probability: f64,
    /// `gamma`: scale of the Lévy steps. 0.1; Yang's program has 0.01, which ends twenty times worse.
    pub gamma: f64,
    /// Where local moves start.
    pub local_base: LocalBase,
}

/// Where a local move starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
pub enum LocalBase {
    /// At the flower, as equation (6) has it.
    Accepted,
    /// At the flower's last trial, accepted or not, as in Yang's program: ends ten thousand times worse on the paper's fitness (11).
    LastTrial,
}

impl Default for Fpa {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Fpa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { switch_probability: 0.8, gamma: 0.1, local_base: LocalBase::Accepted };

    /// Equation (4).
    pub(crate) fn global(&self, i: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws) {
        flowers.copy_position(i, trial);
        for (x, best) in trial.iter_mut().zip(flowers.best()) {
            *x += self.gamma * levy(draws) * (*x - best);
        }
    }

    /// Equation (6).
    pub(crate) fn local(&self, i: usize, flowers: &Population, trial: &mut [f64], draws: &mut Draws) {
        self.stand_at_base(i, flowers, trial);
        let epsilon = draws.uniform();
        let [j, k] = draws.partners(i, flowers.len());
        flowers.add_difference(trial, epsilon, j, k);
    }

    /// Sets a trial to where its local move starts.
    pub(crate) fn stand_at_base(&self, i: usize, flowers: &Population, trial: &mut [f64]) {
        match self.local_base {
            LocalBase::Accepted => flowers.copy_position(i, trial),
            LocalBase::LastTrial => {}
        }
    }
}

impl Moves for Fpa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_probability("switch_probability", self.switch_probability)?;
        check_factor("gamma", self.gamma)
    }

    /// Flowers uniform in the box.
    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per flower. Draws per flower: `rand`; then the Lévy steps, or `epsilon` and the partners.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        generation.try_each(|i, flowers, trial, draws| {
            if draws.uniform() > self.switch_probability {
                self.global(i, flowers, trial, draws);
            } else {
                self.local(i, flowers, trial, draws);
            }
        });
    }
}
