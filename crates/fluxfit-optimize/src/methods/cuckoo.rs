//! Cuckoo search.
//!
//! Idea: each cuckoo flies a Lévy step scaled by its distance to the best nest; then most coordinates of all nests are moved along the
//! difference of two others. The better of the old and the new place is kept, both times.
//!
//! ```text
//! fly       x' = x_i + scale Levy (x_i - g) N(0, 1)                          Levy and N per dimension
//! abandon   x' = x_i + r (x_a - x_b) where rand > pa, else x_i               rand per dimension, one r; a, b of two permutations
//! ```
//!
//! X.-S. Yang and S. Deb, "Cuckoo search via Lévy flights", NaBIC 2009, doi:10.1109/NABIC.2009.5393690, with Yang's program. Two
//! evaluations per nest and round: flights and abandonments take turns, one iteration each.
//!
//! When to use it: to compare with what others report of it.

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    levy::levy,
    moves::Moves,
    setting::{check_factor, check_probability},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of cuckoo search.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Cuckoo {
    /// Scale of the flights. 0.01.
    pub scale: f64,
    /// `pa`: a coordinate stays where it is with this probability. 0.25.
    pub abandoned: f64,
}

impl Cuckoo {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { scale: 0.01, abandoned: 0.25 };

    /// Per component: the Lévy steps, then the normal factors.
    fn fly(&self, generation: &mut Generation) {
        generation.try_each(|i, nests, trial, draws| {
            trial.fill_with(|| levy(draws));
            for ((x, own), best) in trial.iter_mut().zip(nests.position(i)).zip(nests.best()) {
                *x = own + self.scale * *x * (own - best) * draws.normal();
            }
        });
    }

    /// The two permutations, r, then one number per nest and component.
    fn abandon(&self, generation: &mut Generation) {
        let count = generation.population.len();
        let (to, from) = (generation.draws.permutation(count), generation.draws.permutation(count));
        let r = generation.draws.uniform();
        generation.try_each(|i, nests, trial, draws| {
            let partners = nests.position(to[i]).iter().zip(nests.position(from[i]));
            for ((x, own), (to, from)) in trial.iter_mut().zip(nests.position(i)).zip(partners) {
                // Both are computed, then one is chosen: a branch on a random number is guessed wrongly too often.
                let (stays, moved) = (draws.uniform() <= self.abandoned, own + r * (to - from));
                *x = if stays { *own } else { moved };
            }
        });
    }
}

impl Moves for Cuckoo {
    /// Whether the next generation is one of abandonments.
    type Memory = bool;

    fn check(&self) -> Result<(), Error> {
        check_factor("scale", self.scale)?;
        check_probability("abandoned", self.abandoned)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, bool) {
        (setup.uniform(), false)
    }

    fn propose(&self, abandons: &mut bool, generation: &mut Generation) {
        if *abandons {
            self.abandon(generation);
        } else {
            self.fly(generation);
        }
        *abandons = !*abandons;
    }
}
