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

use super::particles::{Flight, Particles};
use crate::{
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::{Population, WORST_COST},
    setting::check_factor,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of APSO.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Apso {
    /// The flight underneath.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub flight: Flight,
    /// Inertia weight of the best particle. 0.4.
    pub inertia_min: f64,
    /// Inertia weight of those worse than the average. 0.9.
    pub inertia_max: f64,
}

impl Default for Apso {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Apso {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { flight: Flight::DEFAULT, inertia_min: 0.4, inertia_max: 0.9 };

    /// The inertia weight that follows from a particle's cost, given the current costs of the swarm.
    fn inertia(&self, costs: &[f64]) -> impl Fn(f64) -> f64 + use<> {
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

impl Moves for Apso {
    type Memory = Particles;

    fn check(&self) -> Result<(), Error> {
        self.flight.check()?;
        check_factor("inertia_min", self.inertia_min)?;
        check_factor("inertia_max", self.inertia_max)
    }

    /// Particles uniform in the box, with their velocities.
    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Particles) {
        Particles::start(&self.flight, setup)
    }

    fn begin(&self, particles: &mut Particles, generation: &mut Generation) {
        particles.remember(generation.population);
    }

    /// One flight per particle.
    fn propose(&self, particles: &mut Particles, generation: &mut Generation) {
        let costs = generation.population.costs().to_vec();
        let inertia = self.inertia(&costs);
        particles.fly(&self.flight, |i| inertia(costs[i]), generation);
    }

    fn accept(&self, particles: &mut Particles, generation: &mut Generation) {
        generation.population.accept_all();
        particles.remember(generation.population);
    }

    fn fits(particles: &Particles, swarm: &Population) -> bool {
        particles.fit(swarm)
    }
}
