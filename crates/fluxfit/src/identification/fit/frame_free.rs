//! The flux of each operating point without any frame: a length that no lag, no offset of the angle and no open loop turns.
//!
//! ```text
//! |u - (R_s + j omega_e L) i| = |omega_e| psi_f
//! ```
//!
//! A recorder's points differ in this by more than noise: means of different periods, a speed of another instant, a voltage that is
//! measured while the drive coasts and computed while it drives. No interval of `psi_f` is narrower than their scatter.

use crate::{frames::Dq, motor::Motor, steady::OperatingPoint};

/// Slower points, as a part of the fastest, divide little voltage by little speed.
const LEAST_SPEED: f64 = 0.2;

/// Standard deviation, Wb, of the points' flux beyond what their noise explains.
pub(super) fn scatter(points: &[OperatingPoint], motor: &Motor) -> f64 {
    let fastest = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    // What did not come out as a motor's is none here.
    let motor = Motor { rs: motor.rs.max(0.0), ld: motor.ld.max(0.0), lq: motor.lq.max(0.0), psi_f: 0.0 };
    let readings: Vec<(f64, f64)> = points
        .iter()
        .filter(|point| point.omega_e().abs() >= LEAST_SPEED * fastest && fastest > 0.0)
        .map(|point| {
            let (u, taken, omega_e) = (point.voltage(), motor.steady_voltage(point.current(), point.omega_e()), point.omega_e());
            let own = Dq { d: u.d - taken.d, q: u.q - taken.q };
            let [[_, _], [_, q]] = point.residual_covariance(&motor);
            (own.magnitude() / omega_e.abs(), q / omega_e.powi(2))
        })
        .collect();
    let count = readings.len() as f64;
    if count < 2.0 {
        return 0.0;
    }
    let mean = readings.iter().map(|(flux, _)| flux).sum::<f64>() / count;
    let variance = readings.iter().map(|(flux, _)| (flux - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let noise = readings.iter().map(|(_, variance)| variance).sum::<f64>() / count;
    (variance - noise).max(0.0).sqrt()
}
