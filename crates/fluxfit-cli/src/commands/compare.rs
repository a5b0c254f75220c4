//! `fluxfit compare`: many runs of many methods on one fitness, as the paper compares them.

use super::{Status, input, report};
use crate::{
    arguments::{Compare, StudyModel},
    error::CommandError,
    interrupt, json, terminal,
};
use fluxfit::{
    document::StudyDocument,
    identify::Settings,
    log::Log,
    motor::Parameter,
    objective::voltage_error::IdZero,
    optimizer::{self, CloseTo, Method, bounds::Bounds},
    study::{
        MethodStudy,
        facts::StudyFacts,
        fitness::{Fitness, Problem},
        run_method, settle,
    },
};
use fluxfit_files::read_truth;
use fluxfit_report::{Report, figures, html};
use std::time::Instant;

/// Runs the verb.
pub(crate) fn run(arguments: &Compare) -> Result<Status, CommandError> {
    report::check(&arguments.log, arguments.truth.as_deref())?;
    check(arguments)?;
    let input = input::read(&arguments.log)?;
    let truth = arguments.truth.as_deref().map(read_truth).transpose()?.map(|truth| truth.motor);
    let problem = terminal::working("looking for the minimum".to_owned(), || problem(arguments, &input.log));
    let mut problem = problem.map_err(|error| input::of_log(&input.name, error))?;
    let bounds = input::search_box(&arguments.log, &input, &problem.bounds)?;
    let settings = search_settings(arguments, &problem.fitness)?;

    let methods = study(&arguments.methods, arguments.runs, settings, &bounds, &mut problem.fitness)?;
    let facts = StudyFacts { settings: &settings, runs: arguments.runs, bounds: &bounds, problem: &problem, truth: truth.as_ref() };
    let is_whole = facts.is_whole(&methods, arguments.methods.len());
    if arguments.log.json {
        terminal::print(&json::text(&StudyDocument::of(&facts, &methods, !is_whole))?)?;
    } else {
        terminal::study::show(&input.name, &facts, &methods)?;
    }
    if !is_whole {
        terminal::study::interrupted(&arguments.methods, arguments.runs, &methods);
        return Ok(Status::Incomplete);
    }
    let shown = Report {
        title: &input.name,
        log: &input.log,
        notes: &input.said(),
        operating_points: &problem.operating_points,
        identification: None,
        held_out: None,
        study: Some((&facts, &methods)),
        origin: &report::origin(arguments.log.seed),
    };
    report::write(arguments.log.report.as_deref(), || html(&shown), arguments.log.figures.as_deref(), || figures(&shown))?;
    if problem.unexcited.is_empty() {
        return Ok(Status::Complete);
    }
    let open: Vec<&str> = problem.unexcited.iter().copied().map(Parameter::symbol).collect();
    terminal::note(&format!("this log does not excite {}: what the methods say of it is chance; see fluxfit identify", open.join(", ")));
    Ok(Status::Incomplete)
}

/// Refuses what the output error has no use for.
fn check(arguments: &Compare) -> Result<(), CommandError> {
    let stated = [("--window", !arguments.log.window.is_empty()), ("--id-zero", arguments.id_zero != IdZero::Measured)];
    match stated.into_iter().find(|(_, stated)| *stated && arguments.model == StudyModel::OutputError) {
        Some((option, _)) => {
            Err(CommandError::Usage(format!("{option} is for --model steady; the output error takes every row as measured")))
        }
        None => Ok(()),
    }
}

fn problem(arguments: &Compare, log: &Log) -> Result<Problem, fluxfit::error::Error> {
    match arguments.model {
        StudyModel::Steady => {
            let windows = arguments.log.window.clone();
            let settings = Settings { windows, voltage_timing: arguments.log.voltage_timing.stated(), ..Settings::default() };
            Problem::steady(log, &settings, arguments.id_zero)
        }
        StudyModel::OutputError => Problem::output_error(log, arguments.log.voltage_timing.stated()),
    }
}

/// Every method in turn, with the seconds of wall time that one of its runs took; interrupted, those that have a finished run.
pub(super) fn study(
    methods: &[Method],
    runs: usize,
    settings: optimizer::Settings,
    bounds: &Bounds,
    fitness: &mut Fitness,
) -> Result<Vec<(MethodStudy, f64)>, CommandError> {
    let progress = terminal::counting("comparing", runs * methods.len() * settings.iterations);
    let (mut studies, mut seconds) = (Vec::new(), Vec::new());
    for method in methods {
        terminal::detail(|| format!("{}: {runs} runs begin", method.label()));
        let start = Instant::now();
        let iterated = || {
            progress.add(1);
            interrupt::go_on()
        };
        if let Some(study) = interrupt::gently(|| run_method(*method, runs, settings, bounds, fitness, iterated))? {
            seconds.push(start.elapsed().as_secs_f64() / study.motors.len() as f64);
            studies.push(study);
        }
        if interrupt::go_on().is_break() {
            break;
        }
    }
    progress.turn_to("polishing the lowest end of a swarm");
    settle(fitness, &mut studies);
    Ok(studies.into_iter().zip(seconds).collect())
}

fn search_settings(arguments: &Compare, fitness: &Fitness) -> Result<optimizer::Settings, CommandError> {
    for (option, value) in [("--tolerance", arguments.tolerance), ("--target-cost", arguments.target_cost)] {
        if value.is_some_and(|value| !(value >= 0.0 && value.is_finite())) {
            return Err(CommandError::Usage(format!("{option} must be a finite number, zero or more")));
        }
    }
    Ok(optimizer::Settings {
        population: arguments.population,
        iterations: arguments.iterations,
        seed: arguments.log.seed,
        run: 0,
        close_to_optimum: arguments.tolerance.map(|tolerance| CloseTo { optimum: fitness.minimum().1, tolerance }),
        target_cost: arguments.target_cost,
    })
}
