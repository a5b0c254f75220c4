//! Why the parameters are as certain as they are: reasons and remedies, warnings, the model, and the parts of the uncertainty.

use crate::{
    judgement::relative_half_width,
    report::Report,
    section::Section,
    table,
    typography::{DASH, capitalized, fault, list, minus, number, prose, symbol},
};
use fluxfit::{
    Judgement, Reason, Remedy, Summary,
    evidence::{Identification, ModelChoice, Part, Provenance},
};
use fluxfit_units::significant;
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let content = html! {
        (explanations(found))
        (warnings(found))
        (model(found))
        @if let Some(temperature) = &found.temperature {
            p { (prose(&sentence(&temperature.to_string()))) }
        }
        (parts(found))
    };
    Some(Section { anchor: "explanation", heading: "Reasons, warnings and sources of uncertainty", content })
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
                @if fit.fault_estimates.is_empty() { "No fault of the drive was found" } @else {
                    "Found beside the motor, and corrected: "
                    @for (k, nuisance) in fit.fault_estimates.iter().enumerate() {
                        @if k > 0 { "; " } (prose(nuisance.unknown.label())) " " (fault(nuisance))
                    }
                }
                " (" a href="#faults" { "details" } ")."
            } @else { "The steady voltage equations are fitted to the means over windows of constant currents and speed." }
        }
    }
}

/// Reasons, once for parameters with the same one; first the one step that helps most, then what else would.
fn explanations(found: &Identification) -> Markup {
    let mut shared: Vec<(Vec<&Judgement>, &Reason)> = Vec::new();
    for judgement in &found.parameters {
        let Some(reason) = &judgement.reason else { continue };
        match shared.iter_mut().find(|(_, other)| other.is_told_with(reason)) {
            Some((judgements, _)) => judgements.push(judgement),
            None => shared.push((vec![judgement], reason)),
        }
    }
    let next = Summary::of(&found.parameters).next.map(|next| next.remedy);
    html! {
        @if let Some(remedy) = &next { p.next { strong { "To do next: " } (prose(&remedy.to_string())) "." } }
        @if !shared.is_empty() {
            dl.reasons {
                @for (judgements, reason) in &shared {
                    dt { (list(&judgements.iter().map(|judgement| symbol(judgement.parameter)).collect::<Vec<_>>())) }
                    dd {
                        p { (prose(&sentence(&if judgements.len() > 1 { format!("{reason:#}") } else { reason.to_string() }))) }
                        (remedies(judgements, next.as_ref()))
                    }
                }
            }
        }
    }
}

/// The remedies of these parameters that are not the next step.
fn remedies(judgements: &[&Judgement], next: Option<&Remedy>) -> Markup {
    let mut told: Vec<&Remedy> = Vec::new();
    for remedy in judgements.iter().filter_map(|judgement| judgement.remedy.as_ref()) {
        if Some(remedy) != next && !told.contains(&remedy) {
            told.push(remedy);
        }
    }
    html! { @for remedy in told { p { strong { "To do: " } (prose(&remedy.to_string())) "." } } }
}

/// The text as a sentence: with a capital letter, unless it begins with a symbol, and a full stop.
fn sentence(text: &str) -> String {
    let symbol = text.split(' ').next().is_some_and(|word| word.contains('_'));
    format!("{}.", if symbol { text.to_owned() } else { capitalized(text) })
}

fn warnings(found: &Identification) -> Markup {
    html! {
        @if !found.warnings.is_empty() {
            div.warnings role="note" aria-label="Warnings" {
                @for warning in &found.warnings {
                    p { strong { "Warning: " (warning.code()) } br; (prose(&sentence(&warning.to_string()))) }
                }
            }
        }
    }
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
                table {
                    thead { tr {
                        th scope="col" { "Standard error, %" }
                        @for which in &shown { th scope="col" { (which.label()) } }
                        th scope="col" { "combined" }
                    } }
                    tbody {
                        @for judgement in answered {
                            tr {
                                th scope="row" { (symbol(judgement.parameter)) }
                                @for which in &shown { td { (share(judgement, part(judgement, *which))) } }
                                td { (share(judgement, judgement.uncertainty.standard_error())) }
                            }
                        }
                    }
                }
            }))
            p.small {
                "The parts are added in quadrature. Only the part from noise decreases with more rows. "
                "The 95 % interval is the combined standard error times Student’s t."
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
