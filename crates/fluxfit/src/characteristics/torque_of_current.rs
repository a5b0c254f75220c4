//! Torque against the current, as a dynamometer measures it of a driven or held motor,
//!
//! ```text
//! torque = 3/2 (p psi_f i_q + s i_d i_q) + c
//! ```
//!
//! `s` is `p L_d - p L_q` at these currents, which saturation makes another number than that of a short circuit; `c` is what the bench
//! itself takes, and the sensor's zero. Both are fitted beside the flux, `s` where i_d is not zero.

use super::machine::Machine;
use crate::frames::Dq;

/// Torque against current.
#[derive(Debug, Clone, PartialEq)]
pub struct TorqueOfCurrent {
    /// Currents in any order.
    pub rows: Vec<TorqueOfCurrentRow>,
}

/// A current and its torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueOfCurrentRow {
    /// A, peak.
    pub current: Dq,
    /// At the shaft, N m, with the sign that makes it grow with i_q.
    pub torque: f64,
}

impl TorqueOfCurrentRow {
    /// N m, without what the bench takes.
    pub(super) fn torque_of(&self, machine: &Machine, saliency: f64) -> f64 {
        1.5 * (machine.p_psi_f * self.current.q + saliency * self.current.d * self.current.q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    #[test]
    fn torque_is_that_of_the_motor() {
        let motor = Motor { rs: 0.1, ld: 1e-3, lq: 3e-3, psi_f: 0.05 };
        let machine = Machine { rs: 0.1, p_ld: 4e-3, p_lq: 12e-3, p_psi_f: 0.2 };
        let current = Dq { d: -7.0, q: 11.0 };
        let row = TorqueOfCurrentRow { current, torque: 0.0 };
        // Power of the air gap over the speed of the shaft.
        let power = 1.5 * (motor.steady_voltage(current, 400.0).d * current.d + motor.steady_voltage(current, 400.0).q * current.q);
        let heat = 1.5 * motor.rs * (current.d.powi(2) + current.q.powi(2));
        assert!((row.torque_of(&machine, machine.p_ld - machine.p_lq) - (power - heat) / 100.0).abs() < 1e-12);
    }
}
