//! The page of a validation: the verdict, given against the log's own, each channel, and the courses on which it rests.

use crate::{
    ValidationReport,
    figure::{self, residuals},
    frame,
    measured::Measured,
    origin,
    page::{self, Section},
    typography::{DASH, capitalized, decimals, grouped, minus, number, power, prose, symbol, unit},
};
use fluxfit::{
    Validation, evidence::SteadyFit, log::Log, validation::prediction::Prediction, validation::validate::Channel,
    validation::validate::Difference, validation::validate::LITTLE, validation::validate::Outcome, validation::validate::SIGNIFICANCE,
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// A probability below which nobody asks how small it is.
const NEVER: f64 = 1e-12;

/// The whole page.
pub(crate) fn document(report: &ValidationReport) -> Markup {
    let found = report.found;
    let sections = [
        Section { anchor: "parameters", heading: "Given, and as the log has it", content: parameters(found) },
        Section { anchor: "prediction", heading: "Measured against predicted", content: prediction(report.log, found) },
        Section { anchor: "read", heading: "What was read", content: read(report) },
        Section { anchor: "reproduce", heading: "How to reproduce", content: origin::reproduce(report.origin) },
    ];
    page::sheet(&format!("{} on {}", report.motor, report.title), &prose(&found.verdict()), &sections, report.origin)
}

/// An outcome as a word on its colour.
fn badge(outcome: Outcome) -> Markup {
    html! { span class={ "badge " (outcome.key()) } { (outcome.label()) } }
}

fn parameters(found: &Validation) -> Markup {
    html! {
        (frame::scrolling("Parameters, given and of the log", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Given" } th scope="col" { "The log’s own" }
                    th scope="col" { "Difference" } th scope="col" { "± 95 %" } th scope="col" { "In standard errors" }
                } }
                tbody { @for difference in &found.parameters { (parameter(difference)) } }
            }
        }))
        p.small {
            "The log’s own parameters are identified from it as if nothing were given; the difference is own less given. "
            @if found.test.tested > 0 {
                "A log of exactly this motor would differ as much or more, in all parameters together, with probability "
                (probability(found.test.probability)) ": below " (SIGNIFICANCE) " the log differs. "
            }
            "By little means by at most " (number(100.0 * LITTLE, |percent| significant(percent, 1)))
            " % of the current or voltage, which is about what current sensors are good to. "
            @if found.untested().next().is_some() { "A parameter that the log cannot tell is taken as given, and the others are tested with it." }
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

/// A probability; of very small ones only that they are.
fn probability(probability: f64) -> Markup {
    if probability < NEVER {
        html! { "less than " (power(NEVER)) }
    } else {
        power(probability)
    }
}

fn parameter(difference: &Difference) -> Markup {
    let Difference { parameter, given, own } = *difference;
    let scale = Scale::for_value(parameter, given);
    let error = own.map_or(0.0, |own| own.standard_error);
    let show = |value: f64| number(value, |value| scale.format(value, error));
    let half_width = own.map(|own| 100.0 * own.half_width / given);
    html! {
        tr {
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
                td { "cannot tell" } @for _ in 0..3 { td.none { (DASH) } }
            }
        }
    }
}

fn prediction(log: &Log, found: &Validation) -> Markup {
    html! {
        p { @match &found.prediction {
            Prediction::Currents(_) => {
                "The logged voltages drive the motor that was given, row by row; nothing but its first current comes from the measured ones. "
                "Noise is what the log’s own parameters miss in the same way."
            }
            Prediction::Voltages(_) => {
                "At each operating point the steady voltage equations predict the voltages from the currents. "
                "Noise is the standard uncertainty of a point’s voltages."
            }
        } }
        (channels(found))
        @match &found.prediction {
            Prediction::Currents(courses) => {
                @let both = Measured::and_predicted(log, courses);
                (frame::live_figure(|size| figure::currents::draw(both, size), &figure::currents::live(both), &html! {
                    (prose("Above: i_d and i_q, measured (wide, light) and predicted (thin, dark); below each, measured less predicted at its own scale. Every column of pixels \
                     spans from the least to the largest value in it, so that no transient is lost. The bold line is the mean over short spans: a prediction that holds keeps it at zero, and leaves noise around it."))
                    (figure::currents::thinning(&both))
                }))
            }
            Prediction::Voltages(left) => @if let Some(fit) = &found.own.steady {
                @let fit = with_residuals(fit, left);
                (frame::live_figure(|size| residuals::draw(&fit, size), &residuals::live(&fit), &html! {
                    "Measured less predicted (here: fitted) voltages, with bars of two standard uncertainties. Bars that miss zero mean that the prediction fails there."
                }))
            },
        }
    }
}

/// The log's own operating points, with what is left of their voltages.
pub(crate) fn with_residuals(fit: &SteadyFit, left: &[[f64; 2]]) -> SteadyFit {
    let mut fit = fit.clone();
    fit.estimate.residuals = left.to_vec();
    fit
}

/// What was held out, predicted: a section of the page of an identification.
pub(crate) fn held_out((log, found): (&Log, Option<&Validation>)) -> Markup {
    html! {
        p {
            "These " (grouped(log.rows() as u64)) " rows, " (number(log.duration(), |seconds| significant(seconds, 3)))
            " s, had no part in the answer above; here it is “given”, with its uncertainty, and held against them. "
            @if let Some(found) = found { strong { (prose(&found.verdict())) } }
            @else { strong { "They are not predicted" } ", because that takes all four parameters." }
        }
        @if let Some(found) = found {
            (parameters(found))
            h3 { "Measured against predicted" }
            (prediction(log, found))
        }
    }
}

fn channels(found: &Validation) -> Markup {
    html! {
        (frame::scrolling("Channels", &html! {
            table {
                thead { tr {
                    th scope="col" { "Channel" } th scope="col" { "Missed by, rms" } th scope="col" { "Noise, rms" } th scope="col" { "Ratio" }
                    th scope="col" { "Variance explained" } th scope="col" { "Prediction differs by" } th scope="col" { "Verdict" }
                } }
                tbody { @for channel in &found.channels { (row(channel)) } }
            }
        }))
        p.small {
            "Missed by: measured less predicted. Differs by: the prediction of the given parameters less that of the log’s own, as a share of the "
            @if found.own.output.is_some() { "current" } @else { "voltage" } " vector. "
            "A channel that stands still has no variance to be explained."
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
            td { (badge(outcome)) }
        }
    }
}

/// As many nines as there are.
fn explained_percent(explained: f64) -> String {
    let digits = decimals(100.0 * (1.0 - explained), 1).min(6);
    number(100.0 * explained, |percent| format!("{percent:.digits$} %"))
}

fn read(report: &ValidationReport) -> Markup {
    let log = report.log;
    html! {
        dl.facts {
            dt { "Motor" } dd { (report.motor) }
            dt { "Rows" } dd { (grouped(log.rows() as u64)) }
            dt { "Rate" } dd { (origin::rate(log)) }
            dt { "Duration" } dd { (number(log.duration(), |seconds| significant(seconds, 3))) " s" }
            dt { "Segments between gaps" } dd { (log.segments().len()) }
            dt { "Model" } dd { (report.found.own.model.model.label()) " (" (report.found.own.model.reason) ")" }
        }
        @if !report.notes.is_empty() { ul { @for note in report.notes { li { (prose(note)) } } } }
    }
}
