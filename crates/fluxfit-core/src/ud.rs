//! A covariance `P = U D U'` with unit upper triangular `U` and diagonal `D` (Bierman and Thornton 1977, doi
//! 10.1016/0005-1098(77)90006-1). It stays positive whatever the rounding.

use crate::{PARAMETERS, real::Number};

/// States: i_d, i_q and the four parameters.
pub const STATES: usize = 6;

/// The factors.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ud<T> {
    u: [[T; STATES]; STATES],
    d: [T; STATES],
}

impl<T: Number> Ud<T> {
    /// Independent states with these variances.
    #[inline(always)]
    pub fn new(d: [T; STATES]) -> Self {
        let mut u = [[T::ZERO; STATES]; STATES];
        (0..STATES).for_each(|j| u[j][j] = T::ONE);
        Self { u, d }
    }

    /// Calls `with` for each number that may change and that of another covariance.
    #[inline(always)]
    pub(crate) fn with<U>(&mut self, other: &mut Ud<U>, with: impl Fn(&mut T, &mut U)) {
        for j in 0..STATES {
            with(&mut self.d[j], &mut other.d[j]);
            for i in 0..j {
                with(&mut self.u[i][j], &mut other.u[i][j]);
            }
        }
    }

    /// Makes the last states, the parameters, have the covariance `W W'` with an upper triangular `W`, independent of the first two.
    pub fn set_parameters(&mut self, w: &[[T; PARAMETERS]; PARAMETERS]) {
        let first = STATES - PARAMETERS;
        for j in 0..PARAMETERS {
            let own = w[j][j];
            self.d[first + j] = own * own;
            for i in 0..j {
                // Where the diagonal is zero, the whole column is.
                self.u[first + i][first + j] = own.abs().if_above(T::ZERO, w[i][j] / own, T::ZERO);
            }
        }
        for i in 0..first {
            (first..STATES).for_each(|j| self.u[i][j] = T::ZERO);
        }
    }

    /// Makes the first `count` states independent of all others, with this variance.
    pub fn forget_first(&mut self, count: usize, variance: T) {
        for i in 0..count {
            (i + 1..STATES).for_each(|j| self.u[i][j] = T::ZERO);
            self.d[i] = variance;
        }
    }

    /// Adds `v v'` to the covariance (Agee and Turner 1972, as in Bierman 1977, section III.3).
    #[inline(always)]
    pub fn add(&mut self, v: &[T; STATES]) {
        let (mut v, mut weight) = (*v, T::ONE);
        for j in (0..STATES).rev() {
            let (own, before) = (v[j], self.d[j]);
            let sum = before + weight * own * own;
            self.d[j] = sum;
            // Of a state that is exact before and after, `own` is zero, and nothing changes.
            let divisor = sum.if_above(T::ZERO, sum, T::ONE);
            for i in 0..j {
                v[i] -= own * self.u[i][j];
                self.u[i][j] += weight * own * v[i] / divisor;
            }
            weight = sum.if_above(T::ZERO, weight * before / divisor, weight);
        }
    }

    /// Variance of one state.
    #[inline(always)]
    pub fn variance(&self, state: usize) -> T {
        (state..STATES).fold(T::ZERO, |sum, k| sum + self.u[state][k] * self.u[state][k] * self.d[k])
    }

    /// The covariance after the states moved on: `Phi P Phi' + diag(q)`, where `Phi` is the identity but for its first two rows.
    ///
    /// Weighted Gram-Schmidt orthogonalization of the rows of `[Phi U | I]` with the weights `(D, q)` (Thornton).
    #[inline(always)]
    pub fn propagate(&mut self, phi: &[[T; STATES]; 2], q: &[T; STATES]) {
        let mut w = self.u;
        for (row, phi) in w.iter_mut().zip(phi) {
            for (k, value) in row.iter_mut().enumerate() {
                *value = (0..=k).fold(T::ZERO, |sum, m| sum + phi[m] * self.u[m][k]);
            }
        }
        let d = self.d;
        // The second half of the rows, where only those of states with noise matter.
        let mut noise = Self::new(d).u;
        for j in (0..STATES).rev() {
            let (own, own_noise) = (w[j], noise[j]);
            // Left of the diagonal both are zero, but the first two rows of `Phi U`.
            let first = if j < 2 { 0 } else { j };
            let mut weighted = [T::ZERO; STATES];
            let mut weighted_noise = [T::ZERO; STATES];
            let mut sum = T::ZERO;
            for k in first..STATES {
                weighted[k] = d[k] * own[k];
                sum += weighted[k] * own[k];
            }
            for k in j..STATES {
                weighted_noise[k] = q[k] * own_noise[k];
                sum += weighted_noise[k] * own_noise[k];
            }
            self.d[j] = sum;
            // A state without variance is exact, and independent of all others.
            let per_sum = sum.if_above(T::ZERO, T::ONE / sum, T::ZERO);
            for i in 0..j {
                let mut product = T::ZERO;
                for k in first..STATES {
                    product += w[i][k] * weighted[k];
                }
                for k in j..STATES {
                    product += noise[i][k] * weighted_noise[k];
                }
                let factor = product * per_sum;
                self.u[i][j] = factor;
                for k in first..STATES {
                    w[i][k] -= factor * own[k];
                }
                for k in j..STATES {
                    noise[i][k] -= factor * own_noise[k];
                }
            }
        }
    }

