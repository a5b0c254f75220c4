//! Gains that are common to all current sensors, or to all voltages: no log shows them, so their stated accuracy widens the intervals.
//!
//! Currents read `1 + g` times too large turn a motor into another one that explains the log as well: `R_s`, `L_d` and `L_q` divided by
//! `1 + g`, and the same `psi_f`. Voltages read `1 + g` times too large multiply all four by `1 + g`. All parameters move together, so
//! that this is a term of rank one in their covariance, and ratios such as `L_d / L_q` stay as sharp as they were.
//!
//! A parameter that is known does not move with the others. What that takes from them is exact to first order:
//!
//! ```text
//! d theta / d g = m theta - sum over known q of K_q m_q x_q
//! ```
//!
//! with `m` -1, 0 or 1, the known value `x_q`, and `K_q` what a unit of `x_q` does to the estimate. It is one for the parameter itself if
//! that is fixed.

use super::{finding::Finding, output::OutputFit, steady::SteadyFit};
use crate::{
    error::Error,
    identification::request::{Known, Request},
    levenberg_marquardt::{MOTOR, jacobian},
    log::Log,
    motor::{Motor, PARAMETERS},
    normal_matrix::NormalMatrix,
    objective::{adjustable::Unknown, output_error::OutputError},
};

/// What reading all currents too large does to each parameter, in its own size: the voltages divided by them are impedances.
pub(crate) const BY_CURRENTS: [f64; PARAMETERS] = [-1.0, -1.0, -1.0, 0.0];

/// What reading all voltages too large does.
pub(crate) const BY_VOLTAGES: [f64; PARAMETERS] = [1.0; PARAMETERS];

/// Half of the 95 % interval of a normal distribution, in standard deviations.
const HALF_WIDTH: f64 = 1.959_964;

/// What a unit of each parameter's known value does to all of them; zero for a parameter that is not known.
type ByKnown = [[f64; PARAMETERS]; PARAMETERS];

/// Counts the stated accuracies in the uncertainty of both fits.
///
/// # Errors
/// If the rows are too few to be simulated.
pub(crate) fn count(log: &Log, steady: Option<&mut SteadyFit>, output: Option<&mut OutputFit>, request: &Request) -> Result<(), Error> {
    if request.current_accuracy.is_none() && request.bus_accuracy.is_none() {
        return Ok(());
    }
    if let Some(fit) = steady {
        let by_known = by_known_of_points(fit, request);
        widen(&mut fit.finding, &by_known, request);
    }
    if let Some(fit) = output {
        let by_known = by_known_of_currents(log, fit, request)?;
        widen(&mut fit.finding, &by_known, request);
    }
    Ok(())
}

fn widen(finding: &mut Finding, by_known: &ByKnown, request: &Request) {
    let moves = |signs, accuracy: Option<f64>| {
        let standard = accuracy.unwrap_or(0.0) / HALF_WIDTH;
        per_unit(&finding.motor, signs, &request.known, by_known).map(|moved| standard * moved)
    };
    let (currents, voltages) = (moves(BY_CURRENTS, request.current_accuracy), moves(BY_VOLTAGES, request.bus_accuracy));
    finding.uncertainty.count_common_gains(&currents, &voltages);
}

/// The effect of a gain error of one on each parameter, to first order, SI.
fn per_unit(motor: &Motor, signs: [f64; PARAMETERS], known: &[Known; PARAMETERS], by_known: &ByKnown) -> [f64; PARAMETERS] {
    let theta = motor.to_array();
    std::array::from_fn(|p| {
        let held = known.iter().enumerate().map(|(q, known)| match known {
            Known::Nothing => 0.0,
            Known::Fixed(value) | Known::Prior { value, .. } => by_known[q][p] * signs[q] * value,
        });
        signs[p] * theta[p] - held.sum::<f64>()
    })
}

/// Of the operating points, whose equations are linear: through the gains of the estimate.
fn by_known_of_points(fit: &SteadyFit, request: &Request) -> ByKnown {
    let mut priors = fit.estimate.prior_gains.iter();
    let mut by_known = [[0.0; PARAMETERS]; PARAMETERS];
    for (q, known) in request.known.iter().enumerate() {
        match known {
            Known::Nothing => {}
            Known::Prior { standard_error, .. } => {
                let gain = priors.next().copied().unwrap_or_default();
                by_known[q] = gain.map(|moved| moved / standard_error);
            }
            Known::Fixed(_) => {
                by_known[q][q] = 1.0;
                for (point, gain) in fit.operating_points.iter().zip(&fit.estimate.gains) {
                    let [d, q_axis] = point.equations().map(|equation| equation.coefficients[q]);
                    by_known[q].iter_mut().zip(gain).for_each(|(moved, gain)| *moved -= gain[0] * d + gain[1] * q_axis);
                }
            }
        }
    }
    by_known
}

/// Of simulated currents: through their derivatives, the faults beside the motor included.
fn by_known_of_currents(log: &Log, fit: &OutputFit, request: &Request) -> Result<ByKnown, Error> {
    let mut by_known = [[0.0; PARAMETERS]; PARAMETERS];
    if request.known.iter().all(|known| *known == Known::Nothing) {
        return Ok(by_known);
    }
    let objective = OutputError::of_rows(log, &fit.stretches, fit.voltage_timing.value)?;
    let is_free = |p: &usize| !matches!(request.known[*p], Known::Fixed(_));
    let free: Vec<usize> = (0..PARAMETERS).filter(is_free).collect();
    let faults = fit.fault_estimates.iter().map(|estimate| estimate.unknown);
    let unknowns: Vec<Unknown> = free.iter().map(|p| MOTOR[*p]).chain(faults).collect();
    let mut columns = jacobian(&objective, &fit.drive, &unknowns);
    // A prior is a residual of its own, with the weight of the currents' noise over its standard error.
    let noise = (fit.cost / fit.residuals.len() as f64).sqrt();
    let weight = |q: usize| if let Known::Prior { standard_error, .. } = request.known[q] { noise / standard_error } else { 0.0 };
    for (row, q) in free.iter().enumerate() {
        columns.iter_mut().enumerate().for_each(|(column, slopes)| slopes.push(if row == column { weight(*q) } else { 0.0 }));
    }
    let inverse = NormalMatrix::of(&columns).inverse();
    for (q, known) in request.known.iter().enumerate() {
        // What a unit of the known value asks of each unknown, before the others answer.
        let asked: Vec<f64> = match known {
            Known::Nothing => continue,
            Known::Prior { .. } => {
                let place = free.iter().position(|p| *p == q);
                (0..unknowns.len()).map(|k| if Some(k) == place { weight(q).powi(2) } else { 0.0 }).collect()
            }
            Known::Fixed(_) => {
                by_known[q][q] = 1.0;
                let by_fixed = jacobian(&objective, &fit.drive, &[MOTOR[q]]).into_iter().next().unwrap_or_default();
                columns.iter().map(|column| -column.iter().zip(&by_fixed).map(|(one, other)| one * other).sum::<f64>()).collect()
            }
        };
        for (k, p) in free.iter().enumerate() {
            let moved: f64 = asked.iter().enumerate().map(|(l, asked)| inverse[(k, l)] * asked).sum();
            by_known[q][*p] = if moved.is_finite() { moved } else { 0.0 };
        }
    }
    Ok(by_known)
}
