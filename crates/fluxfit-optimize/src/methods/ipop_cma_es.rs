//! IPOP-CMA-ES: CMA-ES that is restarted with twice the samples when it no longer gets better.
//!
//! ```text
//! restart   when the best costs of the last 10 + 30 D / samples generations are within the tolerance, or sigma is below it:
//!           a new distribution, its mean uniform in the box, with twice the samples a generation
//! ```
//!
//! A. Auger and N. Hansen, "A restart CMA evolution strategy with increasing population size", CEC 2005, doi:10.1109/CEC.2005.1554902.
//! The rest: [`cma_es`](super::cma_es).
//!
//! When to use it: on functions of several minima, or with steps or kinks.

use super::cma_es::{CmaEs, Distribution, stretched};
use crate::{
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
    setting::check_factor,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Most samples of a generation: they fit into memory.
const MOST_SAMPLES: usize = 1_000_000;

/// Settings of IPOP-CMA-ES.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct IpopCmaEs {
    /// Costs closer to each other, and distributions smaller, than this are at the end. 1e-13.
    pub tolerance: f64,
}

impl IpopCmaEs {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { tolerance: 1e-13 };

    /// Learns from a generation; draws the mean of a new distribution if this one is at its end.
    fn learn(&self, climb: &mut Climb, generation: &mut Generation) {
        let ranking = generation.population.ranking();
        climb.distribution.learn(&ranking);
        climb.bests.extend(ranking.first().map(|best| generation.population.costs()[*best]));
        let d = generation.bounds.dimension();
        let window = window(d, climb.samples);
        if climb.bests.len() > window {
            climb.bests.remove(0);
        }
        let (lowest, highest) =
            climb.bests.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), best| (low.min(*best), high.max(*best)));
        let is_flat = climb.bests.len() == window && highest - lowest < self.tolerance;
        if is_flat || climb.distribution.sigma < self.tolerance {
            climb.samples = (2 * climb.samples).min(MOST_SAMPLES);
            climb.bests.clear();
            climb.distribution = Distribution::new(d, generation.draws);
        }
    }
}

/// Generations that are looked back at.
fn window(dimension: usize, samples: usize) -> usize {
    10 + (30 * dimension).div_ceil(samples.max(1))
}

/// The distribution at work.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Climb {
    distribution: Distribution,
    samples: usize,
    /// The best cost of each of the last generations.
    bests: Vec<f64>,
}

impl Moves for IpopCmaEs {
    type Memory = Climb;

    fn check(&self) -> Result<(), Error> {
        check_factor("tolerance", self.tolerance)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Climb) {
        let (positions, distribution) = CmaEs {}.start(setup);
        let samples = CmaEs::samples(setup.bounds.dimension());
        (positions, Climb { distribution, samples, bests: Vec::new() })
    }

    fn begin(&self, climb: &mut Climb, generation: &mut Generation) {
        self.learn(climb, generation);
    }

    fn propose(&self, climb: &mut Climb, generation: &mut Generation) {
        let samples = climb.distribution.sample(climb.samples, generation.draws);
        generation.try_these(&stretched(&samples, generation.bounds).collect::<Vec<f64>>());
    }

    fn accept(&self, climb: &mut Climb, generation: &mut Generation) {
        generation.population.replace();
        self.learn(climb, generation);
    }

    fn fits(climb: &Climb, population: &Population) -> bool {
        let window = window(population.best().len(), climb.samples);
        let looked_back = window.min(climb.distribution.generations as usize);
        climb.distribution.fits(population) && (1..=MOST_SAMPLES).contains(&climb.samples) && climb.bests.len() == looked_back
    }
}
