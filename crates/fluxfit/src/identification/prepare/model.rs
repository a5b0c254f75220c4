//! Which model answers.
//!
//! The output error uses every row and wants to know what acted between them: rows that follow each other about as fast as the drive's
//! samples. A log that is slower has lost it; its operating points are what it still tells.

use crate::log::Log;

/// How the log is modelled. Steady operating points need currents and speed held constant for a while; the output error also uses
/// transients, but needs rows as fast as the drive's own sampling. [`evidence::choose_model`](crate::evidence::choose_model) chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Model {
    /// The steady voltage equations, by weighted least squares on the means of steady operating points.
    Steady,
    /// The output error: currents are simulated row by row from the logged voltages and fitted to the measured ones.
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

/// Lowest rate of rows, Hz, that counts as a drive's own sampling; slower rows count as a recorder's.
pub const SLOWEST_CONTROL: f64 = 1000.0;

/// Largest angle from row to row, rad, at which rows are simulated: the mean over a row of what stands still in the stator, as dead time
/// and offsets do, is smaller by a twentieth there.
const FARTHEST_TURN: f64 = 1.0;

/// A model, and why it answers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ModelChoice {
    /// The model.
    pub model: Model,
    /// Why.
    pub reason: ModelReason,
}

/// Why a model answers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ModelReason {
    /// The request states it.
    Stated,
    /// The channels were sampled at different instants.
    Interpolated,
    /// The voltages are zero throughout: what they tell is in the steady currents of the short circuit.
    ShortCircuit,
    /// Rows are slower than any drive's own sampling: below [`evidence::SLOWEST_CONTROL`](crate::evidence::SLOWEST_CONTROL).
    SlowRows {
        /// Rate of the rows, Hz.
        rate: f64,
    },
    /// The rotor turns so far from row to row that what happened between them is lost.
    TurnsTooFar {
        /// Largest electrical angle from row to row, rad.
        turn: f64,
    },
    /// Rows come as fast as a drive controls, but the simulated currents leave more than noise, and the operating points, which agree with
    /// each other, have the narrower intervals.
    PointsTellMore,
    /// Rows come as fast as a drive controls.
    FastRows {
        /// Rate of the rows, Hz.
        rate: f64,
        /// Largest electrical angle from row to row, rad.
        turn: f64,
    },
}

/// The model that the request states, or the one that suits the log; and why.
pub fn choose(log: &Log, stated: Option<Model>) -> ModelChoice {
    if let Some(model) = stated {
        return ModelChoice { model, reason: ModelReason::Stated };
    }
    let slowest = log.segments().iter().map(|segment| segment.sample_period).fold(0.0, f64::max);
    let turn = largest_turn(log);
    let (model, reason) = if log.is_short_circuit() {
        (Model::Steady, ModelReason::ShortCircuit)
    } else if log.is_interpolated() {
        (Model::Steady, ModelReason::Interpolated)
    } else if slowest > 1.0 / SLOWEST_CONTROL {
        (Model::Steady, ModelReason::SlowRows { rate: 1.0 / slowest })
    } else if turn > FARTHEST_TURN {
        (Model::Steady, ModelReason::TurnsTooFar { turn })
    } else {
        (Model::OutputError, ModelReason::FastRows { rate: 1.0 / slowest, turn })
    };
    ModelChoice { model, reason }
}

/// Largest electrical angle from row to row, rad; the fastest hundredth of the rows does not count, being noise of the speed.
pub(crate) fn largest_turn(log: &Log) -> f64 {
    let mut turns: Vec<f64> = log
        .segments()
        .iter()
        .flat_map(|segment| log.columns().omega_e[segment.rows.clone()].iter().map(|omega_e| omega_e.abs() * segment.sample_period))
        .collect();
    let place = (turns.len() * 99 / 100).min(turns.len().saturating_sub(1));
    *turns.select_nth_unstable_by(place, f64::total_cmp).1
}
