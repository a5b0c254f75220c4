//! APSO: particle swarm whose inertia weight follows each particle's cost.
//!
//! Idea: a particle better than the average settles, one worse than the average keeps flying.
//!
//! ```text
//! w_i = w_min + (w_max - w_min) (f_i - f_min) / (f_avg - f_min)   if f_i <= f_avg
//! w_i = w_max                                                     otherwise
//! ```
//!
//! `f` are the costs of the places where the particles are, those that are finite; with all of them equal the weight is `w_min`.
//! The name "APSO" covers several methods; this is the one usual beside LPSO in the literature of motor identification. The
//! flight itself: [`Flight`].
//!
//! When to use it: the strongest of the paper's baselines on smooth, single-valleyed fitness functions.

use super::{particles::Flight, population::WORST_COST};
use serde::{Deserialize, Serialize};

/// Settings of APSO.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Apso {
    /// The flight underneath.
    pub flight: Flight,
    /// Inertia weight of the best particle. 0.4.
    pub inertia_min: f64,
    /// Inertia weight of those worse than the average. 0.9.
    pub inertia_max: f64,
}

impl Default for Apso {
    fn default() -> Self {
        Self { flight: Flight::default(), inertia_min: 0.4, inertia_max: 0.9 }
    }
}

impl Apso {
    /// The inertia weight that follows from a particle's cost, given the current costs of the swarm.
    pub(super) fn inertia(&self, costs: &[f64]) -> impl Fn(f64) -> f64 + use<> {
        let finite = || costs.iter().copied().filter(|cost| *cost < WORST_COST);
        let lowest = finite().fold(f64::INFINITY, f64::min);
        let count = finite().count() as f64;
        let average = finite().map(|cost| cost / count).sum::<f64>();
        let Self { inertia_min, inertia_max, .. } = *self;
        move |cost| {
            if average <= lowest {
                inertia_min
            } else if cost > average {
                inertia_max
            } else {
                inertia_min + (inertia_max - inertia_min) * (cost - lowest) / (average - lowest)
            }
        }
    }
}
