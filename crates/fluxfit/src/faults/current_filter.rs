//! Current filter: a low pass of first order between the motor's currents and the logged ones.
//!
//! Either it lies in the phases, as an RC filter before the converter. Over a period `T` in which the motor's current goes straight from
//! `i_0` to `i_1` in the stator,
//!
//! ```text
//! y_1 = a y_0 + (c - a) i_0 + (1 - c) i_1,    a = exp(-T / tau),    c = (tau / T) (1 - a)
//! ```
//!
//! which is the exact solution of `tau dy/dt = i - y`. Or the drive smooths the d and q currents from period to period before it logs
//! them: `y_1 = a y_0 + (1 - a) i_1` in the rotor's frame.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription},
};
use crate::{
    frames::{Turn, turned},
    lanes::Number,
};
use std::f64::consts::TAU;

/// A filter of the logged currents.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CurrentFilter {
    /// Time constant of a filter in the phases, s; zero without one.
    pub phases: f64,
    /// Time constant of a filter of the d and q currents, s; zero without one.
    pub dq: f64,
}

/// Time constants, s, from which a fit starts: of corners between some hundred hertz and the switching frequency.
const TIME_CONSTANTS: [f64; 3] = [5e-4, 1.6e-4, 4e-5];

/// Lowest corner frequency, Hz: below it, no drive controls a current.
const LOWEST_CORNER: f64 = 100.0;

/// Usual time constant, s: of a corner at 1.6 kHz.
const USUAL: f64 = 1e-4;

/// The family of both faults in this file.
const FAMILY: &str = "current filter";

pub(super) static OF_PHASES: Description<CurrentFilter> = Description {
    key: "current_filter",
    label: "filter of the phase currents",
    family: FAMILY,
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "current_filter_time_constant", label: "time constant of the phase currents' filter", unit: "s" },
        get: |state| state.phases,
        set: |state, value| state.phases = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |_, _| TIME_CONSTANTS.map(|phases| CurrentFilter { phases, dq: 0.0 }).to_vec(),
    is_physical: |state, _, _| is_physical(state.phases),
};

pub(super) static OF_DQ: Description<CurrentFilter> = Description {
    key: "dq_current_filter",
    label: "filter of the logged d and q currents",
    family: FAMILY,
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "dq_current_filter_time_constant", label: "time constant of the d and q currents' filter", unit: "s" },
        get: |state| state.dq,
        set: |state, value| state.dq = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |_, _| TIME_CONSTANTS.map(|dq| CurrentFilter { phases: 0.0, dq }).to_vec(),
    is_physical: |state, _, _| is_physical(state.dq),
};

fn is_physical(time_constant: f64) -> bool {
    time_constant > 0.0 && time_constant < 1.0 / (TAU * LOWEST_CORNER)
}

impl CurrentFilter {
    /// `a` and `c` over a period of this length, s, and 1 for a filter that turns with the stator, 0 for one that turns with the rotor: of
    /// that, `c` is `a`.
    pub(super) fn weights(self, period: f64) -> [f64; 3] {
        let decay = |periods: f64| if periods > 0.0 { (-1.0 / periods).exp() } else { 0.0 };
        if self.dq != 0.0 {
            let a = decay(self.dq / period);
            return [a, a, 0.0];
        }
        // A time constant below zero, which a fit may try beside zero, advances the current.
        let periods = self.phases / period;
        let a = decay(periods);
        [a, periods * (1.0 - a), 1.0]
    }
}

/// The logged current at the end of a period, given that at its start, `y`, and the motor's at both, `i`; all `d, q` in the rotor's frame
/// of their instants.
#[inline(always)]
pub(super) fn filtered<V: Number>([a, c, turns]: [V; 3], y: [V; 2], i: [[V; 2]; 2], place: &Place) -> [V; 2] {
    let one = a.constant(1.0);
    let [before, after] = i;
    let kept = [a * y[0] + (c - a) * before[0], a * y[1] + (c - a) * before[1]];
    let Turn { cos, sin } = place.start.until(place.end);
    let kept = turned(kept, turns.mul_add(a.constant(cos - 1.0), one), turns * a.constant(-sin));
    [kept[0] + (one - c) * after[0], kept[1] + (one - c) * after[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A current that stands still in the stator from the start on: `y = 1 - exp(-t / tau)`, whatever the rotor does.
    #[test]
    fn a_step_rises_as_an_exponential() {
        const PERIOD: f64 = 1e-4;
        const TIME_CONSTANT: f64 = 3e-4;
        let weights = CurrentFilter { phases: TIME_CONSTANT, dq: 0.0 }.weights(PERIOD);
        let mut y = [0.0; 2];
        for row in 0..10 {
            let turn = |row: usize| Turn::by(0.05 * row as f64);
            let place = Place { start: turn(row), end: turn(row + 1), ..Place::still(turn(0)) };
            let still = [1.0, 0.5];
            y = filtered(weights, y, [place.start.backward(still), place.end.backward(still)], &place);
            let risen = 1.0 - (-PERIOD * (row + 1) as f64 / TIME_CONSTANT).exp();
            let expected = place.end.backward([risen, 0.5 * risen]);
            assert!((y[0] - expected[0]).hypot(y[1] - expected[1]) < 1e-14, "{y:?}");
        }
    }

    /// A current that stands still in the rotor's frame: `y = 1 - a^k` after k rows.
    #[test]
    fn a_step_in_the_rotors_frame_rises_as_an_exponential() {
        let weights = CurrentFilter { phases: 0.0, dq: 3e-4 }.weights(1e-4);
        let mut y = [0.0; 2];
        for row in 1..10 {
            let place = Place { start: Turn::by(0.1), end: Turn::by(0.2), ..Place::still(Turn::by(0.15)) };
            y = filtered(weights, y, [[1.0, 0.5]; 2], &place);
            let risen = 1.0 - (-f64::from(row) / 3.0).exp();
            assert!((y[0] - risen).hypot(y[1] - 0.5 * risen) < 1e-14, "{y:?}");
        }
    }
}
