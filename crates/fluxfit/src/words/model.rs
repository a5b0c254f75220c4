//! Why a model answers.

use crate::identification::prepare::model::ModelReason;
use std::fmt::{Display, Formatter, Result};

impl Display for ModelReason {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Stated => write!(f, "as stated"),
            Self::Interpolated => write!(f, "its channels were sampled at different instants"),
            Self::ShortCircuit => write!(f, "the voltages are zero in every row: the motor turned with shorted terminals"),
            Self::SlowRows { rate } => write!(f, "rows come at {rate:.3} Hz, slower than any drive's own sampling"),
            Self::TurnsTooFar { turn } => {
                write!(f, "the rotor turns up to {turn:.2} rad from row to row, too far to simulate what happened between them")
            }
            Self::PointsTellMore => write!(
                f,
                "simulated currents differ from the measured ones by more than noise, and the operating points tell the parameters better"
            ),
            Self::FastRows { rate, turn } => {
                write!(f, "rows come at {:.1} kHz and the rotor turns at most {turn:.3} rad between them", 1e-3 * rate)
            }
        }
    }
}
