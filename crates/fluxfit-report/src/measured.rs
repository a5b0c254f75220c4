//! Measured currents and those that a model gives for them: what the figures of currents draw, whichever model it is.

use fluxfit::{evidence::OutputFit, frames::Dq, log::Log, validation::prediction::PredictedStretch};
use std::ops::Range;

/// The log, and the model's currents beside its own.
#[derive(Clone, Copy)]
pub(crate) struct Measured<'a> {
    log: &'a Log,
    model: Model<'a>,
}

/// Where the second current of a row comes from.
#[derive(Clone, Copy)]
enum Model<'a> {
    /// The motor that was found, driven by the logged voltages.
    Simulated(&'a OutputFit),
    /// A motor that was given.
    Predicted(&'a [PredictedStretch]),
}

/// A row of the log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    /// Time, s; logs of their own clocks follow each other.
    pub(crate) t: f64,
    /// Measured current, A.
    pub(crate) measured: Dq,
    /// Measured less the model's, A.
    pub(crate) missed: Dq,
}

impl<'a> Measured<'a> {
    /// Beside the currents of the motor that was found. Of a sensor's fault that was found, both have the same.
    pub(crate) fn and_simulated(log: &'a Log, fit: &'a OutputFit) -> Self {
        Self { log, model: Model::Simulated(fit) }
    }

    /// Beside those of a motor that was given. Of a sensor's fault, neither has any.
    pub(crate) fn and_predicted(log: &'a Log, courses: &'a [PredictedStretch]) -> Self {
        Self { log, model: Model::Predicted(courses) }
    }

    /// What the model's current is called.
    pub(crate) fn word(&self) -> &'static str {
        match self.model {
            Model::Simulated(_) => "simulated",
            Model::Predicted(_) => "predicted",
        }
    }

    /// The pieces between gaps.
    pub(crate) fn pieces(self) -> impl Iterator<Item = impl Iterator<Item = Row> + Clone> {
        let starts = starts(self.log);
        let mut before = 0;
        self.ranges().into_iter().enumerate().map(move |(piece, rows)| {
            let start = starts[self.log.segment_of(rows.start).map_or(0, |segment| segment.log)];
            let first = before;
            before += rows.len();
            rows.enumerate().map(move |(k, row)| {
                let (measured, missed) = match self.model {
                    Model::Simulated(fit) => {
                        let (columns, of_row) = (self.log.columns(), 2 * (first + k));
                        (Dq { d: columns.id[row], q: columns.iq[row] }, Dq { d: fit.residuals[of_row], q: fit.residuals[of_row + 1] })
                    }
                    Model::Predicted(courses) => {
                        let (measured, predicted) = (courses[piece].measured[k], courses[piece].predicted[k]);
                        (measured, Dq { d: measured.d - predicted.d, q: measured.q - predicted.q })
                    }
                };
                Row { t: self.log.columns().t[row] - start, measured, missed }
            })
        })
    }

    fn ranges(&self) -> Vec<Range<usize>> {
        match self.model {
            Model::Simulated(fit) => fit.stretches.clone(),
            Model::Predicted(courses) => courses.iter().map(|course| course.rows.clone()).collect(),
        }
    }

    /// All rows.
    pub(crate) fn rows(&self) -> usize {
        self.ranges().iter().map(ExactSizeIterator::len).sum()
    }

    /// Times of the first row and of the last one, s; infinite where there is no row.
    pub(crate) fn times(&self) -> [f64; 2] {
        let all = || self.pieces().flatten().map(|row| row.t);
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    }
}

/// What is taken from each log's time, s, so that logs of their own clocks follow each other.
fn starts(log: &Log) -> Vec<f64> {
    let logs = log.segments().last().map_or(1, |segment| segment.log + 1);
    let t = &log.columns().t;
    let mut starts = Vec::new();
    let mut end = None;
    for number in 0..logs {
        let rows = || log.segments().iter().filter(|segment| segment.log == number).map(|segment| &segment.rows);
        let (Some(first), Some(last)) = (rows().next(), rows().next_back()) else {
            starts.push(0.0);
            continue;
        };
        // The first keeps its time.
        let start = end.map_or(0.0, |end| t[first.start] - end);
        starts.push(start);
        end = Some(t[last.end - 1] - start);
    }
    starts
}
