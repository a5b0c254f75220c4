//! Operating points of a driven motor, a row each: what a dynamometer's table holds of the dq frame,
//!
//! ```text
//! u_d = R i_d - Omega p L_q i_q + V i_d / |i|
//! u_q = R i_q + Omega (p L_d i_d + p psi_f) + V i_q / |i|
//! ```
//!
//! `V` is what the inverter loses against the current, of voltages that it commands; it is not negative. The frame may be turned by a small
//! angle, of voltages and currents alike, and the voltages may lag by another one that grows with the speed. All three are fitted beside
//! the motor, and what the points leave open of them counts.

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
    /// At the shaft, N m, where it was measured.
    pub torque: Option<f64>,
}

/// What lies between a motor and its operating points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Drive {
    /// V, against the current.
    pub(super) lost: f64,
    /// By which the rotor is ahead of the frame of the table, rad.
    pub(super) angle: f64,
    /// By which the voltages are turned further for each rad/s of the shaft, s.
    pub(super) lag: f64,
}

impl SteadyPoint {
    /// V, in the frame of the table.
    pub(super) fn voltage_of(&self, machine: &Machine, drive: &Drive) -> Dq {
        let i = self.current.turned(-drive.angle);
        let resistance = machine.rs + if i.magnitude() > 0.0 { drive.lost / i.magnitude() } else { 0.0 };
        let u = Dq {
            d: resistance * i.d - self.speed * machine.p_lq * i.q,
            q: resistance * i.q + self.speed * (machine.p_ld * i.d + machine.p_psi_f),
        };
        u.turned(drive.angle + self.speed * drive.lag)
    }

    /// Torque of the air gap, N m, of a motor with this resistance whose inverter loses so much; none at rest.
    pub(super) fn torque_of(&self, rs: f64, lost: f64) -> Option<f64> {
        let Self { speed, voltage: u, current: i, .. } = *self;
        let heat = (rs * i.magnitude() + lost) * i.magnitude();
        (speed != 0.0).then(|| 1.5 * (u.d * i.d + u.q * i.q - heat) / speed)
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
        let point = SteadyPoint { speed: 100.0, voltage: Dq::default(), current, torque: None };
        let of_motor = motor.steady_voltage(current, 400.0);
        let lossy = point.voltage_of(&machine, &Drive { lost: 0.5, ..Drive::default() });
        // 0.5 V along 3-4-5.
        assert!((lossy.d - of_motor.d + 0.3).abs() < 1e-12 && (lossy.q - of_motor.q - 0.4).abs() < 1e-12, "{lossy:?}");
        // A frame that is behind by 0.1 rad has the same vectors at larger angles; the voltages lag by 0.2 rad more.
        let turned = SteadyPoint { current: current.turned(0.1), ..point };
        let seen = turned.voltage_of(&machine, &Drive { angle: 0.1, lag: 2e-3, ..Drive::default() });
        let expected = of_motor.turned(0.3);
        assert!((seen.d - expected.d).hypot(seen.q - expected.q) < 1e-12, "{seen:?}");
        // Power of the air gap over the speed: 3/2 p (psi_f i_q + (L_d - L_q) i_d i_q).
        let torque = SteadyPoint { voltage: of_motor, ..point }.torque_of(0.1, 0.0).unwrap();
        assert!((torque - 1.5 * 4.0 * (0.05 * 4.0 + 2e-3 * 12.0)).abs() < 1e-12, "{torque}");
        assert_eq!(SteadyPoint { speed: 0.0, ..point }.torque_of(0.1, 0.0), None);
    }
}
