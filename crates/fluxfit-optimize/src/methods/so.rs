//! SO: the snake optimizer.
//!
//! Idea: two halves, males and females, explore while there is little food, go to it while it is hot, then fight or mate.
//!
//! ```text
//! Te = exp(-t/T),  Q = c1 exp(t/T - 1);  own half's random member r, opposite half's best b, opposite partner p of the same number
//! Q < 0.25          x' = x_r ± c2 exp(-f_r/f_i) ((U - L) r + L)             r, the member and the sign per dimension
//! else Te > 0.6     x' = g ± c3 Te r (g - x_i)                              the sign per snake
//! else              fight, with probability 0.4 (one number an iteration):
//!                   x' = x_i + c3 exp(-f_b/f_i) r (Q b - x_i)
//!                   or mate: x' = x_i + c3 exp(-f_p/f_i) r (Q x_p - x_i);
//!                   with probability 1/2 the worst of each half is drawn anew in the box
//! accept            x' when it is better than x_i
//! ```
//!
//! F. A. Hashim and A. G. Hussien, "Snake optimizer", Knowledge-Based Systems 242 (2022) 108320, doi:10.1016/j.knosys.2022.108320.
//! `t` is counted from 1. The authors' programs differ in c2 (0.05 and 0.5).
//!
//! **Drawn to the origin** by `Q b` with Q < 1, and moved by the lower bound. `exp(-f_a/f_b)` also changes with a constant added to the
//! cost: a noisy log, whose lowest cost is large, makes all of them 1/e.
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
use std::ops::Range;

/// Less food than this: the snakes explore.
const FOOD: f64 = 0.25;

/// Hotter than this: they go to the food.
const HOT: f64 = 0.6;

/// They fight where a number is above this, else mate.
const PEACE: f64 = 0.6;

/// Settings of SO.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct So {
    /// `c1`: the food at the end. 0.5.
    pub c1: f64,
    /// `c2`: scale of the exploration. 0.05.
    pub c2: f64,
    /// `c3`: scale of the other moves. 2.
    pub c3: f64,
}

/// What the snakes do in an iteration.
enum Mood {
    Explore,
    Eat(f64),
    Fight(f64),
    /// Whether the worst of each half are drawn anew.
    Mate(f64, bool),
}

impl So {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { c1: 0.5, c2: 0.05, c3: 2.0 };

    /// One trial per snake. Draws: where they fight or mate, which; where they mate, whether the worst are drawn anew; then per snake
    /// what its move needs, per component in the order of its equation.
    pub(crate) fn crawl(&self, generation: &mut Generation) {
        let u = generation.progress();
        let (heat, food) = ((-u).exp(), self.c1 * (u - 1.0).exp());
        let mood = match () {
            () if food < FOOD => Mood::Explore,
            () if heat > HOT => Mood::Eat(heat),
            () if generation.draws.uniform() > PEACE => Mood::Fight(food),
            () => Mood::Mate(food, generation.draws.uniform() < 0.5),
        };
        let bounds = generation.bounds;
        let count = generation.population.len();
        let halves = [0..count / 2, count / 2..count];
        let of_lowest = |half: &Range<usize>| first_by(half, |a, b| a < b, generation.population);
        let of_highest = |half: &Range<usize>| first_by(half, |a, b| a > b, generation.population);
        let (best, worst) = (halves.each_ref().map(of_lowest), halves.each_ref().map(of_highest));
        generation.try_each(|i, snakes, trial, draws| {
            let own = usize::from(i >= count / 2);
            snakes.copy_position(i, trial);
            match mood {
                Mood::Explore => {
                    for (d, (x, (lower, upper))) in trial.iter_mut().zip(bounds.iter()).enumerate() {
                        let member = halves[own].start + draws.index(halves[own].len());
                        let step = self.c2 * attraction(snakes, member, i) * ((upper - lower) * draws.uniform() + lower);
                        *x = snakes.position(member)[d] + draws.sign() * step;
                    }
                }
                Mood::Eat(heat) => {
                    let sign = draws.sign();
                    for (x, food) in trial.iter_mut().zip(snakes.best()) {
                        *x = food + sign * self.c3 * heat * draws.uniform() * (food - *x);
                    }
                }
                Mood::Fight(food) => self.approach(best[1 - own], food, i, snakes, trial, draws),
                Mood::Mate(_, true) if i == worst[own] => {
                    for (x, (lower, upper)) in trial.iter_mut().zip(bounds.iter()) {
                        *x = lower + draws.uniform() * (upper - lower);
                    }
                }
                Mood::Mate(food, _) => {
                    let partner = halves[1 - own].start + (i - halves[own].start) % halves[1 - own].len().max(1);
                    self.approach(partner, food, i, snakes, trial, draws);
                }
            }
        });
    }

    /// The move of a fight or of mating.
    fn approach(&self, other: usize, food: f64, i: usize, snakes: &Population, trial: &mut [f64], draws: &mut Draws) {
        let strength = self.c3 * attraction(snakes, other, i);
        for (x, other) in trial.iter_mut().zip(snakes.position(other)) {
            *x += strength * draws.uniform() * (food * other - *x);
        }
    }
}

/// The first of a half whose cost comes before those of all others.
fn first_by(half: &Range<usize>, comes_before: impl Fn(f64, f64) -> bool, snakes: &Population) -> usize {
    half.clone().fold(half.start, |first, i| if comes_before(snakes.costs()[i], snakes.costs()[first]) { i } else { first })
}

/// `exp(-f_a/f_i)`, with a guard against a cost of zero.
fn attraction(snakes: &Population, a: usize, i: usize) -> f64 {
    (-snakes.costs()[a] / (snakes.costs()[i] + f64::EPSILON)).exp()
}

impl Moves for So {
    type Memory = ();

    fn check(&self) -> Result<(), Error> {
        check_factor("c1", self.c1)?;
        check_factor("c2", self.c2)?;
        check_factor("c3", self.c3)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, ()) {
        (setup.uniform(), ())
    }

    fn propose(&self, (): &mut (), generation: &mut Generation) {
        self.crawl(generation);
    }
}
