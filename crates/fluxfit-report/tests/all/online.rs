//! The page of the estimators of a stream.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::{
    logs::{origin, recorded},
    markup::checked,
};
use fluxfit::{Log, Motor, paper};
use fluxfit_report::{Options, Report, figures, html};
use fluxfit_track::{
    Start, Timing, Tracked, Verdict,
    comparison::{BatchEntry, OnlineComparison, compare_online},
};
use std::sync::LazyLock;

/// Long enough for every estimator to begin.
static LOG: LazyLock<Log> = LazyLock::new(|| recorded(0.08, |scenario| scenario.duration = 0.6));

fn compared(truth: Option<&Motor>) -> OnlineComparison {
    let batch = [0.96, 5.2e-3, 0.012, 0.1827].map(|value| BatchEntry::new(Some(value), Some(1e-3 * value)));
    compare_online(&LOG, Timing::Centered, &Start::default(), truth, batch)
}

/// The page and its figure of the estimators.
fn shown(comparison: &OnlineComparison) -> (String, String) {
    let origin = origin();
    let report = Report {
        title: "x",
        log: &LOG,
        notes: &[],
        operating_points: &[],
        identification: None,
        held_out: None,
        study: None,
        online: Some(comparison),
        json: None,
        options: Options::default(),
        origin: &origin,
    };
    let figure = figures(&report).into_iter().find(|figure| figure.name == "estimators").unwrap();
    (html(&report), figure.svg)
}

#[test]
fn each_estimator_has_a_row_in_the_table_and_in_the_figure() {
    let (page, figure) = shown(&compared(Some(&paper::MOTOR)));
    let text = checked(&page);
    for expected in ["Estimators on a stream", "difference to the true values", "Dashed: the true value", "batch answer"] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    for key in fluxfit_track::Method::ALL.map(fluxfit_track::Method::key) {
        assert!(page.contains(&format!("<code>{key}</code>")) && figure.contains(&format!("{key}: ")), "{key}");
    }
    let text = checked(&shown(&compared(None)).0);
    assert!(text.contains("difference to the batch values") && !text.contains("Dashed: the true value"), "{text}");
}

#[test]
fn what_is_not_told_has_no_line() {
    // Green, amber, grey and black lines of 1.6 pixels.
    let curves = |figure: &str| figure.matches("stroke-width=\"16\"").count();
    let mut comparison = compared(None);
    assert!(curves(&shown(&comparison).1) >= 14);
    let nothing = Tracked { value: None, standard_error: None, verdict: Verdict::NotIdentifiable };
    comparison.courses.iter_mut().flat_map(|course| &mut course.told).for_each(|told| *told = [nothing; 4]);
    assert_eq!(curves(&shown(&comparison).1), 0);
}
