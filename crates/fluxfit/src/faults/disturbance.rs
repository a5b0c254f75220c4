//! Disturbing voltages: unknown voltages act on the motor from row to row, beside those in the log.
//!
//! The simulated current is then corrected by a part of its error at every row, as the Kalman filter of a disturbed motor does, and what
//! is compared with the log is the prediction of one row from the row before. R. E. Kalman, "A new approach to linear filtering and
//! prediction problems", Journal of Basic Engineering 82, 1960, doi:10.1115/1.3662552; the gain is an unknown of the fit, as in L. Ljung,
//! System Identification, 2nd edition, 1999, section 4.3 (innovations form).

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, one, present_state};
use crate::{frames::Dq, lanes::Number};

/// The observer of a disturbed motor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Disturbance {
    /// Observer gain: the part of the error of each simulated current that is corrected at every row.
    pub gain: Dq,
}

/// Gain below which next to no observer was needed. Simulated drives whose log has nothing that the model lacks come to 0.01 to 0.14.
const SMALL: f64 = 0.2;

impl Disturbance {
    /// Whether next to no observer was needed.
    pub(crate) fn is_small(&self) -> bool {
        self.gain.magnitude() < SMALL
    }
}

/// At a gain of one the simulation starts anew at each measured current: more is no observer.
const LARGEST: f64 = 1.0;

pub(super) static FAULT: Description<Disturbance> = Description {
    key: "process_noise",
    label: "disturbing voltages",
    family: "disturbances",
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[
        NumberDescription {
            names: Names { key: "observer_gain_d", label: "observer gain, d", unit: "1" },
            get: |state| state.gain.d,
            set: |state, value| state.gain.d = value,
            usual_size: one,
        },
        NumberDescription {
            names: Names { key: "observer_gain_q", label: "observer gain, q", unit: "1" },
            get: |state| state.gain.q,
            set: |state, value| state.gain.q = value,
            usual_size: one,
        },
    ],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| {
        let Dq { d, q } = state.gain;
        d.max(q) > 0.0 && d.abs().max(q.abs()) < LARGEST
    },
};

/// The current that is compared with the log, `i`, A, corrected by its `error`, measured less simulated, A; all of them, and the gain,
/// `d, q`.
#[inline(always)]
pub(super) fn corrected<V: Number>(gain: [V; 2], i: [V; 2], error: [V; 2]) -> [V; 2] {
    [i[0] + gain[0] * error[0], i[1] + gain[1] * error[1]]
}

/// What the correction leaves of a difference between two simulations of the same measurement: of `i`, where that of the compared currents
/// is `compared`.
#[inline(always)]
pub(super) fn remaining<V: Number>(gain: [V; 2], i: [V; 2], compared: [V; 2]) -> [V; 2] {
    [i[0] - gain[0] * compared[0], i[1] - gain[1] * compared[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_shrink_as_the_correction_makes_them() {
        let gain = [0.25, -0.1];
        let (measured, one, other) = ([1.0, 2.0], [0.5, 2.5], [3.0, -1.0]);
        let after = |i: [f64; 2]| corrected(gain, i, [measured[0] - i[0], measured[1] - i[1]]);
        let difference = [one[0] - other[0], one[1] - other[1]];
        let left = remaining(gain, difference, difference);
        let (one, other) = (after(one), after(other));
        assert!((left[0] - (one[0] - other[0])).hypot(left[1] - (one[1] - other[1])) < 1e-15);
    }
}
