//! Means of the runs' estimates and their errors (Table 2 of the paper), with the paper's values if its motor is the true one.

use crate::{
    report::Report,
    section::Section,
    table,
    typography::{DASH, capitalized, minus, number, symbol, unit},
};
use fluxfit::study::comparison::Comparison;
use fluxfit::{
    motor::{Motor, Parameter},
    optimizer::Method,
    paper::{self, Table2Column},
    study::{MethodStudy, error_percent, fitness::Fitness},
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// Searches whose means are this close to the minimum, %, have converged: a tenth of the difference between the paper's methods.
const CONVERGED: f64 = 0.03;

/// Resolution of an estimate as a fraction of its value; two digits of it are shown.
const RESOLUTION: f64 = 2e-4;

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (facts, methods) = report.study?;
    let unexcited = facts.problem.unexcited.as_slice();
    let with_paper = facts.truth.as_ref().is_some_and(is_papers_motor);
    let content = html! {
        @if facts.is_crowded() { (means_by_method(facts, methods, unexcited)) } @else { (means(facts, methods, unexcited, with_paper)) }
        (interpretation(facts, methods, unexcited, with_paper))
    };
    Some(Section { anchor: "estimates", heading: "Means of the estimates", content })
}

/// Name of the minimum that the methods approach.
fn minimum_name(facts: &Comparison) -> &'static str {
    match facts.problem.fitness {
        Fitness::VoltageError(_) => "exact least squares",
        Fitness::OutputError { .. } => "the polish",
    }
}

/// Whether a motor is the paper's, apart from rounding.
fn is_papers_motor(motor: &Motor) -> bool {
    motor.to_array().iter().zip(paper::MOTOR.to_array()).all(|(one, other)| (one / other - 1.0).abs() < 1e-9)
}

/// The column of a method in the paper's table.
fn papers_column(method: &Method) -> Option<&'static Table2Column> {
    paper::TABLE_2.iter().find(|column| column.method == method.key())
}

/// The table.
fn means(facts: &Comparison, methods: &[(MethodStudy, f64)], unexcited: &[Parameter], with_paper: bool) -> Markup {
    let papers = |study: &MethodStudy| papers_column(&study.method).filter(|_| with_paper);
    html! {
        (table::scrolling("Means of the estimates", &html! {
            table.estimates {
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Parameter" }
                        @if facts.truth.is_some() { th scope="col" rowspan="2" { "True" } }
                        @for (study, _) in methods {
                            th scope="colgroup" colspan=(if papers(study).is_some() { 2 } else { 1 }) { (study.method.label()) }
                        }
                        th scope="col" rowspan="2" { (capitalized(minimum_name(facts))) }
                    }
                    tr { @for (study, _) in methods {
                        th scope="col" { "here" }
                        @if papers(study).is_some() { th.paper scope="col" { "paper" } }
                    } }
                }
                tbody { @for parameter in Parameter::ALL {
                    @let known = !unexcited.contains(&parameter);
                    (estimates(facts, methods, parameter, known, &papers))
                    @if let Some(truth) = &facts.truth { (errors(facts, methods, parameter, truth, known, &papers)) }
                } }
            }
        }))
    }
}

/// The table where there are too many methods for a column each: a row each, the best first, below the true motor and the minimum.
fn means_by_method(facts: &Comparison, methods: &[(MethodStudy, f64)], unexcited: &[Parameter]) -> Markup {
    let (exact, _) = facts.problem.fitness.minimum();
    let scale = |parameter: Parameter| Scale::for_value(parameter, facts.truth.as_ref().unwrap_or(&exact).get(parameter));
    let show = |motor: &Motor, parameter: Parameter| {
        number(motor.get(parameter), |value| scale(parameter).format(value, value.abs() * RESOLUTION))
    };
    let ours = |motor: &Motor, parameter: Parameter| if unexcited.contains(&parameter) { DASH.to_owned() } else { show(motor, parameter) };
    html! {
        (table::scrolling("Means of the estimates", &html! {
            table {
                thead { tr {
                    th scope="col" { "Method" }
                    @for parameter in Parameter::ALL { th scope="col" { (symbol(parameter)) ", " (unit(parameter, &scale(parameter))) } }
                } }
                tbody {
                    @if let Some(truth) = &facts.truth {
                        tr { th scope="row" { "True" } @for parameter in Parameter::ALL { td { (show(truth, parameter)) } } }
                    }
                    tr {
                        th scope="row" { (capitalized(minimum_name(facts))) }
                        @for parameter in Parameter::ALL { td { (ours(&exact, parameter)) } }
                    }
                    @for (study, _) in facts.ranking().into_iter().filter_map(|place| methods.get(place)) {
                        tr {
                            th scope="row" { (study.method.label()) }
                            @for parameter in Parameter::ALL { td { (ours(&study.mean(), parameter)) } }
                        }
                    }
                }
            }
        }))
    }
}

