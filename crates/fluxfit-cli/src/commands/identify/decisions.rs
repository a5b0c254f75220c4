//! What an identification decided on the way, for `--verbose`.

use crate::terminal::detail;
use fluxfit::{evidence::Identification, evidence::OutputFit};
use fluxfit_units::{significant, small};

/// Tells the windows, the model and, of the output error, the readings and faults that were tried.
pub(crate) fn show(found: &Identification) {
    for point in found.operating_points() {
        detail(|| format!("window {} .. {} s, {} rows", significant(point.time.0, 6), significant(point.time.1, 6), point.rows.len()));
    }
    detail(|| format!("model {}: {}", found.model.model.label(), found.model.reason));
    if let Some(fit) = &found.output {
        output(fit);
    }
    if let Some(search) = &found.search {
        detail(|| format!("the swarm made {} evaluations", search.report.evaluations));
    }
}

fn output(fit: &OutputFit) {
    for tried in &fit.timings {
        let converged = if tried.polished.converged { "" } else { ", not converged" };
        let rms = tried.mean_square().sqrt();
        detail(|| format!("voltages read as {}: misses the currents by {} A rms{converged}", tried.timing.label(), small(rms)));
    }
    for tried in &fit.fault_trials {
        detail(|| format!("{}: {}", tried.fault.label(), tried.outcome.label()));
    }
}
