//! Linear least squares for the four parameters: equations as a triangular factor, which can be merged, evaluated and solved.
//!
//! The rows of the equations `a . x = b` are kept as their triangular (QR) factor `R = qr([A  -b])`, five by five. Then
//!
//! ```text
//! f(x) = |A x - b|² = |R [x; 1]|²        15 multiply-adds for any number of rows
//! qr([R_1; R_2])                         the factor of both blocks: one pass over a log of any length
//! R_4 x = -z                             the least-squares solution, with R = [R_4 z; 0 rho] and f(x_ls) = rho²
//! f(x) - f(x_ls) = |R_4 (x - x_ls)|²     without cancellation
//! ```
//!
//! The Gram matrix `AᵀA` would lose half of the digits. G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed.,
//! section 5.3; merging factors: J. Demmel et al., "Communication-optimal parallel and sequential QR and LU factorizations",
//! doi:10.1137/080731992.

use crate::{
    motor::{Motor, PARAMETERS},
    singular_values::SingularValueDecomposition,
};
use nalgebra::{DMatrix, SMatrix, SVector};

/// Columns of a row: the coefficients and the negative right-hand side.
const COLUMNS: usize = PARAMETERS + 1;

/// Entries of an upper triangle.
const ENTRIES: usize = COLUMNS * (COLUMNS + 1) / 2;

/// Rows that are collected before they are merged into the factor: enough to spread the cost of a factorization, few enough for the
/// cache.
const BLOCK: usize = 128;

/// Singular values below this fraction of the largest, with columns scaled to equal length, count as zero. It bounds the rounding
/// error, about 1e-16 times the square root of the number of rows; the effect of noise is judged elsewhere.
const RANK_TOLERANCE: f64 = 1e-10;

/// One equation of the parameters, weighted: `coefficients . x = value`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equation {
    /// One per parameter, in the order of [`Parameter::ALL`](crate::motor::Parameter::ALL).
    pub coefficients: [f64; PARAMETERS],
    /// Right-hand side.
    pub value: f64,
}

impl Equation {
    /// The equation times `weight`, the square root of its weight in the sum of squares.
    pub fn weighted(self, weight: f64) -> Self {
        Self { coefficients: self.coefficients.map(|coefficient| weight * coefficient), value: weight * self.value }
    }

    /// `value - coefficients . x`.
    pub fn residual(&self, x: &[f64; PARAMETERS]) -> f64 {
        self.coefficients.iter().zip(x).fold(self.value, |residual, (a, x)| residual - a * x)
    }
}

/// The triangular factor of any number of equations.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangularFactor {
    /// Upper triangle, row after row.
    entries: [f64; ENTRIES],
    /// Number of equations.
    equations: usize,
}

/// The least-squares solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    /// The minimizer; if it is not unique, the one of least norm with columns scaled to equal length.
    pub motor: Motor,
    /// Sum of squares at the minimizer.
    pub cost: f64,
    /// Rank: number of independent combinations of the parameters that the equations determine, noise apart.
    pub rank: usize,
}

impl FromIterator<Equation> for TriangularFactor {
    fn from_iter<T: IntoIterator<Item = Equation>>(equations: T) -> Self {
        let mut factor = Self { entries: [0.0; ENTRIES], equations: 0 };
        let mut block = Vec::with_capacity(BLOCK * COLUMNS);
        for equation in equations {
            block.extend(equation.coefficients);
            block.push(-equation.value);
            factor.equations += 1;
            if block.len() == BLOCK * COLUMNS {
                factor.merge_rows(&block);
                block.clear();
            }
        }
        factor.merge_rows(&block);
        factor
    }
}

impl TriangularFactor {
    /// The factor of both sets of equations.
    pub fn merge(mut self, other: &Self) -> Self {
        let rows: Vec<f64> = other.matrix().transpose().iter().copied().collect();
        self.merge_rows(&rows);
        self.equations += other.equations;
        self
    }

