//! Voltage lag: the logged voltages act a fixed time after the instant of their row, and the drive does not turn them forward for it. The
//! rotor has turned further by then: in its frame they lie behind by `omega_e` times that time, and the currents of the same row do not.
//!
//! Where a log holds each of a drive's periods the [reading](crate::objective::acting_voltage) of its voltages says so. Rows that come
//! slower are of no whole number of periods: a voltage that was computed at its row acts one to two periods of the drive later, and means
//! over many periods lag alike.

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, present_state};

/// Voltages that lag.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VoltageLag {
    /// By which time, s.
    pub time: f64,
}

/// Longest lag, s: two periods of a drive that controls at 1 kHz.
const LONGEST: f64 = 2e-3;

/// What is no lag may come out below zero by this time, s.
const LEAST: f64 = 5e-6;

/// Usual lag, s: a period of a drive.
const USUAL: f64 = 1e-4;

pub(super) static FAULT: Description<VoltageLag> = Description {
    key: "voltage_lag",
    label: "lag of the voltages",
    family: "voltage lag",
    // It is the same in every position of the rotor.
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[NumberDescription {
        names: Names { key: "voltage_lag", label: "time by which the voltages lag behind their frame", unit: "s" },
        get: |state| state.time,
        set: |state, value| state.time = value,
        usual_size: |_, _| USUAL,
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.time > -LEAST && state.time < LONGEST,
};
