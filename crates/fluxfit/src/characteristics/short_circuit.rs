//! Terminals shorted: equation (2) without voltage, in the steady state,
//!
//! ```text
//! i_d = -Omega² p L_q p psi_f / D,     i_q = -Omega R_s p psi_f / D,     D = R_s² + Omega² p L_d p L_q
//! torque = 3/2 (p psi_f i_q + (p L_d - p L_q) i_d i_q)
//! ```
//!
//! At low speed the current tells `p psi_f / R_s`, at high speed `psi_f / L_d`, in between `R_s² / (L_d L_q)`; torque or a voltage tells
//! the rest.

use super::machine::Machine;
use crate::frames::Dq;

/// Current and torque against speed.
#[derive(Debug, Clone, PartialEq)]
pub struct ShortCircuit {
    /// Speeds in any order.
    pub rows: Vec<ShortCircuitRow>,
}

/// A speed, its current and its torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShortCircuitRow {
    /// Mechanical rad/s, not zero.
    pub speed: f64,
    /// Of a phase, rms, A; of three the mean.
    pub current: f64,
    /// Standard error of the current by what the phases differ in, A; zero where one phase was measured.
    pub current_error: f64,
    /// At the shaft, N m, of either sign.
    pub torque: Option<f64>,
}

impl ShortCircuitRow {
    /// The steady current in the dq frame, A, peak.
    fn dq_current(&self, machine: &Machine) -> Dq {
        let Machine { rs, p_ld, p_lq, p_psi_f } = *machine;
        let speed = self.speed.abs();
        let denominator = rs * rs + speed * speed * p_ld * p_lq;
        Dq { d: -speed * speed * p_lq * p_psi_f / denominator, q: -speed * rs * p_psi_f / denominator }
    }

    pub(super) fn current_of(&self, machine: &Machine) -> f64 {
        self.dq_current(machine).magnitude() / 2.0_f64.sqrt()
    }

    /// Braking torque, N m, positive.
    pub(super) fn torque_of(&self, machine: &Machine) -> f64 {
        let Dq { d, q } = self.dq_current(machine);
        -1.5 * (machine.p_psi_f * q + (machine.p_ld - machine.p_lq) * d * q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    /// The currents leave equation (2) without voltage, and the power of the shaft heats the winding.
    #[test]
    fn no_voltage_is_left_and_no_power() {
        let machine = Machine { rs: 7e-3, p_ld: 0.45e-3, p_lq: 1.15e-3, p_psi_f: 0.25 };
        let motor = Motor { rs: 7e-3, ld: 0.45e-3, lq: 1.15e-3, psi_f: 0.25 };
        for speed in [5.0, 40.0, 900.0] {
            let row = ShortCircuitRow { speed, current: 0.0, current_error: 0.0, torque: None };
            let current = row.dq_current(&machine);
            let voltage = motor.steady_voltage(current, speed);
            assert!(voltage.magnitude() < 1e-12 * speed, "{voltage:?}");
            let heat = 3.0 * machine.rs * row.current_of(&machine).powi(2);
            assert!((row.torque_of(&machine) * speed / heat - 1.0).abs() < 1e-12);
        }
    }
}
