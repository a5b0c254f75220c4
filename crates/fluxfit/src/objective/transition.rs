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

    /// The same for a difference of two simulations: without the magnet.
    #[inline]
    pub fn difference_after(&self, i: Dq, u: Dq) -> Dq {
        let step = |[fd, fq, gd, gq, _]: [f64; ENTRIES / 2]| fd * i.d + fq * i.q + gd * u.d + gq * u.q;
        Dq { d: step(self.rows[0]), q: step(self.rows[1]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::AlphaBeta;
    use proptest::prelude::*;

    /// Equation (1) with the stator's voltage standing still, by Runge and Kutta in steps far shorter than anything moves.
    fn integrated(motor: &Motor, omega_e: f64, period: f64, start: Dq, u: Dq) -> Dq {
        let stator: AlphaBeta = u.to_alpha_beta(0.0);
        let slope = |i: Dq, t: f64| {
            let u = stator.to_dq(omega_e * (t - 0.5 * period));
            let steady = motor.steady_voltage(i, omega_e);
            Dq { d: (u.d - steady.d) / motor.ld, q: (u.q - steady.q) / motor.lq }
        };
        let steps = 50 + (400.0 * period * (omega_e.abs() + motor.rs / motor.ld.min(motor.lq))) as usize;
        let h = period / steps as f64;
        let moved = |i: Dq, k: Dq, by: f64| Dq { d: i.d + by * k.d, q: i.q + by * k.q };
        (0..steps).fold(start, |i, step| {
            let t = step as f64 * h;
            let k1 = slope(i, t);
            let k2 = slope(moved(i, k1, 0.5 * h), t + 0.5 * h);
            let k3 = slope(moved(i, k2, 0.5 * h), t + 0.5 * h);
            let k4 = slope(moved(i, k3, h), t + h);
            Dq { d: i.d + h / 6.0 * (k1.d + 2.0 * (k2.d + k3.d) + k4.d), q: i.q + h / 6.0 * (k1.q + 2.0 * (k2.q + k3.q) + k4.q) }
        })
    }

    proptest! {
        /// From a large servo to a winding that decays within the period, from standstill to 0.3 rad a period, both ways round.
        #[test]
        fn a_period_is_the_integral(rs in 1e-3..5.0, ld in 2e-5..5e-2, ratio in 0.3..4.0, psi_f in 0.0..0.5, turn in -0.3..0.3,
                                    d in -20.0..20.0, q in -20.0..20.0, ud in -200.0..200.0, uq in -200.0..200.0) {
            let (motor, period) = (Motor { rs, ld, lq: ratio * ld, psi_f }, 1e-4);
            let (start, u) = (Dq { d, q }, Dq { d: ud, q: uq });
            let found = Transition::of(&motor, turn / period, period).after(start, u);
            let expected = integrated(&motor, turn / period, period, start, u);
            let scale = 1.0 + expected.magnitude();
            prop_assert!((found.d - expected.d).hypot(found.q - expected.q) < 1e-9 * scale, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn no_inductance_is_no_number() {
        let found = Transition::of(&Motor { rs: 1.0, ld: 0.0, lq: 1e-3, psi_f: 0.1 }, 100.0, 1e-4).after(Dq::default(), Dq::default());
        assert!(found.d.is_nan());
    }
}
