//! What the limited accuracy of the voltages does to the unknowns of a fit.
//!
//! The error of a drive's voltages along either axis is a random function of the operating point, a fraction of the voltage there, and
//! alike at points that lie close together. The adjoint equations of the output error give the effect of a volt at any row on each unknown.

use crate::{
    frames::Dq,
    objective::{adjustable::Adjustable, output_error::OutputError},
};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Distance between operating points, as a fraction of the largest current and speed, beyond which the errors of their voltages are
/// nearly independent: a drive's voltage error is a function of the operating point, smooth on that scale.
const SMOOTH: f64 = 0.1;

/// Periods are gathered into cells of this size in the space of operating points, likewise: a few to that scale.
const CELL: f64 = 0.04;

/// How far the voltages are trusted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VoltageAccuracy {
    /// Standard uncertainty as a fraction of the voltage.
    pub(crate) fraction: f64,
    /// The same at any voltage, V.
    pub(crate) volts: f64,
}

/// Covariance of the unknowns from the voltages' accuracy. `slopes` are the derivatives of the residuals by each
/// unknown, `inverse` is the inverse of their normal matrix.
pub(crate) fn covariance(
    objective: &OutputError,
    drive: &Adjustable,
    inverse: &DMatrix<f64>,
    slopes: &[Vec<f64>],
    accuracy: VoltageAccuracy,
) -> DMatrix<f64> {
    let size = slopes.len();
    if accuracy.fraction == 0.0 && accuracy.volts == 0.0 {
        return DMatrix::zeros(size, size);
    }
    let (mut most_current, mut most_speed) = (f64::MIN_POSITIVE, f64::MIN_POSITIVE);
    for (_, i, omega_e) in objective.periods() {
        most_current = most_current.max(i.magnitude());
        most_speed = most_speed.max(omega_e.abs());
    }
    let cell = |i: Dq, omega_e: f64| [i.d / most_current, i.q / most_current, omega_e / most_speed].map(|x| (x / CELL).round() as i32);
    let of_periods: Vec<([i32; 3], f64)> = objective
        .periods()
        .map(|(u, i, omega_e)| {
            (cell(i, omega_e), ((accuracy.fraction * u.d).powi(2) + (accuracy.fraction * u.q).powi(2) + accuracy.volts.powi(2)).sqrt())
        })
        .collect();
    let mut numbers: BTreeMap<[i32; 3], usize> = of_periods.iter().map(|(cell, _)| (*cell, 0)).collect();
    numbers.values_mut().enumerate().for_each(|(number, place)| *place = number);
    let places: Vec<(usize, f64)> = of_periods.iter().map(|(cell, volts)| (numbers[cell], *volts)).collect();
    // Per cell and axis: what a volt there does to each unknown, weighted with its voltage. Of the residuals, simulated currents
    // have the opposite sign.
    let mut cells: Vec<([i32; 3], Vec<Dq>)> = numbers.into_keys().map(|cell| (cell, vec![Dq::default(); size])).collect();
    let weights = (0..size).map(|p| {
        let mut weights = vec![0.0; slopes[0].len()];
        for (q, slope) in slopes.iter().enumerate() {
            weights.iter_mut().zip(slope).for_each(|(weight, slope)| *weight += inverse[(p, q)] * slope);
        }
        weights
    });
    for (p, effects) in objective.by_voltage(drive, &weights.collect::<Vec<_>>()).into_iter().enumerate() {
        for ((place, volts), effect) in places.iter().zip(effects) {
            let sum = &mut cells[*place].1[p];
            sum.d += volts * effect.d;
            sum.q += volts * effect.q;
        }
    }
    let mut covariance = DMatrix::zeros(size, size);
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
