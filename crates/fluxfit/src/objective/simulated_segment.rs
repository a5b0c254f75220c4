//! A segment of the log, simulated: the currents of an adjustable drive from the segment's first row to its last, held against the
//! measured ones.
//!
//! What the log does not hold, the segment's first current and, of centred voltages, its first vector, enters the simulated currents
//! linearly: with each simulation runs the response to each of these, and least squares solves for them.

use super::{
    acting_voltage::{Period, VoltageTiming, angles, periods},
    adjustable::Adjustable,
    transition::Transition,
    transition_table::TransitionTable,
};
use crate::{
    faults::{Faults, dead_time::PeriodAngles},
    frames::{AlphaBeta, Dq},
    log::Log,
    motor::Motor,
};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Periods whose lengths agree within this fraction are of one length: what the digits of a time column leave.
const EVEN: f64 = 1e-3;

/// If less than this part of the cost is left by the linear unknowns, too few digits are left too, and residuals are squared one by one:
/// an unstable motor's currents, wrong by far, are much like the response to a wrong start, and their cost must not come out negative.
const CANCELLED: f64 = 1e-8;

/// Rounds in which the flux beyond `L i` is found at a period's end: each is a fifth or less of the one before, of a change that is small.
const EXTRA_FLUX_ROUNDS: usize = 3;

/// Most linear unknowns of a segment: the first current, the first vector.
const LINEAR_UNKNOWNS: usize = 4;

/// A segment, ready to be simulated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SimulatedSegment {
    /// Its rows in the log.
    pub(super) rows: Range<usize>,
    pub(super) periods: Vec<Period>,
    /// Measured currents, A, in the frame of the rotor's most likely angle; one more than periods.
    pub(super) measured: Vec<Dq>,
    /// The electrical angle at each of them, rad: their frame against the stator.
    theta_e: Vec<f64>,
    /// Whether that angle is the logged one.
    pub(super) angle_known: bool,
    /// What the first vector of centred voltages adds to each period's, per volt along alpha; none of delayed ones. Along beta it is
    /// the same, turned by a right angle.
    alternating: Vec<Dq>,
    /// The length of its periods, s, if they are even.
    even: Option<f64>,
}

impl SimulatedSegment {
    pub(super) fn of(log: &Log, rows: &Range<usize>, reading: VoltageTiming) -> Self {
        let angles = angles(log, rows);
        let periods = periods(log, rows, &angles, reading);
        let (lost, columns) = (reading.lost_rows(), log.columns());
        let rows = rows.start + lost..rows.end;
        let theta_e = angles.rotor[lost..].to_vec();
        // Out of the drive's frame, into the rotor's.
        let frames = angles.logged[lost..].iter().zip(&theta_e);
        let in_rotor_frame =
            |(row, (logged, rotor)): (usize, (&f64, &f64))| Dq { d: columns.id[row], q: columns.iq[row] }.turned(logged - rotor);
        let measured = rows.clone().zip(frames).map(in_rotor_frame).collect();
        let length = (columns.t[rows.end - 1] - columns.t[rows.start]) / periods.len() as f64;
        let even = periods.iter().all(|period| (period.length / length - 1.0).abs() < EVEN).then_some(length);
        let alternating = if reading == VoltageTiming::Centered { alternating(&periods) } else { Vec::new() };
        Self { rows, periods, measured, theta_e, angle_known: angles.known, alternating, even }
    }

    fn linear_unknowns(&self) -> usize {
        if self.alternating.is_empty() { LINEAR_UNKNOWNS / 2 } else { LINEAR_UNKNOWNS }
    }

    /// The measured current of a row with the faults of the sensors undone, A, in the frame of the magnet.
    pub(super) fn motor_current(&self, row: usize, faults: &Faults) -> Dq {
        faults.motor_current(self.measured[row], self.theta_e[row])
    }

    /// One period of an imperfect drive, from the current `i` at its start. Faults that depend on the current follow the simulated one:
    /// the measured one would bring its noise into the prediction.
    fn after_period(&self, k: usize, transition: &Transition, i: Dq, drive: &Adjustable) -> Dq {
        let (Period { omega_e, u, theta_e, .. }, faults) = (self.periods[k], &drive.faults);
        let angles = PeriodAngles { row: self.rows.start + k, start: self.theta_e[k], middle: theta_e, end: self.theta_e[k + 1] };
        let u = faults.motor_voltage(u, i, &angles);
        if faults.flux_is_linear() {
            return transition.after(i, u);
        }
        // Flux beyond L i + psi_f takes a voltage as any flux does: by its turning, and by its growth.
        let flux = faults.extra_flux(i);
        let linear = transition.after(i, Dq { d: u.d + omega_e * flux.q, q: u.q - omega_e * flux.d });
        (0..EXTRA_FLUX_ROUNDS).fold(linear, |end, _| {
            let grown = faults.extra_flux(end);
            Dq { d: linear.d - (grown.d - flux.d) / drive.motor.ld, q: linear.q - (grown.q - flux.q) / drive.motor.lq }
        })
    }

    fn transitions<'a>(&'a self, motor: &'a Motor) -> impl Fn(&Period) -> Transition + 'a {
        let table = self.even.map(|length| TransitionTable::new(motor, &self.periods, length));
        move |period| match &table {
            Some(table) => table.at(period.omega_e),
            None => Transition::of(motor, period.omega_e, period.length),
        }
    }

