//! The summary below the heading of a page.

use crate::{
    judgement::is_given,
    report::Report,
    typography::{amperes, capitalized, count, grouped, in_words, list, power, symbol},
};
use fluxfit::{
    Judgement, Verdict,
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

fn identification(found: &Identification) -> Markup {
    let with = |is: &dyn Fn(&Judgement) -> bool| -> Vec<Markup> {
        found.parameters.iter().filter(|judgement| is(judgement)).map(|judgement| symbol(judgement.parameter)).collect()
    };
    let of = |verdict: Verdict| with(&|judgement| judgement.verdict == verdict && !is_given(judgement));
    let given = with(&is_given);
    let (good, weak, none) = (of(Verdict::Identified), of(Verdict::Weak), of(Verdict::NotIdentifiable));
    html! {
        (capitalized(&in_words(good.len()))) " of " (count(found.parameters.len(), "parameter")) " identified"
        @if !given.is_empty() { "; given: " (list(&given)) }
        @if !weak.is_empty() { "; weak: " (list(&weak)) }
        @if !none.is_empty() { "; not identifiable from this log: " (list(&none)) }
        ". "
        (basis(found))
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

fn study(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> Markup {
    html! {
        @if let [(only, _)] = methods { (only.method.label()) " ran " } @else { (capitalized(&count(methods.len(), "method"))) " ran " }
        @if facts.runs == 1 { "once" } @else { (facts.runs) " times" } @if methods.len() != 1 { " each" } "; median cost above the " (facts.problem.fitness.minimum_label()) ": "
        @for (k, (study, _)) in methods.iter().enumerate() {
            @if k > 0 { ", " }
            (study.method.label()) "\u{a0}" (power(study.median()))
        }
        "."
    }
}
