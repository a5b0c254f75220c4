//! Disturbing voltages: unknown voltages act on the motor from row to row, beside those in the log.
//!
//! The simulated current is then corrected by a part of its error at every row, as the Kalman filter of a disturbed motor does, and what
//! is compared with the log is the prediction of one row from the row before. R. E. Kalman, "A new approach to linear filtering and
//! prediction problems", Journal of Basic Engineering 82, 1960, doi:10.1115/1.3662552; the gain is an unknown of the fit, as in L. Ljung,
//! System Identification, 2nd edition, 1999, section 4.3 (innovations form).

use super::description::{Description, Names, NumberDescription, one, present_state};
use crate::frames::Dq;

/// The observer of a disturbed motor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Disturbance {
    /// Observer gain: the part of the error of each simulated current that is corrected at every row.
    pub gain: Dq,
}

/// At a gain of one the simulation starts anew at each measured current: more is no observer.
const LARGEST: f64 = 1.0;

pub(super) static FAULT: Description<Disturbance> = Description {
    key: "process_noise",
    label: "disturbing voltages",
    family: "disturbances",
    needs_angle: false,
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
    is_physical: |state, _, _| {
        let Dq { d, q } = state.gain;
        d.max(q) > 0.0 && d.abs().max(q.abs()) < LARGEST
    },
};

impl Disturbance {
    /// The simulated current `i`, A, corrected by its `error`, measured less simulated, A.
    #[inline]
    pub(crate) fn corrected(&self, i: Dq, error: Dq) -> Dq {
        Dq { d: i.d + self.gain.d * error.d, q: i.q + self.gain.q * error.q }
    }

    /// What the correction leaves of a difference between two simulations of the same measurement.
    #[inline]
    pub(crate) fn remaining(&self, difference: Dq) -> Dq {
        Dq { d: (1.0 - self.gain.d) * difference.d, q: (1.0 - self.gain.q) * difference.q }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_shrink_as_the_correction_makes_them() {
        let observer = Disturbance { gain: Dq { d: 0.25, q: -0.1 } };
        let (measured, one, other) = (Dq { d: 1.0, q: 2.0 }, Dq { d: 0.5, q: 2.5 }, Dq { d: 3.0, q: -1.0 });
        let corrected = |i: Dq| observer.corrected(i, Dq { d: measured.d - i.d, q: measured.q - i.q });
        let remaining = observer.remaining(Dq { d: one.d - other.d, q: one.q - other.q });
        let (one, other) = (corrected(one), corrected(other));
        assert!((remaining.d - (one.d - other.d)).hypot(remaining.q - (one.q - other.q)) < 1e-15);
    }
}
