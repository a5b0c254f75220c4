//! The answer: the parameters, how far to trust them, why a verdict is not better and what to do.

use crate::{
    figure::intervals,
    frame, tried,
    typography::{DASH, capitalized, list, minus, number, prose, symbol, unit},
};
use fluxfit::{
    Judgement, Verdict, evidence::IDENTIFIED, evidence::Identification, evidence::ModelChoice, evidence::Part, evidence::Provenance,
    evidence::WEAK,
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(found: &Identification) -> Markup {
    html! {
        (parameters(found))
        (model(found))
        (explanations(found))
        (warnings(found))
        (frame::figure(|size| intervals::draw(found, size), &html! {
            "Half of the 95 % interval as a share of the value, on a logarithmic scale: farther left is better. "
            (thresholds())
        }))
        (parts(found))
    }
}

/// The model, why it was chosen, and what it found beside the motor.
fn model(found: &Identification) -> Markup {
    let ModelChoice { model, reason: why } = &found.model;
    html! {
        p {
            strong { "Model: " (model.label()) } " (" (prose(&why.to_string())) "). "
            @if let Some(fit) = &found.output {
                "The motor is the one whose simulated currents are nearest the measured ones, row by row. Its voltages are read as "
                (fit.voltage_reading.0.label()) @if fit.voltage_reading.1 == Provenance::Found { ", as the currents ask for" } ". "
                @if fit.nuisance.is_empty() { "No fault of the drive shows" } @else {
                    "Found beside the motor, and taken into account: "
                    @for (k, nuisance) in fit.nuisance.iter().enumerate() {
                        @if k > 0 { "; " } (prose(nuisance.unknown.label())) " " (tried::found(nuisance))
                    }
                }
                " (" a href="#tried" { "what was tried" } ")."
            } @else { "The steady voltage equations hold for the means of windows in which the log stands still." }
        }
    }
}

/// A verdict as a word on its colour.
fn badge(verdict: Verdict) -> Markup {
    html! { span class={ "badge " (verdict.key()) } { (verdict.key().replace('-', " ")) } }
}

/// Whether a parameter was given instead of identified: then there is no doubt of it, and no verdict either.
pub(crate) fn is_given(judgement: &Judgement) -> bool {
    judgement.value().is_some() && judgement.uncertainty.standard_error() == 0.0
}

fn thresholds() -> Markup {
    html! {
        (badge(Verdict::Identified)) " means at most " (percent(IDENTIFIED)) " of the value, "
        (badge(Verdict::Weak)) " at most " (percent(WEAK)) ", "
        (badge(Verdict::NotIdentifiable)) " more than that, or not positive: then no value is given."
    }
}

fn percent(fraction: f64) -> String {
    format!("{:.0} %", 100.0 * fraction)
}

fn parameters(found: &Identification) -> Markup {
    html! {
        (frame::scrolling("Parameters", &html! {
            table.parameters {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Value" } th scope="col" { "± 95 %" }
                    th scope="col" { "95 % interval" } th scope="col" { "Mostly from" } th scope="col" { "Verdict" }
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
    let width = intervals::relative_half_width(judgement);
    html! {
        tr {
            (heading)
            td.value { strong { (show(value)) } " " (unit) }
            @if let Some(width) = width {
                td { "±" (significant(100.0 * width, 2)) " %" }
                td { (show(low)) " … " (show(high)) " " (unit) }
                td.words { (judgement.uncertainty.largest_part().label()) }
            } @else {
                // Given, not identified: the reason says so.
                @for _ in 0..3 { td.none { (DASH) } }
            }
            td { @if is_given(judgement) { span.badge { "given" } } @else { (badge(judgement.verdict)) } }
        }
    }
}

/// Reasons and remedies; parameters that share both share the lines.
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

/// With a capital, unless it begins with a symbol, and a full stop.
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

/// Parts of an uncertainty, noise first.
fn all_parts(judgement: &Judgement) -> impl Iterator<Item = (f64, Part)> {
    std::iter::once((judgement.uncertainty.statistical, Part::Noise)).chain(judgement.uncertainty.systematic.parts())
}

fn part(judgement: &Judgement, wanted: Part) -> f64 {
    all_parts(judgement).find(|(_, part)| *part == wanted).map_or(0.0, |(value, _)| value)
}

/// Where the uncertainty comes from: each part's standard error in percent of the value. Parts that nobody has are left out.
fn parts(found: &Identification) -> Markup {
    let answered: Vec<&Judgement> =
        found.parameters.iter().filter(|judgement| intervals::relative_half_width(judgement).is_some()).collect();
    let all = found.parameters.first().into_iter().flat_map(all_parts).map(|(_, part)| part);
    let shown: Vec<Part> = all.filter(|which| answered.iter().any(|judgement| part(judgement, *which) > 0.0)).collect();
    html! {
        @if !shown.is_empty() {
            h3 { "Where the uncertainty comes from" }
            (frame::scrolling("Parts of the uncertainty", &html! {
                table {
                    thead { tr {
                        th scope="col" { "Standard error, %" }
                        @for which in &shown { th scope="col" { (which.label()) } }
                        th scope="col" { "together" }
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
                "The parts are added in quadrature. “Noise” falls with more rows; the others do not. "
                "The 95 % interval is Student’s t times the whole."
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
