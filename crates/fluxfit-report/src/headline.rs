//! The summary below the heading of a page.

use crate::{
    report::Report,
    typography::{amperes, capitalized, count, grouped, power, prose},
};
use fluxfit::{
    Summary,
    evidence::Identification,
    study::{MethodStudy, comparison::Comparison},
};
use maud::{Markup, html};

/// The summary of a report.
pub(crate) fn headline(report: &Report) -> Markup {
    html! {
        @if let Some((found, _)) = report.identification { (identification(found)) }
        @if let Some((facts, methods)) = report.study {
            @if report.identification.is_some() { " " }
            (study(facts, methods))
        }
    }
}

/// How many parameters are identified and what to do next, in the library's words; then the data behind it.
fn identification(found: &Identification) -> Markup {
    html! {
        strong { (prose(&Summary::of(&found.parameters, &found.warnings).to_string())) }
        @if found.is_complete() {
            " Nothing more is to be done" @if !found.warnings.is_empty() { ", but see the warnings" } "."
        }
        br;
        span.basis { (basis(found)) }
    }
}

/// The data to which the motor is fitted.
fn basis(found: &Identification) -> Markup {
    html! {
        @if let Some(fit) = &found.output {
            @let (rms, rows) = (fit.residual_rms(), fit.residuals.len() / 2);
            "Simulated and measured currents differ by " (amperes(rms.d)) " (d) and " (amperes(rms.q)) " (q), root mean square over "
            (grouped(rows as u64)) " rows."
        } @else {
            "Fitted to the means of " (count(found.operating_points().len(), "operating point")) "."
        }
    }
}

/// Methods that are named where there are too many for a sentence.
const NAMED: usize = 3;

fn study(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> Markup {
    html! {
        @if let [(only, _)] = methods { (only.method.label()) " ran " } @else { (capitalized(&count(methods.len(), "method"))) " ran " }
        @if facts.runs == 1 { "once" } @else { (facts.runs) " times" } @if methods.len() != 1 { " each" } "; "
        @if facts.is_crowded() {
            @let noise = facts.problem.noise();
            @let within = methods.iter().filter(|(study, _)| study.share_within(noise) >= 1.0).count();
            @if within == 0 { "none" } @else { (within) } " of them ended within the noise of the data in every run. Of least cost: "
            @for (k, (study, _)) in facts.ranking().into_iter().take(NAMED).filter_map(|place| methods.get(place)).enumerate() {
                @if k > 0 { "; " }
                (study.method.label())
            }
        } @else {
            "median cost above the " (facts.problem.fitness.minimum_label()) ": "
            @for (k, (study, _)) in methods.iter().enumerate() {
                @if k > 0 { ", " }
                (study.method.label()) "\u{a0}" (power(study.median()))
            }
        }
        "."
    }
}
