//! What a search found.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
pub enum StopReason {
    /// All iterations were run.
    IterationLimit,
    /// The best cost came close enough to the known optimum.
    CloseToOptimum,
    /// The best cost reached the target.
    TargetCost,
    /// The caller stopped it.
    Interrupted,
}

/// The best so far, after an iteration.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Record {
    /// Iterations done; 0 is the start.
    pub iteration: usize,
    /// Candidates evaluated.
    pub evaluations: u64,
    /// Best cost.
    pub cost: f64,
    /// Its position.
    pub best: Vec<f64>,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SearchReport {
    /// Best position.
    pub best: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// Candidates evaluated.
    pub evaluations: u64,
    /// Why the search ended.
    pub stop_reason: StopReason,
    /// The best after each iteration, the start included.
    pub history: Vec<Record>,
}
