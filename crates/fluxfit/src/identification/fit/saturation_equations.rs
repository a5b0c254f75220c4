//! Whether saturation explains why operating points contradict each other.
//!
//! That points contradict each other is found by [`misfit`](super::misfit). To find out why, constant parameters are solved
//! again beside terms of saturation, those of the [simulated currents](crate::faults::saturation),
//!
//! ```text
//! psi_d = L_d i_d + psi_f + s_d i_d |i_d| + c i_q²,     psi_q = L_q i_q + s_q i_q |i_q| + 2 c i_d i_q
//! ```
//!
//! in both cases beside what else follows the current, the [losses](super::voltage_loss) of dead time and devices. Saturation it is if its
//! terms explain the contradiction best by Schwarz's criterion, and iron takes flux away.

use super::{
    super::request::{Known, Request},
    excitation::Excitation,
    voltage_loss::Loss,
};
use crate::{
    frames::Dq,
    motor::{Motor, PARAMETERS, Parameter},
    singular_values::SingularValueDecomposition,
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, DVector};

/// Operating points whose currents differ by less than this fraction of the largest say the same of saturation.
const DISTINCT: f64 = 0.02;

/// Least number of distinct currents: two make a straight line.
const LEAST_CURRENTS: usize = 3;

/// The constants beside the terms of saturation, if those explain the contradiction between the points beside `losses`; with all that is
/// `possible` of the drive.
pub(super) fn explain(
    points: &[OperatingPoint],
    (losses, possible): (&[Loss], &[Loss]),
    excitation: &Excitation,
    motor: &Motor,
    request: &Request,
) -> Option<Solved> {
    if distinct_currents(points) < LEAST_CURRENTS {
        return None;
    }
    let equations = Equations { points, losses, excitation, motor, request, peak: peak(points) };
    let rival = equations.solve(&[]).criterion;
    let best = SATURATIONS
        .iter()
        .map(|causes| equations.solve(causes))
        .filter(|solved| solved.takes_flux_away())
        .min_by(|one, other| one.criterion.total_cmp(&other.criterion))?;
    let causes: Vec<Cause> = best.causes.iter().map(|(cause, _)| *cause).collect();
    let beside_all = || Equations { losses: possible, ..equations }.solve(&causes);
    (best.criterion < rival).then(|| Solved { losses: beside_all().losses, ..best })
}

/// The largest current, A.
pub(super) fn peak(points: &[OperatingPoint]) -> f64 {
    points.iter().map(|point| point.current().magnitude()).fold(f64::MIN_POSITIVE, f64::max)
}

/// How many operating points differ in their current.
fn distinct_currents(points: &[OperatingPoint]) -> usize {
    let apart = DISTINCT * peak(points);
    let mut distinct: Vec<Dq> = Vec::new();
    for i in points.iter().map(OperatingPoint::current) {
        if distinct.iter().all(|other| (i.d - other.d).hypot(i.q - other.q) > apart) {
            distinct.push(i);
        }
    }
    distinct.len()
}

/// What lets equations follow the current.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cause {
    /// `s_q`.
    Q,
    /// `s_d`.
    D,
    /// `c`.
    Cross,
}

/// Saturation, from the simplest kind on.
const SATURATIONS: [&[Cause]; 4] = [&[Cause::Q], &[Cause::Cross], &[Cause::Q, Cause::Cross], &[Cause::Q, Cause::Cross, Cause::D]];

impl Cause {
    /// What one unit of it does to both voltages, V; of saturation, a henry at the current `peak`.
    fn voltage(self, point: &OperatingPoint, peak: f64) -> [f64; 2] {
        let (i, omega_e) = (point.current(), point.omega_e());
        match self {
            Self::Q => [-omega_e * i.q * i.q.abs() / peak, 0.0],
            Self::D => [0.0, omega_e * i.d * i.d.abs() / peak],
            Self::Cross => [-omega_e * 2.0 * i.d * i.q / peak, omega_e * i.q * i.q / peak],
        }
    }
}

/// The equations, to be solved with one cause or another.
struct Equations<'a> {
    points: &'a [OperatingPoint],
    losses: &'a [Loss],
    excitation: &'a Excitation,
    /// The motor that tells what noise does to the equations.
    motor: &'a Motor,
    request: &'a Request,
    peak: f64,
}

/// Constants beside causes.
#[derive(Debug)]
pub(super) struct Solved {
    pub(super) motor: Motor,
    /// Standard uncertainty of R_s, ohm.
    pub(super) rs_uncertainty: f64,
    causes: Vec<(Cause, f64)>,
    /// What each loss comes out as, and its standard error.
    pub(super) losses: Vec<(f64, f64)>,
    /// Schwarz's, lowest is best.
    criterion: f64,
}

impl Solved {
    /// Whether it is what iron does: flux along q is lost; or the magnet's, where it is that alone.
    fn takes_flux_away(&self) -> bool {
        let of = |cause: Cause| self.causes.iter().find(|(other, _)| *other == cause).map(|(_, value)| *value);
        match (of(Cause::Q), of(Cause::Cross)) {
            (Some(q), _) => q < 0.0 && self.motor.lq > 0.0,
            (None, Some(cross)) => cross * self.motor.psi_f < 0.0,
            (None, None) => false,
        }
    }
}

