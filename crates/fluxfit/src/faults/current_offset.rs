//! Current sensor offset: what the current sensors read at zero. It is a constant vector in the stator's frame, so it turns in the
//! rotor's.

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, peak_current, present_state};
use crate::{
    frames::{AlphaBeta, Turn},
    lanes::Number,
};

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
    angle: AngleNeed::Traced,
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
    kinds: no_kinds,
    is_physical: |state, _, peak| state.current.alpha.hypot(state.current.beta) < peak,
};

/// The current, A, without the offset (alpha, beta), where `i` (d, q) was measured with the rotor there.
#[inline(always)]
pub(super) fn removed<V: Number>(offset: [V; 2], i: [V; 2], rotor: Turn) -> [V; 2] {
    let [d, q] = rotor.backward(offset);
    [i[0] - d, i[1] - q]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Dq;

    /// 0.2 A on phase a alone: two thirds of it along alpha, whatever the angle.
    #[test]
    fn the_offset_stands_still_in_the_stator() {
        for theta_e in [0.0, 1.0, 4.0] {
            let mut phases = Dq { d: 3.0, q: -2.0 }.to_alpha_beta(theta_e).to_abc();
            phases.a += 0.2;
            let read = phases.to_alpha_beta().to_dq(theta_e);
            let found = removed([0.2 * 2.0 / 3.0, 0.0], [read.d, read.q], Turn::by(theta_e));
            assert!((found[0] - 3.0).hypot(found[1] + 2.0) < 1e-14, "{found:?}");
        }
    }
}
