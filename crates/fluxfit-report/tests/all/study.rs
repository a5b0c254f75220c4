//! The page of a study.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::{
    logs::{TWO, log, origin},
    markup::checked,
};
use fluxfit::{
    Motor, Request,
    optimizer::Method,
    paper,
    study::{
        ConvergenceCurves, MethodStudy,
        comparison::{ComparisonRequest, compare},
    },
};
use fluxfit_report::{Options, Report, figures, html};
use std::ops::ControlFlow;

/// A study, its page checked; `change` bends what the runs left behind.
fn study_page(methods: &[Method], truth: Option<Motor>, currents: &[(f64, f64)], change: impl Fn(&mut MethodStudy)) -> String {
    let log = log(currents, 0.1);
    let search = fluxfit::optimizer::SearchSettings { population: 20, iterations: 12, ..Default::default() };
    let bounds = [5.0, 0.05, 0.05, 1.0].map(|upper| Some((0.0, upper)));
    let request = Request { search, bounds, ..Request::default() };
    let asked = ComparisonRequest { request, methods: methods.to_vec(), runs: 3, truth, ..ComparisonRequest::default() };
    let mut comparison = compare(&log, &asked, &|_| ControlFlow::Continue(())).unwrap();
    comparison.studies.iter_mut().for_each(&change);
    let methods: Vec<_> = comparison.studies.iter().map(|study| (study.clone(), 1e-3)).collect();
    let origin = origin();
    let report = Report {
        title: "drive.csv",
        log: &log,
        notes: &[],
        operating_points: &comparison.problem.operating_points,
        identification: None,
        held_out: None,
        study: Some((&comparison, &methods)),
        online: None,
        json: None,
        options: Options::default(),
        origin: &origin,
    };
    let page = html(&report);
    assert_eq!(page.matches("<figure>").count(), figures(&report).len());
    page
}

#[test]
fn a_study_of_the_papers_motor_shows_the_papers_table() {
    let text = checked(&study_page(&paper::METHODS, Some(paper::MOTOR), &TWO, |_| ()));
    for expected in ["Four methods ran 3 times each", "0.9639", "5.283", "0.01414", "0.051", "cannot be known", "Fig. 4", "Fig. 5"] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    let other = Motor { rs: 1.0, ..paper::MOTOR };
    assert!(!checked(&study_page(&paper::METHODS, Some(other), &TWO, |_| ())).contains("0.9639"));
}

/// Twenty-two names in a sentence, or columns beside each other, are read by nobody.
#[test]
fn many_methods_have_a_row_each_and_three_are_named() {
    let methods = Method::all();
    let text = checked(&study_page(&methods, Some(paper::MOTOR), &TWO, |_| ()));
    let headline = text.split("each;").nth(1).unwrap().split('.').take(2).collect::<Vec<_>>().join(".");
    assert!(headline.contains("within the noise of the data in every run. Of least cost:"), "{headline}");
    assert_eq!(headline.matches(';').count(), 2, "{headline}");
    assert!(text.contains("True") && text.contains("Exact least squares") && !text.contains("The last column"), "{text}");
}

#[test]
fn one_method_no_truth_and_what_is_not_excited() {
    let text = checked(&study_page(&paper::METHODS[3..], None, &[(0.0, 9.0), (0.0, 5.0)], |_| ()));
    assert!(text.contains("APSO ran 3 times;") && text.contains("This log does not excite Ld"), "{text}");
}

#[test]
fn costs_of_zero_no_iterations_and_broken_numbers() {
    let zero = |study: &mut MethodStudy| {
        study.cost_above_optimum.fill(0.0);
        study.convergence.quartiles.fill([0.0; 3]);
    };
    assert!(checked(&study_page(&paper::METHODS, Some(paper::MOTOR), &TWO, zero)).contains("rounding errors and drawn at that value"));
    let empty = |study: &mut MethodStudy| study.convergence = ConvergenceCurves::default();
    assert!(!checked(&study_page(&paper::METHODS, None, &TWO, empty)).contains("Fig. 4"));
    let start_only = |study: &mut MethodStudy| {
        study.convergence.quartiles.truncate(1);
        study.convergence.parameters_median.truncate(1);
    };
    checked(&study_page(&paper::METHODS, None, &TWO, start_only));
    let broken = |study: &mut MethodStudy| {
        study.motors.fill(Motor { rs: f64::NAN, ld: f64::INFINITY, lq: 0.0, psi_f: -0.0 });
        study.cost_above_optimum.fill(f64::INFINITY);
        study.convergence.quartiles.fill([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
        study.convergence.parameters_median.fill([f64::NAN; 4]);
    };
    checked(&study_page(&paper::METHODS, Some(paper::MOTOR), &TWO, broken));
}

#[test]
fn the_same_input_is_the_same_page() {
    let pages: [String; 2] = std::array::from_fn(|_| study_page(&paper::METHODS, None, &TWO, |_| ()));
    assert_eq!(pages[0], pages[1]);
}
