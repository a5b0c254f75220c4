//! Dead time and device drops: each phase loses a voltage against its current.
//!
//! What a switching period loses depends on the currents at its edges, ripple included: `switched_period.rs` has the equations. Where rows
//! are not switching periods, or devices take their voltage gradually, the loss has a width: a ramp `i / width`, but at most one and at
//! least minus one, stands in for the current's sign.
//!
//! A log of operating points alone shows the fault by its harmonics only: [`ripple`].
//!
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, doi:10.1109/41.88903.

mod half;
mod ramp;
pub mod ripple;
pub(super) mod switched_period;

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, one, peak_current, present_state};

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
    /// One if a current that reaches zero within the dead time stays there, as in an inverter; zero if the current at the edge decides
    /// alone, as in many simulators.
    pub clamps: f64,
    /// Where the DC voltage is not logged: what it is over what it is taken for, less one.
    pub bus: f64,
    /// What the width is at least, A, in a fit: below it simulated currents near zero would go their own ways at the least change of
    /// anything.
    pub least_width: f64,
}

/// The carrier's half in which a row of the log begins.
pub(crate) fn carrier_half(row: usize) -> f64 {
    if row.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// The part of the DC voltage that a drive takes at most, where that is not logged: some voltage is left for its current loop.
pub(crate) const USED_PART: f64 = 0.8;

/// The DC voltage over what the largest voltages need of it: a drive in six-step operation has less than one, and one at a low speed many
/// times that.
const RATIOS: std::ops::RangeInclusive<f64> = 0.9..=100.0;

/// The least width as a fraction of the largest current: half the narrowest one that a fit starts from.
const LEAST_WIDTH: f64 = 0.005;

/// Angles of phase a from which a fit starts where the angle is not known, as fractions of the sixth of a turn after which the loss
/// repeats: near enough to the right one for its harmonics to find it.
const PHASES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// The sixth of a turn.
const SIXTH: f64 = std::f64::consts::FRAC_PI_3;

/// How the voltage is lost, and from which width a fit starts.
struct Start {
    lasting: f64,
    halves: f64,
    clamps: f64,
    /// As a fraction of the largest current.
    width: f64,
    ripple: f64,
}

/// Dead time where rows are carrier periods, or either half of one, with currents that stay at zero and without; device drops; and the mean
/// over rows of other lengths, or where no ripple shows.
const KINDS: [Start; 8] = [
    Start { lasting: 0.0, halves: 0.0, clamps: 1.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: 1.0, clamps: 1.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: -1.0, clamps: 1.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: 0.0, clamps: 0.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: 1.0, clamps: 0.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 0.0, halves: -1.0, clamps: 0.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 1.0, halves: 0.0, clamps: 0.0, width: 0.02, ripple: 1.0 },
    Start { lasting: 1.0, halves: 0.0, clamps: 0.0, width: 0.02, ripple: 0.0 },
];

/// The last of them with other widths: the cost has a kink wherever the ramp's end passes a measured current, so one start does not find
/// them all.
const WIDER: [Start; 2] = [
    Start { lasting: 1.0, halves: 0.0, clamps: 0.0, width: 0.1, ripple: 0.0 },
    Start { lasting: 1.0, halves: 0.0, clamps: 0.0, width: 0.4, ripple: 0.0 },
];

impl Start {
    fn of(&self, state: &DeadTime, peak: f64) -> DeadTime {
        let Self { lasting, halves, clamps, width, ripple } = *self;
        DeadTime { width: width * peak, ripple, lasting, halves, clamps, least_width: LEAST_WIDTH * peak, ..*state }
    }
}

fn starts(state: &DeadTime, peak: f64) -> Vec<DeadTime> {
    KINDS.iter().chain(&WIDER).map(|start| start.of(state, peak)).collect()
}

fn kinds(state: &DeadTime, peak: f64) -> Vec<DeadTime> {
    KINDS.iter().map(|start| start.of(state, peak)).collect()
}

const VOLTAGE: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dead_time_voltage", label: "dead-time voltage per phase", unit: "V" },
    get: |state| state.voltage,
    set: |state, value| state.voltage = value,
    usual_size: |motor, peak| motor.rs.abs() * peak,
};

const WIDTH: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dead_time_width", label: "phase current below which dead time takes less", unit: "A" },
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

const DC_VOLTAGE_EXCESS: NumberDescription<DeadTime> = NumberDescription {
    names: Names { key: "dc_voltage_excess", label: "DC voltage above 1.25 times what the voltages need", unit: "1" },
    get: |state| state.bus,
    set: |state, value| state.bus = value,
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
    starts,
    kinds,
    is_physical: |state, _, peak| state.takes_voltage() && state.is_no_resistance(peak),
};

/// The same where the angle is not known.
pub(super) static WITHOUT_ANGLE: Description<DeadTime> = Description {
    key: "dead_time_without_angle",
    label: "dead time",
    family: FAMILY,
    angle: AngleNeed::OnlyTraced,
    alters_measured_current: false,
    numbers: &[VOLTAGE, WIDTH, PHASE],
    starts: |state, peak| PHASES.iter().flat_map(|phase| starts(&DeadTime { phase: SIXTH * phase, ..*state }, peak)).collect(),
    kinds,
    is_physical: |state, _, peak| state.takes_voltage() && state.is_no_resistance(peak),
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
    kinds: no_kinds,
    is_physical: |state, _, _| (0.0..=1.0).contains(&state.lasting),
};

/// The DC voltage, where it is not logged and dead time was found first: the ripple at the edges depends on it.
pub(super) static DC_VOLTAGE: Description<DeadTime> = Description {
    key: "dc_voltage",
    label: "DC voltage",
    family: "DC voltage",
    angle: AngleNeed::Traced,
    alters_measured_current: false,
    numbers: &[DC_VOLTAGE_EXCESS],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| RATIOS.contains(&((1.0 + state.bus) / USED_PART)),
};

impl DeadTime {
    /// An inverter takes voltage, it never adds any.
    fn takes_voltage(&self) -> bool {
        self.voltage > 0.0
    }

    /// A loss that grows with the current up to the largest, A, is a resistance.
    fn is_no_resistance(&self, peak: f64) -> bool {
        self.width.abs() < peak
    }
}
