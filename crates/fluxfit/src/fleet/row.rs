//! A row of the results: one motor, and one window of time where windows were asked for. The rows of a fleet are in memory together, so a
//! text that several of them have is held once.

use crate::{Verdict, motor::PARAMETERS};
use std::sync::Arc;

/// A row of the results.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetRow {
    /// The motor's name.
    pub motor: Arc<str>,
    /// The file or table.
    pub source: Arc<str>,
    /// Start of the window, s; `None` where all of the motor's rows were taken.
    pub window_start: Option<f64>,
    /// The parameters in their order.
    pub estimates: [FleetEstimate; PARAMETERS],
    /// Codes of the warnings.
    pub warnings: Vec<Arc<str>>,
    /// Why there is no answer.
    pub error: Option<Arc<str>>,
}

/// A parameter of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetEstimate {
    /// The verdict.
    pub verdict: Verdict,
    /// The value; `None` where it is not identifiable.
    pub value: Option<FleetValue>,
    /// Why the verdict is not better.
    pub reason: Option<Arc<str>>,
}

/// A value with half of its 95 % interval, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FleetValue {
    /// The value.
    pub value: f64,
    /// Half of its 95 % interval; zero of a value that was given.
    pub half_width: f64,
}

/// Half-width of a 95 % interval in standard errors.
const HALF_WIDTH: f64 = 1.959_964;

impl FleetValue {
    /// Half of the interval as a fraction of the value.
    pub fn relative_half_width(self) -> f64 {
        self.half_width / self.value.abs()
    }

    /// The standard error that the interval says.
    pub(super) fn standard_error(self) -> f64 {
        self.half_width / HALF_WIDTH
    }

    /// Whether it was found from the log: a given value has no uncertainty, and says nothing of the motor.
    pub fn is_found(self) -> bool {
        self.half_width > 0.0 && self.half_width.is_finite() && self.value.is_finite() && self.value != 0.0
    }
}

impl FleetEstimate {
    /// The value if it was found from the log.
    pub fn found(&self) -> Option<FleetValue> {
        self.value.filter(|value| value.is_found())
    }
}
