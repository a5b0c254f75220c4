//! Which model answers.
//!
//! The output error uses every row and knows the inverter's own periods, so it wants them: rows that follow each other as fast as the
//! drive's samples. A decimated or filtered log has lost them; its operating points are what it still tells.

use super::Settings;
use crate::{log::Log, steady::zero_order_hold::MAX_ANGLE_PER_SAMPLE};

/// A model of the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// The steady equations at operating points.
    Steady,
    /// The currents, simulated row by row.
    OutputError,
}

impl Model {
    /// Name in files and on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::Steady => "steady",
            Self::OutputError => "output-error",
        }
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Steady => "steady operating points",
            Self::OutputError => "output error",
        }
    }
}

/// Slower than this no drive controls a current, Hz: such rows are a recorder's.
pub const SLOWEST_CONTROL: f64 = 1000.0;

/// The model that the settings state, or the one that suits the log; and why.
pub fn choose(log: &Log, settings: &Settings) -> (Model, String) {
    if let Some(model) = settings.model {
        return (model, "as stated".to_owned());
    }
    let slowest = log.segments().iter().map(|segment| segment.sample_period).fold(0.0, f64::max);
    let turn = largest_turn(log);
    if log.is_interpolated() {
        (Model::Steady, "its channels were sampled at different instants".to_owned())
    } else if slowest > 1.0 / SLOWEST_CONTROL {
        (Model::Steady, format!("rows come at {:.3} Hz, no drive's own sampling", 1.0 / slowest))
    } else if turn > MAX_ANGLE_PER_SAMPLE {
        (Model::Steady, format!("the rotor turns up to {turn:.2} rad from row to row, too far for the inverter's own periods"))
    } else {
        (Model::OutputError, format!("rows come at {:.1} kHz and the rotor turns at most {turn:.3} rad between them", 1e-3 / slowest))
    }
}

/// Largest electrical angle from row to row, rad; the fastest hundredth of the rows does not count, being noise of the speed.
fn largest_turn(log: &Log) -> f64 {
    let mut turns: Vec<f64> = log
        .segments()
        .iter()
        .flat_map(|segment| log.columns().omega_e[segment.rows.clone()].iter().map(|omega_e| omega_e.abs() * segment.sample_period))
        .collect();
    let place = (turns.len() * 99 / 100).min(turns.len().saturating_sub(1));
    *turns.select_nth_unstable_by(place, f64::total_cmp).1
}
