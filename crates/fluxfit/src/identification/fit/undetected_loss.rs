//! What dead time and device drops that were not found could still do to the parameters.
//!
//! Where rows are far apart, or the residuals are not noise, the harmonics of the loss cannot be seen, and its fundamental looks like
//! resistance. That nothing was found then means little: the voltage of the loss is known no better than its physical limit and the rows
//! say,
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
    voltage_loss::{LossPrior, is_control_rate},
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

/// How far each parameter could be moved by it, SI, as a standard deviation; zero where dead time was found, or would have been.
pub(super) fn doubt(
    log: &Log,
    objective: &OutputError,
    drive: &Adjustable,
    unknowns: &[Unknown],
    residuals: &[f64],
    steady: Option<&SteadyFit>,
    request: &Request,
) -> [f64; PARAMETERS] {
    let was_found = unknowns.iter().any(|unknown| unknown.fault().is_some_and(|fault| fault.family() == Fault::DeadTime.family()));
    let is_noise = correlation_of_neighbours(residuals, &objective.rows_per_segment()) <= CORRELATED;
    let is_disturbed = unknowns.iter().any(|unknown| unknown.is_observer_gain());
    // A fundamental of 4/pi V per volt of each phase.
    let possible = LossPrior::possible(log, request).standard_error * PI / 4.0;
    if was_found || possible == 0.0 || is_control_rate(log) && is_noise && !is_disturbed {
        return [0.0; PARAMETERS];
    }
    if let Some(points) = steady.filter(|_| !is_control_rate(log)) {
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
