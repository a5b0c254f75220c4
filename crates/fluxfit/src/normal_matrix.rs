//! The normal matrix of a least-squares problem whose columns may be dependent.

use crate::singular_values::SingularValueDecomposition;
use nalgebra::{DMatrix, DVector, DVectorView};

/// Part of the largest singular value of a normal matrix below which a direction is none: derivatives by differences are right to
/// 1e-9 or so, and the normal matrix squares that, but only where columns nearly cancel does it matter.
const RANK_TOLERANCE: f64 = 1e-13;

/// Scalar products of the columns of a least-squares problem.
#[derive(Debug, Clone)]
pub(crate) struct NormalMatrix {
    products: DMatrix<f64>,
}

/// A least-squares problem of as many rows as it has columns, with the same normal matrix and the same right-hand side of the normal
/// equations.
pub(crate) struct FewRows {
    /// Columns.
    pub(crate) matrix: DMatrix<f64>,
    /// Right-hand side.
    pub(crate) right: DVector<f64>,
}

impl NormalMatrix {
    pub(crate) fn of(columns: &[Vec<f64>]) -> Self {
        Self { products: DMatrix::zeros(0, 0) }.with(&[], columns)
    }

    /// With further columns; `own` are those that it is of.
    pub(crate) fn with(&self, own: &[Vec<f64>], further: &[Vec<f64>]) -> Self {
        let (known, size) = (own.len(), own.len() + further.len());
        let column = |p: usize| if p < known { &own[p] } else { &further[p - known] };
        let mut products = self.products.clone().resize(size, size, 0.0);
        for p in known..size {
            for q in 0..p + 1 {
                let product = dot(column(p), column(q));
                (products[(p, q)], products[(q, p)]) = (product, product);
            }
        }
        Self { products }
    }

    /// Whether every product is a number.
    pub(crate) fn is_finite(&self) -> bool {
        self.products.iter().all(|product| product.is_finite())
    }

    /// One over the columns' lengths: henries and ohms differ by orders of magnitude. Columns of nothing keep theirs.
    fn scales(&self) -> DVector<f64> {
        self.products.diagonal().map(|square| if square > 0.0 { 1.0 / square.sqrt() } else { 1.0 })
    }

    fn decomposed(&self, scales: &DVector<f64>) -> SingularValueDecomposition {
        let size = scales.len();
        SingularValueDecomposition::of(DMatrix::from_fn(size, size, |p, q| self.products[(p, q)] * scales[p] * scales[q]))
    }

    /// The inverse, zero along directions in which the columns do not differ.
    pub(crate) fn inverse(&self) -> DMatrix<f64> {
        let scales = self.scales();
        let decomposition = self.decomposed(&scales);
        let inverse = decomposition.pseudo_inverse(RANK_TOLERANCE * decomposition.values.first().copied().unwrap_or(0.0));
        DMatrix::from_fn(scales.len(), scales.len(), |p, q| inverse[(p, q)] * scales[p] * scales[q])
    }

    /// The same problem in few rows, given the columns' scalar products with the right-hand side.
    pub(crate) fn few_rows(&self, right: &DVector<f64>) -> FewRows {
        let (scales, size) = (self.scales(), right.len());
        let SingularValueDecomposition { values, right: directions, .. } = self.decomposed(&scales);
        let least = RANK_TOLERANCE * values.first().copied().unwrap_or(0.0);
        let sizes: Vec<f64> = values.iter().map(|value| if *value > least { value.sqrt() } else { 0.0 }).collect();
        let along = |row: usize| (0..size).map(|p| directions[(p, row)] * right[p] * scales[p]).sum::<f64>();
        FewRows {
            matrix: DMatrix::from_fn(size, size, |row, p| sizes[row] * directions[(p, row)] / scales[p]),
            right: DVector::from_fn(size, |row, _| if sizes[row] > 0.0 { along(row) / sizes[row] } else { 0.0 }),
        }
    }
}

/// Scalar product of two columns of equal length.
pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    // In several sums at once: a single one waits for each addition.
    DVectorView::from_slice(one, one.len()).dot(&DVectorView::from_slice(other, other.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_columns_have_the_inverse() {
        // Of sizes as different as those of derivatives by henries and by ohms; without the sizes the normal matrix is [2 1; 1 2].
        let sizes = [1e6, 1e-3];
        let inverse = NormalMatrix::of(&[vec![sizes[0], 0.0, sizes[0]], vec![0.0, sizes[1], sizes[1]]]).inverse();
        for (p, q, expected) in [(0, 0, 2.0 / 3.0), (0, 1, -1.0 / 3.0), (1, 0, -1.0 / 3.0), (1, 1, 2.0 / 3.0)] {
            assert!((inverse[(p, q)] * sizes[p] * sizes[q] - expected).abs() < 1e-12, "{inverse}");
        }
    }

    /// A column that repeats another one adds a direction of which nothing is known: it is left out.
    #[test]
    fn dependent_columns_have_the_pseudo_inverse() {
        let column = vec![3.0, 4.0];
        let inverse = NormalMatrix::of(&[column.clone(), column]).inverse();
        assert!(inverse.iter().all(|entry| (entry - 0.01).abs() < 1e-12), "{inverse}");
        assert!(NormalMatrix::of(&[vec![0.0, 0.0]]).inverse()[(0, 0)].abs() < f64::EPSILON);
    }

    /// The few rows have the normal matrix and the right-hand side of the many, and of dependent columns none is lost.
    #[test]
    fn few_rows_tell_the_same() {
        let columns = [vec![3.0, 1.0, -2.0, 5.0], vec![1e-3, 2e-3, 0.0, 1e-3], vec![6.0, 2.0, -4.0, 10.0]];
        let residuals = [1.0, -1.0, 2.0, 0.5];
        let right = DVector::from_fn(3, |p, _| dot(&columns[p], &residuals));
        let FewRows { matrix, right: few } = NormalMatrix::of(&columns).few_rows(&right);
        let size = |p: usize| dot(&columns[p], &columns[p]).sqrt();
        for p in 0..3 {
            assert!((matrix.column(p).dot(&few) - right[p]).abs() < 1e-12 * size(p), "{p}");
            for q in 0..3 {
                let product = matrix.column(p).dot(&matrix.column(q));
                assert!((product - dot(&columns[p], &columns[q])).abs() < 1e-12 * size(p) * size(q), "{p} {q}");
            }
        }
    }
}
