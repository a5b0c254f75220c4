//! Rows as they arrive become sample periods: the voltage that acted over each, its mean speed, and the current at its end.
//!
//! A jump in time begins anew, and so does a row with a value that is no number or that no drive had; such rows are counted. The first
//! rows whose acting voltage is not known are left out. Taking them as 0 V would throw the inductances by 200 %.

use crate::{
    alternation::{Alternation, turned},
    faults::DriveFaults,
    timing::{LONGEST_DELAY, Timing},
};
use fluxfit::log::Row;
use fluxfit_core::Period;
use serde::{Deserialize, Serialize};

/// A period is a gap if it is longer than this many usual ones: rows that were lost.
const GAP: f64 = 1.5;

/// How fast the usual period follows: clocks drift slowly.
const FOLLOWED: f64 = 1e-3;

/// So many gaps in a row are a new usual period.
const NEW_PERIOD: u32 = 3;

/// A value so many times larger than any before is a spike.
const SPIKE: f64 = 20.0;

/// Rows before spikes are looked for.
const ROWS_BEFORE_SPIKES: u64 = 1000;

/// Longest spike, in rows: more are a change.
const LONGEST_SPIKE: u32 = 2;

/// What a row brings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// A current, A, from which on periods follow.
    Begin([f64; 2]),
    /// A period, and the current, A, at its end.
    Period(Period<f64>, [f64; 2]),
}

/// Rows that were left out, and why.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Rows with a value that is no number.
    pub not_numbers: u64,
    /// Rows with a value that no drive had.
    pub spikes: u64,
    /// Jumps in time.
    pub gaps: u64,
}

/// A row as it was logged, but for the offset of its sensors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Logged {
    u: [f64; 2],
    i: [f64; 2],
    omega_e: f64,
    /// The integral of the speed.
    theta: f64,
    /// The logged angle, if any.
    angle: f64,
}

/// Rows in, periods out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stream {
    timing: Timing,
    #[serde(default)]
    faults: DriveFaults,
    last_t: Option<f64>,
    /// The last rows of this stretch, newest first, and how many.
    rows: [Logged; LONGEST_DELAY + 2],
    count: usize,
    /// Of centred voltages: the vector that acted over the period before, in the stator's frame, V.
    before: [f64; 2],
    alternation: Alternation,
    usual_period: f64,
    odd_periods: u32,
    largest: [f64; 3],
    rows_seen: u64,
    spikes_in_a_row: u32,
    left_out: LeftOut,
}

impl Stream {
    /// A stream without rows yet.
    pub fn new(timing: Timing, faults: DriveFaults) -> Self {
        Self {
            timing,
            faults,
            last_t: None,
            rows: [Logged::default(); LONGEST_DELAY + 2],
            count: 0,
            before: [0.0; 2],
            alternation: Alternation::default(),
            usual_period: 0.0,
            odd_periods: 0,
            largest: [0.0; 3],
            rows_seen: 0,
            spikes_in_a_row: 0,
            left_out: LeftOut::default(),
        }
    }

    /// When the voltages act.
    pub fn timing(&self) -> Timing {
        self.timing
    }

    /// Rows that were left out.
    pub fn left_out(&self) -> LeftOut {
        self.left_out
    }

    /// Time from row to row, s; zero before the second row.
    pub fn usual_period(&self) -> f64 {
        self.usual_period
    }

    /// Largest current, A, voltage, V, and speed, electrical rad/s, so far.
    pub fn largest(&self) -> [f64; 3] {
        self.largest
    }

    /// What the next row brings, freed of the faults of the drive; nothing, if the voltage that acts from its predecessor on is not known.
    pub fn push(&mut self, row: &Row) -> Option<Event> {
        if !self.is_sound(row) {
            self.count = 0;
            return None;
        }
        let length = self.last_t.map(|last| row.t - last);
        self.last_t = Some(row.t);
        let continues = length.is_some_and(|length| self.continues(length));
        if !continues {
            self.left_out.gaps += u64::from(self.count > 0);
            self.count = 0;
        }
        let length = length.unwrap_or(0.0);
        let theta = if self.count > 0 { self.rows[0].theta + 0.5 * (self.rows[0].omega_e + row.omega_e) * length } else { 0.0 };
        // Wrapped, so that it keeps its digits in a stream of days; only differences within a few rows matter.
        let theta = if theta.abs() > 1e4 { self.rewind(theta) } else { theta };
        self.rows.rotate_right(1);
        let (i, angle) = (self.faults.current(row), row.theta_e.unwrap_or(0.0));
        self.rows[0] = Logged { u: [row.ud, row.uq], i, omega_e: row.omega_e, theta, angle };
        self.count += 1;
        self.event(length)
    }

