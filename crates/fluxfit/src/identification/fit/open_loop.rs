//! Rows in open-loop operation: at the start, before a drive without an encoder knows the rotor's angle, it turns a current at will, and
//! the rotor follows with its d axis on that current. The columns are in a frame that is not the rotor's.
//!
//! Such points tell the resistance, but for the magnet's voltage, which is small at their speed; and nothing else. There, the magnet's
//! voltage is at right angles to the current, whatever the columns call it. In the rotor's frame, the voltage at right angles to the
//! current is known up to small things: resistance, dead time and devices act along the current.
//!
//! ```text
//! u x i / |i| = omega_e (psi_f i_d + L_d i_d² + L_q i_q²) / |i|      in the rotor's frame
//! u x i / |i| = ± omega_e psi_f                                       with the current on the rotor's d axis
//! ```

use super::{
    super::request::Request,
    estimate::Estimate,
    excitation::Excitation,
    frame_lag::{FrameLag, rough_flux},
    part::Part,
    voltage_loss::Loss,
};
use crate::{log::Log, steady::OperatingPoint};
use std::ops::Range;

/// Drives leave open-loop operation at a few percent of their speed; above this part of the largest, nothing is suspected.
const SLOW: f64 = 0.2;

/// The voltage at right angles to the current may differ from that of the rotor's frame by this part of the magnet's voltage.
const FRAME_TOLERANCE: f64 = 0.5;

/// Magnet's voltages below this part of the log's largest voltage are too small to say which way they point.
const SMALLEST: f64 = 2e-3;

/// The rows of the points of this operation.
pub(super) fn find(log: &Log, points: &[OperatingPoint], lag: &FrameLag, request: &Request) -> Vec<Range<usize>> {
    let fastest = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let is_slow = |point: &OperatingPoint| point.omega_e().abs() < SLOW * fastest;
    let fast: Vec<OperatingPoint> = points.iter().filter(|point| !is_slow(point)).cloned().collect();
    let psi_f = rough_flux(&fast).abs();
    let excitation = Excitation::of(&fast, &request.known);
    let motor = Estimate::solve(&fast, &excitation, request, &lag.rough_unknowns(&fast, log)).motor;
    let largest = points.iter().map(|point| point.voltage().magnitude()).fold(0.0, f64::max);
    let is_open_loop = |point: &OperatingPoint| {
        let (u, i, omega_e) = (point.voltage(), point.current(), point.omega_e());
        let across = (u.q * i.d - u.d * i.q) / i.magnitude();
        let expected = omega_e * (psi_f * i.d + motor.ld.max(0.0) * i.d.powi(2) + motor.lq.max(0.0) * i.q.powi(2)) / i.magnitude();
        let own = psi_f * omega_e.abs();
        own > SMALLEST * largest && (across - expected).abs() > FRAME_TOLERANCE * own
    };
    points.iter().filter(|point| is_slow(point) && is_open_loop(point)).map(|point| point.rows.clone()).collect()
}

/// What is unknown of these points beside the motor: the magnet's voltage may point anywhere, so that it counts for nothing. What is left
/// is the resistance.
pub(super) fn unknowns(points: &[OperatingPoint], open_loop: &[Range<usize>], psi_f: f64) -> Vec<Loss> {
    let of_point = |w: usize| {
        let standard_error = (points[w].omega_e() * psi_f).abs().max(f64::MIN_POSITIVE);
        [[1.0, 0.0], [0.0, 1.0]].map(|voltage| {
            let voltages = (0..points.len()).map(|other| if other == w { voltage } else { [0.0; 2] });
            Loss { voltages: voltages.collect(), expected: 0.0, standard_error, part: Part::FrameLag }
        })
    };
    (0..points.len()).filter(|w| open_loop.contains(&points[*w].rows)).flat_map(of_point).collect()
}
