//! A segment of the log, ready to be simulated: each period with the voltage that acted over it, each row with its measured current.

use super::{
    acting_voltage::{Period, VoltageTiming, periods},
    angles::Angles,
    transition_polynomials::TransitionPlan,
};
use crate::{
    faults::{Place, USED_PART, carrier_half},
    frames::{Dq, Turn},
    log::Log,
    motor::Motor,
};
use std::ops::Range;

/// Most linear unknowns of a segment: the first current and, of centred voltages, the first vector. Neither is in the log, and simulated
/// currents respond to them linearly.
pub(super) const LINEAR_UNKNOWNS: usize = 4;

/// One period, as the simulation of perfect drives needs it: what all candidates share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PeriodRow {
    /// How far the rotor turns, rad.
    pub(super) turn: f64,
    /// Where the squared turn lies in its class.
    pub(super) place: f64,
    /// The voltage that acts, V, in the frame at the middle of the period: d, q.
    pub(super) u: [f64; 2],
    /// The measured current at its end, A: d, q.
    pub(super) measured: [f64; 2],
    /// What the first vector of centred voltages adds to its voltage, per volt along alpha; zero of delayed ones. Along beta it is the
    /// same, turned by a right angle.
    pub(super) alternating: [f64; 2],
    /// The class of its length.
    pub(super) class: usize,
}

/// A segment, ready to be simulated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SimulatedSegment {
    /// Its rows in the log.
    pub(super) rows: Range<usize>,
    pub(super) periods: Vec<Period>,
    /// The same periods, as they are simulated; filled by [`plan`](Self::plan).
    pub(super) rows_of_periods: Vec<PeriodRow>,
    /// Measured currents, A, in the frame of the rotor's most likely angle; one more than periods.
    pub(super) measured: Vec<Dq>,
    /// The rotor at each of them, against the stator.
    pub(super) turns: Vec<Turn>,
    /// The same at the middle of each period.
    pub(super) middles: Vec<Turn>,
    /// Whether that angle is the logged one.
    pub(super) angle_known: bool,
    /// The log's segment, through which the speed can be integrated.
    pub(super) log_segment: Option<usize>,
    /// Whether the first vector is unknown, because the voltages are centred.
    pub(super) alternates: bool,
    /// Whether the voltage changes within each period: the drive samples in the middle of its own.
    has_halves: bool,
    /// Whether the DC voltage is in the log.
    pub(super) bus_known: bool,
    /// One over the DC voltage, 1/V.
    per_bus: f64,
    /// The rotor at both ends of the [span](SPAN_OF_MEANS) around each period, where what acts is averaged over that; else empty.
    spans: Vec<[Turn; 2]>,
}

/// Between rows that are means over their own spans, what acts is averaged twice: over a span, and from row to row. Its weight is a
/// triangle over two periods, which has the second moment of a box that is so many periods long, the square root of two.
const SPAN_OF_MEANS: f64 = std::f64::consts::SQRT_2;