    /// Subtracts whole turns from all angles.
    fn rewind(&mut self, theta: f64) -> f64 {
        let turns = std::f64::consts::TAU * (theta / std::f64::consts::TAU).round();
        self.rows.iter_mut().for_each(|row| row.theta -= turns);
        theta - turns
    }

    fn event(&mut self, length: f64) -> Option<Event> {
        let i = self.faults.in_magnets_frame(self.rows[0].i);
        let lost = match self.timing {
            Timing::Centered => 0,
            Timing::Delayed { delay, .. } => delay,
        };
        if self.count == 1 && self.timing == Timing::Centered {
            // The vector before the first row is not in the log. The mean around that row stands in for it.
            self.before = turned(self.rows[0].u, self.rows[0].theta);
            self.alternation = Alternation::new(self.rows[0].u);
        }
        if self.count == lost + 1 {
            return (self.timing != Timing::Centered || self.alternation.is_known()).then_some(Event::Begin(i));
        }
        if self.count <= lost {
            return None;
        }
        self.count = self.count.min(LONGEST_DELAY + 2);
        let (start, end) = (self.rows[1], self.rows[0]);
        let middle = 0.5 * (start.theta + end.theta);
        let u = match self.timing {
            Timing::Centered => {
                let mean = turned(start.u, start.theta);
                self.before = [2.0 * mean[0] - self.before[0], 2.0 * mean[1] - self.before[1]];
                let was_known = self.alternation.is_known();
                let u = self.alternation.without(turned(self.before, -middle), middle);
                if !was_known {
                    return self.alternation.is_known().then_some(Event::Begin(i));
                }
                u
            }
            Timing::Delayed { delay, at_row } => {
                let logged = self.rows[1 + delay];
                // The drive advanced the angle by its speed times the delay.
                let ahead = if at_row { 0.0 } else { logged.omega_e * (delay as f64 + 0.5) * length };
                turned(logged.u, logged.theta + ahead - middle)
            }
        };
        let mean = [0.5 * (start.i[0] + end.i[0]), 0.5 * (start.i[1] + end.i[1])];
        let lost = self.faults.lost(mean, start.angle + 0.5 * (end.theta - start.theta));
        let u = self.faults.in_magnets_frame([u[0] - lost[0], u[1] - lost[1]]);
        Some(Event::Period(Period { u, omega_e: (end.theta - start.theta) / length, length }, i))
    }

    /// Whether a period of this length is no gap.
    fn continues(&mut self, length: f64) -> bool {
        if length.is_nan() || length <= 0.0 {
            return false;
        }
        if self.usual_period == 0.0 {
            self.usual_period = length;
        }
        if length < GAP * self.usual_period && length > self.usual_period / GAP {
            self.usual_period += FOLLOWED * (length - self.usual_period);
            self.odd_periods = 0;
            return true;
        }
        self.odd_periods += 1;
        if self.odd_periods >= NEW_PERIOD {
            (self.usual_period, self.odd_periods) = (length, 0);
        }
        false
    }

    /// Whether all values may be those of a drive. What is not is counted.
    fn is_sound(&mut self, row: &Row) -> bool {
        if ![row.t, row.ud, row.uq, row.id, row.iq, row.omega_e].iter().all(|value| value.is_finite()) {
            self.left_out.not_numbers += 1;
            return false;
        }
        let sizes = [row.id.hypot(row.iq), row.ud.hypot(row.uq), row.omega_e.abs()];
        let is_spike = self.rows_seen >= ROWS_BEFORE_SPIKES
            && sizes.iter().zip(self.largest).any(|(size, largest)| largest > 0.0 && *size > SPIKE * largest);
        if is_spike && self.spikes_in_a_row < LONGEST_SPIKE {
            self.spikes_in_a_row += 1;
            self.left_out.spikes += 1;
            return false;
        }
        self.spikes_in_a_row = 0;
        self.rows_seen += 1;
        self.largest.iter_mut().zip(sizes).for_each(|(largest, size)| *largest = largest.max(size));
        true
    }
}