    /// Simulates all rows. `see` gets, for each row, the difference of measured and simulated current, and the simulated current's
    /// response to each linear unknown.
    fn simulate(&self, drive: &Adjustable, mut see: impl FnMut(Dq, &[Dq])) {
        let transition = self.transitions(&drive.motor);
        let perfect = drive.faults == Faults::default();
        let observer = drive.faults.disturbance;
        let unknowns = self.linear_unknowns();
        let mut i = self.motor_current(0, &drive.faults);
        let unit = |k: usize| Dq { d: f64::from(u8::from(k == 0)), q: f64::from(u8::from(k == 1)) };
        let mut response: [Dq; LINEAR_UNKNOWNS] = std::array::from_fn(unit);
        see(Dq::default(), &response[..unknowns]);
        let mut error = Dq::default();
        for (k, period) in self.periods.iter().enumerate() {
            let transition = transition(period);
            let corrected = observer.corrected(i, error);
            let measured;
            (i, measured) = if perfect {
                (transition.after(corrected, period.u), self.measured[k + 1])
            } else {
                (self.after_period(k, &transition, corrected, drive), self.motor_current(k + 1, &drive.faults))
            };
            let alpha = self.alternating.get(k).copied().unwrap_or_default();
            let beta = Dq { d: -alpha.q, q: alpha.d };
            for (response, u) in response[..unknowns].iter_mut().zip([Dq::default(), Dq::default(), alpha, beta]) {
                *response = transition.difference_after(observer.remaining(*response), u);
            }
            error = Dq { d: measured.d - i.d, q: measured.q - i.q };
            see(error, &response[..unknowns]);
        }
    }

    /// The linear unknowns that fit best, the part of the cost that is left, and the cost without them.
    fn fit(&self, drive: &Adjustable, mut keep: impl FnMut(Dq, &[Dq])) -> (DVector<f64>, f64, f64) {
        let n = self.linear_unknowns();
        let (mut normal, mut right, mut total) = ([[0.0; LINEAR_UNKNOWNS]; LINEAR_UNKNOWNS], [0.0; LINEAR_UNKNOWNS], 0.0);
        self.simulate(drive, |error, response| {
            keep(error, response);
            total += error.d * error.d + error.q * error.q;
            for (k, one) in response.iter().enumerate() {
                right[k] += one.d * error.d + one.q * error.q;
                for (entry, other) in normal[k].iter_mut().zip(response) {
                    *entry += one.d * other.d + one.q * other.q;
                }
            }
        });
        let right = DVector::from_column_slice(&right[..n]);
        let normal = DMatrix::from_fn(n, n, |row, column| normal[row][column]);
        match normal.cholesky() {
            Some(factor) => {
                let best = factor.solve(&right);
                let cost = total - right.dot(&best);
                (best, cost, total)
            }
            None => (DVector::zeros(n), total, total),
        }
    }

    /// Sum of the squared residuals, A².
    pub(super) fn cost(&self, drive: &Adjustable) -> f64 {
        let (_, left, total) = self.fit(drive, |_, _| ());
        if left > CANCELLED * total { left } else { self.residuals(drive).iter().map(|residual| residual * residual).sum() }
    }

    /// Measured less simulated current, A: `d, q` of each row in turn.
    pub(super) fn residuals(&self, drive: &Adjustable) -> Vec<f64> {
        let n = self.linear_unknowns();
        let mut residuals = Vec::with_capacity(2 * self.measured.len());
        let mut responses = Vec::with_capacity(n * self.measured.len());
        let (best, _, _) = self.fit(drive, |error, response| {
            residuals.extend([error.d, error.q]);
            responses.extend_from_slice(response);
        });
        let (rows, _) = residuals.as_chunks_mut::<2>();
        for (error, responses) in rows.iter_mut().zip(responses.chunks_exact(n)) {
            for (value, response) in best.iter().zip(responses) {
                error[0] -= value * response.d;
                error[1] -= value * response.q;
            }
        }
        residuals
    }

    /// What a volt on each axis over each period does to a linear function of the simulated currents, which `weights` gives: `d, q` per
    /// row. From the last period to the first, by the adjoint equations.
    pub(super) fn by_voltage(&self, drive: &Adjustable, weights: &[f64]) -> Vec<Dq> {
        let transition = self.transitions(&drive.motor);
        let observer = drive.faults.disturbance;
        let (weights, _) = weights.as_chunks::<2>();
        let mut effects = vec![Dq::default(); self.periods.len()];
        let mut behind = Dq::default();
        for (k, period) in self.periods.iter().enumerate().rev() {
            let [d, q] = weights[k + 1];
            let after = Dq { d: behind.d + d, q: behind.q + q };
            let (by_current, by_voltage) = transition(period).transposed(after);
            effects[k] = by_voltage;
            behind = observer.remaining(by_current);
        }
        effects
    }
}

/// A volt along alpha whose sign alternates from period to period, in the rotor's frame.
fn alternating(periods: &[Period]) -> Vec<Dq> {
    let signs = [1.0, -1.0].into_iter().cycle();
    periods.iter().zip(signs).map(|(period, sign)| AlphaBeta { alpha: sign, beta: 0.0 }.to_dq(period.theta_e)).collect()
}
