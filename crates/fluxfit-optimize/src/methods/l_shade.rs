//! L-SHADE: differential evolution that learns its settings from what succeeds, and shrinks its population.
//!
//! ```text
//! v        = x_i + F (x_pbest - x_i) + F (x_r1 - x_r2)      pbest one of the best 11 %, r2 from the population or the archive
//! F        ~ Cauchy(M_F, 0.1), drawn again while <= 0, at most 1
//! CR       ~ N(M_CR, 0.1) cut to 0..1; M_F, M_CR one of six remembered pairs
//! x'       as DE's, bounds as DE's; accepted when at least as good; a parent that is beaten goes to the archive
//! learn    one pair after the other: weighted Lehmer means of the F and CR that beat their parents, weights the gains.
//!          M_CR stays 0 for ever once all that beat had CR = 0
//! shrink   N falls linearly with the evaluations from 18 D to 4; the worst go. The archive holds 2.6 N
//! ```
//!
//! R. Tanabe and A. Fukunaga, "Improving the search performance of SHADE using linear population size reduction", CEC 2014,
//! doi:10.1109/CEC.2014.6900380. The population asked for sets the number of evaluations only.
//!
//! When to use it: as a yardstick; it has no bias towards any point of the box.

use super::de::between;
use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Candidates of the start, per dimension.
const PER_DIMENSION: usize = 18;

/// Candidates at the end: one, and the three that its move needs.
const FEWEST: usize = 4;

/// Pairs remembered.
const PAIRS: usize = 6;

/// Rows of the archive, per candidate.
const ARCHIVE: f64 = 2.6;

/// The part of the population that counts as best; at least two.
const BEST_PART: f64 = 0.11;

/// Scale of both distributions.
const SPREAD: f64 = 0.1;

/// Settings of L-SHADE: none, it adapts them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct LShade {}

/// What L-SHADE has learnt.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Learnt {
    factors: [f64; PAIRS],
    /// None: 0 for ever.
    crossovers: [Option<f64>; PAIRS],
    /// The pair to be learnt next.
    next: usize,
    archive: Vec<f64>,
    /// F and CR of each trial.
    tried: Vec<(f64, f64)>,
    /// Candidates of the start.
    first: usize,
}

impl LShade {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self {};
}

impl Learnt {
    /// Draws the pair, F (until it is positive), CR unless that is 0 for ever.
    fn settings(&self, draws: &mut Draws) -> (f64, f64) {
        let pair = draws.index(PAIRS);
        let factor = loop {
            let factor = self.factors[pair] + SPREAD * draws.student_t(1);
            if factor > 0.0 {
                break factor.min(1.0);
            }
        };
        let crossover = self.crossovers[pair].map_or(0.0, |mean| (mean + SPREAD * draws.normal()).clamp(0.0, 1.0));
        (factor, crossover)
    }

    /// Keeps a beaten parent; in a full archive, in any other's place.
    fn keep(&mut self, parent: &[f64], capacity: usize, draws: &mut Draws) {
        let d = parent.len();
        if self.archive.len() < capacity * d {
            self.archive.extend(parent);
        } else {
            let row = draws.index(capacity) * d;
            self.archive[row..row + d].copy_from_slice(parent);
        }
    }

    /// Learns from the gains of the settings that beat their parents.
    fn learn(&mut self, successes: &[(f64, (f64, f64))]) {
        let largest = successes.iter().map(|(gain, _)| *gain).fold(0.0, f64::max);
        if successes.is_empty() {
            return;
        }
        let lehmer = |of: fn(&(f64, f64)) -> f64| {
            let sum = |power: i32| successes.iter().map(|(gain, tried)| gain / largest * of(tried).powi(power)).sum::<f64>();
            sum(2) / sum(1)
        };
        self.factors[self.next] = lehmer(|(factor, _)| *factor);
        let any_crossed = successes.iter().any(|(_, (_, crossover))| *crossover > 0.0);
        let learnt = (self.crossovers[self.next].is_some() && any_crossed).then(|| lehmer(|(_, crossover)| *crossover));
        // Gains that are too small beside the largest may leave nothing to divide by.
        let learnt = learnt.map(|mean| if mean.is_finite() { mean } else { 0.0 });
        self.crossovers[self.next] = learnt;
        self.next = (self.next + 1) % PAIRS;
    }
}

impl Moves for LShade {
    type Memory = Learnt;

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Learnt) {
        let first = PER_DIMENSION * setup.bounds.dimension();
        let learnt =
            Learnt { factors: [0.5; PAIRS], crossovers: [Some(0.5); PAIRS], next: 0, archive: Vec::new(), tried: Vec::new(), first };
        (setup.uniform_rows(first), learnt)
    }

    /// One trial per candidate. Draws per candidate: its settings, pbest, r1, r2, the forced coordinate, one number per coordinate.
    fn propose(&self, learnt: &mut Learnt, generation: &mut Generation) {
        let bounds = generation.bounds;
        let d = bounds.dimension();
        let ranking = generation.population.ranking();
        let count = ranking.len();
        let best = ((BEST_PART * count as f64).round() as usize).max(2);
        let mut tried = Vec::with_capacity(count);
        let archive = &learnt.archive;
        generation.try_each(|i, population, trial, draws| {
            let (factor, crossover) = learnt.settings(draws);
            tried.push((factor, crossover));
            let pbest = population.position(ranking[draws.index(best)]);
            let [r1] = draws.partners(i, count);
            let r2 = loop {
                let r2 = draws.index(count + archive.len() / d);
                if r2 != i && r2 != r1 {
                    break r2;
                }
            };
            let one = population.position(r1);
            let other = if r2 < count { population.position(r2) } else { &archive[(r2 - count) * d..(r2 - count + 1) * d] };
            let forced = draws.index(d);
            population.copy_position(i, trial);
            for (k, (x, (lower, upper))) in trial.iter_mut().zip(bounds.iter()).enumerate() {
                if draws.uniform() < crossover || k == forced {
                    let moved = *x + factor * (pbest[k] - *x) + factor * (one[k] - other[k]);
                    *x = between(moved, *x, lower, upper);
                }
            }
        });
        learnt.tried = tried;
    }

    fn accept(&self, learnt: &mut Learnt, generation: &mut Generation) {
        let all = generation.size as f64 * (generation.limit as f64 + 1.0);
        let Generation { population, draws, .. } = generation;
        let capacity = |count: usize| (ARCHIVE * count as f64).round() as usize;
        let mut successes = Vec::new();
        let tried = std::mem::take(&mut learnt.tried);
        for (i, settings) in tried.into_iter().enumerate().take(population.len()) {
            let (held, trial) = (population.costs()[i], population.trial_costs()[i]);
            if trial < held {
                learnt.keep(population.position(i), capacity(population.len()), draws);
                successes.push(((held - trial).min(f64::MAX), settings));
            }
            if trial <= held {
                population.take(i, i);
            }
        }
        learnt.learn(&successes);
        let (first, fewest) = (learnt.first as f64, FEWEST as f64);
        let wanted = (first + (fewest - first) * population.evaluations() as f64 / all).round().max(fewest) as usize;
        if wanted < population.len() {
            population.keep(&population.ranking()[..wanted]);
            learnt.archive.truncate(capacity(wanted) * generation.bounds.dimension());
        }
    }

    fn fits(learnt: &Learnt, population: &Population) -> bool {
        let d = population.best().len();
        let trials = population.trial_costs().len();
        learnt.next < PAIRS
            && learnt.archive.len().is_multiple_of(d)
            && population.len() >= FEWEST
            && (learnt.tried.is_empty() || learnt.tried.len() == trials)
    }
}
