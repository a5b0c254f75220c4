//! The swarm's answer beside the exact one.

use crate::{
    frame,
    typography::{grouped, number, power, symbol, unit},
};
use fluxfit::{
    identify::{Identification, Search},
    optimizer::{Method, StopReason},
};
use fluxfit_files::number::Scale;
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
            "The equations are linear in the parameters, so least squares solves them exactly; that is the answer above. "
            (method.label()) " searched for the same minimum and, after " (grouped(search.report.evaluations)) " evaluations, ended "
            (power(search.cost_above_optimum)) " above it (" (stop_reason(search.report.stop_reason)) "). "
            "The unit of that cost is one squared standard uncertainty: below 1 the difference does not matter."
        }
        (values(found, search, method))
    })
}

fn stop_reason(reason: StopReason) -> &'static str {
    match reason {
        StopReason::IterationLimit => "all iterations were run",
        StopReason::CloseToOptimum => "close enough to the optimum",
        StopReason::TargetCost => "the cost asked for was reached",
    }
}

fn values(exact: &Identification, search: &Search, method: &Method) -> Markup {
    html! {
        (frame::scrolling("The swarm’s answer", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Exact" } th scope="col" { (method.label()) } th scope="col" { "Difference" }
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
