//! Where the uncertainty of the parameters comes from: the model, and the parts of each interval.

use crate::{
    judgement::relative_half_width,
    report::Report,
    section::Section,
    table,
    typography::{DASH, list, minus, number, prose, sentence, symbol},
};
use fluxfit::{
    Judgement,
    evidence::{Identification, ModelChoice, OutputFit, Part, Provenance},
    faults::Fault,
};
use fluxfit_units::significant;
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let content = html! {
        (model(found))
        @if let Some(temperature) = &found.temperature {
            p { (prose(&sentence(&temperature.to_string()))) }
        }
        (parts(found))
    };
    Some(Section { anchor: "uncertainty", heading: "Model and sources of uncertainty", content })
}

/// The model, the reason for its choice, and the effects identified in addition to the motor.
fn model(found: &Identification) -> Markup {
    let ModelChoice { model, reason: why, .. } = &found.model;
    html! {
        p {
            strong { "Model: " (model.label()) } " (" (prose(&why.to_string())) "). "
            @if let Some(fit) = &found.output {
                "The parameters minimize the difference between simulated and measured currents over all rows. The logged voltage of a row is taken "
                "as "
                (fit.voltage_timing.value.label()) @if fit.voltage_timing.provenance == Provenance::Found { ", determined from the currents" } ". "
                @let taken = taken(fit);
                @if taken.is_empty() { "No fault of the drive was found" } @else {
                    "Found beside the motor, and corrected: " (list(&taken))
                }
                " (" a href="#faults" { "details" } ")."
            } @else { "The steady voltage equations are fitted to the means over windows of constant currents and speed." }
        }
    }
}

/// The faults that are part of the fit.
fn taken(fit: &OutputFit) -> Vec<Markup> {
    Fault::ALL.into_iter().filter(|fault| fit.has(*fault)).map(|fault| prose(fault.label())).collect()
}

/// The parts of an uncertainty, noise first.
fn all_parts(judgement: &Judgement) -> impl Iterator<Item = (f64, Part)> {
    std::iter::once((judgement.uncertainty.statistical, Part::Noise)).chain(judgement.uncertainty.systematic.parts())
}

fn part(judgement: &Judgement, wanted: Part) -> f64 {
    all_parts(judgement).find(|(_, part)| *part == wanted).map_or(0.0, |(value, _)| value)
}

/// The parts of each uncertainty: standard errors in percent of the value. Parts that are zero for all parameters are omitted.
fn parts(found: &Identification) -> Markup {
    let answered: Vec<&Judgement> = found.parameters.iter().filter(|judgement| relative_half_width(judgement).is_some()).collect();
    let all = found.parameters.first().into_iter().flat_map(all_parts).map(|(_, part)| part);
    let shown: Vec<Part> = all.filter(|which| answered.iter().any(|judgement| part(judgement, *which) > 0.0)).collect();
    html! {
        @if !shown.is_empty() {
            h3 { "Sources of uncertainty" }
            (table::scrolling("Parts of the uncertainty", &html! {
                table.sources {
                    thead { tr {
                        th scope="col" { "Standard error, % of the value" }
                        @for judgement in &answered { th scope="col" { (symbol(judgement.parameter)) } }
                    } }
                    tbody {
                        @for which in &shown { tr {
                            th scope="row" { (which.label()) span.cause { (which.cause()) } }
                            @for judgement in &answered { td { (share(judgement, part(judgement, *which))) } }
                        } }
                        tr.combined {
                            th scope="row" { "combined" }
                            @for judgement in &answered { td { (share(judgement, judgement.uncertainty.standard_error())) } }
                        }
                        tr {
                            th scope="row" { "half of the 95\u{a0}% interval" }
                            @for judgement in &answered { td { "±" (share(judgement, judgement.uncertainty.half_width)) } }
                        }
                    }
                }
            }))
            p.small {
                "The parts are added in quadrature. Only the part from noise decreases with more rows. "
                "Half of the 95\u{a0}% interval is the combined standard error times Student’s t."
            }
        }
    }
}

fn share(judgement: &Judgement, standard_error: f64) -> String {
    if standard_error == 0.0 {
        return DASH.to_owned();
    }
    number(100.0 * standard_error / judgement.raw.abs(), |percent| minus(significant(percent, 2)))
}
