//! DE: differential evolution, DE/rand/1/bin.
//!
//! Idea: a candidate is crossed with a third one that is moved along the difference of two others. The differences shrink with the
//! population, so the steps need no schedule.
//!
//! ```text
//! v      = x_a + F (x_b - x_c)                       a, b, c distinct, not i
//! x'_d   = v_d if rand < CR or d is the forced one, else x_i,d
//! bounds   a coordinate outside is put half way between the parent and the bound
//! accept   x' when it is at least as good as x_i
//! ```
//!
//! R. Storn and K. Price, "Differential evolution – a simple and efficient heuristic for global optimization over continuous spaces",
//! Journal of Global Optimization 11 (1997) 341–359, doi:10.1023/A:1008202821328. F and CR are the usual ones for functions that are
//! not separable.
//!
//! When to use it: as a yardstick; it has no bias towards any point of the box.

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    setting::{check_factor, check_probability},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of DE.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct De {
    /// `F`: factor of the difference. 0.5.
    pub factor: f64,
    /// `CR`: a coordinate is that of the moved candidate with this probability. 0.9.
    pub crossover: f64,
}

impl De {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { factor: 0.5, crossover: 0.9 };
}

impl Moves for De {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_factor("factor", self.factor)?;
        check_probability("crossover", self.crossover)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per candidate. Draws per candidate: a, b, c; the forced coordinate; one number per coordinate.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let bounds = generation.bounds;
        generation.try_each(|i, population, trial, draws| {
            let [a, b, c] = draws.partners(i, population.len());
            let forced = draws.index(trial.len());
            population.copy_position(i, trial);
            let [a, b, c] = [a, b, c].map(|j| population.position(j));
            for (d, (x, (lower, upper))) in trial.iter_mut().zip(bounds.iter()).enumerate() {
                if draws.uniform() < self.crossover || d == forced {
                    *x = between(a[d] + self.factor * (b[d] - c[d]), *x, lower, upper);
                }
            }
        });
    }

    fn accept(&self, (): &mut (), generation: &mut Generation) {
        generation.population.accept_no_worse();
    }
}

/// A coordinate, or half way between the parent and the bound that it lies beyond.
pub(crate) fn between(x: f64, parent: f64, lower: f64, upper: f64) -> f64 {
    if x < lower {
        (lower + parent) / 2.0
    } else if x > upper {
        (upper + parent) / 2.0
    } else {
        x
    }
}
