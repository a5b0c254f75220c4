//! What the limited accuracy of the voltages does to the unknowns of a fit.
//!
//! The error of a drive's voltages along either axis is a random function of the operating point, a fraction of the voltage there, and
//! alike at points that lie close together. The adjoint equations of the output error give the effect of a volt at any row on each unknown.

use crate::{
    frames::Dq,
    objective::{adjustable::Adjustable, output_error::OutputError},
    parallel,
};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Distance between operating points, as a fraction of the largest current and speed, beyond which the errors of their voltages are
/// nearly independent: a drive's voltage error is a function of the operating point, smooth on that scale.
const SMOOTH: f64 = 0.1;

/// Periods are gathered into cells of this size in the space of operating points, likewise: a few to that scale.
const CELL: f64 = 0.04;

/// Cells at least so far apart have less than 1e-13 of their errors in common.
const FARTHEST: i32 = 20;

/// How far the voltages are trusted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct VoltageAccuracy {
    /// Standard uncertainty as a fraction of the voltage.
    pub(crate) fraction: f64,
    /// The same at any voltage, V.
    pub(crate) volts: f64,
    /// The same across the current alone, V: of a voltage along it that comes early or late.
    pub(crate) across: f64,
}

impl VoltageAccuracy {
    fn is_exact(&self) -> bool {
        *self == Self::default()
    }
}

/// Covariances of the unknowns from the voltages' accuracy, one for each that is given. `slopes` are the derivatives of the residuals by
/// each unknown, `inverse` is the inverse of their normal matrix.
pub(crate) fn covariances<const COUNT: usize>(
    objective: &OutputError,
    drive: &Adjustable,
    inverse: &DMatrix<f64>,
    slopes: &[Vec<f64>],
    accuracies: [VoltageAccuracy; COUNT],
) -> [DMatrix<f64>; COUNT] {
    let size = slopes.len();
    if accuracies.iter().all(VoltageAccuracy::is_exact) {
        return accuracies.map(|_| DMatrix::zeros(size, size));
    }
    let periods: Vec<(Dq, Dq, f64)> = objective.periods().collect();
    let cells = Cells::of(&periods);
    let weights = (0..size).map(|p| {
        let mut weights = vec![0.0; slopes[0].len()];
        for (q, slope) in slopes.iter().enumerate() {
            weights.iter_mut().zip(slope).for_each(|(weight, slope)| *weight += inverse[(p, q)] * slope);
        }
        weights
    });
    let of_a_volt = objective.by_voltage(drive, &weights.collect::<Vec<_>>());
    accuracies.map(|accuracy| {
        if accuracy.is_exact() {
            return DMatrix::zeros(size, size);
        }
        let VoltageAccuracy { fraction, volts, across } = accuracy;
        let errors = periods.iter().map(|(u, ..)| ((fraction * u.d).powi(2) + (fraction * u.q).powi(2) + volts.powi(2)).sqrt());
        let of_both_axes = cells.covariance(&errors.collect::<Vec<f64>>(), &of_a_volt);
        if across == 0.0 {
            return of_both_axes;
        }
        of_both_axes + cells.covariance(&vec![across; periods.len()], &across_currents(&periods, &of_a_volt))
    })
}

/// What a volt across the current does to each unknown: the whole of it in the place of d.
fn across_currents(periods: &[(Dq, Dq, f64)], of_a_volt: &[Vec<Dq>]) -> Vec<Vec<Dq>> {
    let across = |(effect, (_, i, _)): (&Dq, &(Dq, Dq, f64))| {
        let magnitude = i.magnitude().max(f64::MIN_POSITIVE);
        Dq { d: (i.d * effect.q - i.q * effect.d) / magnitude, q: 0.0 }
    };
    of_a_volt.iter().map(|effects| effects.iter().zip(periods).map(across).collect()).collect()
}

/// Periods gathered by their operating points.
struct Cells {
    /// Where each cell lies, in multiples of its size: along i_d, i_q and speed.
    places: Vec<[i32; 3]>,
    /// The cell of each period.
    of_periods: Vec<usize>,
}

