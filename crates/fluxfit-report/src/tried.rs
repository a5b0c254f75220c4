//! What else was tried: readings of the voltage columns, and faults of the drive, with what speaks for and against each.

use crate::{
    frame,
    typography::{DASH, capitalized, minus, number, power, prose},
};
use fluxfit::{
    evidence::{FaultTrial, Nuisance, Outcome, OutputFit, Provenance, ReadingTrial},
    faults::Fault,
};
use fluxfit_units::{format_unknown, significant};
use maud::{Markup, html};

/// Standard errors in half of a 95 % interval.
const INTERVAL: f64 = 1.959_964;

/// The section.
pub(crate) fn section(fit: &OutputFit) -> Markup {
    html! {
        h3 { "Beside the motor" }
        (beside(fit))
        (faults(fit))
        h3 { "What the voltage columns mean" }
        (readings(fit))
    }
}

/// A number beside the motor with its 95 %: what, how much, of what unit.
pub(crate) fn found(nuisance: &Nuisance) -> Markup {
    let [value, margin, unit] = format_unknown(nuisance.unknown, nuisance.value, INTERVAL * nuisance.standard_error);
    let unit = unit.replace("deg", "°").strip_prefix('u').map_or_else(|| unit.replace("deg", "°"), |rest| format!("µ{rest}"));
    html! { (minus(value)) " ± " (margin) " " (unit) }
}

fn beside(fit: &OutputFit) -> Markup {
    html! {
        @if fit.nuisance.is_empty() {
            p { "Nothing was found between the motor and its log: no fault below was taken." }
        } @else {
            (frame::scrolling("Found beside the motor", &html! {
                table.tried {
                    thead { tr { th scope="col" { "Found beside the motor" } th scope="col" { "Value ± 95 %" } } }
                    tbody { @for nuisance in &fit.nuisance { tr {
                        th scope="row" { (prose(&capitalized(nuisance.unknown.label()))) }
                        td { (found(nuisance)) }
                    } } }
                }
            }))
            p.small { "They are part of the fit: the parameters above are those of the motor without them." }
        }
    }
}

fn faults(fit: &OutputFit) -> Markup {
    html! {
        (frame::scrolling("Faults that were tried", &html! {
            table.tried {
                thead { tr { th scope="col" { "Tried" } th scope="col" { "Gain" } th.words scope="col" { "Outcome" } } }
                tbody { @for tried in &fit.terms { (fault(tried)) } }
            }
        }))
        p.small {
            "The gain is Schwarz’s criterion, N ln (cost before / cost after) less ln N for each unknown, with N independent residuals: above zero "
            "a fault explains more than chance would. Each is held against what was taken before it. To be taken it must also be physical, and move "
            "a parameter by more than its standard error or take 1 % of the residual’s power away."
        }
    }
}

fn fault(tried: &FaultTrial) -> Markup {
    let judged = !matches!(tried.outcome, Outcome::Covered | Outcome::NeedsAngle);
    html! {
        tr {
            th scope="row" { (capitalized(tried.fault.label())) }
            td { @if judged { (number(tried.gain, gain)) } @else { (DASH) } }
            td.words { @if tried.outcome == Outcome::Taken { span.badge.identified { "taken" } } @else { (explained(tried)) } }
        }
    }
}

/// Tenths only where they decide.
fn gain(gain: f64) -> String {
    if gain.abs() < 10.0 { format!("{gain:.1}") } else { format!("{gain:.0}") }
}

fn explained(tried: &FaultTrial) -> &'static str {
    match (tried.fault, tried.outcome) {
        // An observer's gain is no fault with a size.
        (Fault::Disturbance, Outcome::NotPhysical) => "following the measured current makes the prediction no better",
        _ => tried.outcome.label(),
    }
}

fn readings(fit: &OutputFit) -> Markup {
    let (reading, provenance) = fit.voltage_reading;
    if provenance == Provenance::Stated {
        return html! { p { "It was stated: " (reading.label()) ". No other reading was tried." } };
    }
    let best = fit.readings.first().map_or(0.0, ReadingTrial::mean_square);
    let possible: Vec<_> = fit.possible_readings().map(|tried| tried.reading).collect();
    html! {
        p {
            "Which voltage acted when is not in the log, so every reading of the voltage columns was fitted, without faults of the drive. The one that "
            "leaves least of the currents unexplained was taken: " (reading.label()) "."
            @if possible.len() > 1 {
                " The log does not tell it from " (if possible.len() == 2 { "one other" } else { "some others" })
                "; how far the parameters move between them is counted as uncertainty. " code { "--voltage-timing" } " states it."
            }
        }
        (frame::scrolling("Readings of the voltage columns", &html! {
            table.tried {
                thead { tr {
                    th.words scope="col" { "The voltages of a row are" } th scope="col" { "Left, A rms" }
                    th scope="col" { "Times the best" } th.words scope="col" { "Outcome" }
                } }
                tbody { @for tried in &fit.readings {
                    tr {
                        th scope="row" { (tried.reading.label()) }
                        td { (power(tried.mean_square().sqrt())) }
                        td { (number((tried.mean_square() / best).sqrt(), |ratio| significant(ratio, 3))) }
                        td.words {
                            @if tried.reading == reading { span.badge.identified { "taken" } }
                            @else if possible.contains(&tried.reading) { "possible" }
                            @else { "ruled out" }
                        }
                    }
                } }
            }
        }))
    }
}
