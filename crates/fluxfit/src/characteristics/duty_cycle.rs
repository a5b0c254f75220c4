//! The duty cycle of a drive against speed and current, where it logs no voltage: with `d` the duty and `U_dc` the input voltage,
//!
//! ```text
//! |u| = d U_dc / sqrt 3 - U_0,     |u|² = (R_s i + Omega p psi_f)² + (Omega p L_q i)²        i_d = 0
//! ```
//!
//! A duty of 1 is taken as the largest circle of space vector modulation, as VESC counts it. The length of the voltage alone tells the flux
//! well, the resistance by the current's share of it, and L_q only where `Omega p L_q i` is not small against the flux: its square is seen.
//! L_d is in no equation, because i_d is taken as zero. `U_0`, what the switches lose, is fitted.

use super::{machine::Machine, open_circuit::SQRT_3};

/// Duty cycle against speed.
#[derive(Debug, Clone, PartialEq)]
pub struct DutyCycle {
    /// In the order of the file.
    pub rows: Vec<DutyCycleRow>,
}

/// A row of a drive without voltages.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DutyCycleRow {
    /// Mechanical rad/s, positive.
    pub speed: f64,
    /// Share of the largest voltage, positive.
    pub duty: f64,
    /// V.
    pub input_voltage: f64,
    /// Of the motor, A, peak: positive where it drives; `None` if none was logged.
    pub current: Option<f64>,
}

impl DutyCycleRow {
    /// Amplitude of a phase as commanded, V.
    pub(super) fn voltage(&self) -> f64 {
        self.duty * self.input_voltage / SQRT_3
    }

    /// The same by the model, V.
    pub(super) fn voltage_of(&self, machine: &Machine) -> f64 {
        let current = self.current.unwrap_or(0.0);
        let along = machine.rs * current + self.speed * machine.p_psi_f;
        along.hypot(self.speed * machine.p_lq * current)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frames::Dq, motor::Motor};

    #[test]
    fn the_length_is_that_of_the_steady_voltage() {
        let motor = Motor { rs: 0.1, ld: 1e-3, lq: 3e-3, psi_f: 0.05 };
        let machine = Machine { rs: 0.1, p_ld: 4e-3, p_lq: 12e-3, p_psi_f: 0.2 };
        let row = DutyCycleRow { speed: 100.0, duty: 0.5, input_voltage: 48.0, current: Some(11.0) };
        let voltage = motor.steady_voltage(Dq { d: 0.0, q: 11.0 }, 400.0).magnitude();
        assert!((row.voltage_of(&machine) - voltage).abs() < 1e-12);
        assert!((row.voltage() - 24.0 / 3.0_f64.sqrt()).abs() < 1e-12);
    }
}
