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
//! What a segment does not tell, its first current and, of centred voltages, its first vector, enters `î` linearly and is solved
//! for inside: the cost is the smallest over them.

use super::{
    acting_voltage::{Period, VoltageReading, periods},
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
}

/// A segment, ready to be simulated.
#[derive(Debug, Clone, PartialEq)]
struct Course {
    periods: Vec<Period>,
    /// One more than periods.
    measured: Vec<Dq>,
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
    /// If none is.
    pub fn of(log: &Log, reading: VoltageReading) -> Result<Self, Error> {
        let long_enough = log.segments().iter().filter(|segment| segment.rows.len() >= MIN_ROWS + reading.lost_rows());
        let courses: Vec<Course> = long_enough
            .map(|segment| {
                let periods = periods(log, segment, reading);
                let (first, columns) = (segment.rows.start + reading.lost_rows(), log.columns());
                let measured = (first..segment.rows.end).map(|row| Dq { d: columns.id[row], q: columns.iq[row] }).collect();
                let length = segment.sample_period;
                let even = periods.iter().all(|period| (period.length / length - 1.0).abs() < EVEN).then_some(length);
                let alternating = if reading == VoltageReading::Centered { alternating(&periods) } else { Vec::new() };
                Course { periods, measured, alternating, even }
            })
            .collect();
        let rows = courses.iter().map(|course| course.measured.len()).sum();
        if rows == 0 {
            Err(Error::TooShort { rows: log.rows(), least: MIN_ROWS + reading.lost_rows() })
        } else {
            Ok(Self { courses, rows })
        }
    }

    /// Rows whose currents are compared.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The same for each segment that is long enough.
    pub fn rows_per_segment(&self) -> Vec<usize> {
        self.courses.iter().map(|course| course.measured.len()).collect()
    }

    /// Cost of one motor, A².
    pub fn cost(&self, motor: &Motor) -> f64 {
        self.courses.iter().map(|course| course.cost(motor)).sum()
    }

    /// Measured less simulated current, A: `d, q` of each row in turn.
    pub fn residuals(&self, motor: &Motor) -> Vec<f64> {
        self.courses.iter().flat_map(|course| course.residuals(motor)).collect()
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
        for (candidate, cost) in candidates.iter().zip(costs) {
            *cost = self.cost(&Motor::from(*candidate));
        }
    }
}

/// Most linear unknowns of a segment: the first current, the first vector.
const UNKNOWNS: usize = 4;

impl Course {
    fn unknowns(&self) -> usize {
        if self.alternating.is_empty() { UNKNOWNS / 2 } else { UNKNOWNS }
    }

    /// Simulates, and shows for each row the difference of measured and simulated current, and what each unknown does to the simulated one.
    fn walk(&self, motor: &Motor, mut see: impl FnMut(Dq, &[Dq])) {
        let table = self.even.map(|length| Table::new(motor, &self.periods, length));
        let unknowns = self.unknowns();
        let mut i = self.measured[0];
        let unit = |k: usize| Dq { d: f64::from(u8::from(k == 0)), q: f64::from(u8::from(k == 1)) };
        let mut response: [Dq; UNKNOWNS] = std::array::from_fn(unit);
        see(Dq::default(), &response[..unknowns]);
        for (k, (period, measured)) in self.periods.iter().zip(&self.measured[1..]).enumerate() {
            let transition = match &table {
                Some(table) => table.at(period.omega_e),
                None => Transition::of(motor, period.omega_e, period.length),
            };
            i = transition.after(i, period.u);
            let alpha = self.alternating.get(k).copied().unwrap_or_default();
            let beta = Dq { d: -alpha.q, q: alpha.d };
            for (response, u) in response[..unknowns].iter_mut().zip([Dq::default(), Dq::default(), alpha, beta]) {
                *response = transition.difference_after(*response, u);
            }
            see(Dq { d: measured.d - i.d, q: measured.q - i.q }, &response[..unknowns]);
        }
    }

    /// The unknowns that fit best, the part of the cost that is left, and the cost without them.
    fn fit(&self, motor: &Motor) -> (DVector<f64>, f64, f64) {
        let n = self.unknowns();
        let (mut normal, mut right, mut total) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS], 0.0);
        self.walk(motor, |error, response| {
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

    fn cost(&self, motor: &Motor) -> f64 {
        let (best, left, total) = self.fit(motor);
        if left > CANCELLED * total { left } else { self.residuals_with(motor, &best).iter().map(|residual| residual * residual).sum() }
    }

    fn residuals(&self, motor: &Motor) -> Vec<f64> {
        self.residuals_with(motor, &self.fit(motor).0)
    }

    /// The residuals that these unknowns leave.
    fn residuals_with(&self, motor: &Motor, best: &DVector<f64>) -> Vec<f64> {
        let mut residuals = Vec::with_capacity(2 * self.measured.len());
        self.walk(motor, |mut error, response| {
            for (value, response) in best.iter().zip(response) {
                error.d -= value * response.d;
                error.q -= value * response.q;
            }
            residuals.extend([error.d, error.q]);
        });
        residuals
    }
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
