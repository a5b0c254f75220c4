//! Measurements, and what is promised of them.

use crate::motor::Parameter;

/// Something to measure.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Measurement {
    /// A further stretch of the log, with currents and speed held constant.
    Stretch {
        /// How long to hold it, s.
        seconds: f64,
        /// At which currents and speed.
        place: Place,
        /// That speed, electrical rad/s, where the log has others too.
        omega_e: Option<f64>,
    },
    /// The operating points of the log once more, each for as long, at another speed.
    AllPoints {
        /// How many times as fast.
        times: f64,
    },
    /// R_s measured at the terminals, given as a [prior](crate::Known::Prior).
    Resistance {
        /// Standard error of that measurement as a fraction of R_s.
        accuracy: f64,
    },
}

impl Measurement {
    /// What it takes, to be compared: the kind, then the time, s. A multimeter takes no time of a log, one stretch less than all operating
    /// points once more.
    pub(super) fn effort(&self) -> (u8, f64) {
        match self {
            Self::Resistance { .. } => (0, 0.0),
            Self::Stretch { seconds, .. } => (1, *seconds),
            Self::AllPoints { .. } => (2, 0.0),
        }
    }
}

/// Where to hold the motor, relative to the log's operating point of largest current.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Place {
    /// The same i_q and speed, and this i_d, A.
    Id(f64),
    /// Half the load: this i_q, A, at the same speed.
    HalfLoad {
        /// i_q to hold, A.
        iq: f64,
    },
    /// The same currents at half the speed.
    HalfSpeed,
}

/// A measurement, and the interval to expect after it: computed, not measured.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Promised {
    /// What to measure.
    pub measurement: Measurement,
    /// The parameter that it is for.
    pub parameter: Parameter,
    /// Half of the 95 % interval to expect, as a fraction of the value: 0.05 is ±5 %.
    pub half_width: f64,
}
