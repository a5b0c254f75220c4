//! A block of sample periods as two equations that are linear in the parameters.
//!
//! The mean of the voltage equations over a block is exact; what it needs of the current within a period is its mean, here to third
//! order in the period (the term with 12), and of the derivative only the difference between the ends of the block:
//!
//! ```text
//! d row: rs mean(i_d) + ld (i_d,end - i_d,start)/time - lq mean(omega i_q)         = mean(u_d)
//! q row: rs mean(i_q) + ld mean(omega i_d) + lq (i_q,end - i_q,start)/time + psi_f mean(omega) = mean(u_q)
//! ```
//!
//! The currents are measured, so their noise is in the coefficients too and biases the solution (Söderström 2007, doi
//! 10.1016/j.automatica.2006.11.025): by the derivative, as one over the squared number of periods. Blocks of 50 periods leave 0.1 %
//! where single periods are off by half.

use crate::{PARAMETERS, period::Period, real::Real, square_root::Row};

/// A block that is being filled.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Block<T> {
    /// Periods of a full block.
    wanted: u32,
    /// Periods so far.
    count: u32,
    /// Current at the beginning, A.
    start: [T; 2],
    /// Current at the end of the last period, A.
    last: [T; 2],
    /// Sums of mean current, A.
    i: [T; 2],
    /// Sums of speed times mean current.
    omega_i: [T; 2],
    /// Sum of speeds.
    omega: T,
    /// Sums of mean voltage, V.
    u: [T; 2],
    /// Sum of lengths, s.
    time: T,
}

/// The equations of a full block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equations<T> {
    /// Of the axes d and q; the coefficients are those of the scaled parameters, right sides in V.
    pub rows: [Row<T>; 2],
    /// By how much a variance of 1 A² of each current sample adds to the squared coefficients of both rows together, on the average.
    pub by_noise: [T; PARAMETERS],
    /// Mean current along d, A.
    pub id: T,
    /// Largest current in magnitude at the ends, A.
    pub current: T,
    /// Mean speed, electrical rad/s.
    pub omega_e: T,
    /// Squared mean voltage vector, V².
    pub voltage_squared: T,
}

impl<T: Real> Block<T> {
    /// A block of so many periods, at least one, from a measured current on.
    pub fn new(periods: u32, start: [T; 2]) -> Self {
        let zero = [T::ZERO; 2];
        Self {
            wanted: if periods == 0 { 1 } else { periods },
            count: 0,
            start,
            last: start,
            i: zero,
            omega_i: zero,
            omega: T::ZERO,
            u: zero,
            time: T::ZERO,
        }
    }

    /// Adds a period with the current measured at its end; the equations, if the block is full, with coefficients for parameters as parts
    /// of `nominal`. The next block then begins.
    pub fn add(&mut self, period: &Period<T>, end: [T; 2], nominal: &[T; PARAMETERS]) -> Option<Equations<T>> {
        let (omega, length, half) = (period.omega_e, period.length, T::of(0.5));
        let x = half * omega * length;
        let x_squared = x * x;
        // sin(x)/x: the mean of a vector that turns by 2 x.
        let sinc = T::ONE - x_squared * (T::of(1.0 / 6.0) - x_squared * T::of(1.0 / 120.0));
        let u = [period.u[0] * sinc, period.u[1] * sinc];
        let bow = omega * length * length * T::of(1.0 / 12.0);
        let i = [half * (self.last[0] + end[0]) - bow * u[1] / nominal[1], half * (self.last[1] + end[1]) + bow * u[0] / nominal[2]];
        for c in 0..2 {
            self.i[c] += i[c];
            self.omega_i[c] += omega * i[c];
            self.u[c] += u[c];
        }
        self.omega += omega;
        self.time += length;
        self.last = end;
        self.count += 1;
        if self.count < self.wanted {
            return None;
        }
        let equations = self.equations(nominal);
        *self = Self::new(self.wanted, end);
        Some(equations)
    }

    fn equations(&self, nominal: &[T; PARAMETERS]) -> Equations<T> {
        let [rs, ld, lq, psi_f] = *nominal;
        let part = T::ONE / T::of(f64::from(self.count));
        let per_second = T::ONE / self.time;
        let slope = [(self.last[0] - self.start[0]) * per_second, (self.last[1] - self.start[1]) * per_second];
        let (omega, u) = (self.omega * part, [self.u[0] * part, self.u[1] * part]);
        let d = Row { phi: [rs * self.i[0] * part, ld * slope[0], -(lq * self.omega_i[1] * part), T::ZERO], y: u[0] };
        let q = Row { phi: [rs * self.i[1] * part, ld * self.omega_i[0] * part, lq * slope[1], psi_f * omega], y: u[1] };
        // A mean of n samples has the variance 1/n, a difference of two samples 2.
        let (of_mean, of_slope) = (part, T::of(2.0) * per_second * per_second);
        let inductive = of_slope + omega * omega * of_mean;
        Equations {
            rows: [d, q],
            by_noise: [T::of(2.0) * of_mean * rs * rs, inductive * ld * ld, inductive * lq * lq, T::ZERO],
            id: self.i[0] * part,
            current: (self.last[0] * self.last[0] + self.last[1] * self.last[1]).sqrt(),
            omega_e: omega,
            voltage_squared: u[0] * u[0] + u[1] * u[1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::period::current_after;

    /// The exact currents of a known motor satisfy the equations of each block with its parameters.
    #[test]
    fn exact_currents_satisfy_the_equations() {
        let theta = [0.958, 5.25e-3, 12e-3, 0.1827];
        let mut i = [0.0, 5.0];
        let mut block = Block::<f64>::new(50, i);
        let mut seen = 0;
        for k in 0..500 {
            let omega_e = 419.0 + 0.1 * f64::from(k % 100);
            let u = [-40.0 + f64::from(k % 7), 80.0 - f64::from(k % 11)];
            let period = Period { u, omega_e, length: 1e-4 };
            i = current_after(&theta, i, &period);
            if let Some(equations) = block.add(&period, i, &theta) {
                seen += 1;
                for Row { phi, y } in equations.rows {
                    // Left out of the mean current: Ts²/12 |A| |di/dt| with |A| = 1200 1/s and, over a block, 1000 A/s; it acts on 5 ohm.
                    assert!((phi.iter().sum::<f64>() - y).abs() < 1e-8 / 12.0 * 1200.0 * 1000.0 * 5.0, "{phi:?} {y}");
                }
            }
        }
        assert_eq!(seen, 10);
    }
}
