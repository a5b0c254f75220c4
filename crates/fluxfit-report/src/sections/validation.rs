//! The sections of a validation: given parameters against those of the log, and measured against predicted channels.

use super::log;
use crate::{
    report::ValidationReport,
    section::Section,
    table,
    typography::{DASH, capitalized, decimals, grouped, minus, number, power, prose, symbol, unit},
};
use fluxfit::{
    Validation,
    validation::{
        prediction::Prediction,
        validate::{Channel, Difference, LITTLE, Outcome, SIGNIFICANCE},
    },
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// Smaller probabilities are shown as this bound.
const SMALLEST_PROBABILITY: f64 = 1e-12;

/// The section of the parameters.
pub(crate) fn parameters_section(report: &ValidationReport) -> Section {
    Section { anchor: "parameters", heading: "Given parameters and those of the log", content: parameters(report.found) }
}

/// The section of the prediction.
pub(crate) fn prediction_section(report: &ValidationReport) -> Section {
    Section { anchor: "prediction", heading: "Measured against predicted", content: prediction(report.found) }
}

/// The section of the log.
pub(crate) fn log_section(report: &ValidationReport) -> Section {
    let content = html! {
        dl.facts {
            dt { "Motor" } dd { (report.motor) }
            dt { "Rows" } dd { (grouped(report.log.rows() as u64)) }
            (log::facts(report.log))
            dt { "Model" } dd { (report.found.own.model.model.label()) " (" (report.found.own.model.reason) ")" }
        }
        @if !report.notes.is_empty() { ul { @for note in report.notes { li { (note) } } } }
    };
    Section { anchor: "log", heading: "Log", content }
}

/// An outcome on its background colour.
pub(crate) fn badge(outcome: Outcome) -> Markup {
    html! { span class={ "badge " (outcome.key()) } { (outcome.label()) } }
}

/// The table of given parameters and those of the log.
pub(crate) fn parameters(found: &Validation) -> Markup {
    html! {
        (table::scrolling("Given parameters and those of the log", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Given" } th scope="col" { "From this log" }
                    th scope="col" { "Difference" } th scope="col" { "±\u{a0}95\u{a0}%" } th scope="col" { "In standard errors" } th scope="col" { "Verdict" }
                } }
                tbody { @for difference in &found.parameters { (parameter(difference)) } }
            }
        }))
        @for hint in found.parameters.iter().filter_map(Difference::unit_hint) { p.next { strong { "Check the unit: " } (prose(&hint)) "." } }
        p.small {
            "The parameters from this log are identified without the given ones; the difference is that value less the given one. "
            @if found.test.tested > 0 {
                "If the given parameters are the true ones, the probability of such differences or larger ones, of all parameters together, is "
                (probability(found.test.probability)) "; below " (SIGNIFICANCE) " the difference is significant. "
            }
            "Differences of the prediction up to " (number(100.0 * LITTLE, |percent| significant(percent, 1)))
            " % of the current or voltage, about the accuracy of current sensors, count as small. "
            @if found.untested().next().is_some() { "A parameter that is not identifiable from this log is not tested; the others are tested with its given value." }
        }
        @if !found.own.warnings.is_empty() {
            div.warnings role="note" aria-label="Warnings" {
                @for warning in &found.own.warnings {
                    p { strong { "Warning: " (warning.code()) } br; (prose(&capitalized(&warning.to_string()))) "." }
                }
            }
        }
    }
}

/// A probability, or the bound of a very small one.
fn probability(probability: f64) -> Markup {
    if probability < SMALLEST_PROBABILITY {
        html! { "less than " (power(SMALLEST_PROBABILITY)) }
    } else {
        power(probability)
    }
}

fn parameter(difference: &Difference) -> Markup {
    let Difference { parameter, given, own, .. } = *difference;
    let scale = Scale::for_value(parameter, given);
    let error = own.map_or(0.0, |own| own.standard_error);
    let show = |value: f64| number(value, |value| scale.format(value, error));
    let half_width = own.map(|own| 100.0 * own.half_width / given);
    let outcome = match difference.is_different() {
        _ if own.is_none() => Outcome::CannotTell,
        true => Outcome::Contradicts,
        false => Outcome::Agrees,
    };
    html! {
        tr class=[(outcome == Outcome::Contradicts).then_some("differs")] {
            th scope="row" { (symbol(parameter)) }
            td { (show(given)) " " (unit(parameter, &scale)) }
            @if let Some(own) = own {
                td { (show(own.value)) " " (unit(parameter, &scale)) }
                td { (difference.percent().map_or(DASH.to_owned(), |value| {
                    let digits = decimals(half_width.unwrap_or(0.0), 2);
                    number(value, |value| format!("{value:+.digits$} %"))
                })) }
                td { (half_width.map_or(DASH.to_owned(), |value| number(value, |value| format!("{} %", significant(value, 2))))) }
                td { (difference.standard_errors().map_or(DASH.to_owned(), |value| minus(format!("{value:+.1}")))) }
            } @else {
                td { "not identifiable" } @for _ in 0..3 { td.none { (DASH) } }
            }
            td { (badge(outcome)) }
        }
    }
}

/// The method of the prediction, and the table of channels.
pub(crate) fn prediction(found: &Validation) -> Markup {
    html! {
        p { @match &found.prediction {
            Prediction::Currents(_) => {
                "The given motor is simulated with the logged voltages; only its initial currents are taken from the measured ones. "
                "Noise is the residual of the same simulation with the parameters from this log."
            }
            Prediction::Voltages(_) => {
                "At each operating point the steady voltage equations predict the voltages from the currents. "
                "Noise is the standard uncertainty of the measured voltages."
            }
        } }
        (channels(found))
    }
}

fn channels(found: &Validation) -> Markup {
    html! {
        (table::scrolling("Channels", &html! {
            table {
                thead { tr {
                    th scope="col" { "Channel" } th scope="col" { "Residual, rms" } th scope="col" { "Noise, rms" } th scope="col" { "Ratio" }
                    th scope="col" { "Variance explained" } th scope="col" { "Prediction differs by" } th scope="col" { "Verdict" }
                } }
                tbody { @for channel in &found.channels { (row(channel)) } }
            }
        }))
        p.small {
            "The residual is measured less predicted. “Differs by” is the prediction with the given parameters less that with the parameters from "
            "this log, relative to the "
            @if found.own.output.is_some() { "current" } @else { "voltage" } " vector. "
            "A constant channel has no variance to be explained."
        }
    }
}

fn row(channel: &Channel) -> Markup {
    let Channel { name, unit, rms, noise, explained, share, outcome, .. } = *channel;
    let symbol = name.split_at(1);
    html! {
        tr {
            th scope="row" { i { (symbol.0) } sub { (symbol.1) } }
            td { (power(rms)) " " (unit) }
            td { (power(noise)) " " (unit) }
            td { (channel.ratio().map_or(DASH.to_owned(), |ratio| number(ratio, |ratio| significant(ratio, 3)))) }
            td { (explained.map_or(DASH.to_owned(), explained_percent)) }
            td { (power(100.0 * share)) " %" }
            td { @if channel.is_within_intervals_alone() { (channel.verdict()) } @else { (badge(outcome)) } }
        }
    }
}

/// A fraction in percent with enough decimals to show its difference from 100 %.
fn explained_percent(explained: f64) -> String {
    let digits = decimals(100.0 * (1.0 - explained), 1).min(6);
    number(100.0 * explained, |percent| format!("{percent:.digits$} %"))
}
