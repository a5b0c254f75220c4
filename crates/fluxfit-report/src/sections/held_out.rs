//! Rows that were held out of the identification, and their prediction from its answer.

use super::validation::{parameters, prediction};
use crate::{
    report::Report,
    section::Section,
    typography::{grouped, number, prose},
};
use fluxfit_units::significant;
use maud::html;

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (log, validation) = report.held_out?;
    let content = html! {
        p {
            "These " (grouped(log.rows() as u64)) " rows, " (number(log.duration(), |seconds| significant(seconds, 3)))
            " s, were not used for the answer above. Here they are compared with it; it is the “given” motor, with its uncertainty. "
            @if let Some(found) = validation { strong { (prose(&found.verdict())) } }
            @else { strong { "They are not predicted" } ", because a prediction needs all four parameters." }
        }
        @if let Some(found) = validation {
            (parameters(found))
            h3 { "Measured against predicted" }
            (prediction(found))
        }
    };
    Some(Section { anchor: "held-out", heading: "Held-out data", content })
}
