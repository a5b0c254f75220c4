//! The inverter's zero-order hold, and its correction in the steady equations.
//!
//! Over a sample period the voltage vector is constant in the stator frame while the rotor turns by `omega_e T_s`; and a current
//! sampled at the end of a period is not the period's mean. With `x = omega_e T_s / 2`, `sinc x = sin(x)/x` and `u` the vector in the
//! frame at the middle of its period, the flux at the end of the period is known exactly if resistance is neglected: in the stator
//! frame it changes by `u T_s`, in the rotor frame it is the same after each period, so
//!
//! ```text
//! u_d / sinc(x) = R_s ī_d - omega_e L_q i_q
//! u_q / sinc(x) = R_s ī_q + omega_e (L_d i_d + psi_f)
//! ```
//!
//! with the sampled currents in the fluxes. The current in the resistive drop is the period's mean, here to the order `x²` and to the
//! first order of `R_s T_s / L`:
//!
//! ```text
//! ī_d = i_d - omega_e u_q T_s² / (12 L_d),     ī_q = i_q + omega_e u_d T_s² / (12 L_q)
//! ```
//!
//! The inductances enter only this small part of the resistive drop, so a rough estimate of them is enough.
//!
//! A *centred* column, the mean of the two periods around the row in the frame at the row, is that vector times `cos x`.

use crate::{frames::Dq, objective::acting_voltage::VoltageTiming};

/// What `ud, uq` of a row mean, as far as it matters in the steady state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SteadyVoltageTiming {
    /// The mean of the two periods around the row, in the frame at the row.
    Centered,
    /// The vector that acts over one period, in the frame at the middle of that period. Its delay does not matter in the steady state.
    Compensated,
}

impl From<VoltageTiming> for SteadyVoltageTiming {
    fn from(timing: VoltageTiming) -> Self {
        match timing {
            VoltageTiming::Centered => Self::Centered,
            VoltageTiming::Delayed { .. }
            | VoltageTiming::Ended
            | VoltageTiming::MidPeriod { .. }
            | VoltageTiming::Averaged { .. }
            | VoltageTiming::Euler { .. } => Self::Compensated,
        }
    }
}

/// Largest angle per sample, rad, at which the log's period is taken for the inverter's. Logs beyond it are decimated or filtered, and
/// the inverter's period is unknown.
pub const MAX_ANGLE_PER_SAMPLE: f64 = 0.25;

/// Largest `R_s T_s / L` at which the mean current is corrected: the expansion holds for small values only, and no inverter controls
/// a current with a period that long compared with the winding's time constant.
pub const MAX_DECAY_PER_SAMPLE: f64 = 0.25;

/// The zero-order-hold correction of one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZeroOrderHold {
    /// What the voltage columns mean.
    pub timing: SteadyVoltageTiming,
    /// Sample period, s; with zero nothing is corrected.
    pub sample_period: f64,
    /// Inductances that determine the current ripple within a period, H, d and q. Infinite where unknown: the current is then not
    /// corrected.
    pub inductance: Dq,
}

impl ZeroOrderHold {
    /// No correction.
    pub const NONE: Self =
        Self { timing: SteadyVoltageTiming::Compensated, sample_period: 0.0, inductance: Dq { d: f64::INFINITY, q: f64::INFINITY } };

