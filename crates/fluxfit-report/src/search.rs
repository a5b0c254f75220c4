//! The swarm's answer beside that of least squares.

use crate::{
    frame,
    typography::{grouped, number, power, symbol, unit},
};
use fluxfit::{
    evidence::Identification,
    evidence::Search,
    optimizer::{Method, StopReason},
};
use fluxfit_units::Scale;
use maud::{Markup, html};

/// Digits of a value beyond those of its standard error: the swarm is compared with the exact answer, not with the truth.
const FINER: f64 = 1e-2;

/// The section; none where no swarm searched or nothing can be answered.
pub(crate) fn section(found: &Identification, method: Option<&Method>) -> Option<Markup> {
    let (search, method) = (found.search.as_ref()?, method?);
    if found.parameters.iter().all(|judgement| judgement.value().is_none()) {
        return None;
    }
    Some(html! {
        p {
            @if found.output.is_none() {
                "The equations are linear in the parameters, so least squares solves them exactly; that is the answer above. "
            } @else {
                "Simulated currents are not linear in the parameters, so the answer above was reached step by step, from the operating points or "
                "from differences of rows (Levenberg and Marquardt). "
            }
            (method.label()) " searched " @if found.output.is_some() { "the whole box " } "for the same minimum"
            @if found.output.as_ref().is_some_and(|fit| !fit.nuisance.is_empty()) { ", with what was found beside the motor held," }
            " and, after " (grouped(search.report.evaluations)) " evaluations, ended " (distance(found, search)) " it ("
            (stop_reason(search.report.stop_reason)) "). "
            @if found.output.is_none() { "The unit of that cost is one squared standard uncertainty: below 1 the difference does not matter." }
            @else { "The cost is the sum of squared residuals, and its unit here their mean square: below 1 the difference does not matter." }
        }
        (values(found, search, method))
    })
}

/// How far above the answer's cost the swarm's is, in the unit in which 1 is noise; or below, should it have found a better one.
fn distance(found: &Identification, search: &Search) -> Markup {
    let unit = found.output.as_ref().map_or(1.0, |fit| fit.cost / fit.redundancy.max(1) as f64);
    let distance = if unit > 0.0 { search.cost_above_optimum / unit } else { search.cost_above_optimum };
    html! { (power(distance.abs())) @if distance < 0.0 { " below" } @else { " above" } }
}

fn stop_reason(reason: StopReason) -> &'static str {
    match reason {
        StopReason::IterationLimit => "all iterations were run",
        StopReason::CloseToOptimum => "close enough to the optimum",
        StopReason::TargetCost => "the cost asked for was reached",
        StopReason::Interrupted => "interrupted",
    }
}

fn values(exact: &Identification, search: &Search, method: &Method) -> Markup {
    html! {
        (frame::scrolling("The swarm’s answer", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Answer" } th scope="col" { (method.label()) } th scope="col" { "Difference" }
                } }
                tbody {
                    @for judgement in &exact.parameters {
                        @if let Some(value) = judgement.value() {
                            @let scale = Scale::for_value(judgement.parameter, value);
                            @let show = |value: f64| number(value, |value| scale.format(value, FINER * judgement.uncertainty.standard_error()));
                            @let found = search.motor.get(judgement.parameter);
                            @let difference = (value != 0.0).then(|| 100.0 * (found / value - 1.0).abs());
                            tr {
                                th scope="row" { (symbol(judgement.parameter)) ", " (unit(judgement.parameter, &scale)) }
                                td { (show(value)) }
                                td { (show(found)) }
                                td { @if let Some(percent) = difference { (power(percent)) " %" } }
                            }
                        }
                    }
                }
            }
        }))
    }
}
