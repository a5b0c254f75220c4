//! Measured currents and those of a model over time, for the figures of currents.

use crate::row_times::offsets;
use fluxfit::{evidence::OutputFit, frames::Dq, log::Log, validation::prediction::PredictedStretch};
use std::ops::Range;

/// The measured currents of a log, and those of a model.
#[derive(Clone, Copy)]
pub(crate) struct CurrentComparison<'a> {
    log: &'a Log,
    model: CurrentModel<'a>,
}

/// Where the model's currents come from.
#[derive(Clone, Copy)]
enum CurrentModel<'a> {
    /// Simulation of the identified motor with the logged voltages.
    Simulated(&'a OutputFit),
    /// Prediction with given parameters.
    Predicted(&'a [PredictedStretch]),
}

/// The currents of one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CurrentSample {
    /// Time, s; the times of joined logs are consecutive.
    pub(crate) t: f64,
    /// Measured current, A.
    pub(crate) measured: Dq,
    /// Residual: measured less the model's current, A.
    pub(crate) residual: Dq,
}

impl<'a> CurrentComparison<'a> {
    /// Measured and simulated currents. Faults of the current sensors that were identified are in both.
    pub(crate) fn with_simulated(log: &'a Log, fit: &'a OutputFit) -> Self {
        Self { log, model: CurrentModel::Simulated(fit) }
    }

    /// Measured and predicted currents. Faults of the current sensors are in neither.
    pub(crate) fn with_predicted(log: &'a Log, stretches: &'a [PredictedStretch]) -> Self {
        Self { log, model: CurrentModel::Predicted(stretches) }
    }

    /// Name of the model's currents.
    pub(crate) fn name(&self) -> &'static str {
        match self.model {
            CurrentModel::Simulated(_) => "simulated",
            CurrentModel::Predicted(_) => "predicted",
        }
    }

    /// The rows, in pieces between gaps.
    pub(crate) fn pieces(self) -> impl Iterator<Item = impl Iterator<Item = CurrentSample> + Clone> {
        let offsets = offsets(self.log);
        let mut before = 0;
        self.ranges().into_iter().enumerate().map(move |(piece, rows)| {
            let offset = offsets[self.log.segment_of(rows.start).map_or(0, |segment| segment.log)];
            let first = before;
            before += rows.len();
            rows.enumerate().map(move |(k, row)| {
                let (measured, residual) = match self.model {
                    CurrentModel::Simulated(fit) => {
                        let (columns, of_row) = (self.log.columns(), 2 * (first + k));
                        (Dq { d: columns.id[row], q: columns.iq[row] }, Dq { d: fit.residuals[of_row], q: fit.residuals[of_row + 1] })
                    }
                    CurrentModel::Predicted(courses) => {
                        let (measured, predicted) = (courses[piece].measured[k], courses[piece].predicted[k]);
                        (measured, Dq { d: measured.d - predicted.d, q: measured.q - predicted.q })
                    }
                };
                CurrentSample { t: self.log.columns().t[row] - offset, measured, residual }
            })
        })
    }

    fn ranges(&self) -> Vec<Range<usize>> {
        match self.model {
            CurrentModel::Simulated(fit) => fit.stretches.clone(),
            CurrentModel::Predicted(courses) => courses.iter().map(|course| course.rows.clone()).collect(),
        }
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.ranges().iter().map(ExactSizeIterator::len).sum()
    }

    /// Times of the first and the last row, s; infinite if there is no row.
    pub(crate) fn times(&self) -> [f64; 2] {
        let all = || self.pieces().flatten().map(|row| row.t);
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    }
}
