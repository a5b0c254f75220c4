//! LPSO: particle swarm with a linearly falling inertia weight.
//!
//! Idea: fly far at first, settle later.
//!
//! ```text
//! w(t) = w_start + (w_end - w_start) (t - 1) / (iterations - 1),  t = 1 .. iterations
//! ```
//!
//! Y. Shi and R. Eberhart, "A modified particle swarm optimizer", CEC 1998, doi:10.1109/ICEC.1998.699146; the flight itself: [`Flight`].
//!
//! When to use it: as the paper's second baseline.

use super::particles::{Flight, Particles};
use crate::{
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
    setting::check_factor,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of LPSO.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Lpso {
    /// The flight underneath.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub flight: Flight,
    /// Inertia weight of the first iteration. 0.9.
    pub inertia_start: f64,
    /// Inertia weight of the last iteration. 0.4.
    pub inertia_end: f64,
}

impl Default for Lpso {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Lpso {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { flight: Flight::DEFAULT, inertia_start: 0.9, inertia_end: 0.4 };

    /// The inertia weight of iteration `iteration` (from 1) out of `iterations`; past the last one it stays.
    fn inertia(&self, iteration: usize, iterations: usize) -> f64 {
        let fraction = (iteration.saturating_sub(1) as f64 / iterations.saturating_sub(1).max(1) as f64).min(1.0);
        self.inertia_start + (self.inertia_end - self.inertia_start) * fraction
    }
}

impl Moves for Lpso {
    type Memory = Particles;

    fn check(&self) -> Result<(), Error> {
        self.flight.check()?;
        check_factor("inertia_start", self.inertia_start)?;
        check_factor("inertia_end", self.inertia_end)
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
        let inertia = self.inertia(generation.number, generation.limit);
        particles.fly(&self.flight, |_| inertia, generation);
    }

    fn accept(&self, particles: &mut Particles, generation: &mut Generation) {
        generation.population.accept_all();
        particles.remember(generation.population);
    }

    fn fits(particles: &Particles, swarm: &Population) -> bool {
        particles.fit(swarm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weight_falls_from_start_to_end() {
        let lpso = Lpso::default();
        assert_eq!(lpso.inertia(1, 300), 0.9);
        assert!((lpso.inertia(151, 301) - 0.65).abs() < 1e-15);
        assert_eq!(lpso.inertia(300, 300), 0.4);
        assert_eq!(lpso.inertia(1, 1), 0.9);
    }
}