    /// Number of equations.
    pub fn equations(&self) -> usize {
        self.equations
    }

    /// Sum of squares at `x`.
    #[inline]
    pub fn cost(&self, x: &[f64; PARAMETERS]) -> f64 {
        let r = &self.entries;
        let [a, b, c, d] = *x;
        let e0 = r[0] * a + r[1] * b + r[2] * c + r[3] * d + r[4];
        let e1 = r[5] * b + r[6] * c + r[7] * d + r[8];
        let e2 = r[9] * c + r[10] * d + r[11];
        let e3 = r[12] * d + r[13];
        e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3 + r[14] * r[14]
    }

    /// Excess of the sum of squares at `x` over that at a minimizer `x_ls`, without cancellation.
    pub fn excess(&self, x: &[f64; PARAMETERS], x_ls: &[f64; PARAMETERS]) -> f64 {
        let (matrix, _, _) = self.parts();
        (matrix * (SVector::from(*x) - SVector::from(*x_ls))).norm_squared()
    }

    /// The minimizer.
    pub fn solve(&self) -> Solution {
        let (matrix, z, rho) = self.parts();
        // Columns are scaled to equal length: resistances and inductances differ by orders of magnitude.
        let lengths =
            SVector::<f64, PARAMETERS>::from_fn(|j, _| Some(matrix.column(j).norm()).filter(|length| *length > 0.0).unwrap_or(1.0));
        let decomposition = SingularValueDecomposition::of(DMatrix::from_fn(PARAMETERS, PARAMETERS, |i, j| matrix[(i, j)] / lengths[j]));
        let tolerance = RANK_TOLERANCE * decomposition.values[0];
        let y = decomposition.pseudo_inverse(tolerance) * -z;
        let x = SVector::<f64, PARAMETERS>::from_fn(|p, _| y[p] / lengths[p]);
        Solution {
            motor: Motor::from(<[f64; PARAMETERS]>::from(x)),
            cost: (matrix * x + z).norm_squared() + rho * rho,
            rank: decomposition.values.iter().filter(|value| **value > tolerance).count(),
        }
    }

    /// Merges rows into the factor.
    fn merge_rows(&mut self, rows: &[f64]) {
        let below = rows.len() / COLUMNS;
        if below == 0 {
            return;
        }
        let mut stacked = DMatrix::<f64>::zeros(COLUMNS + below, COLUMNS);
        stacked.rows_mut(0, COLUMNS).copy_from(&self.matrix());
        for (i, row) in rows.chunks_exact(COLUMNS).enumerate() {
            for (j, value) in row.iter().enumerate() {
                stacked[(COLUMNS + i, j)] = *value;
            }
        }
        let upper = stacked.qr().unpack_r();
        let mut entries = self.entries.iter_mut();
        for i in 0..COLUMNS {
            for j in i..COLUMNS {
                if let Some(entry) = entries.next() {
                    *entry = upper[(i, j)];
                }
            }
        }
    }

    fn matrix(&self) -> SMatrix<f64, COLUMNS, COLUMNS> {
        let mut entries = self.entries.iter();
        let mut matrix = SMatrix::zeros();
        for i in 0..COLUMNS {
            for j in i..COLUMNS {
                matrix[(i, j)] = entries.next().copied().unwrap_or(0.0);
            }
        }
        matrix
    }