    /// The voltage that satisfies the steady equations, V, and the current's mean over a period, A, for the resistive drop; `omega_e` in
    /// electrical rad/s.
    pub fn correct(&self, u: Dq, i: Dq, omega_e: f64) -> (Dq, Dq) {
        let x = 0.5 * omega_e * self.sample_period;
        let sinc = if x == 0.0 { 1.0 } else { x.sin() / x };
        let factor = match self.timing {
            SteadyVoltageTiming::Centered => 1.0 / (sinc * x.cos()),
            SteadyVoltageTiming::Compensated => 1.0 / sinc,
        };
        let ripple = omega_e * self.sample_period * self.sample_period / 12.0;
        let mean = Dq { d: i.d - u.q * ripple / self.inductance.d, q: i.q + u.d * ripple / self.inductance.q };
        (Dq { d: factor * u.d, q: factor * u.q }, mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

    /// Equation (1) in the dq frame over one period, by Runge and Kutta: the voltage is constant in the stator frame, and `u` in the
    /// frame at the middle of the period.
    fn after_one_period(start: Dq, u: Dq, psi_f: f64, omega_e: f64, period: f64) -> Dq {
        const STEPS: usize = 200;
        let slope = |i: Dq, t: f64| {
            let (sin, cos) = (omega_e * t).sin_cos();
            let (ud, uq) = (cos * u.d + sin * u.q, cos * u.q - sin * u.d);
            Dq {
                d: (ud - MOTOR.rs * i.d + omega_e * MOTOR.lq * i.q) / MOTOR.ld,
                q: (uq - MOTOR.rs * i.q - omega_e * (MOTOR.ld * i.d + psi_f)) / MOTOR.lq,
            }
        };
        let h = period / STEPS as f64;
        let (mut i, mut t) = (start, -0.5 * period);
        for _ in 0..STEPS {
            let moved = |k: Dq, by: f64| Dq { d: i.d + by * k.d, q: i.q + by * k.q };
            let k1 = slope(i, t);
            let k2 = slope(moved(k1, 0.5 * h), t + 0.5 * h);
            let k3 = slope(moved(k2, 0.5 * h), t + 0.5 * h);
            let k4 = slope(moved(k3, h), t + h);
            i = Dq { d: i.d + h / 6.0 * (k1.d + 2.0 * (k2.d + k3.d) + k4.d), q: i.q + h / 6.0 * (k1.q + 2.0 * (k2.q + k3.q) + k4.q) };
            t += h;
        }
        i
    }

    /// The voltage after which the current has its initial value again: the final current is linear in initial current, voltage and
    /// magnet flux.
    fn periodic_voltage(i: Dq, omega_e: f64, period: f64) -> Dq {
        let end = |i: Dq, u: Dq, psi_f: f64| after_one_period(i, u, psi_f, omega_e, period);
        let none = Dq { d: 0.0, q: 0.0 };
        let free = end(i, none, MOTOR.psi_f);
        let (by_d, by_q) = (end(none, Dq { d: 1.0, q: 0.0 }, 0.0), end(none, Dq { d: 0.0, q: 1.0 }, 0.0));
        let (d, q) = (i.d - free.d, i.q - free.q);
        let determinant = by_d.d * by_q.q - by_q.d * by_d.q;
        Dq { d: (d * by_q.q - q * by_q.d) / determinant, q: (by_d.d * q - by_d.q * d) / determinant }
    }

    /// Residual of equation (2) as a fraction of the voltage, with `mean` in the resistive drop and `sampled` in the fluxes.
    fn error(u: Dq, mean: Dq, sampled: Dq, omega_e: f64) -> f64 {
        let flux = Motor { rs: 0.0, ..MOTOR }.steady_voltage(sampled, omega_e);
        (u.d - MOTOR.rs * mean.d - flux.d).hypot(u.q - MOTOR.rs * mean.q - flux.q) / u.magnitude()
    }

    #[test]
    fn corrected_rows_satisfy_the_steady_equations_and_logged_rows_do_not() {
        let period = 1e-4;
        for (angle, i) in
            [(0.04, Dq { d: -2.0, q: 8.5 }), (0.1, Dq { d: -2.0, q: 8.5 }), (0.1, Dq { d: 3.0, q: -9.0 }), (-0.1, Dq { d: -6.0, q: 4.0 })]
        {
            let omega_e: f64 = angle / period;
            let u = periodic_voltage(i, omega_e, period);
            let cos = (0.5 * angle).cos();
            let logged = [(SteadyVoltageTiming::Compensated, u), (SteadyVoltageTiming::Centered, Dq { d: cos * u.d, q: cos * u.q })];
            for (timing, logged) in logged {
                let hold = ZeroOrderHold { timing, sample_period: period, inductance: Dq { d: MOTOR.ld, q: MOTOR.lq } };
                let (corrected, mean) = hold.correct(logged, i, omega_e);
                let (before, after) = (error(logged, i, i, omega_e), error(corrected, mean, i, omega_e));
                // Uncorrected: x²/6, or x²/3 when centred. Corrected: x² times R_s T_s / L, a few percent, squared, and x to the fourth.
                let x2 = (0.5 * angle).powi(2);
                assert!(before > 0.1 * x2, "{timing:?} {angle}: {before:e}");
                assert!(after < 2e-3 * x2, "{timing:?} {angle}: {after:e} of {x2:e}");
            }
        }
    }

    /// The flux does not depend on the inductances: with wrong ones, only the small correction of the resistive drop is wrong.
    #[test]
    fn a_rough_inductance_hardly_matters() {
        let (period, omega_e, i) = (1e-4, 1000.0, Dq { d: -2.0, q: 8.5 });
        let u = periodic_voltage(i, omega_e, period);
        for factor in [0.5, 2.0, f64::INFINITY] {
            let inductance = Dq { d: factor * MOTOR.ld, q: factor * MOTOR.lq };
            let hold = ZeroOrderHold { timing: SteadyVoltageTiming::Compensated, sample_period: period, inductance };
            let (corrected, mean) = hold.correct(u, i, omega_e);
            // At most R_s T_s / L times omega T_s / 12: the whole correction.
            let term = MOTOR.rs * period / MOTOR.ld * omega_e * period / 12.0;
            assert!(error(corrected, mean, i, omega_e) < term, "{factor}");
        }
    }

    #[test]
    fn none_corrects_nothing() {
        let (u, i) = (Dq { d: -20.0, q: 70.0 }, Dq { d: -2.0, q: 8.5 });
        assert_eq!(ZeroOrderHold::NONE.correct(u, i, 400.0), (u, i));
    }
}
