//! R_s of a motor that saturates, from operating points of one current at several speeds.
//!
//! However the flux depends on the current, it is one flux at one current, and its voltage is in proportion to the speed; what R_s takes
//! is not. So the fluxes of every current are unknowns beside R_s, and no form of the saturation is assumed:
//!
//! ```text
//! u_d = R_s i_d - omega_e psi_q(i),     u_q = R_s i_q + omega_e psi_d(i)
//! ```

use super::{
    super::request::{Known, Request},
    misfit::SIGNIFICANCE,
    saturation_equations::LEAST_ACCURACY,
    voltage_loss::Loss,
};
use crate::{
    frames::Dq,
    motor::{Motor, Parameter},
    normal_matrix::{NormalMatrix, dot},
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Currents that differ by at most this part of the largest are one: a controller holds them better than that.
const ONE_CURRENT: f64 = 0.01;

/// Speeds that differ by less than this part of the largest are one: what their noise makes of R_s is nothing, and speeds that are exactly
/// alike leave R_s and the fluxes one unknown.
const ONE_SPEED: f64 = 0.02;

/// Between such currents the flux follows the constant inductances to this part of them, one standard deviation: a saturated motor's slopes
/// are often half of those, and rarely less than a quarter.
const SLOPE: f64 = 0.5;

/// R_s and the drive's unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Resistance {
    /// R_s, ohm, then each of the unknowns.
    pub(super) values: Vec<f64>,
    pub(super) covariance: DMatrix<f64>,
}

impl Resistance {
    /// R_s and its standard uncertainty, ohm.
    pub(super) fn rs(&self) -> (f64, f64) {
        (self.values[0], self.covariance[(0, 0)].max(0.0).sqrt())
    }

    /// With its distance from another as doubt.
    pub(super) fn or_as(mut self, other: &Self) -> Self {
        let doubt = DVector::from_iterator(self.values.len(), self.values.iter().zip(&other.values).map(|(one, other)| one - other));
        self.covariance += &doubt * doubt.transpose();
        self
    }
}

/// R_s beside these unknowns of the drive, given the motor's inductances about right and what each point's voltage may be wrong by beside
/// its noise, V; none where no current has two speeds, or where the points contradict it.
pub(super) fn resistance(
    points: &[OperatingPoint],
    unknowns: &[Loss],
    motor: &Motor,
    accuracy: impl Fn(&OperatingPoint) -> f64,
    request: &Request,
) -> Option<Resistance> {
    let currents = of_several_speeds(points);
    let rows = 2 * currents.iter().map(Vec::len).sum::<usize>();
    // R_s, two fluxes of each current, the drive's unknowns, and the voltages.
    let count = 1 + 2 * currents.len() + unknowns.len();
    let priors = unknowns.iter().map(|unknown| (unknown.expected, unknown.standard_error));
    let of_rs = match request.known[Parameter::Rs as usize] {
        Known::Prior { value, standard_error } => Some((value, standard_error)),
        Known::Fixed(_) => return None,
        Known::Nothing => None,
    };
    let places = (1 + 2 * currents.len()..count).zip(priors).chain(of_rs.map(|prior| (0, prior)));
    let mut columns = vec![Vec::with_capacity(rows + unknowns.len() + 1); count + 1];
    for (k, members) in currents.iter().enumerate() {
        let mean = |of: &dyn Fn(&OperatingPoint) -> f64| members.iter().map(|&w| of(&points[w])).sum::<f64>() / members.len() as f64;
        let middle = Dq { d: mean(&|point| point.current().d), q: mean(&|point| point.current().q) };
        for &w in members {
            let (point, omega_e) = (&points[w], points[w].omega_e());
            let (u, i) = (point.voltage(), point.current());
            let beside = Dq { d: motor.ld * (i.d - middle.d), q: motor.lq * (i.q - middle.q) };
            let noise = point.residual_covariance(motor);
            let drift = Dq { d: motor.ld * point.drift.d, q: motor.lq * point.drift.q };
            let equations = [
                (i.d, 1, -omega_e, u.d - drift.d + omega_e * beside.q, beside.q),
                (i.q, 0, omega_e, u.q - drift.q - omega_e * beside.d, beside.d),
            ];
            for (axis, (current, flux, by_flux, voltage, beside)) in equations.into_iter().enumerate() {
                let of_slope = SLOPE * omega_e * beside;
                let trusted = accuracy(point).max(LEAST_ACCURACY * u.magnitude());
                let weight = (noise[axis][axis].max(0.0) + trusted.powi(2) + of_slope.powi(2)).sqrt().max(f64::MIN_POSITIVE).recip();
                let mut row = vec![0.0; count + 1];
                row[0] = current;
                row[1 + 2 * k + flux] = by_flux;
                for (entry, unknown) in row[1 + 2 * currents.len()..].iter_mut().zip(unknowns) {
                    *entry = unknown.voltages[w][axis];
                }
                row[count] = voltage;
                columns.iter_mut().zip(row).for_each(|(column, entry)| column.push(weight * entry));
            }
        }
    }
    for (place, (expected, standard_error)) in places {
        columns.iter_mut().for_each(|column| column.push(0.0));
        let last = columns[place].len() - 1;
        columns[place][last] = 1.0 / standard_error;
        columns[count][last] = expected / standard_error;
    }
    let voltages = columns.pop()?;
    let covariance = NormalMatrix::of(&columns).inverse();
    let found = &covariance * DVector::from_iterator(count, columns.iter().map(|column| dot(column, &voltages)));
    let left =
        (0..voltages.len()).map(|row| voltages[row] - columns.iter().zip(found.iter()).map(|(column, x)| column[row] * x).sum::<f64>());
    let chi_squared = left.map(|left| left * left).sum::<f64>();
    let degrees = voltages.len().checked_sub(count).filter(|degrees| *degrees > 0)? as f64;
    let limit = ChiSquared::new(degrees).ok()?.inverse_cdf(1.0 - SIGNIFICANCE);
    let kept: Vec<usize> = (0..count).filter(|p| *p == 0 || *p > 2 * currents.len()).collect();
    let resistance = Resistance {
        values: kept.iter().map(|p| found[*p]).collect(),
        covariance: DMatrix::from_fn(kept.len(), kept.len(), |p, q| covariance[(kept[p], kept[q])]),
    };
    (chi_squared <= limit && found[0] > 0.0 && resistance.rs().1 > 0.0).then_some(resistance)
}

/// The points of each current that has several speeds.
fn of_several_speeds(points: &[OperatingPoint]) -> Vec<Vec<usize>> {
    let apart = ONE_CURRENT * points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
    let mut currents: Vec<Vec<usize>> = Vec::new();
    for (w, point) in points.iter().enumerate() {
        let is_near = |first: usize| {
            let (one, other) = (points[first].current(), point.current());
            (one.d - other.d).hypot(one.q - other.q) <= apart
        };
        match currents.iter_mut().find(|members| is_near(members[0])) {
            Some(members) => members.push(w),
            None => currents.push(vec![w]),
        }
    }
    currents.retain(|members| {
        let speeds = || members.iter().map(|&w| points[w].omega_e());
        let (least, most) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(f64::NEG_INFINITY, f64::max));
        most - least > ONE_SPEED * most.abs().max(least.abs())
    });
    currents
}
