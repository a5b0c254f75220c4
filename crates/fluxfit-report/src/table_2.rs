//! Table 2 of the paper: the mean of the runs' estimates and their error, beside the paper's own where its motor is the truth.

use crate::{
    frame,
    typography::{DASH, capitalized, minus, number, symbol, unit},
};
use fluxfit::{
    motor::{Motor, Parameter},
    optimizer::Method,
    paper::{self, Column},
    study::{MethodStudy, error_percent, facts::StudyFacts, fitness::Fitness},
};
use fluxfit_files::number::{Scale, significant};
use maud::{Markup, html};

/// Means this close to the exact answer, %, come from searches that have converged: a tenth of what separates the paper's methods.
const CONVERGED: f64 = 0.03;

/// Digits of an estimate: two of this part of it.
const PRECISION: f64 = 2e-4;

/// The table, and what may be concluded from it.
pub(crate) fn section(facts: &StudyFacts, methods: &[(MethodStudy, f64)], unexcited: &[Parameter]) -> Markup {
    let beside_paper = facts.truth.is_some_and(is_papers);
    html! {
        (table(facts, methods, unexcited, beside_paper))
        (words(facts, methods, unexcited, beside_paper))
    }
}

/// The answer that the swarms approach.
fn answer(facts: &StudyFacts) -> &'static str {
    match facts.problem.fitness {
        Fitness::VoltageError(_) => "exact least squares",
        Fitness::OutputError { .. } => "the polish",
    }
}

/// Whether a motor is the paper's, rounding apart.
fn is_papers(motor: &Motor) -> bool {
    motor.to_array().iter().zip(paper::MOTOR.to_array()).all(|(one, other)| (one / other - 1.0).abs() < 1e-9)
}

/// What the paper has for a method.
fn papers_column(method: &Method) -> Option<&'static Column> {
    paper::TABLE_2.iter().find(|column| column.method == method.key())
}

fn table(facts: &StudyFacts, methods: &[(MethodStudy, f64)], unexcited: &[Parameter], beside_paper: bool) -> Markup {
    let papers = |study: &MethodStudy| papers_column(&study.method).filter(|_| beside_paper);
    html! {
        (frame::scrolling("Mean of the estimates", &html! {
            table.estimates {
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Parameter" }
                        @if facts.truth.is_some() { th scope="col" rowspan="2" { "True" } }
                        @for (study, _) in methods {
                            th scope="colgroup" colspan=(if papers(study).is_some() { 2 } else { 1 }) { (study.method.label()) }
                        }
                        th scope="col" rowspan="2" { (capitalized(answer(facts))) }
                    }
                    tr { @for (study, _) in methods {
                        th scope="col" { "here" }
                        @if papers(study).is_some() { th.paper scope="col" { "paper" } }
                    } }
                }
                tbody { @for parameter in Parameter::ALL {
                    @let known = !unexcited.contains(&parameter);
                    (estimates(facts, methods, parameter, known, &papers))
                    @if let Some(truth) = facts.truth { (errors(facts, methods, parameter, truth, known, &papers)) }
                } }
            }
        }))
    }
}

type Papers<'a> = dyn Fn(&MethodStudy) -> Option<&'static Column> + 'a;

/// A row of means.
fn estimates(facts: &StudyFacts, methods: &[(MethodStudy, f64)], parameter: Parameter, known: bool, papers: &Papers) -> Markup {
    let (exact, _) = facts.problem.fitness.minimum();
    let scale = Scale::for_value(parameter, facts.truth.unwrap_or(&exact).get(parameter));
    let show = |motor: &Motor| number(motor.get(parameter), |value| scale.format(value, value.abs() * PRECISION));
    let ours = |motor: &Motor| if known { show(motor) } else { DASH.to_owned() };
    html! {
        tr.mean {
            th scope="row" { (symbol(parameter)) ", " (unit(parameter, &scale)) }
            @if let Some(truth) = facts.truth { td { (show(truth)) } }
            @for (study, _) in methods {
                td { (ours(&study.mean())) }
                // The paper's own digits.
                @if let Some(column) = papers(study) { td.paper { (minus(scale.format(column.mean.get(parameter), papers_digit(parameter)))) } }
            }
            td { (ours(&exact)) }
        }
    }
}

/// Ten times the last digit that the paper prints, SI: two digits of it are the paper's.
fn papers_digit(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Rs => 1e-3,
        Parameter::Ld | Parameter::Lq => 1e-5,
        Parameter::PsiF => 1e-4,
    }
}

/// An error with the decimals that the paper prints.
fn papers_error(column: &Column, parameter: Parameter) -> String {
    let decimals = if parameter == Parameter::Lq { 5 } else { 3 };
    format!("{:.decimals$}", column.error_percent[parameter as usize])
}

/// A row of errors, %.
fn errors(facts: &StudyFacts, methods: &[(MethodStudy, f64)], parameter: Parameter, truth: &Motor, known: bool, papers: &Papers) -> Markup {
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

/// Careful words: what the table shows, and what it cannot.
fn words(facts: &StudyFacts, methods: &[(MethodStudy, f64)], unexcited: &[Parameter], beside_paper: bool) -> Markup {
    let answer = answer(facts);
    let distance = distance_from_exact(facts, methods, unexcited);
    let distance_text = number(distance, |percent| significant(percent, 2));
    html! {
        p {
            @if distance < CONVERGED {
                "The means of all methods lie within " (distance_text) " % of " (answer) ". "
            } @else {
                "Not every search has converged here: the means lie up to " (distance_text) " % from " (answer) ". "
            }
            @if facts.truth.is_some() {
                "The error is the mean over the runs of the distance from the truth. The last column is the error of the " (facts.problem.fitness.minimum_label()) " itself, which is "
                "that of the log and its noise. A method that lies nearer to the truth than that column has been lucky, "
                "so ranking methods by this error ranks luck."
            }
        }
        @if beside_paper {
            p {
                "The columns “paper” are from Table 2 of Gao, Wang, Jiang and Hu, 2023, whose log is not known. "
                @if distance < CONVERGED {
                    "Searches that have converged cannot differ from each other by the 0.3 to 0.8 % that separate the paper’s methods in R" sub { "s" }
                    " and L" sub { "d" } ". What caused the paper's differences cannot be known; an error that all four share suggests the data, "
                    "a scatter between them searches that had not converged."
                } @else {
                    "What made its methods differ cannot be known."
                }
            }
        }
    }
}

/// Largest distance of a method's mean from the exact answer, %.
fn distance_from_exact(facts: &StudyFacts, methods: &[(MethodStudy, f64)], unexcited: &[Parameter]) -> f64 {
    let (exact, _) = facts.problem.fitness.minimum();
    let known = || Parameter::ALL.into_iter().filter(|parameter| !unexcited.contains(parameter));
    let distances =
        methods.iter().flat_map(|(study, _)| known().filter_map(move |parameter| error_percent(&study.mean(), &exact, parameter)));
    distances.fold(0.0, f64::max)
}
