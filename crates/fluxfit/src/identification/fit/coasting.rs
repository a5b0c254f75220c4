//! Rows without current: whether their voltages are those at the terminals.
//!
//! A coasting rotor shows `psi_f` and the [lag](super::frame_lag) of the frame, if the drive measures its terminals. Many do not: they write
//! zero, the last command, or what a controller would apply that is not switching. The log tells: voltages that are the magnet's turn with
//! the speed and not by a constant angle, they have noise along d, and they are those of the same magnet that acts under load.
//!
//! Measured: under load, the voltages of a VESC are 5 % above those without current, which it measures by dividers; those of a Tritium are
//! 11 % apart, and their angle is 4 degrees at every speed.

use super::{
    super::request::Request,
    estimate::Estimate,
    excitation::Excitation,
    frame_lag::FrameLag,
    uncertainty::Part,
    voltage_loss::{Loss, LossPrior},
};
use crate::{
    frames::Dq,
    log::Log,
    steady::{OperatingPoint, recorder},
};

/// What dividers, offsets and a warmer magnet may make of the terminals' voltage; a controller's idea of it is further off.
const SAME_FLUX: f64 = 0.08;

/// The load tells the gain of the other voltages if it leaves this standard error.
const GAIN_ERROR: f64 = 0.03;

/// Voltages are trusted to this here: a gain is wanted to a few percent.
const ACCURACY: f64 = 0.01;

/// An angle, rad, that is none: a degree.
const NO_ANGLE: f64 = 0.017;

/// The part of the voltage along d below which it was computed from the speed, not measured.
const COMPUTED: f64 = 1e-6;

/// Fewest pieces from which anything is concluded.
const FEWEST: usize = 3;

/// The points without current, if their voltages are the terminals': judged by the points with current.
pub(super) fn at_terminals(log: &Log, loaded: &[OperatingPoint], lag: &FrameLag, request: &Request) -> Vec<OperatingPoint> {
    if !request.windows.is_empty() {
        return Vec::new();
    }
    let pieces: Vec<OperatingPoint> = recorder::coasting(log).into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect();
    let are_theirs = pieces.len() >= FEWEST
        && pieces.iter().any(|piece| piece.voltage().d.abs() > COMPUTED * piece.voltage().magnitude())
        && turn_with_speed(&pieces)
        && have_the_same_flux(log, loaded, &pieces, lag, request);
    if are_theirs { pieces } else { Vec::new() }
}

/// Whether the voltages' angle from the q axis is in proportion to the speed, rather than the same at all speeds.
fn turn_with_speed(pieces: &[OperatingPoint]) -> bool {
    let angles: Vec<(f64, f64)> = pieces
        .iter()
        .map(|piece| {
            // From the axis, whichever way it points: a column with the wrong sign is none of this matter.
            let Dq { d, q } = piece.voltage();
            ((d / q).atan(), piece.omega_e())
        })
        .collect();
    let sum = |of: &dyn Fn(f64, f64) -> f64| angles.iter().map(|(angle, omega_e)| of(*angle, *omega_e)).sum::<f64>();
    let slope = sum(&|angle, omega_e| angle * omega_e) / sum(&|_, omega_e| omega_e * omega_e);
    let constant = sum(&|angle, _| angle) / angles.len() as f64;
    let turning = sum(&|angle, omega_e| (angle - slope * omega_e).powi(2));
    turning <= sum(&|angle, _| (angle - constant).powi(2)) || turning <= angles.len() as f64 * NO_ANGLE.powi(2)
}

/// Whether they are those of the magnet that acts under load: a gain of theirs, solved for beside the motor, is near one.
fn have_the_same_flux(log: &Log, loaded: &[OperatingPoint], pieces: &[OperatingPoint], lag: &FrameLag, request: &Request) -> bool {
    let points: Vec<OperatingPoint> = loaded.iter().chain(pieces).cloned().collect();
    let excitation = Excitation::of(&points, &request.known);
    let of_pieces =
        points.iter().enumerate().map(|(w, point)| if w < loaded.len() { [0.0; 2] } else { [point.voltage().d, point.voltage().q] });
    let gain = Loss { voltages: of_pieces.collect(), expected: 0.0, standard_error: 1.0, part: Part::FrameLag };
    let inductances = Dq { d: f64::INFINITY, q: f64::INFINITY };
    let losses = LossPrior::possible(log, request).losses(&points, 0.0, inductances);
    let unknowns: Vec<Loss> = [gain].into_iter().chain(losses).chain(lag.rough_unknowns(&points, log)).collect();
    let estimate = Estimate::solve_with(&points, &excitation, request, &unknowns, ACCURACY);
    estimate.found.first().is_some_and(|(gain, error)| gain.abs() <= SAME_FLUX && *error <= GAIN_ERROR)
}
