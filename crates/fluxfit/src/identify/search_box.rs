//! The box in which a swarm searches.
//!
//! From the log: no parameter can ask for more than the whole voltage, `R_s <= |u|/|i|`, `L <= |u|/(omega |i|)`, `psi_f <= |u|/omega`, each at the operating point where that is largest. A motor's
//! rating gives the same bounds from its nameplate.

use crate::{error::Error, motor::PARAMETERS, optimizer::bounds::Bounds, steady::OperatingPoint};

/// The box that the operating points allow.
///
/// # Errors
/// If the points have no voltage, current or speed.
pub fn from_points(points: &[OperatingPoint]) -> Result<Bounds, Error> {
    let mut upper = [0.0_f64; PARAMETERS];
    for point in points {
        let box_of_point = largest(point.voltage().magnitude(), point.current().magnitude(), point.omega_e().abs());
        for (upper, one) in upper.iter_mut().zip(box_of_point) {
            *upper = upper.max(Some(one).filter(|one| one.is_finite()).unwrap_or(0.0));
        }
    }
    Bounds::new(vec![0.0; PARAMETERS], upper.to_vec())
}

/// The box of a rating: phase-peak voltage (V) and current (A), electrical speed (rad/s).
///
/// # Errors
/// If one of them is not a positive finite number.
pub fn from_rating(voltage: f64, current: f64, omega_e: f64) -> Result<Bounds, Error> {
    Bounds::new(vec![0.0; PARAMETERS], largest(voltage, current, omega_e).to_vec())
}

fn largest(voltage: f64, current: f64, omega_e: f64) -> [f64; PARAMETERS] {
    let inductance = voltage / (omega_e * current);
    [voltage / current, inductance, inductance, voltage / omega_e]
}
