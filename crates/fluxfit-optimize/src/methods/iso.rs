//! Improved snakes, after reference \[10\] of the paper, reconstructed from its abstract: an equation of the original may differ.
//!
//! Idea: the snakes of [`so`](super::so), started better and helped out of local minima.
//!
//! ```text
//! start     logistic map, mu = 4; with each x its quasi-opposite ~ U(c, L + U - x), c the box's centre; the best N of all 2 N
//! snakes    one iteration of SO
//! helpers   one trial g (1 + 0.1 (1 - t/T) Cauchy) per dimension, for the best snake;
//!           x_i + r (x_j - x_k) where rand < 1/2, for a quarter of the snakes, one r each (a cuckoo's move)
//! accept    what is better
//! ```
//!
//! An iteration takes N + 1 + N/4 evaluations, and t/T is counted in evaluations: all phases of SO are run through. Where T is an iteration
//! limit that the evaluations cut short by a fifth, the snakes eat longer and end ten to thirty times closer on the paper's fitness (11).
//! It is drawn to the origin as SO is, and more so by the factor on g.
//!
//! When to use it: to compare with the improved snakes that the paper cites.

use super::so::So;
use crate::{
    error::Error,
    iteration::{Generation, Setup},
    logistic_map::logistic_start,
    moves::Moves,
    population::Population,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Width of the Cauchy trial at the start, as a part of the best place.
const MUTATION: f64 = 0.1;

/// One snake in so many gets a cuckoo's move.
const HELPED: usize = 4;

/// Settings of the improved snakes: those of SO.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Iso {
    /// The snakes underneath.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub snakes: So,
}

impl Iso {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { snakes: So::DEFAULT };
}

/// Whom the trials under way are for, where they are not one for each snake.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Help {
    helps_next: bool,
    helped: Option<Vec<u32>>,
}

impl Moves for Iso {
    type Memory = Help;

    fn check(&self) -> Result<(), Error> {
        self.snakes.check()
    }

    /// Draws the map's starts, then one number per component of the quasi-opposites.
    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Help) {
        let mut positions = logistic_start(setup.size, setup.bounds, setup.draws);
        let sides: Vec<(f64, f64)> = setup.bounds.iter().collect();
        let opposite = |(x, (lower, upper)): (&f64, (f64, f64))| {
            let centre = lower / 2.0 + upper / 2.0;
            centre + setup.draws.uniform() * (lower + upper - x - centre)
        };
        let opposites: Vec<f64> = positions.iter().zip(sides.into_iter().cycle()).map(opposite).collect();
        positions.extend(opposites);
        positions.chunks_exact_mut(setup.bounds.dimension()).for_each(|position| setup.bounds.clamp(position));
        (positions, Help { helps_next: false, helped: None })
    }

    /// The best half, in their old order.
    fn begin(&self, _: &mut Help, generation: &mut Generation) {
        let mut best = generation.population.ranking();
        best.truncate(generation.size);
        best.sort_unstable();
        generation.population.keep(&best);
    }

    /// Draws of the helpers: a permutation, whose first quarter is helped; the Cauchy numbers; per snake helped r, its partners, one
    /// number per component.
    fn propose(&self, help: &mut Help, generation: &mut Generation) {
        help.helped = None;
        if help.helps_next {
            let count = generation.population.len();
            let helped: Vec<usize> = generation.draws.permutation(count).into_iter().take(count / HELPED).collect();
            let width = MUTATION * (1.0 - generation.progress());
            generation.try_some(1 + helped.len(), |k, snakes, trial, draws| {
                if k == 0 {
                    for (x, best) in trial.iter_mut().zip(snakes.best()) {
                        *x = best * (1.0 + width * draws.student_t(1));
                    }
                    return;
                }
                let i = helped[k - 1];
                snakes.copy_position(i, trial);
                let r = draws.uniform();
                let [to, from] = draws.partners(i, count);
                for ((x, to), from) in trial.iter_mut().zip(snakes.position(to)).zip(snakes.position(from)) {
                    if draws.uniform() < 0.5 {
                        *x += r * (to - from);
                    }
                }
            });
            let best = generation.population.ranking()[0];
            help.helped = Some([best].into_iter().chain(helped).map(|i| i as u32).collect());
        } else {
            self.snakes.crawl(generation);
        }
        help.helps_next = !help.helps_next;
    }

    fn accept(&self, help: &mut Help, generation: &mut Generation) {
        match &help.helped {
            None => generation.population.accept_better(),
            Some(helped) => {
                for (k, i) in helped.iter().enumerate() {
                    generation.population.take_if_better(*i as usize, k);
                }
            }
        }
    }

    fn fits(help: &Help, snakes: &Population) -> bool {
        let fits = |helped: &Vec<u32>| helped.len() == snakes.trial_costs().len() && helped.iter().all(|i| (*i as usize) < snakes.len());
        help.helped.as_ref().is_none_or(fits)
    }
}
