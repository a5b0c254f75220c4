//! Resistance drift: the winding warms while the log is taken, and R_s grows. Linear in time; R_s itself is that at half the log's time.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription, no_kinds, present_state},
};
use crate::lanes::Number;

/// A resistance that changes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ResistanceDrift {
    /// R_s at the log's end less that at its start, ohm.
    pub change: f64,
}

impl ResistanceDrift {
    /// Largest change, as a fraction of R_s: 125 K of copper, from cold to the limit of most windings.
    pub(crate) const LARGEST: f64 = 0.5;
}

pub(super) static FAULT: Description<ResistanceDrift> = Description {
    key: "resistance_drift",
    label: "drift of R_s",
    family: "resistance drift",
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[NumberDescription {
        names: Names { key: "resistance_change", label: "R_s at the log's end less that at its start", unit: "ohm" },
        get: |state| state.change,
        set: |state, value| state.change = value,
        usual_size: |motor, _| motor.rs.abs(),
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, motor, _| state.change.abs() < ResistanceDrift::LARGEST * motor.rs.abs(),
};

/// The voltage, V, that the change takes at current `i`, A.
#[inline(always)]
pub(super) fn taken<V: Number>(change: V, i: [V; 2], place: &Place) -> [V; 2] {
    let more = change * change.constant(place.time);
    [more * i[0], more * i[1]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Turn;

    /// A tenth of an ohm more over the whole log: half of that less at its start, none in its middle, half more at its end.
    #[test]
    fn the_change_is_linear_in_time() {
        for (time, ohms) in [(-0.5, -0.05), (0.0, 0.0), (0.5, 0.05)] {
            let found = taken(0.1, [3.0, -2.0], &Place { time, ..Place::still(Turn::by(0.3)) });
            assert!((found[0] - 3.0 * ohms).hypot(found[1] + 2.0 * ohms) < 1e-15, "{found:?}");
        }
    }
}
