//! Current filter: a low pass of first order between the motor's currents and the logged ones, as of an RC filter before the converter.
//!
//! It stands still in the stator. Over a period `T` in which the motor's current goes straight from `i_0` to `i_1` there,
//!
//! ```text
//! y_1 = a y_0 + (c - a) i_0 + (1 - c) i_1,    a = exp(-T / tau),    c = (tau / T) (1 - a)
//! ```
//!
//! which is the exact solution of `tau dy/dt = i - y`.

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
    /// Its time constant, s; zero without one.
    pub time_constant: f64,
}

/// Corner frequencies, Hz, from which a fit starts: current sensors' filters lie between some hundred hertz and the switching frequency.
const CORNERS: [f64; 3] = [300.0, 1000.0, 4000.0];

/// Lowest corner frequency, Hz: below it, no drive controls a current.
const LOWEST_CORNER: f64 = 20.0;

/// Usual time constant, s: of a corner at 1.6 kHz.
const USUAL: f64 = 1e-4;

pub(super) static FAULT: Description<CurrentFilter> = Description {
    key: "current_filter",
    label: "filter of the logged currents",
    family: "current filter",
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "current_filter_time_constant", label: "time constant of the currents' filter", unit: "s" },
        get: |state| state.time_constant,
        set: |state, value| state.time_constant = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |_, _| CORNERS.iter().map(|corner| CurrentFilter { time_constant: 1.0 / (TAU * corner) }).collect(),
    is_physical: |state, _, _| (0.0..1.0 / (TAU * LOWEST_CORNER)).contains(&state.time_constant),
};

impl CurrentFilter {
    /// `a` and `c` over a period of this length, s. A time constant below zero, which a fit may try beside zero, advances the current.
    pub(super) fn weights(self, period: f64) -> [f64; 2] {
        let periods = self.time_constant / period;
        let a = if periods > 0.0 { (-1.0 / periods).exp() } else { 0.0 };
        [a, periods * (1.0 - a)]
    }
}

/// The logged current at the end of a period, given that at its start, `y`, and the motor's at both, `i`; all `d, q` in the rotor's frame
/// of their instants.
#[inline(always)]
pub(super) fn filtered<V: Number>([a, c]: [V; 2], y: [V; 2], i: [[V; 2]; 2], place: &Place) -> [V; 2] {
    let one = a.constant(1.0);
    let [before, after] = i;
    let kept = [a * y[0] + (c - a) * before[0], a * y[1] + (c - a) * before[1]];
    let Turn { cos, sin } = place.start.until(place.end);
    let kept = turned(kept, a.constant(cos), a.constant(-sin));
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
        let weights = CurrentFilter { time_constant: TIME_CONSTANT }.weights(PERIOD);
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
}
