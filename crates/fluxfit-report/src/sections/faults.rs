//! Faults of the drive and voltage timings: which were tried, and which are part of the fit.

use crate::{
    report::Report,
    section::Section,
    table::{self, key},
    typography::{DASH, capitalized, decimals, fault, number, power, prose, sentence},
};
use fluxfit::{
    Warning,
    evidence::{FaultOutcome, FaultTrial, OutputFit, Provenance, Resolved, TimingTrial, VERY_STRONG},
    faults::Fault,
};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let fit = found.output.as_ref()?;
    let content = html! {
        h3 { "Faults of the drive" }
        (identified(fit))
        (tried(fit, &found.warnings))
        h3 { "Voltage timing" }
        (voltage_timings(fit))
    };
    Some(Section { anchor: "faults", heading: "Faults of the drive and voltage timing", content })
}

/// The faults that are part of the fit.
fn identified(fit: &OutputFit) -> Markup {
    html! {
        @if fit.fault_estimates.is_empty() {
            p { "None of the faults below was found." }
        } @else {
            (table::scrolling("Found beside the motor", &html! {
                table.tried {
                    thead { tr { th scope="col" { "Found beside the motor" } th scope="col" { "Value ±\u{a0}95\u{a0}%" } } }
                    tbody { @for nuisance in &fit.fault_estimates { tr {
                        th scope="row" { (prose(&capitalized(nuisance.unknown.label()))) }
                        td { (fault(nuisance)) }
                    } } }
                }
            }))
            p.small {
                "These are part of the fit: what they do to voltages and currents is not mistaken for the motor, and what their own uncertainty "
                "leaves open is part of the intervals."
                @if fit.has(Fault::Saturation) { " Beside saturation, the inductances of the answer are those at small currents." }
                @for meaning in Fault::ALL.into_iter().filter(|fault| fit.has(*fault)).filter_map(Fault::meaning) { " " (sentence(meaning)) }
            }
        }
    }
}

/// All faults that were tried.
fn tried(fit: &OutputFit, warnings: &[Warning]) -> Markup {
    html! {
        (table::scrolling("Faults that were tried", &html! {
            table.tried {
                thead { tr { th scope="col" { "Fault tried" } th scope="col" { "Gain" } th.words scope="col" { "Outcome" } } }
                tbody { @for tried in sorted(&fit.fault_trials) { (row(tried, warnings)) } }
            }
        }))
        p.small {
            "The gain is Schwarz’s criterion (BIC): N ln (cost before / cost after) less ln N for each unknown, with N independent residuals. "
            "Above zero the fault explains more than chance is expected to; above " (VERY_STRONG) " the odds are 150 to 1 that it is there. Each "
            "fault is compared with the fit that includes the faults taken before. It is taken if its gain is above " (VERY_STRONG) ", its value "
            "is physical, and it changes a parameter by more than its standard error or removes a noticeable part of the residuals’ power; an angle "
            "also needs operating points that tell it where rows are not the drive’s periods."
        }
    }
}

/// First the faults that were taken, then the others that were judged, each by their gain.
fn sorted(trials: &[FaultTrial]) -> Vec<&FaultTrial> {
    let mut sorted: Vec<&FaultTrial> = trials.iter().collect();
    let place = |trial: &FaultTrial| if trial.outcome == FaultOutcome::Taken { 0 } else { 1 + u8::from(!is_judged(trial)) };
    sorted.sort_by(|one, other| place(one).cmp(&place(other)).then(other.gain.total_cmp(&one.gain)));
    sorted
}

/// Whether the trial has a gain.
fn is_judged(trial: &FaultTrial) -> bool {
    !matches!(trial.outcome, FaultOutcome::Covered | FaultOutcome::NeedsAngle | FaultOutcome::NeedsTurning | FaultOutcome::NeedsCloserRows)
}

/// The warning of the operating points of the same effect, which the simulated currents did not confirm.
fn warning_of(fault: Fault, warnings: &[Warning]) -> Option<&Warning> {
    warnings.iter().find(|warning| {
        matches!((fault, warning), (Fault::DeadTime, Warning::DeadTime { .. }) | (Fault::Saturation, Warning::Saturation { .. }))
    })
}

