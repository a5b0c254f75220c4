//! What LPSO and APSO share: particles that remember their best place and fly with a velocity.
//!
//! ```text
//! v' = w v + c1 rand (own best - x) + c2 rand (best - x),  each component within the velocity limit
//! x' = x + v', clamped to the box
//! ```
//!
//! J. Kennedy and R. Eberhart, "Particle swarm optimization", ICNN 1995, doi:10.1109/ICNN.1995.488968. Both `rand` are drawn per dimension.

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    population::{Population, WORST_COST},
    setting::{check_factor, check_fraction_of_box},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of the flight.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Flight {
    /// `c1`: pull of a particle's own best place. 2.
    pub cognitive: f64,
    /// `c2`: pull of the swarm's best place. 2.
    pub social: f64,
    /// Largest component of a velocity, as a fraction of the box's width. 0.1; with 0.2 some runs on the paper's fitness (11) stick.
    pub velocity_limit: f64,
}

impl Default for Flight {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Flight {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { cognitive: 2.0, social: 2.0, velocity_limit: 0.1 };

    /// Refuses settings out of range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        check_factor("cognitive", self.cognitive)?;
        check_factor("social", self.social)?;
        check_fraction_of_box("velocity_limit", self.velocity_limit)
    }
}

/// What each particle remembers, beside its position in the [`Population`].
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Particles {
    velocities: Vec<f64>,
    own_best: Vec<f64>,
    own_best_costs: Vec<f64>,
}

impl Particles {
    /// Particles uniform in the box, their velocities uniform within the limit. Draws one number per component, row after row: first
    /// of the positions, then of the velocities.
    pub(crate) fn start(flight: &Flight, setup: &mut Setup) -> (Vec<f64>, Self) {
        let positions = setup.uniform();
        let mut velocities = Vec::with_capacity(positions.len());
        for _ in 0..setup.size {
            let widths = setup.bounds.iter().map(|(lower, upper)| upper - lower);
            velocities.extend(widths.map(|width| flight.velocity_limit * width * (2.0 * setup.draws.uniform() - 1.0)));
        }
        let particles = Self { velocities, own_best: positions.clone(), own_best_costs: vec![WORST_COST; setup.size] };
        (positions, particles)
    }

    /// Moves each particle `i` with inertia weight `inertia(i)`. Draws per component: `rand` of c1, `rand` of c2.
    pub(crate) fn fly(&mut self, flight: &Flight, inertia: impl Fn(usize) -> f64, generation: &mut Generation) {
        let bounds = generation.bounds;
        let d = bounds.dimension();
        let (velocities, own_best) = (&mut self.velocities, &self.own_best);
        generation.try_each(|i, swarm, trial, draws| {
            let w = inertia(i);
            swarm.copy_position(i, trial);
            let row = i * d..(i + 1) * d;
            let parts = velocities[row.clone()].iter_mut().zip(&own_best[row]).zip(swarm.best()).zip(bounds.iter());
            for (x, (((v, own), best), (lower, upper))) in trial.iter_mut().zip(parts) {
                let limit = flight.velocity_limit * (upper - lower);
                let pull = flight.cognitive * draws.uniform() * (own - *x) + flight.social * draws.uniform() * (best - *x);
                *v = (w * *v + pull).clamp(-limit, limit);
                *x += *v;
            }
        });
    }

    /// Remembers the places that are better than all before.
    pub(crate) fn remember(&mut self, swarm: &Population) {
        for (i, &cost) in swarm.costs().iter().enumerate() {
            if cost < self.own_best_costs[i] {
                let place = swarm.position(i);
                let row = i * place.len()..(i + 1) * place.len();
                self.own_best_costs[i] = cost;
                self.own_best[row].copy_from_slice(place);
            }
        }
    }

    /// Whether the memory is that of a swarm of this size.
    pub(crate) fn fit(&self, swarm: &Population) -> bool {
        let numbers = swarm.positions().len();
        self.velocities.len() == numbers && self.own_best.len() == numbers && self.own_best_costs.len() == swarm.len()
    }
}
