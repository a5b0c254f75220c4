//! How long and from where a search runs; and the ranges that settings must lie in.

use crate::error::Error;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Most candidates of a population: far beyond what any method gains from, and a run of four dimensions stays within 200 MB.
const LARGEST_POPULATION: usize = 1_000_000;

/// Most iterations: their history, of some 100 bytes each, stays within 100 MB.
const MOST_ITERATIONS: usize = 1_000_000;

/// Most evaluations of a search, or of many runs together: at 10 us each, more than a day of computing. The paper's runs need 15 050.
const MOST_EVALUATIONS: f64 = 1e10;

/// Largest magnitude of a factor: its products with distances in a box, up to 2e150, stay finite.
const LARGEST_FACTOR: f64 = 1e100;

/// How long and from where a search runs.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SearchSettings {
    /// Candidates. 50 in the paper.
    pub population: usize,
    /// Iteration limit. 300 in the paper.
    pub iterations: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of this run: its stream of the seed's random numbers.
    pub run: u64,
    /// Stop once the best cost is this close to a known optimum.
    pub close_to_optimum: Option<CloseTo>,
    /// Stop once the best cost is at or below this.
    pub target_cost: Option<f64>,
}

impl SearchSettings {
    /// Refuses what asks for more memory or time than a machine has. Every search begins with this check; whoever computes something
    /// before a search can ask earlier.
    ///
    /// # Errors
    /// If the population or the number of iterations is larger than a million, or both together need more than 10¹⁰ evaluations.
    pub fn check(&self) -> Result<(), Error> {
        self.check_runs(1)
    }

    /// [`check`](Self::check) of a number of runs.
    ///
    /// # Errors
    /// As [`check`](Self::check), of all runs together.
    pub fn check_runs(&self, runs: usize) -> Result<(), Error> {
        let Self { population, iterations, .. } = *self;
        limit("the population", population as f64, LARGEST_POPULATION as f64, "so that it fits into memory")?;
        limit("the number of iterations", iterations as f64, MOST_ITERATIONS as f64, "so that their history fits into memory")?;
        let evaluations = runs as f64 * population as f64 * (iterations as f64 + 1.0);
        limit("the number of evaluations (runs x population x iterations)", evaluations, MOST_EVALUATIONS, "more take days")
    }
}

fn limit(setting: &'static str, value: f64, most: f64, reason: &'static str) -> Result<(), Error> {
    if value <= most { Ok(()) } else { Err(Error::Limit { setting, value, most, reason }) }
}

/// A known optimum and what counts as close to it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct CloseTo {
    /// The lowest cost there is.
    pub optimum: f64,
    /// Largest excess over it that is good enough.
    pub tolerance: f64,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self { population: 50, iterations: 300, seed: 1, run: 0, close_to_optimum: None, target_cost: None }
    }
}

/// Refuses a probability outside 0 to 1.
pub(crate) fn check_probability(setting: &'static str, value: f64) -> Result<(), Error> {
    within(setting, value, (0.0..=1.0).contains(&value), "a probability from 0 to 1")
}

/// Refuses a factor that is not a number of moderate size.
pub(crate) fn check_factor(setting: &'static str, value: f64) -> Result<(), Error> {
    within(setting, value, value.abs() <= LARGEST_FACTOR, "a finite number of magnitude up to 1e100")
}

/// Refuses a part of the box's width that is negative or larger than the box.
pub(crate) fn check_fraction_of_box(setting: &'static str, value: f64) -> Result<(), Error> {
    within(setting, value, (0.0..=1.0).contains(&value), "a fraction of the box's width from 0 to 1")
}

/// Refuses a count of nothing.
pub(crate) fn check_count(setting: &'static str, value: u32) -> Result<(), Error> {
    within(setting, f64::from(value), value > 0, "at least 1")
}

fn within(setting: &'static str, value: f64, is_within: bool, range: &'static str) -> Result<(), Error> {
    if is_within { Ok(()) } else { Err(Error::Setting { setting, value, range }) }
}
