//! Filters between the drive and its log, low passes of first order.
//!
//! One of the currents may lie in the phases, as an RC filter before the converter. Over a period `T` in which the motor's current goes
//! straight from `i_0` to `i_1` in the stator,
//!
//! ```text
//! y_1 = a y_0 + (c - a) i_0 + (1 - c) i_1,    a = exp(-T / tau),    c = (tau / T) (1 - a)
//! ```
//!
//! which is the exact solution of `tau dy/dt = i - y`. But the way from `i_0` to `i_1` is bent while the rotor turns: at the part `s` of
//! the period the current is by `s (1 - s) b` beside the chord, and of that the filter passes on
//!
//! ```text
//! ((c - a) (1 - 2 tau / T) + a) b.
//! ```
//!
//! Or the drive smooths the d and q currents, or voltages, or both alike, from period
//! to period before it logs them: `y_1 = a y_0 + (1 - a) i_1` in the rotor's frame. The voltage that acted is then
//! `u_1 = y_1 + a / (1 - a) (y_1 - y_0)`.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription, no_kinds, one},
};
use crate::{
    frames::{Turn, turned},
    lanes::Number,
};
use std::f64::consts::TAU;

/// Filters: their time constants, s, zero without one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Filter {
    /// Of the phase currents.
    pub phases: f64,
    /// Of the d and q currents.
    pub currents: f64,
    /// Of the d and q voltages.
    pub voltages: f64,
    /// The part of the noise of the currents that lies before their filter and passes it: by so much, what the filter holds is corrected
    /// to what it put out.
    pub noise_before: f64,
}

/// Time constants, s, from which a fit starts: of corners between some hundred hertz and the switching frequency.
const TIME_CONSTANTS: [f64; 3] = [5e-4, 1.6e-4, 4e-5];

/// Lowest corner frequency, Hz: below it, no drive controls a current.
const LOWEST_CORNER: f64 = 100.0;

/// Usual time constant, s: of a corner at 1.6 kHz.
const USUAL: f64 = 1e-4;

/// Parts of the noise before the filter from which a fit starts.
const NOISE_BEFORE: [f64; 2] = [0.0, 0.9];

/// Every time constant with every part of the noise.
fn starts(filter: impl Fn(f64) -> Filter) -> Vec<Filter> {
    let with = |noise_before| TIME_CONSTANTS.map(|time_constant| Filter { noise_before, ..filter(time_constant) });
    NOISE_BEFORE.into_iter().flat_map(with).collect()
}

/// Most of the noise, with freedom for a fit whose other faults are not found yet.
const MOST_NOISE: f64 = 3.0;

/// By how much a part of the noise may come out below zero or above one. Of 88 filters of simulated drives it came out further beyond in
/// five. Where there was no filter and the rows were every n-th of a drive's, it mostly did.
const BEYOND_A_PART: f64 = 0.35;

const NOISE: NumberDescription<Filter> = NumberDescription {
    names: Names { key: "noise_before_filter", label: "part of the currents' noise before the filter", unit: "1" },
    get: |state| state.noise_before,
    set: |state, value| state.noise_before = value,
    usual_size: one,
};

/// Whether a number with this name is a part, of the whole noise.
pub(super) fn is_part(key: &str) -> bool {
    key == NOISE.names.key
}

/// The family of filters of currents: there is one.
const FAMILY: &str = "current filter";

pub(super) static OF_PHASES: Description<Filter> = Description {
    key: "current_filter",
    label: "filter of the phase currents",
    family: FAMILY,
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[
        NumberDescription {
            names: Names { key: "current_filter_time_constant", label: "time constant of the phase currents' filter", unit: "s" },
            get: |state| state.phases,
            set: |state, value| state.phases = value,
            usual_size: |_, _| USUAL,
        },
        NOISE,
    ],
    starts: |state, _| starts(|phases| Filter { phases, ..*state }),
    kinds: no_kinds,
    is_physical: |state, _, _| is_physical(state.phases) && state.noise_before.abs() < MOST_NOISE,
};

