//! `fluxfit compare`: arguments to a request, the library's comparison to the terminal, to JSON and to a report.

use super::{Status, input, report};
use crate::{
    arguments::{Compare, StudyModel},
    error::CommandError,
    interrupt, json, terminal,
};
use fluxfit::{
    Error, Log, Model, Parameter, Request,
    document::StudyDocument,
    objective::voltage_error::IdZero,
    optimizer::SearchSettings,
    study::{
        MethodStudy,
        comparison::{Comparison, ComparisonRequest, ComparisonStep, compare},
    },
};
use fluxfit_report::{Report, figures, html};
use fluxfit_setup::read_truth;
use std::{ops::ControlFlow, sync::Mutex, time::Instant};

/// Runs the verb.
pub(crate) fn run(arguments: &Compare) -> Result<Status, CommandError> {
    report::check(&arguments.log, arguments.truth.as_deref())?;
    check(arguments)?;
    let input = input::read(&arguments.log)?;
    let asked = request(arguments, &input)?;
    let (comparison, methods) = compared(&input.log, &asked).map_err(|error| input::of_log(&input.name, error))?;
    let is_whole = comparison.is_whole();
    if arguments.log.json {
        terminal::print(&json::text(&StudyDocument::of(&comparison, &methods, !is_whole))?)?;
    } else {
        terminal::study::show(&input.name, &comparison, &methods)?;
    }
    if !is_whole {
        terminal::study::interrupted(&comparison);
        return Ok(Status::Incomplete);
    }
    let shown = Report {
        title: &input.name,
        log: &input.log,
        notes: &input.said(),
        operating_points: &comparison.problem.operating_points,
        identification: None,
        held_out: None,
        study: Some((&comparison, &methods)),
        origin: &report::origin(arguments.log.seed),
    };
    report::write(arguments.log.report.as_deref(), || html(&shown), arguments.log.figures.as_deref(), || figures(&shown))?;
    let unexcited = &comparison.problem.unexcited;
    if unexcited.is_empty() {
        return Ok(Status::Complete);
    }
    let open: Vec<&str> = unexcited.iter().copied().map(Parameter::symbol).collect();
    terminal::note(&format!("this log does not excite {}: the methods' values of it are arbitrary; see fluxfit identify", open.join(", ")));
    Ok(Status::Incomplete)
}

/// Refuses options that the output error does not use, and limits that are no numbers.
fn check(arguments: &Compare) -> Result<(), CommandError> {
    let stated = [("--window", !arguments.log.window.is_empty()), ("--id-zero", arguments.id_zero != IdZero::Measured)];
    if let Some((option, _)) = stated.into_iter().find(|(_, stated)| *stated && arguments.model == StudyModel::OutputError) {
        return Err(CommandError::Usage(format!("{option} is for --model steady; the output error takes every row as measured")));
    }
    for (option, value) in [("--tolerance", arguments.tolerance), ("--target-cost", arguments.target_cost)] {
        if value.is_some_and(|value| !(value >= 0.0 && value.is_finite())) {
            return Err(CommandError::Usage(format!("{option} must be a finite number, zero or more")));
        }
    }
    Ok(())
}

fn request(arguments: &Compare, input: &input::Input) -> Result<ComparisonRequest, CommandError> {
    let search = SearchSettings {
        population: arguments.population,
        iterations: arguments.iterations,
        seed: arguments.log.seed,
        target_cost: arguments.target_cost,
        ..SearchSettings::default()
    };
    Ok(ComparisonRequest {
        request: Request { search, ..input::request(&arguments.log, input)? },
        model: match arguments.model {
            StudyModel::Steady => Model::Steady,
            StudyModel::OutputError => Model::OutputError,
        },
        methods: arguments.methods.clone(),
        runs: arguments.runs,
        id_zero: arguments.id_zero,
        tolerance: arguments.tolerance,
        truth: arguments.truth.as_deref().map(read_truth).transpose()?.map(|truth| truth.motor),
    })
}

/// Compares with a progress display; each method with the seconds of wall time that one of its runs took. The runs can be interrupted.
pub(super) fn compared(log: &Log, asked: &ComparisonRequest) -> Result<(Comparison, Vec<(MethodStudy, f64)>), Error> {
    let iterations = asked.runs.saturating_mul(asked.methods.len()).saturating_mul(asked.request.search.iterations);
    let progress = terminal::counting("looking for the minimum", iterations);
    let starts = Mutex::new(Vec::new());
    let begun = || starts.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let show = |step: ComparisonStep| match step {
        ComparisonStep::Minimum => ControlFlow::Continue(()),
        ComparisonStep::Method(method) => {
            progress.turn_to("comparing");
            // Before the line says that they begin: whoever has read it may interrupt them.
            interrupt::be_gentle(true);
            terminal::detail(|| format!("{}: {} runs begin", method.label(), asked.runs));
            begun().push((Some(method), Instant::now()));
            interrupt::go_on()
        }
        ComparisonStep::Iteration => {
            progress.add(1);
            interrupt::go_on()
        }
        ComparisonStep::LowestMinimum => {
            begun().push((None, Instant::now()));
            interrupt::be_gentle(false);
            progress.turn_to("polishing the lowest end of a swarm");
            ControlFlow::Continue(())
        }
    };
    let comparison = compare(log, asked, &show);
    interrupt::be_gentle(false);
    let comparison = comparison?;
    let starts = starts.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let seconds = |study: &MethodStudy| {
        let place = starts.iter().position(|(method, _)| *method == Some(study.method));
        let ends = place.and_then(|place| Some((starts.get(place)?.1, starts.get(place + 1)?.1)));
        ends.map_or(f64::NAN, |(start, end)| end.duration_since(start).as_secs_f64() / study.motors.len() as f64)
    };
    let methods = comparison.studies.iter().map(|study| (study.clone(), seconds(study))).collect();
    Ok((comparison, methods))
}
