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

/// Largest power of the speed that the current of shorted terminals grows with. It grows in proportion and levels off; where L_q is ten
/// times L_d, with the power 1.33 in between.
const LARGEST_POWER: f64 = 1.4;

/// Fewest speeds of the faster half that show the power, and how far they reach at least, fastest over slowest.
const LEAST_OF_HALF: usize = 4;
const LEAST_REACH: f64 = 1.3;

/// The power of the speed that the currents of the faster half of a table grow with, if no shorted terminals have it: a propeller, whose
/// torque grows with the square, has about 2. By least squares of the logarithms, less twice the standard error.
pub(super) fn too_large_power(rows: &[ShortCircuitRow]) -> Option<f64> {
    let fastest = rows.iter().fold(0.0, |fastest: f64, row| row.speed.abs().max(fastest));
    let half = rows.iter().filter(|row| row.speed.abs() >= 0.5 * fastest);
    let logarithms: Vec<[f64; 2]> = half.map(|row| [row.speed.abs().ln(), row.current.ln()]).collect();
    let count = logarithms.len() as f64;
    let mean = |k: usize| logarithms.iter().map(|of_row| of_row[k]).sum::<f64>() / count;
    let means = [mean(0), mean(1)];
    let sum = |k: usize, l: usize| logarithms.iter().map(|of_row| (of_row[k] - means[k]) * (of_row[l] - means[l])).sum::<f64>();
    let power = sum(0, 1) / sum(0, 0);
    let variance = (sum(1, 1) - power * sum(0, 1)).max(0.0) / (count - 2.0) / sum(0, 0);
    let slowest = logarithms.iter().fold(f64::INFINITY, |slowest, [speed, _]| speed.min(slowest));
    let is_shown = logarithms.len() >= LEAST_OF_HALF && fastest.ln() - slowest > LEAST_REACH.ln();
    (is_shown && power - 2.0 * variance.sqrt() > LARGEST_POWER).then_some(power)
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

    /// Of a motor the current grows less than with the power 1.34, also where L_q is ten times L_d; of a propeller with the square.
    #[test]
    fn a_current_that_grows_with_the_square_of_the_speed_is_that_of_a_load() {
        let rows = |current: &dyn Fn(f64) -> f64| {
            let row = |speed: f64| ShortCircuitRow { speed, current: current(speed), current_error: 0.0, torque: None };
            [1.0, 1.2, 1.4, 1.6, 1.8, 2.0].map(row)
        };
        for scale in (-40..40).map(|k| 10_f64.powf(0.1 * f64::from(k))) {
            let machine = Machine { rs: 1.0, p_ld: 0.1 * scale, p_lq: scale, p_psi_f: 1.0 };
            let of_motor = |speed: f64| ShortCircuitRow { speed, current: 0.0, current_error: 0.0, torque: None }.current_of(&machine);
            assert_eq!(too_large_power(&rows(&of_motor)), None, "{scale}");
        }
        assert!((too_large_power(&rows(&|speed| 0.3 * speed.powi(2))).unwrap() - 2.0).abs() < 1e-9);
        // One speed shows no power, nor do speeds that a load changes by little.
        assert_eq!(too_large_power(&[rows(&|speed| speed)[0]; 6]), None);
        let loaded = rows(&|speed| speed.powi(20)).map(|row| ShortCircuitRow { speed: 10.0 + row.speed, ..row });
        assert_eq!(too_large_power(&loaded), None);
    }
}
