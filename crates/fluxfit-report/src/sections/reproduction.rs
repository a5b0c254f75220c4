//! How to reproduce the page.

use crate::{
    report::{FleetReport, Origin, Report, ValidationReport},
    section::Section,
};
use maud::html;

/// The section of a report.
pub(crate) fn section(report: &Report) -> Option<Section> {
    Some(of(report.origin))
}

/// The section of a validation.
pub(crate) fn validation_section(report: &ValidationReport) -> Section {
    of(report.origin)
}

/// The section of a fleet.
pub(crate) fn fleet_section(report: &FleetReport) -> Option<Section> {
    Some(of(report.origin))
}

fn of(origin: &Origin) -> Section {
    let content = html! {
        // Each word is an element, so that lines break between words and not at the hyphens of options.
        pre { code { @for (k, word) in origin.command.split(' ').enumerate() { @if k > 0 { " " } span { (word) } } } }
        p { "With fluxfit " (origin.version) " and seed " (origin.seed) ", the same log gives the same numbers to the bit, on any number of cores." }
    };
    Section { anchor: "reproduce", heading: "How to reproduce", content }
}
