//! `fluxfit compare --online`: the estimators of `track` on a log, beside the batch answer.

use super::super::{Status, input, report};
use crate::{
    arguments::LogArguments,
    error::CommandError,
    json,
    terminal::{self, HEADING, table, wrapped},
};
use fluxfit::{Parameter, VoltageTiming, identify};
use fluxfit_report::{Report, figures, html};
use fluxfit_setup::read_truth;
use fluxfit_track::{
    Start, Timing,
    comparison::{BatchEntry, EndEntry, OnlineDocument, compare_online},
};
use fluxfit_units::significant;
use std::path::Path;

/// Runs it.
pub(super) fn run(arguments: &LogArguments, truth: Option<&Path>) -> Result<Status, CommandError> {
    report::check(arguments, truth)?;
    let input = input::read(arguments)?;
    let truth = truth.map(read_truth).transpose()?.map(|truth| truth.motor);
    let answer = terminal::working("identifying".to_owned(), || {
        identify(&input.log, &input::request(arguments, &input)?).map_err(|error| CommandError::Usage(error.to_string()))
    })?;
    let of_fit = answer.identification.output.as_ref().map(|fit| fit.voltage_timing.value);
    let timing = arguments.voltage_timing.stated().or(of_fit).unwrap_or(VoltageTiming::Centered);
    let unsupported = || {
        CommandError::Usage("the voltages of this log stand still in the rotor's frame, which no estimator of a stream supports".to_owned())
    };
    let timing = Timing::of(timing).ok_or_else(unsupported)?;
    let batch = Parameter::ALL.map(|parameter| {
        let judgement = answer.parameter(parameter);
        BatchEntry::new(judgement.value(), judgement.value().map(|_| judgement.uncertainty.statistical))
    });
    let motor = &input.motor;
    let start = Start { values: [motor.rs, motor.ld, motor.lq, motor.psi_f], ..Start::default() };
    let comparison = terminal::working("tracking".to_owned(), || compare_online(&input.log, timing, &start, truth.as_ref(), batch));
    let document = json::text(&comparison.document)?;
    if arguments.json {
        terminal::print(&document)?;
    } else {
        terminal::print(&shown(&input.name, &comparison.document))?;
    }
    let shown = Report {
        title: &input.title,
        log: &answer.log,
        notes: &input.said(),
        operating_points: answer.identification.operating_points(),
        identification: Some((&answer.identification, answer.identification.method)),
        held_out: None,
        study: None,
        online: Some(&comparison),
        json: Some(&document),
        options: report::options(),
        origin: &report::origin(arguments.seed),
    };
    report::write(arguments.report.as_deref(), || html(&shown), arguments.figures.as_deref(), || figures(&shown))?;
    Ok(Status::Complete)
}

fn shown(name: &str, document: &OnlineDocument) -> String {
    let cell = |end: &EndEntry| {
        let error = end.error_percent.map_or_else(|| "-".to_owned(), |error| significant(error, 2));
        if end.identifiable == Some(false) { format!("[{error}]") } else { error }
    };
    let rows = document.estimators.iter().map(|estimator| {
        let of = &estimator.parameters;
        let covariance = if estimator.has_covariance { "yes" } else { "none" };
        vec![estimator.method.to_owned(), cell(&of.rs), cell(&of.ld), cell(&of.lq), cell(&of.psi_f), covariance.to_owned()]
    });
    let bound = |entry: &BatchEntry| match (entry.value, entry.statistical) {
        (Some(value), Some(error)) => format!("±{}", significant(100.0 * error / value.abs(), 2)),
        _ => "-".to_owned(),
    };
    let of = &document.batch;
    let last = vec!["batch, its noise".to_owned(), bound(&of.rs), bound(&of.ld), bound(&of.lq), bound(&of.psi_f), "yes".to_owned()];
    let symbols = Parameter::ALL.map(Parameter::symbol);
    let heading = ["", symbols[0], symbols[1], symbols[2], symbols[3], "covariance"];
    format!("{HEADING}{name}{HEADING:#}\n{}\n{}", wrapped("", &document.explanation()), table(&heading, 1, rows.chain([last])))
}