/// Part of the largest singular value below which a combination of unknowns is none.
const RANK_TOLERANCE: f64 = 1e-9;

impl Equations<'_> {
    fn solve(&self, causes: &[Cause]) -> Solved {
        let Self { points, losses, excitation, motor: noisy, request, peak } = self;
        let directions: Vec<[f64; PARAMETERS]> =
            excitation.excited().map(|direction| std::array::from_fn(|p| direction.components[p] * excitation.scale[p])).collect();
        let fixed: [f64; PARAMETERS] = request.known.map(|known| if let Known::Fixed(value) = known { value } else { 0.0 });
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (w, point) in points.iter().enumerate() {
            let equations = point.equations();
            let noise = point.residual_covariance(noisy);
            let open = excitation.unexcited_covariance(&equations);
            let accuracy = request.voltage_accuracy * point.voltage().magnitude();
            for (axis, equation) in equations.iter().enumerate() {
                let variance = noise[axis][axis].max(0.0) + open[axis][axis] + accuracy.powi(2);
                let weight = 1.0 / variance.sqrt().max(LEAST_ACCURACY * point.voltage().magnitude()).max(f64::MIN_POSITIVE);
                let known =
                    directions.iter().map(|direction| (0..PARAMETERS).map(|p| equation.coefficients[p] * direction[p]).sum::<f64>());
                let beside = causes.iter().map(|cause| cause.voltage(point, *peak)[axis]);
                let lost = losses.iter().map(|loss| loss.voltages[w][axis]);
                rows.push(known.chain(beside).chain(lost).chain([equation.residual(&fixed)]).map(|entry| weight * entry).collect());
            }
        }
        for (p, known) in request.known.iter().enumerate() {
            if let Known::Prior { value, standard_error } = known {
                let entries = directions.iter().map(|direction| direction[p]).chain(vec![0.0; causes.len() + losses.len()]).chain([*value]);
                rows.push(entries.map(|entry| entry / standard_error).collect());
            }
        }
        let unknowns = directions.len() + causes.len() + losses.len();
        for (k, loss) in losses.iter().enumerate() {
            let mut row = vec![0.0; unknowns];
            row[directions.len() + causes.len() + k] = 1.0 / loss.standard_error;
            row.push(loss.expected / loss.standard_error);
            rows.push(row);
        }
        let mut matrix = DMatrix::from_fn(rows.len(), unknowns, |row, column| rows[row][column]);
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).map(|norm| if norm > 0.0 { norm } else { 1.0 }).collect();
        matrix.column_iter_mut().zip(&lengths).for_each(|(mut column, length)| column.unscale_mut(*length));
        let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| row[unknowns]));
        let decomposition = SingularValueDecomposition::of(matrix.clone());
        let inverse = decomposition.pseudo_inverse(RANK_TOLERANCE * decomposition.values.first().copied().unwrap_or(0.0));
        let solution = &inverse * &values;
        let chi_squared = (values - matrix * &solution).norm_squared();
        let count = rows.len() as f64;

        let x: Vec<f64> = solution.iter().zip(&lengths).map(|(value, length)| value / length).collect();
        let of_motor = |p: usize| fixed[p] + directions.iter().zip(&x).map(|(direction, x)| direction[p] * x).sum::<f64>();
        // R_s as a combination of the unknowns, and through the pseudo-inverse of the equations; the scatter of what is left tells how far
        // to trust it.
        let rs = DVector::from_fn(unknowns, |k, _| directions.get(k).map_or(0.0, |direction| direction[0] / lengths[k]));
        let degrees = count - unknowns as f64;
        let motor = Motor::from(std::array::from_fn(of_motor));
        let noise = (inverse.transpose() * rs).norm();
        // A resistance below zero is wrong by at least that much. Where nothing is left over there is no scatter: anything that the voltage
        // allows.
        let range = excitation.scale[Parameter::Rs as usize] / 3.0_f64.sqrt();
        let rs_uncertainty = match request.known[Parameter::Rs as usize] {
            Known::Fixed(_) => 0.0,
            _ if degrees > 0.0 => (noise * (chi_squared / degrees).max(1.0).sqrt()).hypot(motor.rs.min(0.0)).min(range),
            Known::Prior { standard_error, .. } => standard_error,
            Known::Nothing => range,
        };
        let of_loss = directions.len() + causes.len()..unknowns;
        Solved {
            motor,
            rs_uncertainty,
            causes: causes.iter().copied().zip(x[directions.len()..].iter().copied()).collect(),
            losses: of_loss.map(|k| (x[k], inverse.row(k).norm() / lengths[k])).collect(),
            // One is what noise alone leaves of each equation.
            criterion: count * (1.0 + chi_squared / count).ln() + unknowns as f64 * count.ln(),
        }
    }
}

/// Voltages are never trusted beyond this fraction, so that noise-free windows have finite weights.
pub(super) const LEAST_ACCURACY: f64 = 1e-9;
