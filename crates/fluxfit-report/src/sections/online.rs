//! The estimators of a stream on the log: what they end with, beside the batch answer.

use crate::{
    report::Report,
    section::Section,
    table,
    typography::{DASH, minus, prose, symbol},
};
use fluxfit::motor::Parameter;
use fluxfit_track::comparison::{BatchEntry, EndEntry, OnlineDocument};
use fluxfit_units::significant;
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let document = &report.online?.document;
    let content = html! {
        p { (prose(&document.explanation())) "." }
        (ends(document))
    };
    Some(Section { anchor: "online", heading: "Estimators on a stream", content })
}

fn ends(document: &OnlineDocument) -> Markup {
    let of_batch = &document.batch;
    html! {
        (table::scrolling("Estimators on a stream", &html! {
            table {
                thead { tr {
                    th scope="col" { "Estimator" }
                    @for parameter in Parameter::ALL { th scope="col" { (symbol(parameter)) } }
                    th scope="col" { "Error covariance" }
                } }
                tbody {
                    @for estimator in &document.estimators {
                        @let of = &estimator.parameters;
                        tr {
                            th scope="row" { code { (estimator.method) } " " (estimator.label) }
                            @for end in [&of.rs, &of.ld, &of.lq, &of.psi_f] { td { (cell(end)) } }
                            td { @if estimator.has_covariance { "yes" } @else { "none" } }
                        }
                    }
                    tr {
                        th scope="row" { "batch answer: its standard error by noise" }
                        @for entry in [&of_batch.rs, &of_batch.ld, &of_batch.lq, &of_batch.psi_f] { td { (noise(entry)) } }
                        td { "yes" }
                    }
                }
            }
        }))
    }
}

fn cell(end: &EndEntry) -> String {
    let error = end.error_percent.map_or_else(|| DASH.to_owned(), |error| minus(significant(error, 2)));
    if end.identifiable == Some(false) { format!("[{error}]") } else { error }
}

fn noise(entry: &BatchEntry) -> String {
    match (entry.value, entry.statistical) {
        (Some(value), Some(error)) => format!("±{}", significant(100.0 * error / value.abs(), 2)),
        _ => DASH.to_owned(),
    }
}
