//! Angle offset: the drive's electrical angle is too large by a constant, as of an encoder that was aligned wrongly.
//!
//! Voltages and currents are then written in a frame that leads the magnet's by that angle: both are turned forward by it to stand in the
//! magnet's frame.

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, one, present_state};

/// An angle that is read wrongly.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AngleOffset {
    /// What the logged angle is too large by, electrical rad.
    pub angle: f64,
}

/// Largest offset, rad: beyond 45 degrees d and q change places.
const LARGEST: f64 = std::f64::consts::FRAC_PI_4;

pub(super) static FAULT: Description<AngleOffset> = Description {
    key: "angle_offset",
    label: "angle offset",
    family: "angle offset",
    // It is the same in every position of the rotor.
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "angle_offset", label: "angle read too large by", unit: "rad" },
        get: |state| state.angle,
        set: |state, value| state.angle = value,
        usual_size: one,
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.angle.abs() < LARGEST,
};
