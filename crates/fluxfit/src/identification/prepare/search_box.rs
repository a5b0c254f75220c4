//! The box in which a swarm searches.
//!
//! From the log: motoring outside deep field weakening, no parameter asks for more than the whole voltage, `R_s <= |u|/|i|`, `L
//! <= |u|/(omega |i|)`, `psi_f <=
//! |u|/omega`, each at the operating point where that is largest. A motor's rating gives the same bounds from its nameplate.
//!
//! Where the points have no current, voltage or speed at all, a parameter is in no equation, and the swarm may look for it anywhere.

use crate::{error::Error, log::Log, motor::PARAMETERS, optimizer::Bounds, steady::OperatingPoint};

/// Side of the box, SI, along parameters that are in no equation.
const ANYWHERE: f64 = 1.0;

/// A bound above this, SI, comes from a current or speed that is zero but for rounding.
const LARGEST: f64 = 1e60;

/// The box that the operating points allow.
///
/// # Errors
/// If a bound is beyond what an optimizer takes.
pub(crate) fn from_points(points: &[OperatingPoint]) -> Result<Bounds, Error> {
    enclosing(points.iter().map(|point| largest(point.voltage().magnitude(), point.current().magnitude(), point.omega_e().abs())))
}

/// The box from zero that holds all of these.
fn enclosing(boxes: impl IntoIterator<Item = [f64; PARAMETERS]>) -> Result<Bounds, Error> {
    let mut upper = [0.0_f64; PARAMETERS];
    for one in boxes {
        for (upper, one) in upper.iter_mut().zip(one) {
            *upper = upper.max(Some(one).filter(|one| *one <= LARGEST).unwrap_or(0.0));
        }
    }
    upper.iter_mut().filter(|upper| **upper == 0.0).for_each(|upper| *upper = ANYWHERE);
    Ok(Bounds::new(vec![0.0; PARAMETERS], upper.to_vec())?)
}

/// The box of a log without operating points: its largest voltage against the root mean square of its currents and speeds, as if
/// that were a point.
///
/// # Errors
/// If a bound is beyond what an optimizer takes.
pub(crate) fn from_rows(log: &Log) -> Result<Bounds, Error> {
    let columns = log.columns();
    let mean_square = |column: &[f64]| column.iter().map(|value| value * value).sum::<f64>() / column.len() as f64;
    let voltage = columns.ud.iter().zip(&columns.uq).map(|(d, q)| d.hypot(*q)).fold(0.0, f64::max);
    let current = (mean_square(&columns.id) + mean_square(&columns.iq)).sqrt();
    enclosing([largest(voltage, current, mean_square(&columns.omega_e).sqrt())])
}

/// The box of a rating: phase-peak voltage (V) and current (A), electrical speed (rad/s).
///
/// # Errors
/// If one of them is not a positive finite number.
pub(crate) fn from_rating(voltage: f64, current: f64, omega_e: f64) -> Result<Bounds, Error> {
    Ok(Bounds::new(vec![0.0; PARAMETERS], largest(voltage, current, omega_e).to_vec())?)
}

fn largest(voltage: f64, current: f64, omega_e: f64) -> [f64; PARAMETERS] {
    let inductance = voltage / (omega_e * current);
    [voltage / current, inductance, inductance, voltage / omega_e]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        log::{Columns, Log},
        motor::Motor,
    };

    /// Points of 40 rows, (i_d, i_q, omega_e, u_d, u_q) each.
    fn points(rows: &[[f64; 5]]) -> Vec<OperatingPoint> {
        let each = |c: usize| rows.iter().flat_map(|row| [row[c]; 40]).collect::<Vec<_>>();
        let t = (0..40 * rows.len()).map(|k| k as f64).collect();
        let log =
            Log::new(Columns { t, id: each(0), iq: each(1), omega_e: each(2), ud: each(3), uq: each(4), ..Columns::default() }).unwrap();
        (0..rows.len()).map(|w| OperatingPoint::measure(&log, 40 * w..40 * (w + 1), None)).collect()
    }

    fn upper(bounds: &Bounds) -> Vec<f64> {
        assert!(bounds.iter().all(|(lower, _)| lower == 0.0));
        bounds.iter().map(|(_, upper)| upper).collect()
    }

    #[test]
    fn each_side_is_the_largest_that_one_point_allows_by_hand() {
        // |u| = 50, |i| = 5, omega = 100: R 10, L 0.1, psi 0.5; and |u| = 13, |i| = 2, omega = 10: R 6.5, L 0.65, psi 1.3.
        let bounds = from_points(&points(&[[-3.0, 4.0, -100.0, -30.0, 40.0], [0.0, 2.0, 10.0, 5.0, 12.0]])).unwrap();
        for (found, expected) in upper(&bounds).into_iter().zip([10.0, 0.65, 0.65, 1.3]) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(upper(&from_rating(50.0, 5.0, 100.0).unwrap()), [10.0, 0.1, 0.1, 0.5]);
        assert!(from_rating(50.0, 0.0, 100.0).is_err());
    }

    #[test]
    fn rows_give_a_box_by_hand() {
        // |u| is at most 50; |i|² is 25 and 9, root mean square sqrt(17); omega² 100² and 20², sqrt(5200).
        let log = Log::new(Columns {
            t: vec![0.0, 1.0],
            id: vec![-3.0, 0.0],
            iq: vec![4.0, 3.0],
            omega_e: vec![-100.0, 20.0],
            ud: vec![-30.0, 5.0],
            uq: vec![40.0, 12.0],
            ..Columns::default()
        });
        let (current, speed) = (17.0_f64.sqrt(), 5200.0_f64.sqrt());
        let inductance = 50.0 / (current * speed);
        for (found, expected) in
            upper(&from_rows(&log.unwrap()).unwrap()).into_iter().zip([50.0 / current, inductance, inductance, 50.0 / speed])
        {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn a_motor_is_in_its_own_box_while_the_voltages_do_not_cancel() {
        let motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
        let rows = [(0.0, 9.0, 400.0), (2.0, 8.5, 400.0)].map(|(d, q, omega)| {
            let u = motor.steady_voltage(crate::frames::Dq { d, q }, omega);
            [d, q, omega, u.d, u.q]
        });
        assert!(from_points(&points(&rows)).unwrap().contains(&motor.to_array()));
    }

    #[test]
    fn what_is_in_no_equation_still_has_a_box() {
        // The drive stands: no speed, so no inductance and no flux. Row two only makes the log one.
        let bounds = from_points(&points(&[[0.0, 2.0, 0.0, 0.0, 8.0], [0.0, 1.0, 7.0, 0.0, 3.0]])[..1]).unwrap();
        let found = upper(&bounds);
        assert!((found[0] - 4.0).abs() < 1e-12 && found[1..] == [ANYWHERE; 3], "{found:?}");
    }
}
