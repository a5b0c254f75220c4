//! `diagnostics.output_error` of an identification: the fit of the simulated currents.

use super::{by_parameter::ByParameter, finite::finite};
use crate::evidence::{FaultOutcome, FaultTrial, OutputFit, TimingTrial};
use serde::Serialize;

/// The fit of the simulated currents, and everything that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OutputErrorEntry {
    /// Stretches of rows that were compared: the first row, counted from 0, and the row after the last.
    pub rows: Vec<[usize; 2]>,
    /// Sum of the squared residuals, A².
    pub cost: f64,
    /// Correlation of neighbouring residuals, the larger of both axes.
    pub correlation_of_neighbours: Option<f64>,
    /// Every voltage timing that was tried, the best first.
    pub readings: Vec<TimingEntry>,
    /// Every fault of the drive that was tried.
    pub terms: Vec<TermEntry>,
}

impl OutputErrorEntry {
    pub(super) fn of(fit: &OutputFit) -> Self {
        Self {
            rows: fit.stretches.iter().map(|rows| [rows.start, rows.end]).collect(),
            cost: fit.cost,
            correlation_of_neighbours: finite(fit.correlation_of_neighbours),
            readings: fit.timings.iter().map(TimingEntry::of).collect(),
            terms: fit.fault_trials.iter().map(TermEntry::of).collect(),
        }
    }
}

/// A voltage timing that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TimingEntry {
    /// The timing, named as in `nuisance.voltage_timing`.
    pub voltage_timing: String,
    /// Root mean square of the residuals, A.
    pub residual_rms: Option<f64>,
    /// The parameters under this timing, SI units.
    pub raw: ByParameter<Option<f64>>,
}

impl TimingEntry {
    fn of(tried: &TimingTrial) -> Self {
        Self {
            voltage_timing: tried.timing.key().to_owned(),
            residual_rms: finite(tried.mean_square().sqrt()),
            raw: tried.polished.drive.motor.to_array().map(finite).into(),
        }
    }
}

/// A fault of the drive that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TermEntry {
    /// Its name.
    pub term: &'static str,
    /// What it gains by Schwarz's criterion, less what its unknowns cost; a positive number speaks for it.
    pub gain: Option<f64>,
    /// Whether it is part of the answer.
    pub taken: bool,
    /// That it was taken, or why not.
    pub outcome: String,
}

impl TermEntry {
    fn of(tried: &FaultTrial) -> Self {
        Self {
            term: tried.fault.key(),
            gain: finite(tried.gain),
            taken: tried.outcome == FaultOutcome::Taken,
            outcome: tried.outcome.label().to_owned(),
        }
    }
}
