//! What the BBOB functions are built of: transformations of places and costs.

use nalgebra::DMatrix;

/// Half the width of the box in which all optima lie.
pub(super) const HALF_BOX: f64 = 5.0;

/// `k / (D - 1)`: from 0 of the first coordinate to 1 of the last.
pub(super) fn part(k: usize, dimension: usize) -> f64 {
    k as f64 / (dimension - 1) as f64
}

/// T_osz: small oscillations, which break the symmetry of a number about zero and keep its sign.
pub(super) fn oscillated(x: f64) -> f64 {
    /// The oscillation's height, and its frequencies on both sides of zero, in the tenth of a logarithm.
    const HEIGHT: f64 = 0.049;
    if x == 0.0 {
        return 0.0;
    }
    let (first, second) = if x > 0.0 { (10.0, 7.9) } else { (5.5, 3.1) };
    let log = x.abs().ln();
    x.signum() * (log + HEIGHT * ((first * log).sin() + (second * log).sin())).exp()
}

/// T_asy: stretches positive coordinates, the later the more.
pub(super) fn asymmetric(z: &[f64], beta: f64) -> Vec<f64> {
    let dimension = z.len();
    let of = |(k, z): (usize, &f64)| if *z > 0.0 { z.powf(1.0 + beta * part(k, dimension) * z.sqrt()) } else { *z };
    z.iter().enumerate().map(of).collect()
}

/// Each coordinate oscillated.
pub(super) fn all_oscillated(z: &[f64]) -> Vec<f64> {
    z.iter().map(|z| oscillated(*z)).collect()
}

/// The diagonal of Lambda: from 1 to the root of the condition.
pub(super) fn lambda(k: usize, dimension: usize, condition: f64) -> f64 {
    condition.powf(0.5 * part(k, dimension))
}

/// Lambda times a vector.
pub(super) fn stretched(z: &[f64], condition: f64) -> Vec<f64> {
    let dimension = z.len();
    z.iter().enumerate().map(|(k, z)| lambda(k, dimension, condition) * z).collect()
}

/// Lambda times a matrix.
pub(super) fn stretched_rows(condition: f64, matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let dimension = matrix.nrows();
    DMatrix::from_fn(dimension, dimension, |row, k| lambda(row, dimension, condition) * matrix[(row, k)])
}

/// A matrix times a vector.
pub(super) fn turned(matrix: &DMatrix<f64>, z: &[f64]) -> Vec<f64> {
    (0..matrix.nrows()).map(|row| (0..z.len()).map(|k| matrix[(row, k)] * z[k]).sum()).collect()
}

/// What lies outside of the box, squared.
pub(super) fn outside(x: &[f64]) -> f64 {
    x.iter().map(|x| (x.abs() - HALF_BOX).max(0.0).powi(2)).sum()
}

/// Rastrigin's function: a bowl with cosines.
pub(super) fn rastrigin(z: &[f64]) -> f64 {
    z.iter().map(|z| 10.0 * (1.0 - (std::f64::consts::TAU * z).cos()) + z * z).sum()
}

/// Squares weighted from 1 to the condition.
pub(super) fn ellipsoid(z: &[f64], condition: f64) -> f64 {
    let dimension = z.len();
    z.iter().enumerate().map(|(k, z)| condition.powf(part(k, dimension)) * z * z).sum()
}

/// The terms of Rosenbrock's function, one for each neighbouring pair.
pub(super) fn valley(z: &[f64]) -> impl Iterator<Item = f64> + '_ {
    z.windows(2).map(|pair| 100.0 * (pair[0] * pair[0] - pair[1]).powi(2) + (pair[0] - 1.0).powi(2))
}
