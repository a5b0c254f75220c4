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

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription, one, peak_current},
};
use crate::{
    frames::{clarke, inverse_clarke},
    lanes::Number,
};

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
    /// Where the angle is not known: the angle of phase a less the integral of the speed, electrical rad. It is only told up to a sixth
    /// of a turn, because six turns of it give the same loss.
    pub phase: f64,
    /// What the width is at least, A, in a fit: below it simulated currents near zero would go their own ways at the least change of
    /// anything.
    pub least_width: f64,
}

/// The carrier's half in which a row of the log begins.
pub(crate) fn carrier_half(row: usize) -> f64 {
    if row.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Widths of the ramp from which a fit starts, as fractions of the largest current: from almost none to a ripple nearly as large as the
/// current. The cost has a kink wherever the ramp's end passes a measured current, so one start does not find them all.
const WIDTHS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8];

/// The least width as a fraction of the largest current: half the narrowest one that a fit starts from.
const LEAST_WIDTH: f64 = 0.005;

/// Angles of phase a from which a fit starts where the angle is not known, as fractions of the sixth of a turn after which the loss
/// repeats: near enough to the right one for its harmonics to find it.
const PHASES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// The sixth of a turn.
const SIXTH: f64 = std::f64::consts::FRAC_PI_3;

/// The same for the fewer widths that are tried with each.
const WIDTHS_WITH_PHASE: [f64; 3] = [0.02, 0.1, 0.4];

const VOLTAGE: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dead_time_voltage", label: "dead-time voltage per phase", unit: "V" },
    get: |state| state.voltage,
    set: |state, value| state.voltage = value,
    usual_size: |motor, peak| motor.rs.abs() * peak,
};

const WIDTH: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dead_time_width", label: "phase current below which less is lost", unit: "A" },
    // Its sign means nothing: a fit that steps across zero comes back on the other side instead of losing its way where the loss is a step.
    get: |state| state.width.abs(),
    set: |state, value| state.width = value,
    usual_size: peak_current,
};

const RIPPLE: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dead_time_ripple", label: "phase current's ripple between the carrier's halves", unit: "A" },
    get: |state| state.ripple,
    set: |state, value| state.ripple = value,
    usual_size: peak_current,
};

const PHASE: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dead_time_phase", label: "angle of phase a at the first row, up to a sixth of a turn", unit: "rad" },
    get: |state| state.phase,
    set: |state, value| state.phase = value,
    usual_size: one,
};

const FAMILY: &str = "dead time";

pub(super) static FAULT: Description<DeadTime> = Description {
    key: "dead_time",
    label: "dead time",
    family: FAMILY,
    angle: AngleNeed::Known,
    alters_measured_current: false,
    numbers: &[VOLTAGE, WIDTH, RIPPLE],
    starts: |state, peak| WIDTHS.iter().map(|width| DeadTime { width: width * peak, least_width: LEAST_WIDTH * peak, ..*state }).collect(),
    is_physical: |state, _, _| state.takes_voltage(),
};

/// The same where the angle is not known.
pub(super) static WITHOUT_ANGLE: Description<DeadTime> = Description {
    key: "dead_time_without_angle",
    label: "dead time",
    family: FAMILY,
    angle: AngleNeed::OnlyTraced,
    alters_measured_current: false,
    numbers: &[VOLTAGE, WIDTH, RIPPLE, PHASE],
    starts: |state, peak| {
        let start =
            |width: &f64, phase: &f64| DeadTime { width: width * peak, phase: SIXTH * phase, least_width: LEAST_WIDTH * peak, ..*state };
        WIDTHS_WITH_PHASE.iter().flat_map(|width| PHASES.iter().map(move |phase| start(width, phase))).collect()
    },
    is_physical: |state, _, _| state.takes_voltage(),
};

impl DeadTime {
    /// An inverter takes voltage, it never adds any.
    fn takes_voltage(&self) -> bool {
        self.voltage > 0.0
    }
}

