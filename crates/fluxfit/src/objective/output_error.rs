//! Output error: the currents of the adjustable motor against the measured ones.
//!
//! ```text
//! f(x) = sum_k |i(k) - î(k; x)|²,   x = (R_s, L_d, L_q, psi_f)
//! ```
//!
//! with `î` from equation (1), driven by the voltage that [acted](super::acting_voltage) over each period and integrated
//! [exactly](super::transition). It is the paper's Fig. 1 taken literally: the output of the real motor is compared with that of the
//! adjustable one. With known voltages and white measurement noise on the currents it is maximum likelihood, in closed loop too,
//! because a voltage depends on past samples only.
//!
//! The [adjustable drive](super::adjustable) may have faults: what they do to voltages and measured currents is undone before the
//! comparison. With an observer's gain the simulated current follows the measured one from row to row, and what is compared is the
//! prediction of one row from the row before: the maximum likelihood where unknown voltages disturb the motor.
//!
//! What a segment does not tell, its first current and, of centred voltages, its first vector, enters `î` linearly and is solved
//! for inside: the cost is the smallest over them.

use super::{
    acting_voltage::{Period, VoltageReading, angles, periods},
    adjustable::{Adjustable, Nuisance},
    phase_loss::mean_loss,
    transition::Transition,
};
use crate::{
    error::Error,
    frames::{AlphaBeta, Dq},
    log::Log,
    motor::{Motor, PARAMETERS},
    optimizer::Objective,
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Periods whose lengths agree within this fraction are of one length: what the digits of a time column leave.
const EVEN: f64 = 1e-3;

/// Turn, rad, from one tabulated transition to the next: a cubic between four of them is right to 0.005⁴ · 3/128 = 1e-11.
const TABLE_STEP: f64 = 0.005;

/// If less than this part of the cost is left by the unknowns, too few digits are left too, and residuals are squared one by one: an
/// unstable motor's currents, wrong by far, are much like the response to a wrong start, and their cost must not come out negative.
const CANCELLED: f64 = 1e-8;

/// Fewest rows that a segment must have left.
const MIN_ROWS: usize = 10;

/// The squared error of the simulated currents.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputError {
    courses: Vec<Course>,
    rows: usize,
    /// What a search over motors takes for granted.
    held: Nuisance,
}

/// A segment, ready to be simulated.
#[derive(Debug, Clone, PartialEq)]
struct Course {
    /// Its rows in the log.
    rows: Range<usize>,
    periods: Vec<Period>,
    /// One more than periods.
    measured: Vec<Dq>,
    /// The electrical angle at each of them, rad: their frame against the stator.
    theta_e: Vec<f64>,
    /// Whether that angle is the logged one.
    angle_known: bool,
    /// What the first vector of centred voltages adds to each period's, per volt along alpha; none of delayed ones. Along beta it is
    /// the same, turned by a right angle.
    alternating: Vec<Dq>,
    /// The length of its periods, s, if they are even.
    even: Option<f64>,
}

/// Transitions at even steps of speed.
struct Table {
    first: f64,
    step: f64,
    nodes: Vec<Transition>,
}

impl OutputError {
    /// The segments of a log that are long enough.
    ///
    /// # Errors
    /// As [`of_rows`](Self::of_rows).
    pub fn of(log: &Log, reading: VoltageReading) -> Result<Self, Error> {
        let segments: Vec<_> = log.segments().iter().map(|segment| segment.rows.clone()).collect();
        Self::of_rows(log, &segments, reading)
    }

    /// Stretches of a log, none of them across a gap; those that are long enough.
    ///
    /// # Errors
    /// If none is, or if the log's channels were sampled at different instants.
    pub fn of_rows(log: &Log, stretches: &[Range<usize>], reading: VoltageReading) -> Result<Self, Error> {
        if log.is_interpolated() {
            return Err(Error::Interpolated);
        }
        let least = MIN_ROWS + reading.lost_rows();
        let long_enough = stretches.iter().filter(|rows| rows.len() >= least);
        let courses: Vec<Course> = long_enough.map(|rows| Course::of(log, rows, reading)).collect();
        let rows = courses.iter().map(|course| course.measured.len()).sum();
        if rows == 0 { Err(Error::TooShort { rows: log.rows(), least }) } else { Ok(Self { courses, rows, held: Nuisance::default() }) }
    }

    /// The same fitness of motors in a drive with these faults.
    pub fn holding(self, held: Nuisance) -> Self {
        Self { held, ..self }
    }

