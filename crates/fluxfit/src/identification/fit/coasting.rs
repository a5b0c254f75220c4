//! Rows without current: whether their voltages are those at the terminals.
//!
//! A coasting rotor shows `psi_f` and the [lag](super::frame_lag) of the frame, if the drive measures its terminals. Many do not: they
//! write zero, the last command, or what a controller would apply that is not switching. The log tells: voltages that are the magnet's turn
//! with the speed and not by a constant angle, they have a part along d, and they are those of the same magnet that acts under load, with
//! the same lag.
//!
//! Measured: under load, the voltages of a VESC are 5 % above those without current, which it measures by dividers; those of a Tritium are
//! 11 % apart, and their angle is 4 degrees at every speed.

use super::{
    super::request::Request,
    estimate::Estimate,
    excitation::Excitation,
    frame_lag::FrameLag,
    part::Part,
    voltage_accuracy::VoltageAccuracy,
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

/// Where the load does not tell the gain, the flux without current may lie below the least voltage over speed under load by this part: a
/// motor takes more voltage than its magnet makes. That of a drive that does not measure lay 14 % below.
const BELOW_LOAD: f64 = 0.08;

/// And above it by this part: noise, or a little field weakening.
const ABOVE_LOAD: f64 = 0.01;

/// Standard error of the gain there, at least: the tolerance of dividers.
const DIVIDERS: f64 = 0.02;

/// Slower loads, as a part of the fastest, say nothing of the flux.
const LEAST_SPEED: f64 = 0.5;

/// Largest difference, s, between the lag with and without current, where the load tells the one: twice what filters of dividers make.
const SAME_LAG: f64 = 10e-6;

/// What is known of that difference here, s: nothing.
const ANY_LAG: f64 = 1e-3;

/// Standard errors of that difference beyond which it is real.
const LAG_FOUND: f64 = 3.0;

/// Voltages are trusted to this here: a gain is wanted to a few percent.
const ACCURACY: f64 = 0.01;

/// An angle, rad, that is none: a degree.
const NO_ANGLE: f64 = 0.017;

/// The part of the voltage along d below which it was computed from the speed, not measured.
const COMPUTED: f64 = 1e-6;

/// Fewest pieces from which anything is concluded.
const FEWEST: usize = 3;

/// Voltages at the terminals of a coasting drive.
pub(super) struct Terminals {
    pub(super) points: Vec<OperatingPoint>,
    /// By which part their voltages may differ from those under load, one standard deviation.
    pub(super) gain: f64,
}

/// The points without current, if their voltages are the terminals': judged by the points with current.
pub(super) fn at_terminals(log: &Log, loaded: &[OperatingPoint], lag: &FrameLag, request: &Request) -> Option<Terminals> {
    if !request.windows.is_empty() {
        return None;
    }
    let points: Vec<OperatingPoint> = recorder::coasting(log).into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect();
    let computed = points.iter().filter(|point| point.voltage().d.abs() <= COMPUTED * point.voltage().magnitude()).count();
    if points.len() < FEWEST || 2 * computed > points.len() || !turn_with_speed(&points) {
        return None;
    }
    let gain = gain_of_same_flux(log, loaded, &points, lag, request)?;
    Some(Terminals { points, gain })
}

/// The unknown gain of these voltages: none at other points.
pub(super) fn gain_unknown(points: &[OperatingPoint], is_coasting: impl Fn(usize) -> bool, standard_error: f64) -> Loss {
    let voltages = points.iter().enumerate().map(|(w, point)| {
        let Dq { d, q } = point.voltage();
        if is_coasting(w) { [d, q] } else { [0.0; 2] }
    });
    Loss { voltages: voltages.collect(), expected: 0.0, standard_error, part: Part::FrameLag }
}

/// Whether the voltages' angle from the q axis is in proportion to the speed, rather than the same at all speeds.
fn turn_with_speed(points: &[OperatingPoint]) -> bool {
    // From the axis, whichever way it points: a column with the wrong sign is none of this matter.
    let angles: Vec<(f64, f64)> = points.iter().map(|point| ((point.voltage().d / point.voltage().q).atan(), point.omega_e())).collect();
    let sum = |of: &dyn Fn(f64, f64) -> f64| angles.iter().map(|(angle, omega_e)| of(*angle, *omega_e)).sum::<f64>();
    let slope = sum(&|angle, omega_e| angle * omega_e) / sum(&|_, omega_e| omega_e * omega_e);
    let constant = sum(&|angle, _| angle) / angles.len() as f64;
    let turning = sum(&|angle, omega_e| (angle - slope * omega_e).powi(2));
    turning <= sum(&|angle, _| (angle - constant).powi(2)) || turning <= angles.len() as f64 * NO_ANGLE.powi(2)
}

/// By which part voltages without current may differ from those under load; nothing if they are not of one flux and one lag.
fn gain_of_same_flux(log: &Log, loaded: &[OperatingPoint], coasting: &[OperatingPoint], lag: &FrameLag, request: &Request) -> Option<f64> {
    let points: Vec<OperatingPoint> = loaded.iter().chain(coasting).cloned().collect();
    let excitation = Excitation::of(&points, &request.known);
    let inductances = Dq { d: f64::INFINITY, q: f64::INFINITY };
    let losses = LossPrior::possible(log, request).losses(&points, 0.0, inductances);
    let mut of_frames = lag.rough_unknowns(&points, log);
    of_frames[FrameLag::OTHER].standard_error = ANY_LAG;
    let gain = gain_unknown(&points, |w| w >= loaded.len(), 1.0);
    let unknowns: Vec<Loss> = [gain].into_iter().chain(of_frames).chain(losses).collect();
    let estimate = Estimate::solve_with(
        &points,
        &excitation,
        request,
        &unknowns,
        VoltageAccuracy { fraction: ACCURACY, ..VoltageAccuracy::default() },
    );
    let (gain, error) = *estimate.found.first()?;
    let (other, of_other) = *estimate.found.get(1 + FrameLag::OTHER)?;
    if other.abs() > SAME_LAG + LAG_FOUND * of_other {
        return None;
    }
    if error > GAIN_ERROR {
        return gain_by_bound(loaded, coasting);
    }
    (gain.abs() <= SAME_FLUX).then_some(gain.hypot(error))
}

/// How large the gain may be by the lightest load alone.
fn gain_by_bound(loaded: &[OperatingPoint], coasting: &[OperatingPoint]) -> Option<f64> {
    let fastest = loaded.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let flux = |point: &OperatingPoint| point.voltage().magnitude() / point.omega_e().abs();
    let fast = loaded.iter().filter(|point| point.omega_e().abs() > LEAST_SPEED * fastest);
    let lightest = fast.map(flux).fold(f64::INFINITY, f64::min);
    let below = 1.0 - coasting.iter().map(flux).sum::<f64>() / coasting.len() as f64 / lightest;
    (-ABOVE_LOAD..=BELOW_LOAD).contains(&below).then_some(below.abs().max(DIVIDERS))
}
