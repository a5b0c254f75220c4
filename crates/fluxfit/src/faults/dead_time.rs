//! Dead time and device drops: each phase loses a voltage against its current.
//!
//! Beyond some phase current the whole voltage is lost; near zero, where the ripple changes the current's sign between the switching
//! instants of a period, a part of it. A ramp of the width of that ripple describes the mean over a period:
//!
//! ```text
//! u_phase = commanded - V f(i_phase - shift),    f(i) = i / width, but at most 1 and at least -1
//! ```
//!
//! Where a row is half a carrier period, each phase switches once in it, up in one row and down in the next. A late edge up takes
//! voltage while current flows out, a late edge down gives some while it flows in: per row that is `V (f + 1)` and `V (f - 1)`, and what
//! is common to all phases has no effect. But the current at an edge up is the lowest of its ripple, at an edge down the highest: near
//! its zero crossing the deciding sign alternates, which is the shift.
//!
//! A log of operating points alone shows the fault by its harmonics only: [`ripple`].
//!
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, doi:10.1109/41.88903.

pub mod ripple;

use super::description::{Description, Names, NumberDescription, peak_current};
use crate::frames::{Abc, AlphaBeta, Dq};

/// What dead time and devices take.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeadTime {
    /// Voltage that each phase loses against its current, V.
    pub voltage: f64,
    /// Phase current, A, from which on it loses all of that; below, in proportion.
    pub width: f64,
    /// Ripple of a phase current between the carrier's rising and falling half, A: where each half is a row, the loss changes its sign at
    /// plus that current in one row and at minus it in the next. Its sign says which half comes first.
    pub ripple: f64,
}

/// Where in the log and in the stator a period lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PeriodAngles {
    /// Row of the log at which it begins.
    pub(crate) row: usize,
    /// Electrical angle at its start, middle and end, rad.
    pub(crate) start: f64,
    pub(crate) middle: f64,
    pub(crate) end: f64,
}

/// Widths of the ramp from which a fit starts, as fractions of the largest current: from almost none to a ripple nearly as large as the
/// current. The cost has a kink wherever the ramp's end passes a measured current, so one start does not find them all.
const WIDTHS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8];

pub(super) static FAULT: Description<DeadTime> = Description {
    key: "dead_time",
    label: "dead time",
    family: "dead time",
    needs_angle: true,
    alters_measured_current: false,
    numbers: &[
        NumberDescription {
            names: Names { key: "dead_time_voltage", label: "dead-time voltage per phase", unit: "V" },
            get: |state| state.voltage,
            set: |state, value| state.voltage = value,
            usual_size: |motor, peak| motor.rs.abs() * peak,
        },
        NumberDescription {
            names: Names { key: "dead_time_width", label: "phase current below which less is lost", unit: "A" },
            get: |state| state.width,
            set: |state, value| state.width = value,
            usual_size: peak_current,
        },
        NumberDescription {
            names: Names { key: "dead_time_ripple", label: "phase current's ripple between the carrier's halves", unit: "A" },
            get: |state| state.ripple,
            set: |state, value| state.ripple = value,
            usual_size: peak_current,
        },
    ],
    starts: |state, peak| WIDTHS.iter().map(|width| DeadTime { width: width * peak, ..*state }).collect(),
    // An inverter takes voltage, it never adds any.
    is_physical: |state, _, _| state.voltage > 0.0,
};

impl DeadTime {
    /// What is left of a period's commanded voltage `u`, V, given the current `i`, A, both in the frame of the logged angle.
    pub(super) fn reduced(&self, u: Dq, i: Dq, angles: &PeriodAngles) -> Dq {
        // Over a period the current hardly moves against the rotor.
        let (start, end) = (i.to_alpha_beta(angles.start), i.to_alpha_beta(angles.end));
        let shift = if angles.row.is_multiple_of(2) { self.ripple } else { -self.ripple };
        let loss = mean_loss(start, end, shift, self.width);
        let loss = loss.to_dq(angles.middle);
        Dq { d: u.d - self.voltage * loss.d, q: u.q - self.voltage * loss.q }
    }
}

