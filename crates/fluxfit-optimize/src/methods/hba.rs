//! HBA: the honey badger algorithm.
//!
//! Idea: a badger digs about the best place, with a strength that grows with the distance to its neighbour and falls with that to the
//! best place; or it follows a bird straight towards or past the best place.
//!
//! ```text
//! alpha = C exp(-t/T);   I = r |x_i - x_(i+1)|² / (4 pi |g - x_i|²);   F = ±1              r, F per badger
//! dig, with probability 1/2   x' = g + F beta I g + F r3 alpha (g - x_i) |cos(2 pi r4) (1 - cos(2 pi r5))|
//! else                        x' = g + F r7 alpha (g - x_i)                               r3, r4, r5, r7 per dimension
//! accept                      x' when it is better than x_i
//! ```
//!
//! F. A. Hashim et al., "Honey badger algorithm", Mathematics and Computers in Simulation 192 (2022) 84–110,
//! doi:10.1016/j.matcom.2021.08.013, with the authors' program: a guard of 2e-16 on each component of the two distances, which are
//! Euclidean and in the coordinates' own units. `t` is counted from 1.
//!
//! **Drawn to the origin**: `beta I g` grows with the distance of the best place from zero. And not invariant to a scale of one
//! coordinate, which weighs it in the two distances.
//!
//! **Held by faces at zero**: once all badgers have the coordinate 0, every term of the move has the factor 0 there, and none leaves it. A
//! fifth of the runs on the paper's fitness (11) ends so, far from the minimum.
//!
//! When to use it: to compare with what others report of it.

use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
    setting::check_factor,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Settings of HBA.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Hba {
    /// `beta`: strength of the smell. 6.
    pub beta: f64,
    /// `C`: the density factor `alpha` at the start. 2.
    pub c: f64,
}

impl Hba {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { beta: 6.0, c: 2.0 };

    /// The move of one badger. Draws r of I, the phase, the sign; per component r3, r4, r5, or r7.
    fn forage(&self, alpha: f64, i: usize, badgers: &Population, trial: &mut [f64], draws: &mut Draws) {
        let strength = draws.uniform() / (4.0 * PI);
        let digs = draws.uniform() < 0.5;
        let sign = draws.sign();
        let neighbour = badgers.position((i + 1) % badgers.len());
        let intensity = strength * distance(badgers.position(i), neighbour) / distance(badgers.position(i), badgers.best());
        badgers.copy_position(i, trial);
        for (x, best) in trial.iter_mut().zip(badgers.best()) {
            let towards = alpha * (best - *x);
            *x = if digs {
                let (r3, r4, r5) = (draws.uniform(), draws.uniform(), draws.uniform());
                let swing = ((TAU * r4).cos() * (1.0 - (TAU * r5).cos())).abs();
                best + sign * self.beta * intensity * best + sign * r3 * towards * swing
            } else {
                best + sign * draws.uniform() * towards
            };
        }
    }
}

/// The squared distance of two places, never zero.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b + f64::EPSILON) * (a - b + f64::EPSILON)).sum()
}

impl Moves for Hba {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_factor("beta", self.beta)?;
        check_factor("c", self.c)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per badger.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let alpha = self.c * (-generation.progress()).exp();
        generation.try_each(|i, badgers, trial, draws| self.forage(alpha, i, badgers, trial, draws));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the best place and all differences are zero, so is every term of the move.
    #[test]
    fn badgers_that_are_all_on_a_face_at_zero_stay_on_it() {
        let mut draws = Draws::seeded(1, 0);
        let mut leaves = |face: f64| {
            let positions = (0..6).flat_map(|_| [face, draws.uniform()]).collect();
            let mut badgers = Population::laid_out(positions, 2);
            badgers.tell(&[5.0, 4.0, 3.0, 2.0, 1.0, 6.0]);
            badgers.accept_all();
            let mut trial = [0.0; 2];
            (0..600).any(|k| {
                Hba::DEFAULT.forage(1.0, k % 6, &badgers, &mut trial, &mut draws);
                trial[0] != face
            })
        };
        assert!(!leaves(0.0));
        assert!(leaves(0.5));
    }
}
