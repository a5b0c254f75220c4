//! The result: the parameters with their intervals and verdicts, the model, reasons, remedies and warnings, and the parts of the
//! uncertainty.

use crate::{
    judgement::{is_given, relative_half_width},
    report::Report,
    section::Section,
    table,
    typography::{DASH, capitalized, fault, list, minus, number, prose, symbol, unit},
};
use fluxfit::{
    Judgement, Verdict, evidence::IDENTIFIED, evidence::Identification, evidence::ModelChoice, evidence::Part, evidence::Provenance,
    evidence::WEAK,
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let content = html! {
        (parameters(found))
        p.small { (thresholds()) }
        (model(found))
        (explanations(found))
        (warnings(found))
        @if let Some(temperature) = &found.temperature {
            p { (prose(&sentence(&temperature.to_string()))) }
        }
        (unseen(found))
        (parts(found))
    };
    Some(Section { anchor: "answer", heading: "Parameters", content })
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
                    "Faults found and corrected: "
                    @for (k, nuisance) in fit.fault_estimates.iter().enumerate() {
                        @if k > 0 { "; " } (prose(nuisance.unknown.label())) " " (fault(nuisance))
                    }
                }
                " (" a href="#faults" { "details" } ")."
            } @else { "The steady voltage equations are fitted to the means over windows of constant currents and speed." }
        }
    }
}

/// A verdict on its background colour.
fn badge(verdict: Verdict) -> Markup {
    html! { span class={ "badge " (verdict.key()) } { (verdict.key().replace('-', " ")) } }
}

fn thresholds() -> Markup {
    html! {
        "Half-width of the 95 % interval: " (badge(Verdict::Identified)) " at most " (percent(IDENTIFIED)) " of the value; "
        (badge(Verdict::Weak)) " at most " (percent(WEAK)) "; "
        (badge(Verdict::NotIdentifiable)) " more, or the value is not positive: no value is shown."
    }
}

fn percent(fraction: f64) -> String {
    format!("{:.0} %", 100.0 * fraction)
}

fn parameters(found: &Identification) -> Markup {
    html! {
        (table::scrolling("Parameters", &html! {
            table.parameters {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Value" } th scope="col" { "± 95 %" }
                    th scope="col" { "95 % interval" } th scope="col" { "Main source of uncertainty" } th scope="col" { "Verdict" }
                } }
                tbody { @for judgement in &found.parameters { (parameter(judgement)) } }
            }
        }))
    }
}

fn parameter(judgement: &Judgement) -> Markup {
    let heading = html! { th scope="row" { (symbol(judgement.parameter)) } };
    let (Some(value), Some([low, high])) = (judgement.value(), judgement.interval()) else {
        return html! {
            tr { (heading) td.value { (DASH) } @for _ in 0..3 { td.none { (DASH) } } td { (badge(judgement.verdict)) } }
        };
    };
    let (scale, error) = (Scale::for_value(judgement.parameter, value), judgement.uncertainty.standard_error());
    let show = |value: f64| number(value, |value| scale.format(value, error));
    let unit = unit(judgement.parameter, &scale);
    let width = relative_half_width(judgement);
    html! {
        tr {
            (heading)
            td.value { strong { (show(value)) } " " (unit) }
            @if let Some(width) = width {
                td { "±" (significant(100.0 * width, 2)) " %" }
                td { (show(low)) " … " (show(high)) " " (unit) }
                td.words { (judgement.uncertainty.largest_part().label()) }
            } @else {
                // Given, not identified, as the reason says.
                @for _ in 0..3 { td.none { (DASH) } }
            }
            td { @if is_given(judgement) { span.badge { "given" } } @else { (badge(judgement.verdict)) } }
        }
    }
}

/// Reasons and remedies, once for parameters with the same ones.
fn explanations(found: &Identification) -> Markup {
    let mut shared: Vec<(Vec<Markup>, &Judgement)> = Vec::new();
    for judgement in found.parameters.iter().filter(|judgement| judgement.reason.is_some()) {
        let symbol = symbol(judgement.parameter);
        match shared.iter_mut().find(|(_, other)| other.reason == judgement.reason && other.remedy == judgement.remedy) {
            Some((symbols, _)) => symbols.push(symbol),
            None => shared.push((vec![symbol], judgement)),
        }
    }
    html! {
        @if !shared.is_empty() {
            dl.reasons {
                @for (symbols, judgement) in &shared {
                    dt { (list(symbols)) }
                    dd {
                        p { (prose(&sentence(&judgement.reason.as_ref().map(ToString::to_string).unwrap_or_default()))) }
                        @if let Some(remedy) = &judgement.remedy { p { strong { "To do: " } (prose(&remedy.to_string())) "." } }
                    }
                }
            }
        }
    }
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

/// What no log shows: what the intervals count of it as stated, and what they do not.
fn unseen(found: &Identification) -> Markup {
    let counted: Vec<String> = found.counted.iter().map(ToString::to_string).collect();
    let unseen: Vec<String> = found.unseen.iter().map(ToString::to_string).collect();
    html! {
        @for (what, errors) in [("In the intervals, as stated: ", counted), ("Not in the intervals, because no log shows it: ", unseen)] {
            @if !errors.is_empty() {
                p {
                    (what)
                    @for (place, error) in errors.iter().enumerate() {
                        @if place > 0 { "; " }
                        (prose(error))
                    }
                    "."
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
