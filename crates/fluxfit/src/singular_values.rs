//! Singular value decomposition of small matrices by one-sided Jacobi rotations: pairs of columns are rotated until all columns are
//! orthogonal; their lengths are then the singular values.
//!
//! Hestenes, "Inversion of matrices by biorthogonalization and related results", 1958, doi 10.1137/0106005. Small singular values
//! have the same relative accuracy as large ones: Demmel and Veselić, "Jacobi's method is more accurate than QR", 1992,
//! doi 10.1137/0613074.
//!
//! Rank-deficient matrices are common here, and nalgebra 0.34 decomposes some of them wrongly (dimforge/nalgebra#1172, also in 0.35):
//! a consistent system of three equations was solved with a residual of 0.002.

use nalgebra::DMatrix;

/// Columns whose cosine is below this count as orthogonal: the rounding error of a scalar product.
const ORTHOGONAL: f64 = 1e-15;

/// Most sweeps over all pairs of columns. Convergence is quadratic: about six sweeps are usual.
const MAX_SWEEPS: usize = 60;

/// `matrix = left diag(values) rightᵀ`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SingularValueDecomposition {
    /// Singular values, largest first.
    pub(crate) values: Vec<f64>,
    /// Left singular vectors as columns; zero where the singular value is zero.
    pub(crate) left: DMatrix<f64>,
    /// Right singular vectors as columns, always a complete orthonormal basis.
    pub(crate) right: DMatrix<f64>,
}

impl SingularValueDecomposition {
    /// Decomposes a matrix of any shape.
    pub(crate) fn of(mut matrix: DMatrix<f64>) -> Self {
        let columns = matrix.ncols();
        let mut right = DMatrix::identity(columns, columns);
        for _ in 0..MAX_SWEEPS {
            let mut rotated = false;
            for p in 0..columns {
                for q in p + 1..columns {
                    if let Some((cos, sin)) = rotation(&matrix, p, q) {
                        rotated = true;
                        rotate(&mut matrix, p, q, cos, sin);
                        rotate(&mut right, p, q, cos, sin);
                    }
                }
            }
            if !rotated {
                break;
            }
        }
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        let mut order: Vec<usize> = (0..columns).collect();
        order.sort_by(|a, b| lengths[*b].total_cmp(&lengths[*a]));
        for (column, length) in lengths.iter().enumerate().filter(|(_, length)| **length > 0.0) {
            matrix.column_mut(column).unscale_mut(*length);
        }
        Self {
            values: order.iter().map(|column| lengths[*column]).collect(),
            left: matrix.select_columns(&order),
            right: right.select_columns(&order),
        }
    }

    /// The pseudo-inverse; singular values at or below `tolerance` count as zero.
    pub(crate) fn pseudo_inverse(&self, tolerance: f64) -> DMatrix<f64> {
        let mut inverse = DMatrix::zeros(self.right.nrows(), self.left.nrows());
        for (j, value) in self.values.iter().enumerate().filter(|(_, value)| **value > tolerance) {
            inverse += self.right.column(j) * self.left.column(j).transpose() / *value;
        }
        inverse
    }
}

/// Cosine and sine of the rotation that makes two columns orthogonal; `None` where they are orthogonal already.
fn rotation(matrix: &DMatrix<f64>, p: usize, q: usize) -> Option<(f64, f64)> {
    let (one, other) = (matrix.column(p), matrix.column(q));
    let (a, b, c) = (one.norm_squared(), other.norm_squared(), one.dot(&other));
    // Also `None` where a column is zero or not finite.
    if c.abs() > ORTHOGONAL * (a * b).sqrt() {
        let zeta = 0.5 * (b - a) / c;
        let tan = 1.0_f64.copysign(zeta) / (zeta.abs() + 1.0_f64.hypot(zeta));
        let cos = 1.0 / 1.0_f64.hypot(tan);
        Some((cos, cos * tan))
    } else {
        None
    }
}

fn rotate(matrix: &mut DMatrix<f64>, p: usize, q: usize, cos: f64, sin: f64) {
    for row in 0..matrix.nrows() {
        let (a, b) = (matrix[(row, p)], matrix[(row, q)]);
        (matrix[(row, p)], matrix[(row, q)]) = (cos * a - sin * b, sin * a + cos * b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(matrix: &DMatrix<f64>) -> Result<(), TestCaseError> {
        let found = SingularValueDecomposition::of(matrix.clone());
        let middle = DMatrix::from_diagonal(&found.values.clone().into());
        let scale = matrix.norm().max(f64::MIN_POSITIVE);
        prop_assert!((&found.left * middle * found.right.transpose() - matrix).norm() < 1e-13 * scale);
        let basis = found.right.transpose() * &found.right;
        prop_assert!((basis - DMatrix::identity(matrix.ncols(), matrix.ncols())).norm() < 1e-13);
        prop_assert!(found.values.windows(2).all(|pair| pair[0] >= pair[1]));
        let inverse = found.pseudo_inverse(1e-12 * scale);
        prop_assert!((matrix * inverse * matrix - matrix).norm() < 1e-10 * scale);
        Ok(())
    }

    proptest! {
        /// Products of two thin matrices have any rank.
        #[test]
        fn matrices_of_any_rank_are_decomposed(rows in 1usize..7, rank in 1usize..5, entries in prop::collection::vec(-10.0..10.0f64, 44)) {
            let left = DMatrix::from_fn(rows, rank, |i, j| entries[i * rank + j]);
            let right = DMatrix::from_fn(rank, 4, |i, j| entries[24 + i * 4 + j]);
            check(&(left * right))?;
        }
    }

    #[test]
    fn known_values() {
        // [[3, 0], [4, 5]]: AᵀA has the eigenvalues 45 and 5.
        let found = SingularValueDecomposition::of(DMatrix::from_row_slice(2, 2, &[3.0, 0.0, 4.0, 5.0]));
        assert!((found.values[0] - 45.0_f64.sqrt()).abs() < 1e-14 && (found.values[1] - 5.0_f64.sqrt()).abs() < 1e-14);
        assert_eq!(SingularValueDecomposition::of(DMatrix::zeros(3, 2)).values, [0.0, 0.0]);
    }

    /// A triangular factor of three equations, which nalgebra's decomposition reproduces only to a tenth.
    #[test]
    fn the_factor_that_nalgebra_decomposes_wrongly() {
        let factor = [
            [9.82802313562282, -7.109974767425566, 0.9226389295090288, -0.9595282287405702],
            [0.0, 5.495777504182345, 4.422529858503232, -7.578329213335594],
            [0.0, 0.0, 8.661878631745154, 8.394169048494057],
            [0.0, 0.0, 0.0, 4.076197102228689e-15],
        ];
        let matrix = DMatrix::from_fn(4, 4, |i, j| factor[i][j] / (0..4).map(|i| factor[i][j] * factor[i][j]).sum::<f64>().sqrt());
        check(&matrix).unwrap();
    }
}