pub(super) static OF_CURRENTS: Description<Filter> = Description {
    key: "dq_current_filter",
    label: "filter of the logged d and q currents",
    family: FAMILY,
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[
        NumberDescription {
            names: Names { key: "dq_current_filter_time_constant", label: "time constant of the d and q currents' filter", unit: "s" },
            get: |state| state.currents,
            set: |state, value| state.currents = value,
            usual_size: |_, _| USUAL,
        },
        NOISE,
    ],
    starts: |state, _| starts(|currents| Filter { currents, ..*state }),
    kinds: no_kinds,
    is_physical: |state, _, _| is_physical(state.currents) && state.noise_before.abs() < MOST_NOISE,
};

pub(super) static OF_VOLTAGES: Description<Filter> = Description {
    key: "dq_voltage_filter",
    label: "filter of the logged d and q voltages",
    family: "voltage filter",
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[NumberDescription {
        names: Names { key: "dq_voltage_filter_time_constant", label: "time constant of the d and q voltages' filter", unit: "s" },
        get: |state| state.voltages,
        set: |state, value| state.voltages = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |state, _| TIME_CONSTANTS.map(|voltages| Filter { voltages, ..*state }).to_vec(),
    kinds: no_kinds,
    is_physical: |state, _, _| is_physical(state.voltages),
};

pub(super) static OF_BOTH: Description<Filter> = Description {
    key: "dq_filter",
    label: "filter of all logged d and q values",
    family: FAMILY,
    angle: AngleNeed::Nothing,
    alters_measured_current: true,
    numbers: &[
        NumberDescription {
            names: Names { key: "dq_filter_time_constant", label: "time constant of the filter of all d and q values", unit: "s" },
            get: |state| state.currents,
            set: |state, value| (state.currents, state.voltages) = (value, value),
            usual_size: |_, _| USUAL,
        },
        NOISE,
    ],
    starts: |state, _| starts(|both| Filter { currents: both, voltages: both, ..*state }),
    kinds: no_kinds,
    is_physical: |state, _, _| is_physical(state.currents) && state.noise_before.abs() < MOST_NOISE,
};

fn is_physical(time_constant: f64) -> bool {
    time_constant > 0.0 && time_constant < 1.0 / (TAU * LOWEST_CORNER)
}

impl Filter {
    /// Whether the noise before it is a part of the noise, as it has to be once everything else is found.
    pub(crate) fn passes_a_part(self) -> bool {
        (-BEYOND_A_PART..=1.0 + BEYOND_A_PART).contains(&self.noise_before)
    }

    /// Of the currents: `a` and `c` over a period of this length, s, and 1 for a filter in the stator's frame, 0 for one in the rotor's: of
    /// that, `c` is `a`. And what is passed on of a bend.
    pub(super) fn weights(self, period: f64) -> [f64; 4] {
        let decay = |periods: f64| if periods > 0.0 { (-1.0 / periods).exp() } else { 0.0 };
        if self.currents != 0.0 {
            let a = decay(self.currents / period);
            return [a, a, 0.0, 0.0];
        }
        // A time constant below zero, which a fit may try beside zero, advances the current.
        let periods = self.phases / period;
        let a = decay(periods);
        let c = periods * (1.0 - a);
        [a, c, 1.0, (c - a) * (1.0 - 2.0 * periods) + a]
    }

    /// Of the voltages: `a / (1 - a)` over a period of this length, s.
    pub(super) fn advance(self, period: f64) -> f64 {
        if self.voltages > 0.0 { 1.0 / (period / self.voltages).exp_m1() } else { 0.0 }
    }
}

/// The logged current at the end of a period, given that at its start, `y`, the motor's at both, `i`, and how its way between them is bent;
/// all `d, q` in the rotor's frame of their instants.
#[inline(always)]
pub(super) fn filtered<V: Number>([a, c, turns, bent]: [V; 4], y: [V; 2], i: [[V; 2]; 2], bend: [V; 2], place: &Place) -> [V; 2] {
    let one = a.constant(1.0);
    let [before, after] = i;
    let kept = [a * y[0] + (c - a) * before[0], a * y[1] + (c - a) * before[1]];
    let Turn { cos, sin } = place.start.until(place.end);
    let kept = turned(kept, turns.mul_add(a.constant(cos - 1.0), one), turns * a.constant(-sin));
    [bent.mul_add(bend[0], kept[0] + (one - c) * after[0]), bent.mul_add(bend[1], kept[1] + (one - c) * after[1])]
}

/// The voltage that was filtered into `logged`, V, given the logged one of the period before.
#[inline(always)]
pub(super) fn unfiltered<V: Number>(advance: V, logged: [V; 2], before: [V; 2]) -> [V; 2] {
    [advance.mul_add(logged[0] - before[0], logged[0]), advance.mul_add(logged[1] - before[1], logged[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A current that stands still in the stator from the start on: `y = 1 - exp(-t / tau)`.
    #[test]
    fn a_step_rises_as_an_exponential() {
        let mut y = [0.0; 2];
        for row in 0..10 {
            y = filtered(
                Filter { phases: 3.0, ..Filter::default() }.weights(1.0),
                y,
                [[1.0, 0.5]; 2],
                [0.0; 2],
                &Place::still(Turn::by(0.3)),
            );
            let risen = 1.0 - (-f64::from(row + 1) / 3.0).exp();
            assert!((y[0] - risen).hypot(y[1] - 0.5 * risen) < 1e-14, "{y:?}");
        }
    }

    /// A way that is bent, against the filter's equation in fine steps.
    #[test]
    fn a_bent_way_passes_as_it_does() {
        const STEPS: u32 = 20_000;
        let ([start, end], bend) = ([1.0, 1.6], 0.3);
        for periods in [0.2, 0.7, 3.0, 20.0] {
            let step = 1.0 / f64::from(STEPS);
            let mut expected = 0.4;
            for k in 0..STEPS {
                let part = (f64::from(k) + 0.5) * step;
                expected += (start + (end - start) * part + part * (1.0 - part) * bend - expected) * step / periods;
            }
            let weights = Filter { phases: periods, ..Filter::default() }.weights(1.0);
            let y = filtered(weights, [0.4, 0.0], [[start, 0.0], [end, 0.0]], [bend, 0.0], &Place::still(Turn::by(0.3)));
            assert!((y[0] - expected).abs() < 2e-4, "{periods}: {}, not {expected}", y[0]);
        }
    }

    /// A current that stands still in the rotor's frame: `y = 1 - a^k` after k rows.
    #[test]
    fn a_step_in_the_rotors_frame_rises_as_an_exponential() {
        let weights = Filter { currents: 3e-4, ..Filter::default() }.weights(1e-4);
        let mut y = [0.0; 2];
        for row in 1..10 {
            let place = Place { start: Turn::by(0.1), end: Turn::by(0.2), ..Place::still(Turn::by(0.15)) };
            y = filtered(weights, y, [[1.0, 0.5]; 2], [0.0; 2], &place);
            let risen = 1.0 - (-f64::from(row) / 3.0).exp();
            assert!((y[0] - risen).hypot(y[1] - 0.5 * risen) < 1e-14, "{y:?}");
        }
    }

    #[test]
    fn filtering_of_voltages_is_undone() {
        let (filter, period) = (Filter { voltages: 3e-4, ..Filter::default() }, 1e-4);
        let a = (-1.0_f64 / 3.0).exp();
        let (before, u) = ([1.0, -2.0], [5.0, 3.0]);
        let logged = [0, 1].map(|axis| a * before[axis] + (1.0 - a) * u[axis]);
        let found = unfiltered(filter.advance(period), logged, before);
        assert!((found[0] - u[0]).hypot(found[1] - u[1]) < 1e-14, "{found:?}");
    }
}