    /// `R_4`, `z` and `rho`.
    fn parts(&self) -> (SMatrix<f64, PARAMETERS, PARAMETERS>, SVector<f64, PARAMETERS>, f64) {
        let matrix = self.matrix();
        (
            matrix.fixed_view::<PARAMETERS, PARAMETERS>(0, 0).into(),
            matrix.fixed_view::<PARAMETERS, 1>(0, PARAMETERS).into(),
            self.entries[ENTRIES - 1],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn equations() -> impl Strategy<Value = Vec<Equation>> {
        let equation =
            (prop::array::uniform4(-10.0..10.0f64), -10.0..10.0f64).prop_map(|(coefficients, value)| Equation { coefficients, value });
        prop::collection::vec(equation, 1..400)
    }

    proptest! {
        #[test]
        fn the_cost_of_the_factor_is_the_sum_of_squares(equations in equations(), x in prop::array::uniform4(-5.0..5.0f64)) {
            let factor: TriangularFactor = equations.iter().copied().collect();
            let direct: f64 = equations.iter().map(|equation| equation.residual(&x).powi(2)).sum();
            prop_assert!((factor.cost(&x) - direct).abs() <= 1e-12 * direct.max(1.0));
            prop_assert_eq!(factor.equations(), equations.len());
        }

        #[test]
        fn merging_gives_the_same_cost_in_any_order(one in equations(), two in equations(), x in prop::array::uniform4(-5.0..5.0f64)) {
            let [a, b]: [TriangularFactor; 2] = [&one, &two].map(|equations| equations.iter().copied().collect());
            let whole: TriangularFactor = one.iter().chain(&two).copied().collect();
            let expected = whole.cost(&x);
            for merged in [a.clone().merge(&b), b.merge(&a)] {
                prop_assert!((merged.cost(&x) - expected).abs() <= 1e-12 * expected.max(1.0));
                prop_assert_eq!(merged.equations(), whole.equations());
            }
        }

        #[test]
        fn the_solution_is_a_minimum_and_the_excess_is_exact(equations in equations(), x in prop::array::uniform4(-5.0..5.0f64)) {
            let factor: TriangularFactor = equations.into_iter().collect();
            let solution = factor.solve();
            // Solutions of nearly singular equations are so large that the rounding error exceeds the bound below: 1e-16 of 10 times
            // 1e3, times a residual of about 1e3, is 1e-9.
            prop_assume!(solution.motor.to_array().iter().all(|value| value.abs() < 1e3));
            let at_x = factor.cost(&x);
            prop_assert!(solution.cost <= at_x * (1.0 + 1e-12));
            let excess = factor.excess(&x, &solution.motor.to_array());
            prop_assert!((excess - (at_x - solution.cost)).abs() <= 1e-9 * at_x.max(1.0));
        }
    }

    #[test]
    fn exact_equations_are_solved_to_rounding() {
        // The paper's motor at two operating points; the cost at the truth is rounding error only.
        let truth = [0.958, 5.25e-3, 12e-3, 0.1827];
        let omega = 418.879;
        let rows = [(0.0, 9.9), (-2.0, 9.3)].into_iter().flat_map(|(id, iq)| [[id, 0.0, -omega * iq, 0.0], [iq, omega * id, 0.0, omega]]);
        let equations = rows.map(|coefficients| Equation { coefficients, value: coefficients.iter().zip(truth).map(|(a, x)| a * x).sum() });
        let factor: TriangularFactor = equations.collect();
        let solution = factor.solve();
        assert_eq!(solution.rank, 4);
        assert!(factor.cost(&truth) < 1e-24, "{:e}", factor.cost(&truth));
        for (found, truth) in solution.motor.to_array().iter().zip(truth) {
            assert!((found / truth - 1.0).abs() < 1e-12, "{found} {truth}");
        }
    }

    #[test]
    fn a_parameter_without_equations_is_zero_and_reduces_the_rank() {
        let rows = [([1.0, 0.0, 0.0, 2.0], 5.0), ([1.0, 0.0, 0.0, 1.0], 3.0), ([0.0, 0.0, 4.0, 0.0], 2.0)];
        let solution = rows.into_iter().map(|(coefficients, value)| Equation { coefficients, value }).collect::<TriangularFactor>().solve();
        assert_eq!(solution.rank, 3);
        let found = solution.motor.to_array();
        assert!(found.iter().zip([1.0, 0.0, 0.5, 2.0]).all(|(found, expected)| (found - expected).abs() < 1e-12), "{found:?}");
    }
}