    /// The covariance after one state was measured with noise of this variance, above zero. Returns the gain times the innovation's
    /// variance, and that variance (Bierman).
    #[inline(always)]
    pub fn measure(&mut self, state: usize, variance: T) -> ([T; STATES], T) {
        let mut gain = [T::ZERO; STATES];
        let mut alpha = variance;
        for j in state..STATES {
            let f = self.u[state][j];
            let v = self.d[j] * f;
            let beta = alpha;
            alpha += f * v;
            self.d[j] = self.d[j] * beta / alpha;
            let lambda = -(f / beta);
            gain[j] = v;
            for i in 0..j {
                let before = self.u[i][j];
                self.u[i][j] = before + lambda * gain[i];
                gain[i] += before * v;
            }
        }
        (gain, alpha)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Matrix = [[f64; STATES]; STATES];

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        core::array::from_fn(|i| core::array::from_fn(|j| (0..STATES).map(|k| a[i][k] * b[k][j]).sum()))
    }

    fn transposed(a: &Matrix) -> Matrix {
        core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
    }

    fn covariance(ud: &Ud<f64>) -> Matrix {
        let scaled: Matrix = core::array::from_fn(|i| core::array::from_fn(|j| ud.u[i][j] * ud.d[j]));
        product(&scaled, &transposed(&ud.u))
    }

    fn close(a: &Matrix, b: &Matrix) -> bool {
        a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-9)
    }

    /// Both updates against the textbook's, on full matrices.
    #[test]
    fn the_updates_are_those_of_the_full_covariance() {
        let mut ud = Ud::<f64>::new([0.3, 0.2, 0.5, 0.1, 0.0, 0.7]);
        let q = [0.01, 0.02, 0.0, 0.03, 0.0, 0.001];
        let phi = [[0.98, 0.03, 0.4, -0.2, 0.1, 0.6], [-0.05, 0.97, 0.1, 0.3, -0.7, 0.2]];
        let mut whole: Matrix = core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))));
        whole[0] = phi[0];
        whole[1] = phi[1];
        for round in 0..5 {
            let mut expected = product(&product(&whole, &covariance(&ud)), &transposed(&whole));
            (0..STATES).for_each(|j| expected[j][j] += q[j]);
            ud.propagate(&phi, &q);
            assert!(close(&covariance(&ud), &expected), "{round}");
            for state in 0..2 {
                let p = covariance(&ud);
                let s = p[state][state] + 0.05;
                let (gain, alpha) = ud.measure(state, 0.05);
                assert!((alpha - s).abs() < 1e-12 && (0..STATES).all(|j| (gain[j] - p[j][state]).abs() < 1e-12));
                let expected: Matrix = core::array::from_fn(|i| core::array::from_fn(|j| p[i][j] - p[i][state] * p[state][j] / s));
                assert!(close(&covariance(&ud), &expected), "{round} {state}");
            }
        }
        let v = [0.3, -0.2, 0.5, 0.0, 0.0, 0.7];
        let before = covariance(&ud);
        let mut wider = ud;
        wider.add(&v);
        let expected: Matrix = core::array::from_fn(|i| core::array::from_fn(|j| before[i][j] + v[i] * v[j]));
        assert!(close(&covariance(&wider), &expected) && wider.variance(4) == 0.0);
        let mut set = ud;
        set.set_parameters(&[[1.0, 0.5, 0.25, 2.0], [0.0, 2.0, 0.0, 1.0], [0.0, 0.0, 3.0, 0.5], [0.0, 0.0, 0.0, 4.0]]);
        let p = covariance(&set);
        // By hand: 1 + 1/4 + 1/16 + 4, 1 + 2, 8.
        assert!((p[2][2] - 5.3125).abs() < 1e-12 && (p[2][3] - 3.0).abs() < 1e-12 && (p[2][5] - 8.0).abs() < 1e-12 && p[0][2] == 0.0);
        // The state without variance or noise stays exact.
        assert_eq!(ud.variance(4), 0.0);
        ud.forget_first(2, 4.0);
        let p = covariance(&ud);
        assert!((p[0][0] - 4.0).abs() < 1e-12 && p[0][3] == 0.0 && p[1][1] == ud.variance(1));
    }
}
