//! `fluxfit compare`: arguments to a request, the library's comparison to the terminal, to JSON and to a report.

pub(crate) mod display;
mod online;

use super::{Status, input, report};
use crate::{
    arguments::{LogArguments, method_keys},
    error::CommandError,
    interrupt, json, terminal,
};
use clap::{Args, ValueEnum};
use fluxfit::{
    Error, Log, Model, Parameter, Request,
    document::StudyDocument,
    objective::voltage_error::IdZero,
    optimizer::{Method, SearchSettings},
    study::{
        MethodStudy,
        comparison::{Comparison, ComparisonRequest, ComparisonStep, compare},
    },
};
use fluxfit_report::{Report, figures, html};
use fluxfit_setup::read_truth;
use std::{ops::ControlFlow, path::PathBuf, sync::Mutex, time::Instant};

#[derive(Debug, Args)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    // The paper's four, unless others are asked for.
    #[arg(long, help_heading = "Search", value_name = "METHOD,..", value_delimiter = ',', default_value = "tgfpa,fpa,lpso,apso", value_parser = parse_method,
          help = format!("Optimizers to compare: all, {}", method_keys()))]
    methods: Vec<AskedMethod>,
    /// Fitness that is minimized
    #[arg(long, help_heading = "Model", value_enum, default_value_t = StudyModel::Steady)]
    model: StudyModel,
    /// Number of independent runs of each optimizer
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 50)]
    runs: usize,
    /// Number of candidates in each run
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 50)]
    population: usize,
    /// Number of iterations of each run
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 300)]
    iterations: usize,
    /// Stop a run when its cost is this close to the minimum (V², or A² with the output error)
    #[arg(long, help_heading = "Search", value_name = "COST")]
    tolerance: Option<f64>,
    /// Stop a run when its cost is at or below this value (V², or A² with the output error)
    #[arg(long, help_heading = "Search", value_name = "COST")]
    target_cost: Option<f64>,
    /// Value of i_d in windows at i_d = 0: measured, or as-paper (zero, the paper's equation (3))
    #[arg(long, help_heading = "Search", value_name = "HOW", default_value = "measured", value_parser = parse_id_zero)]
    id_zero: IdZero,
    /// File of true parameters (LOG.truth.json), for the errors of the runs
    #[arg(long, help_heading = "Prior knowledge", value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Compare the estimators of fluxfit track on this log instead, beside the batch answer
    #[arg(long, help_heading = "Model", conflicts_with_all = ["model", "runs", "population", "iterations", "tolerance", "target_cost", "id_zero", "methods"])]
    online: bool,
}

/// Models that `compare` knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyModel {
    /// Fitness (11) of the paper, on the samples of steady windows
    Steady,
    /// Simulated minus measured currents, on all rows; slow: half an hour on one core for the default study
    OutputError,
}

/// One method, or all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
enum AskedMethod {
    All,
    One(Method),
}

fn parse_method(text: &str) -> Result<AskedMethod, String> {
    if text == "all" {
        return Ok(AskedMethod::All);
    }
    Method::named(text).map(AskedMethod::One).ok_or_else(|| format!("no method '{text}'; there are all, {}", method_keys()))
}

/// The methods that were asked for, in that order.
fn methods(asked: &[AskedMethod]) -> Vec<Method> {
    let expand = |asked: &AskedMethod| match asked {
        AskedMethod::All => Method::all().to_vec(),
        AskedMethod::One(method) => vec![*method],
    };
    asked.iter().flat_map(expand).collect()
}

fn parse_id_zero(text: &str) -> Result<IdZero, String> {
    match text {
        "measured" => Ok(IdZero::Measured),
        "as-paper" => Ok(IdZero::AsPaper),
        _ => Err(format!("no way '{text}'; there are measured, as-paper")),
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Compare) -> Result<Status, CommandError> {
    if arguments.online {
        return online::run(&arguments.log, arguments.truth.as_deref());
    }
    report::check(&arguments.log, arguments.truth.as_deref())?;
    check(arguments)?;
    let input = input::read(&arguments.log)?;
    let asked = request(arguments, &input)?;
    let (comparison, methods) = compared(&input.log, &asked, &interrupt::go_on).map_err(|error| input::of_log(&input.name, error))?;
    let is_whole = comparison.is_whole();
    if arguments.log.json {
        terminal::print(&json::text(&StudyDocument::of(&comparison, &methods, !is_whole))?)?;
    } else {
        display::show(&input.name, &comparison, &methods)?;
    }
    if !is_whole {
        display::interrupted(&comparison);
        return Ok(Status::Incomplete);
    }
    let document = arguments.log.report.is_some().then(|| json::text(&StudyDocument::of(&comparison, &methods, false))).transpose()?;
    let shown = Report {
        title: &input.title,
        log: &input.log,
        notes: &input.said(),
        operating_points: &comparison.problem.operating_points,
        identification: None,
        held_out: None,
        study: Some((&comparison, &methods)),
        online: None,
        json: document.as_deref(),
        options: report::options(),
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
pub(crate) fn check(arguments: &Compare) -> Result<(), CommandError> {
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

/// What is asked of the library.
pub(crate) fn request(arguments: &Compare, input: &input::Input) -> Result<ComparisonRequest, CommandError> {
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
        methods: methods(&arguments.methods),
        runs: arguments.runs,
        id_zero: arguments.id_zero,
        tolerance: arguments.tolerance,
        truth: arguments.truth.as_deref().map(read_truth).transpose()?.map(|truth| truth.motor),
    })
}

/// Compares with a progress display; each method with the seconds of wall time that one of its runs took. The runs can be interrupted.
pub(crate) fn compared(
    log: &Log,
    asked: &ComparisonRequest,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<(Comparison, Vec<(MethodStudy, f64)>), Error> {
    let iterations = asked.runs.saturating_mul(asked.methods.len()).saturating_mul(asked.request.search.iterations);
    let progress = terminal::counting("looking for the minimum", iterations);
    let starts = Mutex::new(Vec::new());
    let begun = || starts.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let show = |step: ComparisonStep| match step {
        ComparisonStep::Method(method) => {
            progress.turn_to("comparing");
            // Before the line says that they begin: whoever has read it may interrupt them.
            interrupt::be_gentle(true);
            let go_on = go_on();
            terminal::detail(|| format!("{}: {} runs begin", method.label(), asked.runs));
            begun().push((Some(method), Instant::now()));
            go_on
        }
        ComparisonStep::Iteration => {
            progress.add(1);
            go_on()
        }
        ComparisonStep::LowestMinimum => {
            begun().push((None, Instant::now()));
            interrupt::be_gentle(false);
            progress.turn_to("polishing the lowest end of a swarm");
            ControlFlow::Continue(())
        }
        _ => ControlFlow::Continue(()),
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
