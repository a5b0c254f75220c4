//! The result of the swarm search, compared with the answer.

use crate::{
    report::Report,
    section::Section,
    table,
    typography::{grouped, number, power, symbol, unit},
};
use fluxfit::{
    evidence::Identification,
    evidence::Search,
    optimizer::{Method, StopReason},
};
use fluxfit_units::Scale;
use maud::{Markup, html};

/// Resolution of the values as a fraction of their standard errors: the swarm is compared with the minimum, not with the truth.
const RESOLUTION: f64 = 1e-2;

/// The section; `None` without a swarm search or without any value.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, method) = report.identification?;
    let (search, method) = (found.search.as_ref()?, method?);
    if found.parameters.iter().all(|judgement| judgement.value().is_none()) {
        return None;
    }
    let content = html! {
        p {
            @if found.output.is_none() {
                "The equations are linear in the parameters, so the answer above is the exact least-squares solution. "
            } @else {
                "Simulated currents are not linear in the parameters, so the answer above was found iteratively (Levenberg-Marquardt), with a start "
                "from the operating points or from differences of rows. "
            }
            "The swarm method " (method.label()) " searched " @if found.output.is_some() { "the whole search box " } "for the same minimum"
            @if found.output.as_ref().is_some_and(|fit| !fit.fault_estimates.is_empty()) { ", with the values of the identified faults fixed," }
            " and ended after " (grouped(search.report.evaluations)) " evaluations with a cost " (distance(found, search)) " that of the answer ("
            (stop_reason(search.report.stop_reason)) "). "
            @if found.output.is_none() { "The unit of this difference is one squared standard uncertainty: below 1 it is negligible." }
            @else { "The unit of this difference is the mean square of the residuals: below 1 it is negligible." }
        }
        (values(found, search, &method))
    };
    Some(Section { anchor: "search", heading: "Result of the swarm search", content })
}

/// Difference of the swarm's cost and the answer's, in the unit of which 1 is negligible.
fn distance(found: &Identification, search: &Search) -> Markup {
    let unit = found.output.as_ref().map_or(1.0, |fit| fit.cost / fit.redundancy.max(1) as f64);
    let distance = if unit > 0.0 { search.cost_above_optimum / unit } else { search.cost_above_optimum };
    html! { (power(distance.abs())) @if distance < 0.0 { " below" } @else { " above" } }
}

fn stop_reason(reason: StopReason) -> &'static str {
    match reason {
        StopReason::IterationLimit => "iteration limit",
        StopReason::CloseToOptimum => "close to the optimum",
        StopReason::TargetCost => "target cost reached",
        StopReason::Interrupted => "interrupted",
    }
}

fn values(exact: &Identification, search: &Search, method: &Method) -> Markup {
    html! {
        (table::scrolling("Result of the swarm search", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Answer" } th scope="col" { (method.label()) } th scope="col" { "Difference" }
                } }
                tbody {
                    @for judgement in &exact.parameters {
                        @if let Some(value) = judgement.value() {
                            @let scale = Scale::for_value(judgement.parameter, value);
                            @let show = |value: f64| number(value, |value| scale.format(value, RESOLUTION * judgement.uncertainty.standard_error()));
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
