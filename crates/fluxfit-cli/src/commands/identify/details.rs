//! What an answer rests on, for `--verbose`: the operating points, the terms that were not taken, what the swarm reached.

use crate::terminal::{self, DIM, HEADING, table};
use fluxfit::{
    Parameter, Warning,
    evidence::{FaultOutcome, Identification, OutputFit, Part, SteadyFit},
    faults::Fault,
    optimizer::Method,
};
use fluxfit_units::{Scale, small};

/// All of it, as paragraphs below the answer.
pub(super) fn text(found: &Identification) -> String {
    let mut text = String::new();
    if let Some(fit) = &found.output {
        if fit.has(Fault::Disturbance) && !found.warnings.contains(&Warning::ProcessNoise) {
            text += &format!("\n{}", terminal::wrapped("", &format!("Changes no verdict: {}.", Warning::ProcessNoise)));
        }
        for (outcome, lines) in [("Not taken", not_taken(fit, false)), ("Not tried without theta_e", not_taken(fit, true))] {
            if !lines.is_empty() {
                text += &format!("\n{}", terminal::wrapped("", &format!("{outcome}: {}.", lines.join(", "))));
            }
        }
    }
    if let Some(fit) = &found.steady {
        let what = if found.output.is_some() {
            "Operating points (means), as a check: off by what their own fit leaves"
        } else {
            "Operating points (means)"
        };
        text += &format!("\n{DIM}{what}{DIM:#}\n{}", operating_points(fit));
        let terms: Vec<&str> = fit.terms().into_iter().map(Part::cause).collect();
        if !terms.is_empty() {
            let what = format!("Fitted beside the four parameters, and part of the fitted voltages: {}.", terms.join("; "));
            text += &terminal::wrapped("", &what);
        }
    }
    let answered = found.parameters.iter().any(|judgement| judgement.value().is_some());
    if let Some(method) = found.method.as_ref().filter(|_| answered) {
        text += &format!("\n{}", search(found, method));
    }
    text
}

/// Faults that the answer does without, in few words: for want of the electrical angle, or for any other reason.
fn not_taken(fit: &OutputFit, needs_angle: bool) -> Vec<&'static str> {
    let mut words = Vec::new();
    for tried in &fit.fault_trials {
        let left_out = if needs_angle {
            tried.outcome == FaultOutcome::NeedsAngle
        } else {
            !matches!(tried.outcome, FaultOutcome::NeedsAngle | FaultOutcome::NeedsTurning | FaultOutcome::Taken | FaultOutcome::Covered)
        };
        let word = tried.fault.family();
        if left_out && !words.contains(&word) {
            words.push(word);
        }
    }
    words
}

fn operating_points(found: &SteadyFit) -> String {
    let in_millivolts = found.estimate.residuals.iter().flatten().all(|residual| residual.abs() < LARGE);
    let rows = found.operating_points.iter().zip(&found.estimate.residuals).map(|(point, residual)| {
        let (u, i) = (point.voltage(), point.current());
        let [from, length] = times(point.time);
        let mut row = vec![from, length, point.rows.len().to_string()];
        row.extend([i.d, i.q, point.omega_e(), u.d, u.q].map(short));
        row.extend(residual.map(|volts| if in_millivolts { millivolts(volts) } else { short(volts) }));
        row
    });
    let off_by = if in_millivolts { ["off by\nd mV", "\nq mV"] } else { ["off by\nd V", "\nq V"] };
    table(&[&["t\ns", "for\ns", "rows", "i_d\nA", "i_q\nA", "omega_e\nrad/s", "u_d\nV", "u_q\nV"][..], &off_by].concat(), 0, rows)
}

/// Start and length, with digits that tell the length to a hundredth of it.
fn times((start, end): (f64, f64)) -> [String; 2] {
    let decimals = (2 - (end - start).log10().floor() as i32).clamp(0, 9) as usize;
    [start, end - start].map(|time| format!("{time:.decimals$}"))
}

/// Up to three decimals, and five digits.
fn short(value: f64) -> String {
    let whole = value.abs().max(1.0).log10().floor() as usize + 1;
    format!("{value:.*}", 5_usize.saturating_sub(whole).min(3))
}

/// From here on, V, residuals are in V.
const LARGE: f64 = 1.0;

/// Without the sign of a zero.
fn millivolts(volts: f64) -> String {
    let text = format!("{:.1}", 1e3 * volts);
    if text == "-0.0" { "0.0".to_owned() } else { text }
}

/// What the swarm alone reached.
fn search(found: &Identification, method: &Method) -> String {
    let Some(search) = &found.search else { return String::new() };
    let known = |parameter: &Parameter| found.parameter(*parameter).value().is_some();
    let values: Vec<String> = Parameter::ALL
        .into_iter()
        .filter(known)
        .map(|parameter| {
            let value = search.motor.get(parameter);
            let scale = Scale::for_value(parameter, value);
            format!("{} {} {}", parameter.symbol(), scale.format(value, value.abs() * 1e-4), scale.unit(parameter.unit()))
        })
        .collect();
    let what = format!(
        "{HEADING}{}{HEADING:#} alone, after {} evaluations, is {}{} above the {} minimum:",
        method.label(),
        search.report.evaluations,
        small(search.cost_above_optimum),
        if found.output.is_some() { " A²" } else { "" },
        if found.output.is_some() { "least-squares" } else { "exact least-squares" },
    );
    terminal::wrapped("", &what) + &terminal::wrapped("  ", &values.join(", "))
}
