//! Speed lag: the logged speed is filtered and lags behind the rotor's, which is then `omega_e + lag d omega_e / dt`. Where the angle is
//! in the log the speed is taken from it, and nothing lags.
//!
//! To first order, what the rotor turns faster induces a voltage with the flux.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription},
};
use crate::lanes::Number;

/// A speed that lags.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedLag {
    /// By which time, s.
    pub time: f64,
}

/// Longest lag, s: of a filter at 1 Hz.
const LONGEST: f64 = 0.16;

/// Usual lag, s: of a filter at 16 Hz.
const USUAL: f64 = 0.01;

pub(super) static FAULT: Description<SpeedLag> = Description {
    key: "speed_lag",
    label: "lag of the logged speed",
    family: "speed lag",
    angle: AngleNeed::Unknown,
    alters_measured_current: false,
    numbers: &[NumberDescription {
        names: Names { key: "speed_lag", label: "time by which the logged speed lags", unit: "s" },
        get: |state| state.time,
        set: |state, value| state.time = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |state, _| vec![*state],
    is_physical: |state, _, _| (0.0..LONGEST).contains(&state.time),
};

/// The voltage, V, `d, q`, that flux (Wb, `d, q`) induces because the rotor turns faster than the log says.
#[inline(always)]
pub(super) fn induced<V: Number>(lag: V, flux: [V; 2], place: &Place) -> [V; 2] {
    let faster = lag * lag.constant(place.acceleration);
    [-faster * flux[1], faster * flux[0]]
}
