//! Current sensor offset: what the current sensors read at zero. It is a constant vector in the stator's frame, so it turns in the
//! rotor's.

use super::description::{Description, Names, NumberDescription, peak_current, present_state};
use crate::frames::{AlphaBeta, Dq};

/// Offsets of the current sensors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CurrentOffset {
    /// What the current sensors read at zero, A. What all three read alike is in neither component.
    pub current: AlphaBeta,
}

pub(super) static FAULT: Description<CurrentOffset> = Description {
    key: "current_offset",
    label: "current sensor offset",
    family: "sensor offset",
    needs_angle: true,
    alters_measured_current: true,
    numbers: &[
        NumberDescription {
            names: Names { key: "current_offset_alpha", label: "current sensor offset, alpha", unit: "A" },
            get: |state| state.current.alpha,
            set: |state, value| state.current.alpha = value,
            usual_size: peak_current,
        },
        NumberDescription {
            names: Names { key: "current_offset_beta", label: "current sensor offset, beta", unit: "A" },
            get: |state| state.current.beta,
            set: |state, value| state.current.beta = value,
            usual_size: peak_current,
        },
    ],
    starts: present_state,
    is_physical: |state, _, peak| state.current.alpha.hypot(state.current.beta) < peak,
};

impl CurrentOffset {
    /// The current, A, without the offset, where `i` was measured at the electrical angle `theta_e`.
    #[inline]
    pub(super) fn removed(&self, i: Dq, theta_e: f64) -> Dq {
        let offset = self.current.to_dq(theta_e);
        Dq { d: i.d - offset.d, q: i.q - offset.q }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.2 A on phase a alone: two thirds of it along alpha, whatever the angle.
    #[test]
    fn the_offset_stands_still_in_the_stator() {
        let fault = CurrentOffset { current: AlphaBeta { alpha: 0.2 * 2.0 / 3.0, beta: 0.0 } };
        for theta_e in [0.0, 1.0, 4.0] {
            let mut phases = Dq { d: 3.0, q: -2.0 }.to_alpha_beta(theta_e).to_abc();
            phases.a += 0.2;
            let found = fault.removed(phases.to_alpha_beta().to_dq(theta_e), theta_e);
            assert!((found.d - 3.0).hypot(found.q + 2.0) < 1e-14, "{found:?}");
        }
    }
}
