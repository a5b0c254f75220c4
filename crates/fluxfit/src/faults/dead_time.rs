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
pub(super) mod switched_period;

use super::{
    description::{AngleNeed, Description, Names, NumberDescription, one, peak_current, present_state},
};

/// What dead time and devices take.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeadTime {
    /// Voltage that each phase loses against its current, V.
    pub voltage: f64,
    /// Phase current, A, from which on it loses all of that; below, in proportion.
    pub width: f64,
    /// Ripple of the currents over what voltages and inductances make of it if a row is a period of the carrier, or half of one.
    pub ripple: f64,
    /// Where the angle is not known: the angle of phase a less the integral of the speed, electrical rad. It is only told up to a sixth
    /// of a turn, because six turns of it give the same loss.
    pub phase: f64,
    /// The part of the voltage that is lost all the time, by the drops of devices; the rest is lost at switching instants.
    pub lasting: f64,
    /// Zero if a row is a whole carrier period; plus one if it is half of one, and even rows have the edges up; minus one if odd rows do.
    pub halves: f64,
    /// What the width is at least, A, in a fit: below it simulated currents near zero would go their own ways at the least change of
    /// anything.
    pub least_width: f64,
}

/// The carrier's half in which a row of the log begins.
pub(crate) fn carrier_half(row: usize) -> f64 {
    if row.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// The least width as a fraction of the largest current: half the narrowest one that a fit starts from.
const LEAST_WIDTH: f64 = 0.005;

/// Angles of phase a from which a fit starts where the angle is not known, as fractions of the sixth of a turn after which the loss
/// repeats: near enough to the right one for its harmonics to find it.
const PHASES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// The sixth of a turn.
const SIXTH: f64 = std::f64::consts::FRAC_PI_3;

/// What a fit starts from. The cost has kinks, and the carrier's halves are not smooth at all, so one start does not find them all.
struct Start {
    lasting: f64,
    halves: f64,
    /// Width as a fraction of the largest current.
    width: f64,
    ripple: f64,
}

/// Dead time where rows are carrier periods, or either half of one; device drops; and three widths where rows are of other lengths or
/// the ripple is hidden.
const SWITCHING: [Start; 7] = [
    Start { lasting: 0.0, halves: 0.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: 1.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: -1.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 1.0, halves: 0.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 1.0, halves: 0.0, width: 0.02, ripple: 0.0 },
    Start { lasting: 1.0, halves: 0.0, width: 0.1, ripple: 0.0 },
    Start { lasting: 1.0, halves: 0.0, width: 0.4, ripple: 0.0 },
];

impl Start {
    fn of(&self, state: &DeadTime, peak: f64) -> DeadTime {
        let Self { lasting, halves, width, ripple } = *self;
        DeadTime { width: width * peak, ripple, lasting, halves, least_width: LEAST_WIDTH * peak, ..*state }
    }
}

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

const LASTING: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "device_drop_part", label: "part of the dead-time voltage that is lost all the time", unit: "1" },
    get: |state| state.lasting,
    set: |state, value| state.lasting = value,
    usual_size: one,
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
    numbers: &[VOLTAGE, WIDTH],
    starts: |state, peak| SWITCHING.map(|start| DeadTime { phase: state.phase, ..start.of(state, peak) }).to_vec(),
    is_physical: |state, _, _| state.takes_voltage(),
};

/// The same where the angle is not known.
pub(super) static WITHOUT_ANGLE: Description<DeadTime> = Description {
    key: "dead_time_without_angle",
    label: "dead time",
    family: FAMILY,
    angle: AngleNeed::OnlyTraced,
    alters_measured_current: false,
    numbers: &[VOLTAGE, WIDTH, PHASE],
    starts: |state, peak| {
        let at = |start: &Start, phase: f64| DeadTime { phase, ..start.of(state, peak) };
        let phases: Vec<f64> = if state.voltage == 0.0 { PHASES.map(|phase| SIXTH * phase).to_vec() } else { vec![state.phase] };
        SWITCHING.iter().flat_map(|start| phases.iter().map(move |phase| at(start, *phase))).collect()
    },
    is_physical: |state, _, _| state.takes_voltage(),
};

/// Both dead time and device drops, where dead time was found first.
pub(super) static DEVICE_DROPS: Description<DeadTime> = Description {
    key: "device_drops",
    label: "device drops beside dead time",
    family: "device drops",
    angle: AngleNeed::Traced,
    alters_measured_current: false,
    numbers: &[LASTING],
    starts: present_state,
    is_physical: |state, _, _| (0.0..=1.0).contains(&state.lasting),
};

impl DeadTime {
    /// An inverter takes voltage, it never adds any.
    fn takes_voltage(&self) -> bool {
        self.voltage > 0.0
    }
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