type Papers<'a> = dyn Fn(&MethodStudy) -> Option<&'static Table2Column> + 'a;

/// A row of means.
fn estimates(facts: &Comparison, methods: &[(MethodStudy, f64)], parameter: Parameter, known: bool, papers: &Papers) -> Markup {
    let (exact, _) = facts.problem.fitness.minimum();
    let scale = Scale::for_value(parameter, facts.truth.as_ref().unwrap_or(&exact).get(parameter));
    let show = |motor: &Motor| number(motor.get(parameter), |value| scale.format(value, value.abs() * RESOLUTION));
    let ours = |motor: &Motor| if known { show(motor) } else { DASH.to_owned() };
    html! {
        tr.mean {
            th scope="row" { (symbol(parameter)) ", " (unit(parameter, &scale)) }
            @if let Some(truth) = &facts.truth { td { (show(truth)) } }
            @for (study, _) in methods {
                td { (ours(&study.mean())) }
                // With the paper's digits.
                @if let Some(column) = papers(study) { td.paper { (minus(scale.format(column.mean.get(parameter), papers_digit(parameter)))) } }
            }
            td { (ours(&exact)) }
        }
    }
}

/// Ten times the last digit that the paper prints, SI; two digits of it are shown.
fn papers_digit(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Rs => 1e-3,
        Parameter::Ld | Parameter::Lq => 1e-5,
        Parameter::PsiF => 1e-4,
    }
}

/// An error with the decimals that the paper prints.
fn papers_error(column: &Table2Column, parameter: Parameter) -> String {
    let decimals = if parameter == Parameter::Lq { 5 } else { 3 };
    format!("{:.decimals$}", column.error_percent[parameter as usize])
}

/// A row of errors, %.
fn errors(facts: &Comparison, methods: &[(MethodStudy, f64)], parameter: Parameter, truth: &Motor, known: bool, papers: &Papers) -> Markup {
    let (exact, _) = facts.problem.fitness.minimum();
    let show = |error: Option<f64>| match error {
        Some(error) if known => number(error, |error| significant(error, 3)),
        _ => DASH.to_owned(),
    };
    html! {
        tr.error {
            th scope="row" { "error, %" }
            td {}
            @for (study, _) in methods {
                td { (show(study.mean_error_percent(truth)[parameter as usize])) }
                @if let Some(column) = papers(study) { td.paper { (papers_error(column, parameter)) } }
            }
            td { (show(error_percent(&exact, truth, parameter))) }
        }
    }
}

/// What can be concluded from the table, and what cannot.
fn interpretation(facts: &Comparison, methods: &[(MethodStudy, f64)], unexcited: &[Parameter], with_paper: bool) -> Markup {
    let minimum = minimum_name(facts);
    let distance = distance_from_minimum(facts, methods, unexcited);
    let distance_text = number(distance, |percent| significant(percent, 2));
    html! {
        p {
            @if distance < CONVERGED {
                "The means of all methods lie within " (distance_text) " % of " (minimum) ". "
            } @else {
                "Not all searches have converged: the means differ by up to " (distance_text) " % from " (minimum) ". "
            }
            @if facts.truth.is_some() && !facts.is_crowded() {
                "The error is the mean over the runs of the distance from the true value. The last column is the error of the "
                (facts.problem.fitness.minimum_label()) ", which is caused by the log and its noise. A method with a smaller error than this has "
                "it by chance, so this error cannot rank the methods."
            }
        }
        @if with_paper && !facts.is_crowded() {
            p {
                "The columns “paper” are from Table 2 of Gao, Wang, Jiang and Hu, 2023, whose log is not published. "
                @if distance < CONVERGED {
                    "Converged searches cannot differ from each other by the 0.3 to 0.8 % between the paper’s methods in R" sub { "s" }
                    " and L" sub { "d" } ". The cause of those differences cannot be known: a common error of all four methods suggests the data, a "
                    "scatter between them suggests searches that had not converged."
                } @else {
                    "The cause of the differences between its methods cannot be known."
                }
            }
        }
    }
}

/// Largest distance of a method's mean from the minimum, %.
fn distance_from_minimum(facts: &Comparison, methods: &[(MethodStudy, f64)], unexcited: &[Parameter]) -> f64 {
    let (exact, _) = facts.problem.fitness.minimum();
    let known = || Parameter::ALL.into_iter().filter(|parameter| !unexcited.contains(parameter));
    let distances =
        methods.iter().flat_map(|(study, _)| known().filter_map(move |parameter| error_percent(&study.mean(), &exact, parameter)));
    distances.fold(0.0, f64::max)
}