    /// Rows whose currents are compared.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The same for each stretch.
    pub fn rows_per_segment(&self) -> Vec<usize> {
        self.courses.iter().map(|course| course.measured.len()).collect()
    }

    /// Rows of the log whose currents are compared, stretch by stretch.
    pub fn stretches(&self) -> impl Iterator<Item = Range<usize>> {
        self.courses.iter().map(|course| course.rows.clone())
    }

    /// Whether every stretch has its angle from the log: what happens in the stator can only then be told from what does in the rotor.
    pub fn angle_known(&self) -> bool {
        self.courses.iter().all(|course| course.angle_known)
    }

    /// Largest measured current vector, A.
    pub fn peak_current(&self) -> f64 {
        self.courses.iter().flat_map(|course| &course.measured).map(|i| i.magnitude()).fold(0.0, f64::max)
    }

    /// Cost of one motor, A².
    pub fn cost(&self, motor: &Motor) -> f64 {
        self.cost_of(&Adjustable { motor: *motor, nuisance: self.held })
    }

    /// Cost of one motor in an imperfect drive, A².
    pub fn cost_of(&self, drive: &Adjustable) -> f64 {
        self.courses.iter().map(|course| course.cost(drive)).sum()
    }

    /// Measured less simulated current, A: `d, q` of each row in turn.
    pub fn residuals(&self, drive: &Adjustable) -> Vec<f64> {
        self.courses.iter().flat_map(|course| course.residuals(drive)).collect()
    }

    /// Simulated currents, A, row by row: what the residuals lack to the measured ones, faults undone.
    pub fn simulated(&self, drive: &Adjustable) -> Vec<Dq> {
        let of_course = |course: &Course| {
            let residuals = course.residuals(drive);
            let (residuals, _) = residuals.as_chunks::<2>();
            let rows = residuals.iter().enumerate();
            let simulated = rows.map(|(row, [d, q])| {
                let measured = course.seen(row, drive);
                Dq { d: measured.d - d, q: measured.q - q }
            });
            simulated.collect::<Vec<_>>()
        };
        self.courses.iter().flat_map(of_course).collect()
    }

    /// What a volt on each axis over each period does to a linear function of the simulated currents, which `weights` gives: `d, q` per
    /// row. The course is run backward, by the adjoint equations. One entry per period, stretch after stretch.
    pub fn by_voltage(&self, drive: &Adjustable, weights: &[f64]) -> Vec<Dq> {
        let mut rest = weights;
        let mut effects = Vec::with_capacity(self.rows);
        for course in &self.courses {
            let (own, others) = rest.split_at(2 * course.measured.len());
            effects.extend(course.by_voltage(drive, own));
            rest = others;
        }
        effects
    }

    /// Voltage (V), current at its start (A), speed (electrical rad/s) of each period, stretch after stretch.
    pub fn periods(&self) -> impl Iterator<Item = (Dq, Dq, f64)> {
        let of_course = |course: &Course| -> Vec<_> {
            course.periods.iter().zip(&course.measured).map(|(period, i)| (period.u, *i, period.omega_e)).collect()
        };
        self.courses.iter().flat_map(of_course)
    }
}

/// A volt along alpha whose sign alternates, seen from the rotor.
fn alternating(periods: &[Period]) -> Vec<Dq> {
    let signs = [1.0, -1.0].into_iter().cycle();
    periods.iter().zip(signs).map(|(period, sign)| AlphaBeta { alpha: sign, beta: 0.0 }.to_dq(period.theta_e)).collect()
}

impl Objective for OutputError {
    fn dimension(&self) -> usize {
        PARAMETERS
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        let (candidates, _) = candidates.as_chunks::<PARAMETERS>();
        // Each cost depends on its own candidate alone: any number of threads gives the same bits.
        costs.par_iter_mut().zip(candidates).for_each(|(cost, candidate)| *cost = self.cost(&Motor::from(*candidate)));
    }
}

/// Rounds in which the flux beyond `L i` is found at a period's end: each is a fifth or less of the one before, of a change that is small.
const SATURATION_ROUNDS: usize = 3;

/// Most linear unknowns of a segment: the first current, the first vector.
const UNKNOWNS: usize = 4;

