//! A winding that warms from operating point to operating point.
//!
//! A resistance that grows by `c` over the log takes `c x i` more at a row whose time is the part `x` of the log's length after its middle.
//! Two points cannot tell that from a flux or an inductance. Their rows can: while current and speed are constant, the voltage along the
//! current grows by `c |i| dx`. So `c` is an unknown beside the motor, with a prior: what is left of the voltage by the motor found is
//! followed through each window, and where all windows show one and the same `c`, that is what is expected, beyond any usual size. Else it
//! is that as far as the rows tell it, and zero as far as windings usually stay as they are. Constant errors of the motor or of the
//! inverter have no slope.

use super::{super::request::Request, part::Part, voltage_loss::Loss};
use crate::{
    faults::resistance_drift::ResistanceDrift,
    frames::Dq,
    log::{Columns, Log},
    motor::Motor,
    steady::OperatingPoint,
};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Means into which a window is divided: longer than most of what a drive does around its steady state, and enough to see a line.
const PARTS: usize = 8;

/// Fewer rows in each are no mean.
const LEAST_ROWS: usize = 8;

/// Chance of a drift where there is none, per log.
const SIGNIFICANCE: f64 = 1e-4;

/// How well the motor is known from which the slopes of current and speed are taken out, as a part of what they make.
const KNOWN: f64 = 0.05;

/// Usual change while a log is taken, as a part of R_s, one standard deviation: 13 K of copper.
const USUAL: f64 = 0.05;

/// Standard errors from which a change is found.
const FOUND: f64 = 5.0;

/// A change of the resistance while the log is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Warming {
    /// R_s at the log's end less that at its start, ohm.
    pub change: f64,
    /// Its standard error, ohm.
    pub standard_error: f64,
}

/// The change that one window shows.
struct Slope {
    /// ohm.
    change: f64,
    /// Its variance per variance of a row's noise, ohm²/V².
    by_noise: f64,
    /// Its variance by what the motor may be wrong, ohm².
    by_motor: f64,
    /// Variance of a row's noise, V², from the scatter of the parts' means about a straight line.
    noise: f64,
}

impl Warming {
    /// What the rows of these points show, by a motor that is about right. What they do not prove is none unless the resistance is
    /// `in_doubt`, nor for whoever states the steady model: that states its equations.
    pub(super) fn expected(log: &Log, points: &[OperatingPoint], motor: &Motor, in_doubt: bool, request: &Request) -> Option<Self> {
        let slopes: Vec<Slope> = points.iter().filter_map(|point| Slope::of(log, point, motor)).collect();
        let proven = mean(&slopes).filter(|shown| shown.is_proven(&slopes) && shown.is_physical(motor));
        if proven.is_some() {
            return proven;
        }
        let are_exact = request.voltage_accuracy == 0.0 || log.is_short_circuit();
        let usual = Self { change: 0.0, standard_error: USUAL * motor.rs };
        (in_doubt && !are_exact && request.model.is_none() && motor.rs > 0.0)
            .then(|| mean(&slopes).map_or(usual, |shown| shown.and(&usual)))
    }

    /// The unknown beside the motor.
    pub(super) fn unknown(&self, log: &Log, points: &[OperatingPoint]) -> Loss {
        let place = |point: &OperatingPoint| place(log.columns(), 0.5 * (point.time.0 + point.time.1));
        let voltages = points.iter().map(|point| [point.current().d, point.current().q].map(|i| i * place(point)));
        Loss { voltages: voltages.collect(), expected: self.change, standard_error: self.standard_error, part: Part::Noise }
    }

    /// Whether there is a change, beyond doubt.
    pub fn is_found(&self) -> bool {
        self.change.abs() > FOUND * self.standard_error
    }

    fn is_physical(&self, motor: &Motor) -> bool {
        self.change.abs() < ResistanceDrift::LARGEST * motor.rs
    }

    fn is_proven(&self, slopes: &[Slope]) -> bool {
        let freedom = (slopes.len() * (PARTS - 2)) as f64;
        let limit = StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - 0.5 * SIGNIFICANCE));
        self.change.abs() > limit * self.standard_error
    }

    /// Both together.
    fn and(&self, other: &Self) -> Self {
        let [one, two] = [self, other].map(|each| each.standard_error.powi(-2));
        Self { change: (one * self.change + two * other.change) / (one + two), standard_error: (one + two).sqrt().recip() }
    }
}

/// What windows show together. They share their noise: weighted by its own, a window would count for its luck.
fn mean(slopes: &[Slope]) -> Option<Warming> {
    let noise = slopes.iter().map(|slope| slope.noise).sum::<f64>() / slopes.len() as f64;
    let weights: Vec<f64> = slopes.iter().map(|slope| (noise * slope.by_noise + slope.by_motor).recip()).collect();
    let weight: f64 = weights.iter().sum();
    let weighted = |of: &dyn Fn(&Slope) -> f64| slopes.iter().zip(&weights).map(|(slope, weight)| weight * of(slope)).sum::<f64>();
    let change = weighted(&|slope| slope.change) / weight;
    let chi_squared = weighted(&|slope| (slope.change - change).powi(2));
    // Windows that contradict each other are less accurate than each looks (R. T. Birge, Phys. Rev. 40 (1932) 207).
    let beyond = (chi_squared / slopes.len().saturating_sub(1).max(1) as f64).max(1.0);
    // The motor is wrong in all windows alike.
    let by_motor = weighted(&|slope| slope.by_motor.sqrt()) / weight;
    let standard_error = (beyond / weight).sqrt().hypot(by_motor);
    (change.is_finite() && standard_error > 0.0 && standard_error.is_finite()).then_some(Warming { change, standard_error })
}

