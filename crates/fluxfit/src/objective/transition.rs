//! What one period does to the current: equation (1), integrated exactly over a period at constant speed in which the voltage
//! vector stands still in the stator.
//!
//! Seen from the rotor the vector turns backward, `du/dt = -j omega_e u`, so current, voltage and magnet together obey one linear equation
//! with constant coefficients, and the matrix exponential of its 5 by 5 matrix is the period:
//!
//! ```text
//! i(t + T) = F i(t) + G u + h          u in the frame at the middle of the period
//! ```
//!
//! The exponential is exact however stiff the winding is (R_s T / L large) and however far the rotor turns.

use crate::{frames::Dq, motor::Motor};
use nalgebra::{Matrix5, SMatrix};

/// Numbers of a transition.
const ENTRIES: usize = 10;

/// One period: `i' = F i + G u + h`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    /// Rows of `[F G h]`: for i_d, for i_q.
    rows: [[f64; ENTRIES / 2]; 2],
}

impl Transition {
    /// The period of `period` seconds at `omega_e` electrical rad/s. Not finite where the motor has no inductance.
    pub fn of(motor: &Motor, omega_e: f64, period: f64) -> Self {
        let Motor { rs, ld, lq, psi_f } = *motor;
        #[rustfmt::skip]
        let rates = Matrix5::new(
            -rs / ld,            omega_e * lq / ld,   1.0 / ld, 0.0,      0.0,
            -omega_e * ld / lq, -rs / lq,             0.0,      1.0 / lq, -omega_e * psi_f / lq,
            0.0,                 0.0,                 0.0,      omega_e,  0.0,
            0.0,                 0.0,                -omega_e,  0.0,      0.0,
            0.0,                 0.0,                 0.0,      0.0,      0.0,
        );
        let whole: SMatrix<f64, 5, 5> = if rates.iter().all(|rate| rate.is_finite()) { (rates * period).exp() } else { rates * f64::NAN };
        // The voltage at the period's start is the middle's, half a turn ahead.
        let (sin, cos) = (0.5 * omega_e * period).sin_cos();
        let row = |row: usize| {
            let (d, q) = (whole[(row, 2)], whole[(row, 3)]);
            [whole[(row, 0)], whole[(row, 1)], cos * d + sin * q, cos * q - sin * d, whole[(row, 4)]]
        };
        Self { rows: [row(0), row(1)] }
    }

    /// The current, A, after a period that begins with `i` and in which `u`, V, acts.
    #[inline]
    pub fn after(&self, i: Dq, u: Dq) -> Dq {
        let step = |[fd, fq, gd, gq, h]: [f64; ENTRIES / 2]| fd * i.d + fq * i.q + gd * u.d + gq * u.q + h;
        Dq { d: step(self.rows[0]), q: step(self.rows[1]) }
    }

    /// The same for a difference of two courses: without the magnet.
    #[inline]
    pub fn difference_after(&self, i: Dq, u: Dq) -> Dq {
        let step = |[fd, fq, gd, gq, _]: [f64; ENTRIES / 2]| fd * i.d + fq * i.q + gd * u.d + gq * u.q;
        Dq { d: step(self.rows[0]), q: step(self.rows[1]) }
    }
}

impl Transition {
    /// A weighted sum of transitions.
    #[inline]
    pub(super) fn blend(nodes: &[Self], weights: &[f64]) -> Self {
        let mut rows = [[0.0; ENTRIES / 2]; 2];
        for (node, weight) in nodes.iter().zip(weights) {
            for (row, other) in rows.iter_mut().zip(&node.rows) {
                row.iter_mut().zip(other).for_each(|(entry, value)| *entry += weight * value);
            }
        }
        Self { rows }
    }
}
