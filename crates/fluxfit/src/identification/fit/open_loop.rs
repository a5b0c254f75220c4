//! Rows in open-loop operation: at the start, before a drive without an encoder knows the rotor's angle, it turns a current at will, and
//! the rotor follows with its d axis on that current. The columns are in a frame that is not the rotor's.
//!
//! There the magnet's voltage is at right angles to the current, whatever the columns call it. In the rotor's frame the voltage at right
//! angles to the current is known up to small things: resistance, dead time and devices act along the current.
//!
//! ```text
//! u x i / |i| = omega_e (psi_f i_d + L_d i_d² + L_q i_q²) / |i|      in the rotor's frame
//! u x i / |i| = ± omega_e psi_f                                       with the current on the rotor's d axis
//! ```

use super::{super::request::Request, estimate::Estimate, excitation::Excitation, frame_lag::FrameLag};
use crate::{log::Log, steady::OperatingPoint};

/// Drives leave open-loop operation at a few percent of their speed; above this part of the largest, nothing is suspected.
const SLOW: f64 = 0.2;

/// The voltage at right angles to the current may differ from that of the rotor's frame by this part of the magnet's voltage.
const FRAME_TOLERANCE: f64 = 0.5;

/// Magnet's voltages below this part of the log's largest voltage are too small to say which way they point.
const SMALLEST: f64 = 2e-3;

/// The points that are not of this operation; all, where only such points would be left out.
pub(super) fn without(log: &Log, points: Vec<OperatingPoint>, lag: &FrameLag, request: &Request) -> Vec<OperatingPoint> {
    let fastest = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let is_slow = |point: &&OperatingPoint| point.omega_e().abs() < SLOW * fastest;
    let fast: Vec<OperatingPoint> = points.iter().filter(|point| !is_slow(point)).cloned().collect();
    let Some(quickest) = fast.iter().max_by(|one, other| one.omega_e().abs().total_cmp(&other.omega_e().abs())) else { return points };
    // The flux is the voltage over the speed, good enough for a direction.
    let psi_f = quickest.voltage().magnitude() / fastest;
    let excitation = Excitation::of(&fast, &request.known);
    let motor = Estimate::solve(&fast, &excitation, request, &lag.unknowns(&fast, psi_f, log)).motor;
    let largest = points.iter().map(|point| point.voltage().magnitude()).fold(0.0, f64::max);
    let is_open_loop = |point: &OperatingPoint| {
        let (u, i, omega_e) = (point.voltage(), point.current(), point.omega_e());
        let across = (u.q * i.d - u.d * i.q) / i.magnitude();
        let expected = omega_e * (psi_f * i.d + motor.ld.max(0.0) * i.d.powi(2) + motor.lq.max(0.0) * i.q.powi(2)) / i.magnitude();
        let own = psi_f * omega_e.abs();
        own > SMALLEST * largest && (across - expected).abs() > FRAME_TOLERANCE * own
    };
    points.iter().filter(|point| !(is_slow(point) && is_open_loop(point))).cloned().collect()
}
