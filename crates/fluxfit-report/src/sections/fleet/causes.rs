//! Why answers are missing: equal reasons of different motors counted together.

use crate::{
    report::FleetReport,
    section::Section,
    table,
    typography::{grouped, prose},
};
use fluxfit::fleet::Cause;
use maud::{Markup, html};

/// Causes and warnings that are listed.
const LISTED: usize = 20;

/// The section; none of a fleet with all answers and no warning.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let (causes, warnings) = (&report.fleet.causes, &report.fleet.warnings);
    let listed = causes.len().min(LISTED);
    let content = html! {
        @if listed > 0 {
            (table::scrolling("Why answers are missing", &html! {
                table {
                    thead { tr { th scope="col" { "Motors" } th.words scope="col" { "Missing" } th.words scope="col" { "Why" } th.words scope="col" { "Which" } } }
                    tbody { @for cause in &causes[..listed] { (row(cause)) } }
                }
            }))
            p.small {
                "Sentences that differ only in names and numbers are counted together; the sentence shown is that of the first motor."
                @if causes.len() > listed { " " (grouped((causes.len() - listed) as u64)) " more kinds of fewer motors are in the results." }
            }
        }
        @if !warnings.is_empty() {
            p {
                "Warnings: "
                @for (k, (code, motors)) in warnings.iter().take(LISTED).enumerate() {
                    @if k > 0 { ", " } code { (code) } " of " (grouped(*motors as u64))
                }
                "."
            }
        }
    };
    (listed > 0 || !warnings.is_empty()).then_some(Section { anchor: "causes", heading: "Reasons and warnings", content })
}

fn row(cause: &Cause) -> Markup {
    let more = cause.motors - cause.names.len();
    html! {
        tr {
            td { (grouped(cause.motors as u64)) }
            td.words { (prose(&cause.missing.to_string())) }
            td.words { (prose(&cause.example)) }
            td.words { (cause.names.join(", ")) @if more > 0 { " and " (grouped(more as u64)) " more" } }
        }
    }
}
