//! Bacteria in niches, after reference \[11\] of the paper, reconstructed from its abstract: an equation of the original may differ.
//!
//! Idea: the bacteria of [`bfo`](super::bfo), taking only what is better, with a step that shrinks, drawn to their nearest better
//! neighbour.
//!
//! ```text
//! step      C = 0.1 · 10^(-6 t/T)
//! tumble    x' = x_i + C d/|d| (U - L), and with probability 1/2 + 1.5 r (n_i - x_i)     n_i the nearest better one, in the unit box
//! swim      on by C d/|d| (U - L), up to 4 times while it is better
//! split     after 20 tumbles the better half has offspring in the places of the other: x + r (x_j - x_k), j, k of the better half
//! scatter   after 4 splits each but the best is drawn anew in the box with probability 0.05
//! ```
//!
//! `r` is drawn per dimension. A tumble takes one to five evaluations, a split N/2.
//!
//! When to use it: to compare with the niche bacteria that the paper cites.

use super::bfo::{SWIMS, tumble};
use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
    setting::{check_count, check_factor, check_fraction_of_box, check_probability},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// The step falls by so many powers of ten.
const DECADES: f64 = 6.0;

/// A tumble is drawn to a neighbour with this probability.
const DRAWN: f64 = 0.5;

/// Settings of the bacteria in niches.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Nbfo {
    /// `C` at the start, as a fraction of the box's width. 0.1.
    pub step: f64,
    /// Pull of the nearest better neighbour. 1.5.
    pub pull: f64,
    /// A bacterium is scattered with this probability. 0.05.
    pub scattered: f64,
    /// Tumbles between two splits. 20.
    pub tumbles: u32,
    /// Splits between two scatterings. 4.
    pub splits: u32,
}

impl Nbfo {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { step: 0.1, pull: 1.5, scattered: 0.05, tumbles: 20, splits: 4 };

    /// A step of one bacterium, in which it swims on too, and the pull of its neighbour. Draws the direction, whether a neighbour draws it,
    /// and r if so and there is one.
    fn step(&self, size: f64, i: usize, generation: &Generation, draws: &mut Draws) -> (Vec<f64>, Vec<f64>) {
        let bacteria = &*generation.population;
        let mut step = tumble(generation.bounds.dimension(), draws);
        for (d, (lower, upper)) in step.iter_mut().zip(generation.bounds.iter()) {
            *d *= size * (upper - lower);
        }
        let mut pull = vec![0.0; step.len()];
        if draws.uniform() < DRAWN
            && let Some(neighbour) = nearest_better(i, generation)
        {
            for ((d, to), from) in pull.iter_mut().zip(bacteria.position(neighbour)).zip(bacteria.position(i)) {
                *d = self.pull * draws.uniform() * (to - from);
            }
        }
        (step, pull)
    }
}

/// The nearest of lower cost, in the unit box.
fn nearest_better(i: usize, generation: &Generation) -> Option<usize> {
    let bacteria = &*generation.population;
    let distance = |k: usize| -> f64 {
        let parts = bacteria.position(i).iter().zip(bacteria.position(k)).zip(generation.bounds.iter());
        parts.map(|((a, b), (lower, upper))| ((a - b) / (upper - lower)).powi(2)).sum()
    };
    let better = (0..bacteria.len()).filter(|k| bacteria.costs()[*k] < bacteria.costs()[i]);
    better.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
}

/// What the trials under way are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
enum Phase {
    Tumble,
    Swim,
    Split,
    Scatter,
}

/// What the bacteria do, and have done.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Niches {
    phase: Phase,
    /// Whose trials are under way.
    moving: Vec<bool>,
    /// The last step of each, without the pull.
    steps: Vec<f64>,
    swims: u32,
    tumbles: u32,
    splits: u32,
}

impl Niches {
    fn movers(&self) -> Vec<usize> {
        (0..self.moving.len()).filter(|i| self.moving[*i]).collect()
    }
}

impl Moves for Nbfo {
    type Memory = Niches;

    fn check(&self) -> Result<(), Error> {
        check_fraction_of_box("step", self.step)?;
        check_factor("pull", self.pull)?;
        check_probability("scattered", self.scattered)?;
        check_count("tumbles", self.tumbles)?;
        check_count("splits", self.splits)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Niches) {
        let positions = setup.uniform();
        let (moving, steps) = (vec![false; setup.size], vec![0.0; positions.len()]);
        (positions, Niches { phase: Phase::Tumble, moving, steps, swims: 0, tumbles: 0, splits: 0 })
    }

