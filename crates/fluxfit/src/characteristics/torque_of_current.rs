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

/// By which part of the largest torque a computed one may miss the formula: single precision, and sums of it.
const ROUNDING: f64 = 1e-5;

/// The same of what its last written digits explain: sensors of a bench err by more, and bearings take more.
const DIGITS: f64 = 1e-3;

/// Fewest rows of which the latter is believed.
const LEAST_OF_DIGITS: usize = 6;

/// Whether torques are what the formula makes of their own currents, without anything that a bench takes: the drive computed them.
pub(super) fn is_computed(rows: &[TorqueOfCurrentRow]) -> bool {
    let largest = |of: fn(&TorqueOfCurrentRow) -> f64| rows.iter().map(of).fold(0.0, |most: f64, value| most.max(value.abs()));
    let torque = largest(|row| row.torque);
    let is_salient = rows.iter().any(|row| row.current.d * row.current.q != 0.0);
    let terms = |row: &TorqueOfCurrentRow| [row.current.q, if is_salient { row.current.d * row.current.q } else { 0.0 }];
    let sum = |of: &dyn Fn(&TorqueOfCurrentRow) -> f64| rows.iter().map(of).sum::<f64>();
    let [qq, qs, ss] = [(0, 0), (0, 1), (1, 1)].map(|(one, other)| sum(&|row| terms(row)[one] * terms(row)[other]));
    let [tq, ts] = [0, 1].map(|term| sum(&|row| terms(row)[term] * row.torque));
    let determinant = qq * ss - qs * qs;
    // Where the second term is the first one again, that one alone.
    let is_both = determinant > ROUNDING * qq * ss;
    let [a, b] = if is_both { [(ss * tq - qs * ts) / determinant, (qq * ts - qs * tq) / determinant] } else { [tq / qq, 0.0] };
    let unknowns = if is_both { 2 } else { 1 };
    let missed = |row: &TorqueOfCurrentRow| (row.torque - a * row.current.q - b * row.current.d * row.current.q).abs();
    let digits = digit(rows.iter().map(|row| row.torque)) + a.abs() * digit(rows.iter().map(|row| row.current.q));
    let of_digits = if rows.len() >= LEAST_OF_DIGITS { digits.min(DIGITS * torque) } else { 0.0 };
    let mut currents: Vec<f64> = rows.iter().map(|row| row.current.q).collect();
    currents.sort_by(f64::total_cmp);
    currents.dedup();
    currents.len() > unknowns + 1 && torque > 0.0 && rows.iter().all(|row| missed(row) <= of_digits.max(ROUNDING * torque))
}

/// The unit of the last digit that all of these values have behind the point, so far as they have one.
fn digit(values: impl Iterator<Item = f64> + Clone) -> f64 {
    /// A number of so many digits is not a rounded one.
    const MOST: i32 = 9;
    let holds = |digit: f64| values.clone().all(|value| ((value / digit).round() * digit - value).abs() <= ROUNDING * digit);
    (0..=MOST).map(|digits| 10.0_f64.powi(-digits)).find(|digit| holds(*digit)).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    /// Rows of i_q from 1 to 12 A and i_d from 0 to -3 A, with the torque that this makes of both.
    fn rows(torque: impl Fn(f64, f64) -> f64) -> Vec<TorqueOfCurrentRow> {
        let row = |k: u32| {
            let (d, q) = (-f64::from(k % 4), f64::from(k) + 0.37);
            TorqueOfCurrentRow { current: Dq { d, q }, torque: torque(d, q) }
        };
        (1..=12).map(row).collect()
    }

    #[test]
    fn a_torque_of_the_drive_is_its_own_formula() {
        let thousandths = |torque: f64| (torque * 1e3).round() / 1e3;
        assert!(is_computed(&rows(|_, q| 0.0731 * q)));
        assert!(is_computed(&rows(|_, q| f64::from((0.0731 * q) as f32))));
        assert!(is_computed(&rows(|_, q| thousandths(0.0731 * q))));
        assert!(is_computed(&rows(|d, q| 0.0731 * q - 0.004 * d * q)));
    }

    /// A bearing of 1 % of the largest torque, a sensor that errs by 0.2 %, a flux that falls with the current.
    #[test]
    fn a_torque_of_a_sensor_is_not() {
        assert!(!is_computed(&rows(|_, q| 0.0731 * q - 0.009)));
        assert!(!is_computed(&rows(|_, q| 0.0731 * q + 0.0018 * (7.0 * q).sin())));
        assert!(!is_computed(&rows(|_, q| 0.0731 * q * (1.0 - 1e-3 * q))));
        // Two currents are not proportional by themselves.
        assert!(!is_computed(&rows(|_, q| 0.0731 * q)[..2]));
    }

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