/// The DC voltage, V: its mean, or what the largest vector of these rows asks for; infinite where there is none.
fn bus_voltage(log: &Log, rows: &Range<usize>) -> f64 {
    let columns = log.columns();
    let largest = || rows.clone().map(|row| columns.ud[row].powi(2) + columns.uq[row].powi(2)).fold(0.0, f64::max).sqrt();
    let mean = |u_dc: &Vec<f64>| u_dc[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
    let bus = columns.u_dc.as_ref().map_or_else(|| 3.0_f64.sqrt() * largest() / USED_PART, mean);
    if bus > 0.0 { bus } else { f64::INFINITY }
}

impl SimulatedSegment {
    pub(super) fn of(log: &Log, rows: &Range<usize>, angles: &Angles, timing: VoltageTiming) -> Self {
        let periods = periods(log, rows, angles, timing);
        let lost = timing.lost_rows();
        let rows = rows.start + lost..rows.end;
        Self {
            measured: angles.measured[lost..].to_vec(),
            turns: angles.rotor_turns[lost..].to_vec(),
            middles: angles.middle_turns[lost..].to_vec(),
            angle_known: angles.known,
            log_segment: log.segments().iter().position(|segment| segment.rows.contains(&rows.start)),
            bus_known: log.columns().u_dc.is_some(),
            per_bus: bus_voltage(log, &rows).recip(),
            alternates: timing == VoltageTiming::Centered,
            has_halves: timing.has_halves(),
            rows_of_periods: Vec::new(),
            spans: Vec::new(),
            rows,
            periods,
        }
    }

    /// Averages what acts in a period over a wider span.
    pub(super) fn spread(&mut self) {
        self.spans = self.periods.iter().map(span).collect();
    }

    /// Scales the voltage of each period by what becomes of its turn, rad.
    pub(super) fn scale_voltages(&mut self, factor: impl Fn(f64) -> f64) {
        for period in &mut self.periods {
            let factor = factor(period.omega_e * period.length);
            period.u = Dq { d: factor * period.u.d, q: factor * period.u.q };
        }
    }

    /// Weighs the halves of periods in which the voltage changes: of the first half the winding of this motor forgets more until the end.
    pub(super) fn weigh_halves(&mut self, motor: &Motor) {
        for period in &mut self.periods {
            let weight = |inductance: f64| 0.5 * (0.25 * motor.rs * period.length / inductance).tanh();
            period.u.d += weight(motor.ld) * period.change_within.d;
            period.u.q += weight(motor.lq) * period.change_within.q;
        }
    }

    /// How far the rotor gets away from where it was, by the speed, rad.
    pub(super) fn turned(&self) -> f64 {
        let (mut angle, mut least, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
        for period in &self.periods {
            angle += period.omega_e * period.length;
            (least, most) = (least.min(angle), most.max(angle));
        }
        most - least
    }

    /// Lays out the periods for the simulation.
    pub(super) fn plan(&mut self, plan: &TransitionPlan) {
        let signs = [1.0, -1.0].into_iter().cycle();
        let rows = self.periods.iter().zip(&self.middles).zip(&self.measured[1..]).zip(signs);
        let rows = rows.map(|(((period, middle), measured), sign)| {
            let (class, place, turn) = plan.place(period);
            // A volt along alpha whose sign alternates from period to period, in the rotor's frame.
            let alternating = middle.backward([if self.alternates { sign } else { 0.0 }, 0.0]);
            PeriodRow { turn, place, u: [period.u.d, period.u.q], measured: [measured.d, measured.q], alternating, class }
        });
        self.rows_of_periods = rows.collect();
    }

    /// Where a period lies.
    #[inline(always)]
    pub(super) fn place(&self, row: usize) -> Place {
        let Period {
            length, omega_e, acceleration, late_by, angle_acceleration, advance_per_lag, time, change_within: Dq { d, q }, ..
        } = self.periods[row];
        Place {
            half: carrier_half(self.rows.start + row),
            changes: self.has_halves.then_some([d, q]),
            start: self.turns[row],
            middle: self.middles[row],
            end: self.turns[row + 1],
            length,
            omega_e,
            acceleration,
            late_by,
            rotor_late_by: if self.angle_known { late_by } else { 0.0 },
            angle_acceleration,
            advance_per_lag,
            per_bus: self.per_bus,
            time,
        }
    }

    /// The place of what acts in a period, and by which part of the period it reaches beyond it at either end.
    #[inline(always)]
    pub(super) fn acting(&self, row: usize, place: Place) -> (Place, f64) {
        match self.spans.get(row) {
            None => (place, 0.0),
            Some([start, end]) => {
                let length = SPAN_OF_MEANS * place.length;
                (Place { start: *start, end: *end, length, ..place }, 0.5 * (SPAN_OF_MEANS - 1.0))
            }
        }
    }
}

/// The rotor at both ends of the span around a period.
fn span(period: &Period) -> [Turn; 2] {
    let half = 0.5 * SPAN_OF_MEANS * period.omega_e * period.length;
    [-half, half].map(|angle| Turn::by(period.theta_e + angle))
}
