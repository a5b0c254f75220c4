//! Operating points of a driven motor, a row each: what a dynamometer's table holds of the dq frame,
//!
//! ```text
//! u_d = R i_d - Omega p L_q i_q + V i_d / |i|
//! u_q = R i_q + Omega (p L_d i_d + p psi_f) + V i_q / |i|
//! ```
//!
//! `V` is what the inverter loses against the current, of voltages that it commands; it is fitted beside the motor.

use super::machine::Machine;
use crate::frames::Dq;

/// Operating points of a driven motor.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyPoints {
    /// In any order.
    pub rows: Vec<SteadyPoint>,
}

/// An operating point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyPoint {
    /// Of the shaft, rad/s, with its sign.
    pub speed: f64,
    /// V, peak of a phase.
    pub voltage: Dq,
    /// A, peak.
    pub current: Dq,
}

impl SteadyPoint {
    /// V, with so much lost against the current.
    pub(super) fn voltage_of(&self, machine: &Machine, lost: f64) -> Dq {
        let Self { speed, current: i, .. } = *self;
        let resistance = machine.rs + if i.magnitude() > 0.0 { lost / i.magnitude() } else { 0.0 };
        Dq { d: resistance * i.d - speed * machine.p_lq * i.q, q: resistance * i.q + speed * (machine.p_ld * i.d + machine.p_psi_f) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    #[test]
    fn the_voltage_is_that_of_the_motor_and_what_is_lost() {
        let motor = Motor { rs: 0.1, ld: 1e-3, lq: 3e-3, psi_f: 0.05 };
        let machine = Machine { rs: 0.1, p_ld: 4e-3, p_lq: 12e-3, p_psi_f: 0.2 };
        let current = Dq { d: -3.0, q: 4.0 };
        let (of_point, of_motor) =
            (SteadyPoint { speed: 100.0, voltage: Dq::default(), current }.voltage_of(&machine, 0.5), motor.steady_voltage(current, 400.0));
        // 0.5 V along 3-4-5.
        assert!((of_point.d - of_motor.d + 0.3).abs() < 1e-12 && (of_point.q - of_motor.q - 0.4).abs() < 1e-12, "{of_point:?}");
    }
}
