//! Linear least squares in square-root form: the upper triangular factor `R` of the rows seen so far and `d = Q' y`, updated row by row
//! with Givens rotations (Gentleman 1973, doi 10.1093/imamat/12.3.329). The covariance `s² R^-1 R^-T` cannot become indefinite.

use crate::{PARAMETERS, real::Real};

/// A linear equation `phi' z = y`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Row<T> {
    /// Coefficients of rs, ld, lq and psi_f, or of their scaled values.
    pub phi: [T; PARAMETERS],
    /// The right side.
    pub y: T,
}

/// The factor of all rows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SquareRoot<T> {
    /// Upper triangle; the diagonal is zero or more.
    pub r: [[T; PARAMETERS]; PARAMETERS],
    /// The right side.
    pub d: [T; PARAMETERS],
}

impl<T: Real> SquareRoot<T> {
    /// The factor of the equations `weight (z_j - 1) = 0`.
    pub fn new(weight: T) -> Self {
        let mut r = [[T::ZERO; PARAMETERS]; PARAMETERS];
        (0..PARAMETERS).for_each(|j| r[j][j] = weight);
        Self { r, d: [weight; PARAMETERS] }
    }

    /// Multiplies the weight of all rows so far: with a number below one they are forgotten.
    pub fn weigh(&mut self, factor: T) {
        let root = factor.sqrt();
        for (row, d) in self.r.iter_mut().zip(&mut self.d) {
            row.iter_mut().for_each(|value| *value = *value * root);
            *d = *d * root;
        }
    }

    /// Adds an equation.
    pub fn add(&mut self, row: &Row<T>) {
        let Row { mut phi, mut y } = *row;
        for j in 0..PARAMETERS {
            if phi[j] == T::ZERO {
                continue;
            }
            let h = (self.r[j][j] * self.r[j][j] + phi[j] * phi[j]).sqrt();
            let (cos, sin) = (self.r[j][j] / h, phi[j] / h);
            for k in j..PARAMETERS {
                let (up, own) = (self.r[j][k], phi[k]);
                self.r[j][k] = cos * up + sin * own;
                phi[k] = cos * own - sin * up;
            }
            let up = self.d[j];
            self.d[j] = cos * up + sin * y;
            y = cos * y - sin * up;
        }
    }

    /// The solution `z`. A direction of which no row tells anything stays at zero.
    pub fn solve(&self) -> [T; PARAMETERS] {
        let mut z = [T::ZERO; PARAMETERS];
        for j in (0..PARAMETERS).rev() {
            let rest = (j + 1..PARAMETERS).fold(self.d[j], |rest, k| rest - self.r[j][k] * z[k]);
            z[j] = if self.r[j][j] > T::ZERO { rest / self.r[j][j] } else { T::ZERO };
        }
        z
    }

    /// `R^-1`, upper triangular; a row without information gives zeros there, which a start weight above zero prevents.
    pub fn inverse(&self) -> [[T; PARAMETERS]; PARAMETERS] {
        let mut inverse = [[T::ZERO; PARAMETERS]; PARAMETERS];
        for column in 0..PARAMETERS {
            for j in (0..=column).rev() {
                let unit = if j == column { T::ONE } else { T::ZERO };
                let rest = (j + 1..=column).fold(unit, |rest, k| rest - self.r[j][k] * inverse[k][column]);
                inverse[j][column] = if self.r[j][j] > T::ZERO { rest / self.r[j][j] } else { T::ZERO };
            }
        }
        inverse
    }

    /// `phi' (R'R)^-1 phi`: how much an equation would add, with what is known so far.
    pub fn leverage(&self, phi: &[T; PARAMETERS]) -> T {
        let inverse = self.inverse();
        (0..PARAMETERS).fold(T::ZERO, |sum, column| {
            let w = (0..=column).fold(T::ZERO, |w, j| w + inverse[j][column] * phi[j]);
            sum + w * w
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three exact equations and a redundant one: the solution by hand is (1, -2, 3, 0.5).
    #[test]
    fn exact_equations_are_solved() {
        let rows = [
            ([2.0, 1.0, 0.0, 4.0], 2.0),
            ([0.0, 1.0, 1.0, 2.0], 2.0),
            ([1.0, 0.0, 1.0, 0.0], 4.0),
            ([1.0, 1.0, 1.0, 2.0], 3.0),
            ([3.0, 0.0, 0.0, -2.0], 2.0),
        ];
        let mut root = SquareRoot::<f64>::new(0.0);
        rows.iter().for_each(|(phi, y)| root.add(&Row { phi: *phi, y: *y }));
        let z = root.solve();
        assert!(z.iter().zip([1.0, -2.0, 3.0, 0.5]).all(|(z, expected)| (z - expected).abs() < 1e-12), "{z:?}");
    }

    /// For one unknown that is measured n times, the variance is 1/n.
    #[test]
    fn the_inverse_is_that_of_the_factor() {
        let mut root = SquareRoot::<f64>::new(1e-9);
        (0..25).for_each(|_| root.add(&Row { phi: [0.0, 2.0, 0.0, 0.0], y: 6.0 }));
        assert!((root.inverse()[1][1] - 0.1).abs() < 1e-9 && (root.solve()[1] - 3.0).abs() < 1e-9);
        assert!((root.leverage(&[0.0, 1.0, 0.0, 0.0]) - 0.01).abs() < 1e-9);
    }
}
