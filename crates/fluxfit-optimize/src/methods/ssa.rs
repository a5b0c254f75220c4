//! SSA: the salp swarm algorithm.
//!
//! Idea: half of the salps, the leaders, swim about the best place at a distance that falls with time; the others follow in a chain.
//!
//! ```text
//! c1 = 2 exp(-(4 t/T)²)
//! leader     x' = g ± c1 ((U - L) r + L)              the sign and r per dimension
//! follower   x' = (x_i + x'_(i-1)) / 2                x' as it is before it is put back into the box
//! ```
//!
//! Every move is taken. S. Mirjalili et al., "Salp swarm algorithm", Advances in Engineering Software 114 (2017) 163–191,
//! doi:10.1016/j.advengsoft.2017.07.002, (3.1) to (3.4). The article has one leader; the authors' program, and this one, has half of the
//! swarm. `t` is counted from 1.
//!
//! **Not invariant to a shift**: `+ L` adds the lower bound to a step. At the end c1 is 2e-7, and the swarm has collapsed long before.
//!
//! When to use it: to compare with what others report of it.

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of SSA: none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Ssa {}

impl Ssa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self {};

    /// `c1`, the distance of the leaders.
    pub(crate) fn distance(progress: f64) -> f64 {
        2.0 * (-(4.0 * progress) * (4.0 * progress)).exp()
    }
}

impl Moves for Ssa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per salp. Draws per component of a leader: r, the sign.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let (bounds, c1) = (generation.bounds, Self::distance(generation.progress()));
        let mut ahead = vec![0.0; bounds.dimension()];
        generation.try_each(|i, salps, trial, draws| {
            if i < salps.len() / 2 {
                for ((x, best), (lower, upper)) in trial.iter_mut().zip(salps.best()).zip(bounds.iter()) {
                    let step = c1 * ((upper - lower) * draws.uniform() + lower);
                    *x = best + draws.sign() * step;
                }
            } else {
                salps.copy_position(i, trial);
                trial.iter_mut().zip(&ahead).for_each(|(x, ahead)| *x = (*x + ahead) / 2.0);
            }
            ahead.copy_from_slice(trial);
        });
    }

    fn accept(&self, (): &mut (), generation: &mut Generation) {
        generation.population.accept_all();
    }
}
