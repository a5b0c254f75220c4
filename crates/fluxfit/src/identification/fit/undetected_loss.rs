//! What dead time and device drops that were not found could still do to the parameters.
//!
//! Where rows are far apart, the rotor stands, the residuals are not noise, or harmonics of the flux were found, the harmonics of the
//! loss cannot be seen, and its fundamental looks like resistance. That nothing was found then means little: the voltage of the loss is
//! known no better than its physical limit, the harmonics in operating points and the rows say,
//!
//! ```text
//! s^-2 = V_possible^-2 + c'c / sigma²,     c: the currents' derivative by it, without what the unknowns explain
//! ```
//!
//! and each parameter moves by its share of `s`. Rows far apart take the harmonics for something else; there it is what the operating
//! points make of the same limit, if there are any.

use super::{
    long_run::effective_sample_size,
    output_errors::{CORRELATED, correlation_of_neighbours},
    steady::SteadyFit,
    voltage_loss::{LossPrior, misshapen_if_fitted},
};
use crate::{
    faults::Fault,
    identification::request::Request,
    levenberg_marquardt::jacobian,
    log::Log,
    motor::{PARAMETERS, Parameter},
    normal_matrix::{NormalMatrix, dot},
    objective::{
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use std::f64::consts::PI;

/// How far each parameter could be moved by it, SI, as a standard deviation; zero where dead time was found for sure, or would have been.
pub(super) fn doubt(
    log: &Log,
    objective: &OutputError,
    drive: &Adjustable,
    unknowns: &[Unknown],
    residuals: &[f64],
    steady: Option<&SteadyFit>,
    request: &Request,
) -> [f64; PARAMETERS] {
    let has = |wanted: Fault| unknowns.iter().any(|unknown| unknown.fault().is_some_and(|fault| fault.family() == wanted.family()));
    let was_found = has(Fault::DeadTime);
    let is_noise = correlation_of_neighbours(residuals, &objective.rows_per_segment()) <= CORRELATED;
    let is_disturbed = unknowns.iter().any(|unknown| unknown.is_observer_gain());
    // What the harmonics in operating points say of it, which no observer corrects; a fundamental of 4/pi V per volt of each phase.
    let limit = LossPrior::possible(log, request).standard_error;
    let known = steady.map_or(limit, |points| points.loss_prior.expected.hypot(points.loss_prior.standard_error));
    let possible = known.min(limit) * PI / 4.0;
    // Harmonics of the flux take those of the loss as their own.
    let would_show = log.is_control_rate() && objective.turns() && is_noise && !is_disturbed && !has(Fault::FluxHarmonics);
    if possible > 0.0
        && !objective.turns()
        && let Some(doubt) = steady.and_then(|points| at_rest(objective, drive, unknowns, points, possible, request))
    {
        return doubt;
    }
    if was_found || possible == 0.0 || would_show {
        return [0.0; PARAMETERS];
    }
    if let Some(points) = steady.filter(|_| !log.is_control_rate()) {
        return points.finding.uncertainty.parameters.map(|parameter| parameter.systematic.dead_time);
    }
    // A loss of nothing yet, whose ramp is that of the first start of a fit.
    let start = Fault::DeadTime.starts(&drive.faults, objective.peak_current()).into_iter().next();
    let (Some(faults), Some(voltage)) = (start, Unknown::of_fault(Fault::DeadTime).next()) else { return [0.0; PARAMETERS] };
    let with_loss = Adjustable { faults, ..*drive };
    let columns = jacobian(objective, drive, unknowns);
    let Some(loss) = jacobian(objective, &with_loss, &[voltage]).pop() else { return [0.0; PARAMETERS] };
    // Residuals are measured less simulated: what an unknown takes up of a volt of the loss.
    let along: Vec<f64> = columns.iter().map(|column| dot(column, &loss)).collect();
    let inverse = NormalMatrix::of(&columns).inverse();
    let share: Vec<f64> = (0..unknowns.len()).map(|p| (0..unknowns.len()).map(|q| inverse[(p, q)] * along[q]).sum()).collect();
    let left = dot(&loss, &loss) - share.iter().zip(&along).map(|(share, along)| share * along).sum::<f64>();
    let variance = dot(residuals, residuals) / effective_sample_size(residuals);
    let told = if variance > 0.0 { left.max(0.0) / variance } else { 0.0 };
    let standard_error = (possible.powi(-2) + told).sqrt().recip();
    Parameter::ALL.map(|parameter| {
        let place = unknowns.iter().position(|unknown| *unknown == Unknown::Motor(parameter));
        place.map_or(0.0, |place| (share[place] * standard_error).abs())
    })
}

/// A current that is held is at least this part of the largest: what an injected voltage swings around is none.
const LEAST_HELD: f64 = 0.2;

/// At rest only transients tell the loss from the resistance, by a shape of the loss that is a rough one. Held currents tell them apart
/// where their magnitudes differ, as the line `V_1 + R_s I` does; what they leave open of the resistance is doubt of it, whether a loss was
/// found or not, and the other parameters move with it as they do in the fit. `None` where no current is held.
fn at_rest(
    objective: &OutputError,
    drive: &Adjustable,
    unknowns: &[Unknown],
    points: &SteadyFit,
    possible: f64,
    request: &Request,
) -> Option<[f64; PARAMETERS]> {
    let place = |parameter: Parameter| unknowns.iter().position(|unknown| *unknown == Unknown::Motor(parameter));
    let rs = place(Parameter::Rs)?;
    let held = points.operating_points.iter().map(|point| point.current().magnitude());
    let held: Vec<f64> = held.filter(|current| *current > LEAST_HELD * objective.peak_current()).collect();
    if held.is_empty() {
        return None;
    }
    let accuracy = request.voltage_accuracy * drive.motor.rs.abs() * objective.peak_current();
    let error = misshapen_if_fitted(drive.faults.dead_time.voltage).hypot(accuracy);
    let line = [held.iter().map(|i| i / error).chain([0.0]).collect(), held.iter().map(|_| 1.0 / error).chain([1.0 / possible]).collect()];
    let of_resistance = NormalMatrix::of(&line).inverse()[(0, 0)].max(0.0).sqrt();
    let inverse = NormalMatrix::of(&jacobian(objective, drive, unknowns)).inverse();
    Some(Parameter::ALL.map(|parameter| place(parameter).map_or(0.0, |p| (inverse[(p, rs)] / inverse[(rs, rs)] * of_resistance).abs())))
}