impl Cells {
    /// Of periods with these voltages (V), currents (A) and speeds (electrical rad/s).
    fn of(periods: &[(Dq, Dq, f64)]) -> Self {
        let largest = |size: &dyn Fn(&(Dq, Dq, f64)) -> f64| periods.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
        let (current, speed) = (largest(&|(_, i, _)| i.magnitude()), largest(&|(.., omega_e)| omega_e.abs()));
        let place = |(_, i, omega_e): &(Dq, Dq, f64)| [i.d / current, i.q / current, omega_e / speed].map(|x| (x / CELL).round() as i32);
        let of_periods: Vec<[i32; 3]> = periods.iter().map(place).collect();
        let mut numbers: BTreeMap<[i32; 3], usize> = of_periods.iter().map(|place| (*place, 0)).collect();
        numbers.values_mut().enumerate().for_each(|(number, cell)| *cell = number);
        Self { of_periods: of_periods.iter().map(|place| numbers[place]).collect(), places: numbers.into_keys().collect() }
    }

    /// Covariance of unknowns, given the standard error of each period's voltage, V, and what a volt there does to each unknown.
    fn covariance(&self, errors: &[f64], of_a_volt: &[Vec<Dq>]) -> DMatrix<f64> {
        let size = of_a_volt.len();
        // Per cell a row: what its voltages' error does to each unknown, of d and then of q. Of the residuals, simulated currents have the
        // opposite sign.
        let mut effects = vec![0.0; self.places.len() * 2 * size];
        for (p, effect) in of_a_volt.iter().enumerate() {
            for ((cell, volts), effect) in self.of_periods.iter().zip(errors).zip(effect) {
                effects[cell * 2 * size + p] += volts * effect.d;
                effects[cell * 2 * size + size + p] += volts * effect.q;
            }
        }
        let rows: Vec<&[f64]> = effects.chunks_exact(2 * size).collect();
        // Errors of cells so far apart have nothing in common.
        let alike: Vec<f64> = (0..FARTHEST * FARTHEST).map(|square| (-0.5 * f64::from(square) * (CELL / SMOOTH).powi(2)).exp()).collect();
        let numbers: Vec<usize> = (0..rows.len()).collect();
        // Each cell's own row and what others have in common with it, in whole: the sum does not depend on how work is shared.
        let common = parallel::map(&numbers, |number| {
            let mut common = vec![0.0; 2 * size];
            for (place, row) in self.places.iter().zip(&rows) {
                let square: i32 = place.iter().zip(&self.places[*number]).map(|(a, b)| (a - b).pow(2)).sum();
                let Some(alike) = usize::try_from(square).ok().and_then(|square| alike.get(square)) else { continue };
                common.iter_mut().zip(*row).for_each(|(common, effect)| *common += alike * effect);
            }
            common
        });
        let mut covariance = DMatrix::zeros(size, size);
        for (own, common) in rows.iter().zip(&common) {
            for p in 0..size {
                for q in 0..size {
                    covariance[(p, q)] += own[p] * common[q] + own[size + p] * common[size + q];
                }
            }
        }
        covariance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The direction across (4, 3) is (-3, 4) / 5: nothing of a volt along the current, all of one across it.
    #[test]
    fn only_what_lies_across_the_current_counts() {
        let period = (Dq::default(), Dq { d: 4.0, q: 3.0 }, 100.0);
        let effects = [Dq { d: 8.0, q: 6.0 }, Dq { d: -0.6, q: 0.8 }, Dq { d: 0.0, q: 1.0 }];
        let across: Vec<f64> = effects.iter().map(|effect| across_currents(&[period], &[vec![*effect]])[0][0].d).collect();
        for (found, expected) in across.iter().zip([0.0, 1.0, 0.8]) {
            assert!((found - expected).abs() < 1e-12, "{across:?}");
        }
        let standing = (Dq::default(), Dq::default(), 0.0);
        assert_eq!(across_currents(&[standing], &[vec![Dq { d: 1.0, q: 1.0 }]])[0][0], Dq::default());
    }
}
