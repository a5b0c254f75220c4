//! The page of a validation.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::{
    logs::{TWO, log},
    markup::checked,
};
use fluxfit::{
    Motor, Request, Validation, frames::Dq, paper, validate, validation::prediction::PredictedStretch, validation::prediction::Prediction,
    validation::validate::Outcome,
};
use fluxfit_report::{Origin, ValidationReport, validation_html};

/// A validation of a motor on the log of two operating points, changed by `change`, as a page.
fn validation_page(given: Motor, currents: &[(f64, f64)], change: impl FnOnce(&mut Validation)) -> (Validation, String) {
    let log = log(currents, 0.1);
    let mut found = validate(&log, &given.into(), &Request::default()).unwrap();
    change(&mut found);
    let notes = ["read as <mechanical> speed".to_owned()];
    let origin = Origin { command: "fluxfit validate 'a log.csv' --motor m.toml".to_owned(), version: "0.1.0".to_owned(), seed: 7 };
    let page = validation_html(&ValidationReport {
        title: "a log.csv",
        motor: "<m>.toml",
        log: &log,
        notes: &notes,
        found: &found,
        json: None,
        origin: &origin,
    });
    (found, page)
}

/// Currents as they might come: two stretches, one of them a single row.
fn courses(value: f64) -> Prediction {
    let course = |rows: std::ops::Range<usize>| PredictedStretch {
        measured: rows.clone().map(|row| Dq { d: (row as f64).sin(), q: 9.0 }).collect(),
        predicted: rows.clone().map(|_| Dq { d: 0.0, q: value }).collect(),
        rows,
    };
    Prediction::Currents(vec![course(0..200), course(300..301)])
}

#[test]
fn a_validation_shows_verdict_parameters_and_channels() {
    let (found, page) = validation_page(paper::MOTOR, &TWO, |_| ());
    let text = checked(&page);
    assert_eq!(found.outcome, Outcome::Agrees);
    for expected in
        ["<m>.toml on a log.csv", "Agrees within the noise", "From this log", "agrees", "Warning: no-redundancy", "read as <mechanical>"]
    {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    // Rows a millisecond apart: an angle that may be off leaves 17 % of L_q.
    let (_, page) = validation_page(Motor { lq: 1.6 * paper::MOTOR.lq, ..paper::MOTOR }, &TWO, |_| ());
    let text = checked(&page);
    assert!(text.contains("Contradicts: ") && text.contains("The log asks for Lq 37") && text.contains("lower"), "{text}");
}

#[test]
fn a_validation_names_parameters_that_are_not_identifiable() {
    let (_, page) = validation_page(paper::MOTOR, &[(0.0, 9.0), (0.0, 5.0)], |_| ());
    let text = checked(&page);
    assert!(text.contains("This log cannot tell Ld: it is taken as given.") && text.contains("not identifiable–––"), "{text}");
}

#[test]
fn predicted_currents_are_drawn_whatever_they_are() {
    for value in [9.1, 9.0, f64::NAN, f64::INFINITY, 1e300] {
        let (_, page) = validation_page(paper::MOTOR, &TWO, |found| found.prediction = courses(value));
        assert!(checked(&page).contains("measured − predicted, "));
    }
    let (_, page) = validation_page(paper::MOTOR, &TWO, |found| found.prediction = Prediction::Currents(Vec::new()));
    checked(&page);
    let broken = |found: &mut Validation| {
        found.channels.iter_mut().for_each(|channel| (channel.rms, channel.noise, channel.explained) = (f64::NAN, 0.0, Some(f64::NAN)));
        found.parameters.iter_mut().for_each(|difference| difference.own = None);
    };
    checked(&validation_page(paper::MOTOR, &TWO, broken).1);
}