/// Mean loss over a period, per volt, in the stator, of a current that goes straight from `start` to `end`, A.
fn mean_loss(start: AlphaBeta, end: AlphaBeta, shift: f64, width: f64) -> AlphaBeta {
    let (start, end) = (start.to_abc(), end.to_abc());
    let phase = |from: f64, to: f64| mean_of_ramp(from - shift, to - shift, width);
    Abc { a: phase(start.a, end.a), b: phase(start.b, end.b), c: phase(start.c, end.c) }.to_alpha_beta()
}

/// A way this short, as a fraction of its ends, leaves no digits in a difference of integrals.
const SHORT: f64 = 1e-6;

/// Mean of the ramp while its argument goes from one value to another.
fn mean_of_ramp(from: f64, to: f64, width: f64) -> f64 {
    let ramp =
        |i: f64| if width > 0.0 { (i / width).clamp(-1.0, 1.0) } else { f64::from(u8::from(i > 0.0)) - f64::from(u8::from(i < 0.0)) };
    // Its integral: a parabola up to the width, straight from there on.
    let integral = |i: f64| if i.abs() < width { 0.5 * i * i / width } else { i.abs() - 0.5 * width.max(0.0) };
    // Over a short way the ramp is straight, or about to be.
    if (to - from).abs() > SHORT * (from.abs() + to.abs()) {
        (integral(to) - integral(from)) / (to - from)
    } else {
        ramp(0.5 * (from + to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_mean_is_that_of_many_points(from in -3.0..3.0f64, to in -3.0..3.0f64, width in 0.01..2.0f64) {
            const POINTS: u32 = 20_000;
            let point = |k: u32| ((from + (to - from) * (f64::from(k) + 0.5) / f64::from(POINTS)) / width).clamp(-1.0, 1.0);
            let expected = (0..POINTS).map(point).sum::<f64>() / f64::from(POINTS);
            prop_assert!((mean_of_ramp(from, to, width) - expected).abs() < 1e-4);
        }
    }

    /// A square wave's fundamental is 4/pi; along the current.
    #[test]
    fn the_fundamental_is_four_over_pi() {
        const STEPS: u32 = 6000;
        let vector = |k: u32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(STEPS)).sin_cos();
            AlphaBeta { alpha: 5.0 * cos, beta: 5.0 * sin }
        };
        let along = |k: u32| {
            let (start, end) = (vector(k), vector(k + 1));
            let loss = mean_loss(start, end, 0.0, 0.0);
            (loss.alpha * (start.alpha + end.alpha) + loss.beta * (start.beta + end.beta)) / 10.0
        };
        let mean = (0..STEPS).map(along).sum::<f64>() / f64::from(STEPS);
        assert!((mean - 4.0 / std::f64::consts::PI).abs() < 1e-5, "{mean}");
    }

    /// Where each row is half a carrier period, a phase current within the ripple loses in one row what it gains in the next.
    #[test]
    fn the_ripple_alternates_from_row_to_row() {
        let dead_time = DeadTime { voltage: 2.0, width: 0.0, ripple: 1.0 };
        let AlphaBeta { alpha, beta } = Abc { a: 3.0, b: -0.5, c: -2.5 }.to_alpha_beta();
        for (row, signs) in [(0, Abc { a: 1.0, b: -1.0, c: -1.0 }), (1, Abc { a: 1.0, b: 1.0, c: -1.0 })] {
            let angles = PeriodAngles { row, start: 0.0, middle: 0.0, end: 0.0 };
            let left = dead_time.reduced(Dq::default(), Dq { d: alpha, q: beta }, &angles);
            let expected = signs.to_alpha_beta();
            assert!((left.d + 2.0 * expected.alpha).hypot(left.q + 2.0 * expected.beta) < 1e-15, "{row}: {left:?}");
        }
    }
}