impl Course {
    fn of(log: &Log, rows: &Range<usize>, reading: VoltageReading) -> Self {
        let angles = angles(log, rows);
        let periods = periods(log, rows, &angles, reading);
        let (lost, columns) = (reading.lost_rows(), log.columns());
        let rows = rows.start + lost..rows.end;
        let theta_e = angles.rotor[lost..].to_vec();
        // Out of the drive's frame, into the rotor's.
        let frames = angles.logged[lost..].iter().zip(&theta_e);
        let turned = |(row, (logged, rotor)): (usize, (&f64, &f64))| turned(Dq { d: columns.id[row], q: columns.iq[row] }, logged - rotor);
        let measured = rows.clone().zip(frames).map(turned).collect();
        let length = (columns.t[rows.end - 1] - columns.t[rows.start]) / periods.len() as f64;
        let even = periods.iter().all(|period| (period.length / length - 1.0).abs() < EVEN).then_some(length);
        let alternating = if reading == VoltageReading::Centered { alternating(&periods) } else { Vec::new() };
        Self { rows, periods, measured, theta_e, angle_known: angles.known, alternating, even }
    }

    fn unknowns(&self) -> usize {
        if self.alternating.is_empty() { UNKNOWNS / 2 } else { UNKNOWNS }
    }

    /// The current of a row as the adjustable drive says that it was, in the frame of the magnet.
    fn seen(&self, row: usize, drive: &Adjustable) -> Dq {
        let (i, faults) = (self.measured[row], &drive.nuisance);
        if *faults == Nuisance::default() {
            return i;
        }
        let theta = self.theta_e[row];
        let offset = faults.current_offset.to_dq(theta);
        let i = Dq { d: i.d - offset.d, q: i.q - offset.q };
        // In the rotor's frame the imbalance turns backward twice as fast. (i + s conj i) is undone exactly.
        let s = faults.imbalance.to_dq(2.0 * theta);
        let shrunk = 1.0 / (1.0 - s.d * s.d - s.q * s.q);
        let i = Dq { d: shrunk * (i.d - s.d * i.d - s.q * i.q), q: shrunk * (i.q - s.q * i.d + s.d * i.q) };
        turned(i, faults.angle_offset - faults.current_turn)
    }

    /// One period of the adjustable drive, from the current `i` at its start: what is lost and what saturates follows the simulated
    /// current. The measured one would let its noise into the prediction.
    fn period(&self, k: usize, transition: &Transition, i: Dq, drive: &Adjustable) -> Dq {
        let (Period { omega_e, mut u, theta_e, .. }, faults) = (self.periods[k], &drive.nuisance);
        if faults.dead_time != 0.0 {
            // As the sensors' frame has it; over a period the current hardly moves against the rotor.
            let seen = turned(i, -faults.angle_offset);
            let (start, end) = (seen.to_alpha_beta(self.theta_e[k]), seen.to_alpha_beta(self.theta_e[k + 1]));
            let half = if (self.rows.start + k).is_multiple_of(2) { faults.dead_time_ripple } else { -faults.dead_time_ripple };
            let loss = mean_loss(start, end, half, faults.dead_time_width);
            let loss = loss.to_dq(theta_e);
            u = Dq { d: u.d - faults.dead_time * loss.d, q: u.q - faults.dead_time * loss.q };
        }
        u = turned(u, faults.angle_offset);
        if faults.saturation == Dq::default() && faults.cross_saturation == 0.0 {
            return transition.after(i, u);
        }
        // Flux beyond L i + psi_f takes a voltage as any flux does: by its turning, and by its growth.
        let flux = extra_flux(i, faults);
        let linear = transition.after(i, Dq { d: u.d + omega_e * flux.q, q: u.q - omega_e * flux.d });
        (0..SATURATION_ROUNDS).fold(linear, |end, _| {
            let grown = extra_flux(end, faults);
            Dq { d: linear.d - (grown.d - flux.d) / drive.motor.ld, q: linear.q - (grown.q - flux.q) / drive.motor.lq }
        })
    }

    fn transitions<'a>(&'a self, motor: &'a Motor) -> impl Fn(&Period) -> Transition + 'a {
        let table = self.even.map(|length| Table::new(motor, &self.periods, length));
        move |period| match &table {
            Some(table) => table.at(period.omega_e),
            None => Transition::of(motor, period.omega_e, period.length),
        }
    }