impl Slope {
    fn of(log: &Log, point: &OperatingPoint, motor: &Motor) -> Option<Self> {
        let (columns, rows) = (log.columns(), &point.rows);
        let length = rows.len() / PARTS;
        let magnitude = point.current().magnitude();
        if length < LEAST_ROWS || magnitude == 0.0 {
            return None;
        }
        let along = |v: Dq| (v.d * point.current().d + v.q * point.current().q) / magnitude;
        // Place, voltage that the motor leaves, voltage that it explains: per part of the window.
        let parts = (0..PARTS).map(|part| {
            let start = rows.start + part * length;
            let mean = |of: &dyn Fn(usize) -> f64| (start..start + length).map(of).sum::<f64>() / length as f64;
            let by_motor = |k: usize| along(motor.steady_voltage(Dq { d: columns.id[k], q: columns.iq[k] }, columns.omega_e[k]));
            let left = |k: usize| along(Dq { d: columns.ud[k], q: columns.uq[k] }) - by_motor(k);
            [mean(&|k| place(columns, columns.t[k])), mean(&left), mean(&by_motor)]
        });
        let parts: Vec<[f64; 3]> = parts.collect();
        let mean = |column: usize| parts.iter().map(|part| part[column]).sum::<f64>() / PARTS as f64;
        let means = [mean(0), mean(1), mean(2)];
        let spread: f64 = parts.iter().map(|part| (part[0] - means[0]).powi(2)).sum();
        let slope = |column: usize| parts.iter().map(|part| (part[0] - means[0]) * part[column]).sum::<f64>() / spread;
        let (of_left, of_motor) = (slope(1), slope(2));
        let scatter: f64 = parts.iter().map(|part| (part[1] - means[1] - of_left * (part[0] - means[0])).powi(2)).sum();
        let slope = Self {
            change: of_left / magnitude,
            by_noise: 1.0 / (spread * length as f64 * magnitude.powi(2)),
            by_motor: (KNOWN * of_motor / magnitude).powi(2),
            noise: scatter / (PARTS - 2) as f64 * length as f64,
        };
        (slope.change.is_finite() && slope.by_noise.is_finite() && slope.noise.is_finite()).then_some(slope)
    }
}

/// Where an instant lies from the log's middle, as a part of its length.
fn place(columns: &Columns, t: f64) -> f64 {
    let (first, last) = (columns.t.first().copied().unwrap_or(t), columns.t.last().copied().unwrap_or(t));
    (t - 0.5 * (first + last)) / (last - first).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::Draws;

    const MOTOR: Motor = Motor { rs: 0.5, ld: 2e-3, lq: 3e-3, psi_f: 0.05 };
    const NOISE: f64 = 0.02;

    /// Three operating points of a thousand rows of a motor whose R_s grows by this over the log, ohm, with noise in the voltages.
    fn log(growth: f64, seed: u64) -> Log {
        let mut draws = Draws::seeded(seed, 0);
        let mut columns = Columns::default();
        for k in 0..3000 {
            let (i, omega_e) = [(Dq { d: 0.0, q: 9.0 }, 400.0), (Dq { d: -3.0, q: 6.0 }, 300.0), (Dq { d: 0.0, q: 4.0 }, 500.0)][k / 1000];
            let rs = MOTOR.rs + growth * (k as f64 / 2999.0 - 0.5);
            let u = Motor { rs, ..MOTOR }.steady_voltage(i, omega_e);
            columns.t.push(k as f64 * 1e-3);
            columns.ud.push(u.d + NOISE * draws.normal());
            columns.uq.push(u.q + NOISE * draws.normal());
            columns.id.push(i.d);
            columns.iq.push(i.q);
            columns.omega_e.push(omega_e);
        }
        Log::new(columns).unwrap()
    }

    fn shown(growth: f64, motor: &Motor, seed: u64) -> Option<Warming> {
        let log = log(growth, seed);
        let points: Vec<OperatingPoint> = (0..3).map(|w| OperatingPoint::measure(&log, 1000 * w..1000 * (w + 1), None)).collect();
        Warming::expected(&log, &points, motor, true, &Request::default())
    }

    /// A tenth of an ohm, seen beside a motor whose flux and resistance are 3 % wrong: nothing of that has a slope.
    #[test]
    fn a_growing_resistance_is_seen_beside_a_motor_that_is_about_right() {
        let about_right = Motor { rs: 0.97 * MOTOR.rs, psi_f: 1.03 * MOTOR.psi_f, ..MOTOR };
        for growth in [0.1, -0.1] {
            let within = |seed: u64| {
                let found = shown(growth, &about_right, seed).unwrap();
                assert!(found.is_found(), "{found:?}");
                (found.change - growth).abs() < 2.0 * found.standard_error
            };
            assert!((0..50).filter(|seed| within(*seed)).count() >= 45);
        }
    }

    /// Where R_s stays, the rows say so better than what is usual, and nothing is found in any of 200 logs.
    #[test]
    fn no_growth_is_found_where_there_is_none() {
        for seed in 0..200 {
            let found = shown(0.0, &MOTOR, seed).unwrap();
            assert!(!found.is_found() && found.standard_error < 0.2 * USUAL * MOTOR.rs, "{found:?}");
        }
        let stated = Request { model: Some(crate::Model::Steady), ..Request::default() };
        let log = log(0.0, 0);
        assert_eq!(Warming::expected(&log, &[OperatingPoint::measure(&log, 0..1000, None)], &MOTOR, true, &stated), None);
    }
}
