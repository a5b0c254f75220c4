//! WOA: the whale optimization algorithm.
//!
//! Idea: a whale goes around the best one on a spiral, or near the best one, or, early in the search, near any other.
//!
//! ```text
//! a = 2 (1 - t/T);  per whale A = 2 a r - a,  C = 2 r',  l ~ U(-1, 1),  p ~ U(0, 1)
//! p < 0.5 and |A| < 1     x' = g - A |C g - x_i|
//! p < 0.5 otherwise       x' = x_r - A |C x_r - x_i|                     r any whale
//! p >= 0.5                x' = |g - x_i| exp(l) cos(2 pi l) + g
//! ```
//!
//! Every move is taken. S. Mirjalili and A. Lewis, "The whale optimization algorithm", Advances in Engineering Software 95 (2016) 51–67,
//! doi:10.1016/j.advengsoft.2016.01.008. `t` is counted from 1.
//!
//! **Drawn to the origin**: `|C g - x|` is a distance only where `g` is zero. On a function that is shifted, box and all, the course
//! is another one, and its end some 60 orders of magnitude worse.
//!
//! When to use it: to compare with what others report of it.

use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Settings of WOA: none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Woa {}

impl Woa {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self {};

    /// The move of one whale. Draws r of A, r' of C, l, p; then, where it searches, the other whale.
    pub(crate) fn swim(a: f64, i: usize, whales: &Population, trial: &mut [f64], draws: &mut Draws) {
        let near = 2.0 * a * draws.uniform() - a;
        let factor = 2.0 * draws.uniform();
        let l = 2.0 * draws.uniform() - 1.0;
        whales.copy_position(i, trial);
        if draws.uniform() >= 0.5 {
            let spiral = l.exp() * (TAU * l).cos();
            for (x, best) in trial.iter_mut().zip(whales.best()) {
                *x = (best - *x).abs() * spiral + best;
            }
        } else {
            let towards = if near.abs() < 1.0 { whales.best() } else { whales.position(draws.index(whales.len())) };
            for (x, towards) in trial.iter_mut().zip(towards) {
                *x = towards - near * (factor * towards - *x).abs();
            }
        }
    }
}

impl Moves for Woa {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    /// One trial per whale.
    fn propose(&self, (): &mut (), generation: &mut Generation) {
        let a = 2.0 * (1.0 - generation.progress());
        generation.try_each(|i, whales, trial, draws| Self::swim(a, i, whales, trial, draws));
    }

    fn accept(&self, (): &mut (), generation: &mut Generation) {
        generation.population.accept_all();
    }
}