/// What is left of a period's commanded voltage `u`, V, given the current `i`, A, both `d, q` in the frame of the logged angle. The first
/// argument is voltage, width and ripple of the fault.
#[inline(always)]
pub(super) fn reduced<V: Number>([voltage, width, ripple]: [V; 3], u: [V; 2], i: [V; 2], place: &Place) -> [V; 2] {
    // Over a period the current hardly moves against the rotor.
    let (start, end) = (place.start.forward(i), place.end.forward(i));
    let loss = mean_loss(start, end, voltage.constant(place.half) * ripple, width);
    let [d, q] = place.middle.backward(loss);
    [u[0] - voltage * d, u[1] - voltage * q]
}

/// Mean loss over a period, per volt, in the stator, of a current that goes straight from `start` to `end`, A.
#[inline(always)]
fn mean_loss<V: Number>(start: [V; 2], end: [V; 2], shift: V, width: V) -> [V; 2] {
    let (start, end) = (inverse_clarke(start), inverse_clarke(end));
    clarke([
        mean_of_ramp(start[0] - shift, end[0] - shift, width),
        mean_of_ramp(start[1] - shift, end[1] - shift, width),
        mean_of_ramp(start[2] - shift, end[2] - shift, width),
    ])
}

/// A way this short, as a fraction of its ends, leaves no digits in a difference of integrals.
const SHORT: f64 = 1e-6;

/// Mean of the ramp while its argument goes from one value to another.
#[inline(always)]
fn mean_of_ramp<V: Number>(from: V, to: V, width: V) -> V {
    let (zero, half, one) = (from.constant(0.0), from.constant(0.5), from.constant(1.0));
    let middle = half * (from + to);
    let sign = zero.if_less(middle, one, middle.if_less(zero, -one, zero));
    let ramp = middle.abs().if_less(width, middle / width, sign);
    let way = to - from;
    // Over a short way the ramp is straight, or about to be.
    let long = from.constant(SHORT) * (from.abs() + to.abs());
    long.if_less(way.abs(), (integral_of_ramp(to, width) - integral_of_ramp(from, width)) / way, ramp)
}

/// The ramp's integral: a parabola up to the width, straight from there on.
#[inline(always)]
fn integral_of_ramp<V: Number>(i: V, width: V) -> V {
    let (zero, half) = (i.constant(0.0), i.constant(0.5));
    let beyond = zero.if_less(width, half * width, zero);
    i.abs().if_less(width, half * i * i / width, i.abs() - beyond)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Abc, AlphaBeta, Turn};
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
            [5.0 * cos, 5.0 * sin]
        };
        let along = |k: u32| {
            let (start, end) = (vector(k), vector(k + 1));
            let loss = mean_loss(start, end, 0.0, 0.0);
            (loss[0] * (start[0] + end[0]) + loss[1] * (start[1] + end[1])) / 10.0
        };
        let mean = (0..STEPS).map(along).sum::<f64>() / f64::from(STEPS);
        assert!((mean - 4.0 / std::f64::consts::PI).abs() < 1e-5, "{mean}");
    }

    /// Where each row is half a carrier period, a phase current within the ripple loses in one row what it gains in the next.
    #[test]
    fn the_ripple_alternates_from_row_to_row() {
        let AlphaBeta { alpha, beta } = Abc { a: 3.0, b: -0.5, c: -2.5 }.to_alpha_beta();
        for (row, signs) in [(0, Abc { a: 1.0, b: -1.0, c: -1.0 }), (1, Abc { a: 1.0, b: 1.0, c: -1.0 })] {
            let still = Turn::by(0.0);
            let place = Place { half: carrier_half(row), ..Place::still(still) };
            let left = reduced([2.0, 0.0, 1.0], [0.0; 2], [alpha, beta], &place);
            let expected = signs.to_alpha_beta();
            assert!((left[0] + 2.0 * expected.alpha).hypot(left[1] + 2.0 * expected.beta) < 1e-15, "{row}: {left:?}");
        }
    }
}
