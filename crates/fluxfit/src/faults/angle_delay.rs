//! Angle delay: the drive's electrical angle is late by a fixed time, as of a resolver converter or a position that is sampled early. It
//! is then too small by `omega_e` times that time: voltages and currents are written in a frame that lags behind the magnet's. While the
//! speed grows it lags more and more: the rotor turns faster than its late angle, by the acceleration times that time.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription, no_kinds, present_state},
};
use crate::lanes::Number;

/// An angle that is read late.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AngleDelay {
    /// By which time, s.
    pub time: f64,
}

/// Longest delay, s: a drive whose angle is older does not run at speed. An angle that was advanced is early by a period at most.
const LONGEST: f64 = 5e-3;

/// Usual delay, s: a period of a drive.
const USUAL: f64 = 1e-4;

pub(super) static FAULT: Description<AngleDelay> = Description {
    key: "angle_delay",
    label: "angle delay",
    family: "angle delay",
    // It is the same in every position of the rotor.
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "angle_delay", label: "time by which the angle is late", unit: "s" },
        get: |state| state.time,
        set: |state, value| state.time = value,
        usual_size: |_, _| USUAL,
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.time > -USUAL && state.time < LONGEST,
};

/// Cosine and sine of the turn from the frame of the late angle to the magnet's, which lies ahead of it: backward by `omega_e` times the
/// delay. By the series of both, which has all digits that matter up to a radian and stays bounded beyond nothing: an angle that late
/// is no candidate's.
#[inline(always)]
pub(super) fn turn<V: Number>(delay: V, omega_e: f64) -> [V; 2] {
    let angle = -delay * delay.constant(omega_e);
    let square = angle * angle;
    let (mut cos, mut sin) = (angle.constant(0.0), angle.constant(0.0));
    for (of_cosine, of_sine) in COSINE.iter().zip(&SINE).rev() {
        cos = cos.mul_add(square, angle.constant(*of_cosine));
        sin = sin.mul_add(square, angle.constant(*of_sine));
    }
    [cos, angle * sin]
}

/// The voltage, V, `d, q`, that flux (Wb, `d, q`) induces because the rotor turns faster than an angle that is `delay` s late.
#[inline(always)]
pub(super) fn induced<V: Number>(delay: V, flux: [V; 2], place: &Place) -> [V; 2] {
    let faster = delay * delay.constant(place.angle_acceleration);
    [-faster * flux[1], faster * flux[0]]
}

/// Taylor's coefficients of the cosine, of even powers.
const COSINE: [f64; 7] = [1.0, -1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0, -1.0 / 3_628_800.0, 1.0 / 479_001_600.0];

/// The same of the sine, of odd powers.
const SINE: [f64; 7] = [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0, 1.0 / 6_227_020_800.0];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Turn;

    #[test]
    fn the_turn_is_that_of_the_angle() {
        for (delay, omega_e) in [(1e-4_f64, 3000.0), (-2e-4, 5000.0), (0.0, 100.0)] {
            let (sin, cos) = (-delay * omega_e).sin_cos();
            let found = turn(delay, omega_e);
            assert!((found[0] - cos).hypot(found[1] - sin) < 1e-10, "{found:?}");
        }
    }

    /// 40 us behind a speed that grows by 75 000 rad/s²: the rotor turns 3 rad/s faster than that angle, and 0.2 Wb along d induce 0.6 V
    /// along q.
    #[test]
    fn a_late_angle_turns_too_slowly_while_the_speed_grows() {
        let place = Place { angle_acceleration: 75e3, ..Place::still(Turn::by(0.0)) };
        let found = induced(40e-6, [0.2, 0.0], &place);
        assert!(found[0].abs() < 1e-12 && (found[1] - 0.6).abs() < 1e-12, "{found:?}");
    }
}