    /// Simulates, and shows for each row the difference of measured and simulated current, and what each unknown does to the simulated one.
    fn walk(&self, drive: &Adjustable, mut see: impl FnMut(Dq, &[Dq])) {
        let transition = self.transitions(&drive.motor);
        let perfect = drive.nuisance == Nuisance::default();
        let gain = drive.nuisance.observer_gain;
        let unknowns = self.unknowns();
        let mut i = self.seen(0, drive);
        let unit = |k: usize| Dq { d: f64::from(u8::from(k == 0)), q: f64::from(u8::from(k == 1)) };
        let mut response: [Dq; UNKNOWNS] = std::array::from_fn(unit);
        see(Dq::default(), &response[..unknowns]);
        let mut error = Dq::default();
        for (k, period) in self.periods.iter().enumerate() {
            let transition = transition(period);
            let followed = Dq { d: i.d + gain.d * error.d, q: i.q + gain.q * error.q };
            let measured;
            (i, measured) = if perfect {
                (transition.after(followed, period.u), self.measured[k + 1])
            } else {
                (self.period(k, &transition, followed, drive), self.seen(k + 1, drive))
            };
            let alpha = self.alternating.get(k).copied().unwrap_or_default();
            let beta = Dq { d: -alpha.q, q: alpha.d };
            for (response, u) in response[..unknowns].iter_mut().zip([Dq::default(), Dq::default(), alpha, beta]) {
                let followed = Dq { d: (1.0 - gain.d) * response.d, q: (1.0 - gain.q) * response.q };
                *response = transition.difference_after(followed, u);
            }
            error = Dq { d: measured.d - i.d, q: measured.q - i.q };
            see(error, &response[..unknowns]);
        }
    }

    /// The unknowns that fit best, the part of the cost that is left, and the cost without them.
    fn fit(&self, drive: &Adjustable, mut keep: impl FnMut(Dq, &[Dq])) -> (DVector<f64>, f64, f64) {
        let n = self.unknowns();
        let (mut normal, mut right, mut total) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS], 0.0);
        self.walk(drive, |error, response| {
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

    fn cost(&self, drive: &Adjustable) -> f64 {
        let (_, left, total) = self.fit(drive, |_, _| ());
        if left > CANCELLED * total { left } else { self.residuals(drive).iter().map(|residual| residual * residual).sum() }
    }

    fn residuals(&self, drive: &Adjustable) -> Vec<f64> {
        let n = self.unknowns();
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

    fn by_voltage(&self, drive: &Adjustable, weights: &[f64]) -> Vec<Dq> {
        let transition = self.transitions(&drive.motor);
        let gain = drive.nuisance.observer_gain;
        let (weights, _) = weights.as_chunks::<2>();
        let mut effects = vec![Dq::default(); self.periods.len()];
        let mut behind = Dq::default();
        for (k, period) in self.periods.iter().enumerate().rev() {
            let [d, q] = weights[k + 1];
            let after = Dq { d: behind.d + d, q: behind.q + q };
            let (by_current, by_voltage) = transition(period).transposed(after);
            effects[k] = by_voltage;
            behind = Dq { d: (1.0 - gain.d) * by_current.d, q: (1.0 - gain.q) * by_current.q };
        }
        effects
    }
}

/// A vector turned forward, rad.
fn turned(vector: Dq, by: f64) -> Dq {
    if by == 0.0 {
        return vector;
    }
    let AlphaBeta { alpha, beta } = vector.to_alpha_beta(by);
    Dq { d: alpha, q: beta }
}

/// Flux, Wb, beyond `L i + psi_f`.
fn extra_flux(i: Dq, faults: &Nuisance) -> Dq {
    let cross = faults.cross_saturation;
    Dq { d: faults.saturation.d * i.d * i.d.abs() + cross * i.q * i.q, q: faults.saturation.q * i.q * i.q.abs() + 2.0 * cross * i.d * i.q }
}

impl Table {
    fn new(motor: &Motor, periods: &[Period], length: f64) -> Self {
        let speeds = || periods.iter().map(|period| period.omega_e);
        let (low, high) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(f64::NEG_INFINITY, f64::max));
        let step = TABLE_STEP / length;
        let first = low - step;
        // One node before the first speed and two behind the last.
        let nodes = ((high - low) / step).ceil() as usize + 4;
        Self { first, step, nodes: (0..nodes).map(|node| Transition::of(motor, first + node as f64 * step, length)).collect() }
    }

    /// The cubic through the four nodes around a speed.
    #[inline]
    fn at(&self, omega_e: f64) -> Transition {
        let place = (omega_e - self.first) / self.step;
        let node = (place as usize).clamp(1, self.nodes.len() - 3);
        let x = place - node as f64;
        let weights = [
            -x * (x - 1.0) * (x - 2.0) / 6.0,
            (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
            -(x + 1.0) * x * (x - 2.0) / 2.0,
            (x + 1.0) * x * (x - 1.0) / 6.0,
        ];
        Transition::blend(&self.nodes[node - 1..node + 3], &weights)
    }
}
