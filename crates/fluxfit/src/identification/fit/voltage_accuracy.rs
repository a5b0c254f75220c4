//! What the voltages' accuracy does to a fit of simulated currents.

use crate::{
    frames::Dq,
    objective::{adjustable::Adjustable, output_error::OutputError},
};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Operating points this far apart, as a fraction of the largest current and speed, are as good as independent in their voltages'
/// errors: a drive's voltage error is a function of where it runs, smooth on that scale.
const SMOOTH: f64 = 0.1;

/// Periods are gathered by where they run, in cells of this fraction: a few to that scale.
const CELL: f64 = 0.04;

/// Covariance of the unknowns from the voltages' accuracy: their error along either axis is a random function of the operating point,
/// of that fraction of the voltage there, alike at points that lie close.
pub(crate) fn covariance(
    objective: &OutputError,
    drive: &Adjustable,
    inverse: &DMatrix<f64>,
    slopes: &[Vec<f64>],
    fraction: f64,
) -> DMatrix<f64> {
    let size = slopes.len();
    if fraction == 0.0 {
        return DMatrix::zeros(size, size);
    }
    let (mut most_current, mut most_speed) = (f64::MIN_POSITIVE, f64::MIN_POSITIVE);
    for (_, i, omega_e) in objective.periods() {
        most_current = most_current.max(i.magnitude());
        most_speed = most_speed.max(omega_e.abs());
    }
    let cell = |i: Dq, omega_e: f64| [i.d / most_current, i.q / most_current, omega_e / most_speed].map(|x| (x / CELL).round() as i32);
    // Per cell and axis: what a volt there does to each unknown, weighted with its voltage. Of the residuals, simulated currents
    // have the opposite sign.
    let mut cells: BTreeMap<[i32; 3], Vec<Dq>> = BTreeMap::new();
    for p in 0..size {
        let mut weights = vec![0.0; slopes[0].len()];
        for (q, slope) in slopes.iter().enumerate() {
            weights.iter_mut().zip(slope).for_each(|(weight, slope)| *weight += inverse[(p, q)] * slope);
        }
        let effects = objective.by_voltage(drive, &weights);
        for ((u, i, omega_e), effect) in objective.periods().zip(effects) {
            let sums = cells.entry(cell(i, omega_e)).or_insert_with(|| vec![Dq::default(); size]);
            let volts = fraction * u.magnitude();
            sums[p].d += volts * effect.d;
            sums[p].q += volts * effect.q;
        }
    }
    let mut covariance = DMatrix::zeros(size, size);
    let cells: Vec<_> = cells.into_iter().collect();
    for (one, effects) in &cells {
        for (other, others) in &cells {
            let distance: f64 = one.iter().zip(other).map(|(a, b)| (f64::from(a - b) * CELL / SMOOTH).powi(2)).sum();
            let alike = (-0.5 * distance).exp();
            for p in 0..size {
                for q in 0..size {
                    covariance[(p, q)] += alike * (effects[p].d * others[q].d + effects[p].q * others[q].q);
                }
            }
        }
    }
    covariance
}
