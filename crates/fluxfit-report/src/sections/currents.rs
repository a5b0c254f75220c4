//! Measured against simulated currents.

use crate::{
    report::Report,
    section::Section,
    typography::{amperes, percent, prose},
};
use fluxfit::{evidence::OutputFit, faults::Fault, log::Log};
use maud::html;

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let fit = found.output.as_ref()?;
    let rms = fit.residual_rms();
    let content = html! {
        p {
            @if fit.has(Fault::Disturbance) {
                "Each row is predicted from the measured currents of the row before, with the identified motor and the logged voltages and speeds, "
                "because voltages that are not in the log disturb this motor. "
            } @else {
                "The identified motor is simulated with the logged voltages and speeds from the first row of each stretch to its last. Measured "
                "currents are not fed back; only the initial currents of each stretch are fitted. "
            }
            "The root-mean-square residuals are " (amperes(rms.d)) " (" (prose("i_d")) ") and " (amperes(rms.q)) " (" (prose("i_q")) "), "
            (percent(part_of_current(report.log, fit))) " % of the largest current."
        }
    };
    Some(Section { anchor: "currents", heading: "Measured against simulated", content })
}

/// The larger residual, root mean square, as a part of the largest current.
pub(super) fn part_of_current(log: &Log, fit: &OutputFit) -> f64 {
    let rms = fit.residual_rms();
    rms.d.max(rms.q) / peak_current(log, fit)
}

/// The largest measured current of the rows that were fitted, A; never zero.
fn peak_current(log: &Log, fit: &OutputFit) -> f64 {
    let columns = log.columns();
    let all = fit.stretches.iter().flat_map(Clone::clone).map(|row| columns.id[row].hypot(columns.iq[row]));
    all.fold(f64::MIN_POSITIVE, f64::max)
}
