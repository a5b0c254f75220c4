//! The normal matrix of a least-squares problem whose columns may be dependent.

use crate::singular_values::SingularValueDecomposition;
use nalgebra::DMatrix;

/// Part of the largest singular value of a normal matrix below which a direction is none: derivatives by differences are right to
/// 1e-9 or so, and the normal matrix squares that, but only where columns nearly cancel does it matter.
const RANK_TOLERANCE: f64 = 1e-13;

/// Inverse of the normal matrix of these columns, zero along directions in which they do not differ.
pub(crate) fn inverse_normal(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let size = columns.len();
    // Columns of equal length: henries and ohms differ by orders of magnitude.
    let lengths: Vec<f64> =
        columns.iter().map(|column| dot(column, column).sqrt()).map(|length| if length > 0.0 { length } else { 1.0 }).collect();
    let normal = DMatrix::from_fn(size, size, |p, q| dot(&columns[p], &columns[q]) / lengths[p] / lengths[q]);
    let decomposition = SingularValueDecomposition::of(normal);
    let inverse = decomposition.pseudo_inverse(RANK_TOLERANCE * decomposition.values.first().copied().unwrap_or(0.0));
    DMatrix::from_fn(size, size, |p, q| inverse[(p, q)] / lengths[p] / lengths[q])
}

/// Scalar product of two columns.
pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_columns_have_the_inverse() {
        // Of sizes as different as those of derivatives by henries and by ohms; without the sizes the normal matrix is [2 1; 1 2].
        let sizes = [1e6, 1e-3];
        let inverse = inverse_normal(&[vec![sizes[0], 0.0, sizes[0]], vec![0.0, sizes[1], sizes[1]]]);
        for (p, q, expected) in [(0, 0, 2.0 / 3.0), (0, 1, -1.0 / 3.0), (1, 0, -1.0 / 3.0), (1, 1, 2.0 / 3.0)] {
            assert!((inverse[(p, q)] * sizes[p] * sizes[q] - expected).abs() < 1e-12, "{inverse}");
        }
    }

    /// A column that repeats another one adds a direction of which nothing is known: it is left out.
    #[test]
    fn dependent_columns_have_the_pseudo_inverse() {
        let column = vec![3.0, 4.0];
        let inverse = inverse_normal(&[column.clone(), column]);
        assert!(inverse.iter().all(|entry| (entry - 0.01).abs() < 1e-12), "{inverse}");
        assert!(inverse_normal(&[vec![0.0, 0.0]])[(0, 0)].abs() < f64::EPSILON);
    }
}