fn row(tried: &FaultTrial, warnings: &[Warning]) -> Markup {
    html! {
        tr {
            th scope="row" { (prose(&capitalized(tried.fault.label()))) }
            td { @if is_judged(tried) { (number(tried.gain, gain)) } @else { (DASH) } }
            td.words { @if tried.outcome == FaultOutcome::Taken { span.badge.identified { "taken" } } @else {
                (explained(tried))
                @if let Some(warning) = warning_of(tried.fault, warnings) {
                    "; the operating points alone show it (warning “" (warning.code()) "”)"
                }
            } }
        }
    }
}

/// The gain, with tenths only if it is small.
fn gain(gain: f64) -> String {
    if gain.abs() < 10.0 { format!("{gain:.1}") } else { format!("{gain:.0}") }
}

fn explained(tried: &FaultTrial) -> &'static str {
    match (tried.fault, tried.outcome) {
        // The observer's gain is not the size of a fault.
        (Fault::Disturbance, FaultOutcome::NotPhysical) => "correcting with the measured current does not improve the prediction",
        (_, FaultOutcome::NotNeeded) if tried.gain > 0.0 => "explains hardly more than chance would",
        _ => tried.outcome.label(),
    }
}

/// A ratio: three digits, and as many as show that it is more than 1.
fn relative_to_best(ratio: f64) -> String {
    let more = ratio - 1.0;
    if more >= LIKE { format!("{ratio:.0$}", decimals(more, 2).clamp(2, 4)) } else { "1.00".to_owned() }
}

/// Residuals that differ by less than this part are as large.
const LIKE: f64 = 1e-3;

/// Whether the timing is one that no usual drive has, and its residuals are as small as those of the best.
fn is_unusual_but_fits(tried: &TimingTrial, best: f64) -> bool {
    tried.timing.is_unusual() && (tried.mean_square() / best).sqrt() < 1.0 + LIKE
}

/// The voltage timings that were tried.
fn voltage_timings(fit: &OutputFit) -> Markup {
    let Resolved { value: timing, provenance } = fit.voltage_timing;
    if provenance == Provenance::Stated {
        return html! { p { "The voltage timing was stated: " (timing.label()) ". No other one was tried." } };
    }
    let best = fit.timings.first().map_or(0.0, TimingTrial::mean_square);
    let possible: Vec<_> = fit.possible_timings().map(|tried| tried.timing).collect();
    html! {
        p {
            "The log does not state when its voltages act, so all voltage timings were fitted, with the identified faults. The one with the "
            "smallest residuals was taken: " (timing.label()) "."
            @if fit.timings.iter().any(|tried| tried.timing != timing && is_unusual_but_fits(tried, best)) {
                " Where an unusual timing fits as well, the usual one is taken."
            }
            @if possible.len() > 1 {
                " The log does not distinguish it from " (if possible.len() == 2 { "one other" } else { "some others" })
                "; the differences of the parameters between them are part of the uncertainty, unless the voltage timing is stated."
            }
        }
        (table::scrolling("Voltage timings", &html! {
            table.tried.timings.stacked {
                thead { tr {
                    th.words scope="col" { "The voltage of a row is" } th scope="col" { "Residual, A rms" }
                    th scope="col" { "Relative to the best" } th.words scope="col" { "Outcome" }
                } }
                tbody { @for tried in &fit.timings {
                    tr {
                        th scope="row" { (tried.timing.label()) }
                        td { (key("residual ")) (power(tried.mean_square().sqrt())) (key(" A rms")) }
                        td { (number((tried.mean_square() / best).sqrt(), relative_to_best)) (key(" of the best")) }
                        td.words {
                            @if tried.timing == timing { span.badge.identified { "taken" } }
                            @else if possible.contains(&tried.timing) { "possible" }
                            @else if is_unusual_but_fits(tried, best) { "fits as well, but is unusual" }
                            @else { "ruled out" }
                        }
                    }
                } }
            }
        }))
    }
}
