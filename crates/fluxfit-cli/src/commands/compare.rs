//! `fluxfit compare`: many runs of many methods on fitness (11), as the paper compares them.

use super::{Status, input, report};
use crate::{arguments::Compare, error::CommandError, terminal};
use fluxfit::{
    identify::{Known, Settings, excitation::Excitation},
    motor::{PARAMETERS, Parameter},
    objective::voltage_error::VoltageError,
    optimizer::{self, CloseTo, Method, bounds::Bounds},
    study::{MethodStudy, fitness, run_method},
};
use fluxfit_files::{answer, read_truth};
use fluxfit_report::{Report, html};
use std::time::Instant;

/// Runs the verb.
pub(crate) fn run(arguments: &Compare) -> Result<Status, CommandError> {
    report::check(&arguments.log, arguments.truth.as_deref())?;
    let input = input::read(&arguments.log)?;
    let truth = arguments.truth.as_deref().map(read_truth).transpose()?.map(|truth| truth.motor);
    let settings =
        Settings { windows: arguments.log.window.clone(), voltage_timing: arguments.log.voltage_timing.stated(), ..Settings::default() };
    let fitness = fitness(&input.log, &settings, arguments.id_zero).map_err(|error| input::of_log(&input.name, error))?;
    let bounds = input::search_box(&arguments.log, &input.motor, &fitness.operating_points)?;
    let settings = search_settings(arguments, &fitness.objective)?;

    let methods = study(&arguments.methods, arguments.runs, settings, &bounds, &fitness.objective, arguments.log.json)?;
    let facts = answer::StudyFacts {
        settings: &settings,
        runs: arguments.runs,
        bounds: &bounds,
        objective: &fitness.objective,
        rows: &fitness.rows,
        truth: truth.as_ref(),
    };
    if arguments.log.json {
        terminal::print(&answer::to_text(&answer::study(&facts, &methods)))?;
    } else {
        terminal::study::show(&input.name, &facts, &methods)?;
    }
    report::write(arguments.log.report.as_deref(), arguments.log.seed, |origin| {
        html(&Report {
            title: &input.name,
            log: &input.log,
            notes: &input.notes,
            operating_points: &fitness.operating_points,
            identification: None,
            study: Some((&facts, &methods)),
            origin,
        })
    })?;
    let excitation = Excitation::of(&fitness.operating_points, &[Known::Nothing; PARAMETERS]);
    let open: Vec<&str> = Parameter::ALL.into_iter().filter(|parameter| excitation.is_open(*parameter)).map(Parameter::symbol).collect();
    if open.is_empty() {
        return Ok(Status::Complete);
    }
    terminal::note(&format!("this log does not excite {}: what the methods say of it is chance; see fluxfit identify", open.join(", ")));
    Ok(Status::Incomplete)
}

/// Every method in turn, with the seconds of wall time that one of its runs took.
pub(super) fn study(
    methods: &[Method],
    runs: usize,
    settings: optimizer::Settings,
    bounds: &Bounds,
    objective: &VoltageError,
    quiet: bool,
) -> Result<Vec<(MethodStudy, f64)>, CommandError> {
    let progress = terminal::progress(runs * methods.len(), "runs", quiet);
    let mut studies = Vec::new();
    for method in methods {
        let start = Instant::now();
        let study = run_method(*method, runs, settings, bounds, objective, || progress.inc(1))?;
        studies.push((study, start.elapsed().as_secs_f64() / runs as f64));
    }
    progress.finish_and_clear();
    Ok(studies)
}

fn search_settings(arguments: &Compare, objective: &VoltageError) -> Result<optimizer::Settings, CommandError> {
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
        close_to_optimum: arguments.tolerance.map(|tolerance| CloseTo { optimum: objective.least_squares().cost, tolerance }),
        target_cost: arguments.target_cost,
    })
}