    /// Draws of a scattering: one number for each but the best, then the places of those that go; of a split: per offspring its partners,
    /// then r; of a tumble: the steps.
    fn propose(&self, niches: &mut Niches, generation: &mut Generation) {
        let (count, bounds) = (generation.population.len(), generation.bounds);
        if niches.phase == Phase::Scatter {
            let best = generation.population.ranking()[0];
            niches.moving = (0..count).map(|i| i != best && generation.draws.uniform() < self.scattered).collect();
            let movers = niches.movers().len();
            if movers > 0 {
                generation.try_some(movers, |_, _, trial, draws| {
                    trial.iter_mut().zip(bounds.iter()).for_each(|(x, (lower, upper))| *x = lower + draws.uniform() * (upper - lower));
                });
                return;
            }
            niches.phase = Phase::Tumble;
        }
        if niches.phase == Phase::Split {
            let ranking = generation.population.ranking();
            let half = count / 2;
            niches.moving = vec![false; count];
            ranking[count - half..].iter().for_each(|i| niches.moving[*i] = true);
            generation.try_some(half, |k, bacteria, trial, draws| {
                bacteria.copy_position(ranking[k], trial);
                let [to, from] = draws.partners(k, count - half).map(|rank| bacteria.position(ranking[rank]));
                trial.iter_mut().zip(to).zip(from).for_each(|((x, to), from)| *x += draws.uniform() * (to - from));
            });
            return;
        }
        // Only a tumble is drawn to a neighbour.
        let mut pulls = vec![0.0; niches.steps.len()];
        if niches.phase == Phase::Tumble {
            niches.swims = 0;
            niches.moving = vec![true; count];
            let size = self.step * 10f64.powf(-DECADES * generation.progress());
            // The steps look at the whole generation while they draw.
            let mut draws = std::mem::replace(generation.draws, Draws::replay(Vec::new()));
            let (steps, drawn): (Vec<_>, Vec<_>) = (0..count).map(|i| self.step(size, i, generation, &mut draws)).unzip();
            (niches.steps, pulls) = (steps.concat(), drawn.concat());
            *generation.draws = draws;
        }
        let (movers, steps) = (niches.movers(), &niches.steps);
        generation.try_some(movers.len(), |k, bacteria, trial, _| {
            let i = movers[k];
            bacteria.copy_position(i, trial);
            let first = i * bounds.dimension();
            trial.iter_mut().zip(&steps[first..]).zip(&pulls[first..]).for_each(|((x, step), pull)| *x += step + pull);
        });
    }

    fn accept(&self, niches: &mut Niches, generation: &mut Generation) {
        let movers = niches.movers();
        let population = &mut *generation.population;
        let trials = population.trial_costs().len();
        match niches.phase {
            Phase::Split | Phase::Scatter => {
                // The offspring stand in the order of the survivors' ranking, the places in that of their numbers.
                movers.iter().enumerate().take(trials).for_each(|(k, i)| population.take(*i, k));
                let scatters = niches.phase == Phase::Split && niches.splits.is_multiple_of(self.splits);
                niches.phase = if scatters { Phase::Scatter } else { Phase::Tumble };
            }
            Phase::Tumble | Phase::Swim => {
                for (k, i) in movers.into_iter().enumerate().take(trials) {
                    niches.moving[i] = population.take_if_better(i, k) && niches.swims < SWIMS;
                }
                niches.swims = niches.swims.saturating_add(1);
                niches.phase = Phase::Swim;
                if !niches.moving.contains(&true) {
                    niches.tumbles = niches.tumbles.wrapping_add(1);
                    let splits = niches.tumbles.is_multiple_of(self.tumbles);
                    niches.splits = niches.splits.wrapping_add(u32::from(splits));
                    niches.phase = if splits { Phase::Split } else { Phase::Tumble };
                }
            }
        }
    }

    fn fits(niches: &Niches, bacteria: &Population) -> bool {
        niches.moving.len() == bacteria.len() && niches.steps.len() == bacteria.positions().len()
    }
}
