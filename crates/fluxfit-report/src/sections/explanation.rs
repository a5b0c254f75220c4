//! What to do next, and why: reasons and remedies of the parameters, and warnings.

use super::flux;
use crate::{
    report::{Options, Report},
    section::Section,
    typography::{list, prose, sentence, symbol},
};
use fluxfit::{Judgement, NextStep, Reason, Remedy, Summary, evidence::Identification};
use maud::{Markup, html};

/// The section; `None` if there is nothing to do and nothing to warn of.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let is_explained = found.parameters.iter().any(|judgement| judgement.reason.is_some());
    (is_explained || !found.warnings.is_empty()).then(|| {
        let content = html! { (explanations(found, &report.options)) (warnings(found, &report.options)) };
        Section { anchor: "explanation", heading: if is_explained { "What to do next, reasons and warnings" } else { "Warnings" }, content }
    })
}

/// Reasons, once for parameters with the same one; first the one step that helps most, then what else would.
fn explanations(found: &Identification, options: &Options) -> Markup {
    let mut shared: Vec<(Vec<&Judgement>, &Reason)> = Vec::new();
    for judgement in &found.parameters {
        let Some(reason) = &judgement.reason else { continue };
        match shared.iter_mut().find(|(_, other)| other.is_told_with(reason)) {
            Some((judgements, _)) => judgements.push(judgement),
            None => shared.push((vec![judgement], reason)),
        }
    }
    let next = Summary::of(&found.parameters, &found.warnings).next;
    html! {
        @if let Some(next) = &next { p.next { strong { "To do next: " } (to_do(&next.instruction(), &next.remedy, options)) (to_fluxes(found, &next.remedy)) } }
        @if !shared.is_empty() {
            dl.reasons {
                @for (judgements, reason) in &shared {
                    dt { (list(&judgements.iter().map(|judgement| symbol(judgement.parameter)).collect::<Vec<_>>())) }
                    dd {
                        p { (prose(&sentence(&if judgements.len() > 1 { format!("{reason:#}") } else { reason.to_string() }))) }
                        (remedies(judgements, next.as_ref(), options))
                    }
                }
            }
        }
    }
}

/// The remedies of these parameters beside the next step: instead of it, where it helps them too.
fn remedies(judgements: &[&Judgement], next: Option<&NextStep>, options: &Options) -> Markup {
    let mut told: Vec<(&str, Markup)> = Vec::new();
    let is_next = |remedy: &Remedy| next.is_some_and(|next| next.is_same(remedy));
    for judgement in judgements {
        let Some(remedy) = judgement.remedy.as_ref().filter(|remedy| !is_next(remedy)) else { continue };
        let label = if next.is_some_and(|next| next.parameters.contains(&judgement.parameter)) { "Or: " } else { "To do: " };
        let step = match remedy {
            // Its alternative stands above.
            Remedy::HoldLonger { or, .. } if is_next(or) => html! { (prose(&format!("{remedy:#}"))) "." },
            remedy => to_do(&remedy.to_string(), remedy, options),
        };
        if told.iter().all(|(_, other)| other.0 != step.0) {
            told.push((label, step));
        }
    }
    html! { @for (label, step) in told { p { strong { (label) } (step) } } }
}

/// A remedy in these words, with the option that carries it out.
fn to_do(instruction: &str, remedy: &Remedy, options: &Options) -> Markup {
    html! { (prose(instruction)) (option((options.of_remedy)(remedy))) "." }
}

/// The way to the table of fluxes, where a step is to take them from it.
fn to_fluxes(found: &Identification, remedy: &Remedy) -> Markup {
    let has_table = found.saturation.as_ref().is_some_and(|saturation| saturation.fluxes.iter().any(Option::is_some));
    html! {
        @if has_table && matches!(remedy, Remedy::SmallSteps | Remedy::TakeIncremental { .. }) {
            " " a href={ "#" (flux::TABLE) } { "Table of fluxes" } "."
        }
    }
}

/// An option in brackets.
fn option(option: Option<&str>) -> Markup {
    html! { @if let Some(option) = option { " (" code { (option) } ")" } }
}

fn warnings(found: &Identification, options: &Options) -> Markup {
    html! {
        @if !found.warnings.is_empty() {
            div.warnings role="note" aria-label="Warnings" {
                @for warning in &found.warnings {
                    p { strong { "Warning: " (warning.code()) } br; (prose(sentence(&warning.to_string()).trim_end_matches('.'))) (option((options.of_warning)(warning))) "." }
                }
            }
        }
    }
}
