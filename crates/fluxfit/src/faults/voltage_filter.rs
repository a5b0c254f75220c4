//! Voltage filter: the drive smooths the d and q voltages from period to period before it logs them, `y_k = a y_(k-1) + (1 - a) u_k`. What
//! acted is then `u_k = y_k + a / (1 - a) (y_k - y_(k-1))`.

use super::description::{AngleNeed, Description, Names, NumberDescription};
use crate::lanes::Number;
use std::f64::consts::TAU;

/// A filter of the logged voltages.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VoltageFilter {
    /// Its time constant, s; zero without one.
    pub time_constant: f64,
}

/// Time constants, s, from which a fit starts: of corners between some hundred hertz and the switching frequency.
const TIME_CONSTANTS: [f64; 3] = [5e-4, 1.6e-4, 4e-5];

/// Lowest corner frequency, Hz: of what is slower, the digits of the log do not bring back the voltages.
const LOWEST_CORNER: f64 = 100.0;

/// Usual time constant, s: of a corner at 1.6 kHz.
const USUAL: f64 = 1e-4;

pub(super) static FAULT: Description<VoltageFilter> = Description {
    key: "voltage_filter",
    label: "filter of the logged d and q voltages",
    family: "voltage filter",
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[NumberDescription {
        names: Names { key: "voltage_filter_time_constant", label: "time constant of the d and q voltages' filter", unit: "s" },
        get: |state| state.time_constant,
        set: |state, value| state.time_constant = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |_, _| TIME_CONSTANTS.map(|time_constant| VoltageFilter { time_constant }).to_vec(),
    is_physical: |state, _, _| state.time_constant > 0.0 && state.time_constant < 1.0 / (TAU * LOWEST_CORNER),
};

impl VoltageFilter {
    /// `a / (1 - a)` over a period of this length, s.
    pub(super) fn advance(self, period: f64) -> f64 {
        if self.time_constant > 0.0 { 1.0 / (period / self.time_constant).exp_m1() } else { 0.0 }
    }
}

/// The voltage that was filtered into `logged`, V, given the logged one of the period before.
#[inline(always)]
pub(super) fn unfiltered<V: Number>(advance: V, logged: [V; 2], before: [V; 2]) -> [V; 2] {
    [advance.mul_add(logged[0] - before[0], logged[0]), advance.mul_add(logged[1] - before[1], logged[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filtering_is_undone() {
        let (filter, period) = (VoltageFilter { time_constant: 3e-4 }, 1e-4);
        let a = (-1.0_f64 / 3.0).exp();
        let (before, u) = ([1.0, -2.0], [5.0, 3.0]);
        let logged = [0, 1].map(|axis| a * before[axis] + (1.0 - a) * u[axis]);
        let found = unfiltered(filter.advance(period), logged, before);
        assert!((found[0] - u[0]).hypot(found[1] - u[1]) < 1e-14, "{found:?}");
    }
}
