//! What LPSO and APSO share: particles that remember their best place and fly with a velocity.
//!
//! ```text
//! v' = w v + c1 rand (own best - x) + c2 rand (best - x),  each component within the velocity limit
//! x' = x + v', clamped to the box
//! ```
//!
//! J. Kennedy and R. Eberhart, "Particle swarm optimization", ICNN 1995, doi:10.1109/ICNN.1995.488968. Both `rand` are drawn per dimension.

use super::{bounds::Bounds, draws::Draws, population::Population};
use serde::{Deserialize, Serialize};

/// Settings of the flight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Flight {
    /// `c1`: pull of a particle's own best place. 2.
    pub cognitive: f64,
    /// `c2`: pull of the swarm's best place. 2.
    pub social: f64,
    /// Largest component of a velocity, as a fraction of the box's width. 0.1; with 0.2 some runs on fitness (11) stick.
    pub velocity_limit: f64,
}

impl Default for Flight {
    fn default() -> Self {
        Self { cognitive: 2.0, social: 2.0, velocity_limit: 0.1 }
    }
}

/// A particle's memory, beside its position in the [`Population`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Particles {
    velocities: Vec<f64>,
    own_best: Vec<f64>,
    own_best_costs: Vec<f64>,
}

impl Particles {
    /// Velocities uniform within the limit. Draws one number per component, row after row.
    pub(super) fn start(flight: &Flight, swarm: &Population, bounds: &Bounds, draws: &mut Draws) -> Self {
        let mut velocities = Vec::with_capacity(swarm.positions().len());
        for _ in 0..swarm.len() {
            velocities.extend(bounds.iter().map(|(lower, upper)| flight.velocity_limit * (upper - lower) * (2.0 * draws.uniform() - 1.0)));
        }
        Self { velocities, own_best: swarm.positions().to_vec(), own_best_costs: swarm.costs().to_vec() }
    }

    /// One trial per particle `i`, with inertia weight `inertia(i)`. Draws per component: `rand` of c1, `rand` of c2.
    pub(super) fn propose(
        &mut self,
        flight: &Flight,
        inertia: impl Fn(usize) -> f64,
        swarm: &mut Population,
        bounds: &Bounds,
        draws: &mut Draws,
    ) {
        let d = bounds.dimension();
        let (velocities, own_best) = (&mut self.velocities, &self.own_best);
        swarm.propose_each(bounds, |i, swarm, trial| {
            let w = inertia(i);
            swarm.stand_at(i, trial);
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
    pub(super) fn remember(&mut self, swarm: &Population) {
        for (i, &cost) in swarm.costs().iter().enumerate() {
            if cost < self.own_best_costs[i] {
                let place = swarm.position(i);
                let row = i * place.len()..(i + 1) * place.len();
                self.own_best_costs[i] = cost;
                self.own_best[row].copy_from_slice(place);
            }
        }
    }
}
