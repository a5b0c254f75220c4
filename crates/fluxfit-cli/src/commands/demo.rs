//! `fluxfit demo`: the paper's rig, end to end: simulate, identify, compare four methods, write a report.

use super::{Status, compare, report};
use crate::{arguments::Demo, error::CommandError, terminal};
use fluxfit::{
    identify::{self, identify},
    log::Log,
    motor::PARAMETERS,
    objective::voltage_error::IdZero,
    optimizer::{self, Method, bounds::Bounds},
    paper,
    study::{facts::StudyFacts, fitness::Problem},
};
use fluxfit_drive::{Scenario, simulate};
use fluxfit_report::{Report, figures, html};

/// What stands where a log's name would.
const NAME: &str = "The paper's rig, simulated";

/// Runs the verb.
pub(crate) fn run(arguments: &Demo) -> Result<Status, CommandError> {
    report::check_name(&arguments.report)?;
    report::check_directory(arguments.figures.as_deref())?;
    let scenario = Scenario::paper();
    let log = terminal::working("simulating".to_owned(), || simulate(&scenario, 0, || ()))?.log()?;
    let bounds = Bounds::new(vec![0.0; PARAMETERS], paper::SEARCH_BOX.to_vec())?;

    let search = optimizer::Settings { seed: arguments.seed, ..optimizer::Settings::default() };
    let settings = identify::Settings { search, bounds: Some(bounds.clone()), ..identify::Settings::default() };
    let found = identify(&log, &settings)?;
    terminal::identification::show(NAME, &log, &found, settings.method.as_ref())?;

    let mut problem = Problem::steady(&log, &settings, IdZero::Measured)?;
    let methods = compare::study(&Method::all(), paper::RUNS, search, &bounds, &mut problem.fitness)?;
    let facts = StudyFacts { settings: &search, runs: paper::RUNS, bounds: &bounds, problem: &problem, truth: Some(&paper::MOTOR) };
    terminal::print("\n")?;
    terminal::study::show(NAME, &facts, &methods)?;
    if !facts.is_whole(&methods, Method::all().len()) {
        terminal::study::interrupted(&Method::all(), paper::RUNS, &methods);
        return Ok(Status::Incomplete);
    }

    let shown = Report {
        title: NAME,
        log: &log,
        notes: &notes(&scenario, &log),
        operating_points: found.operating_points(),
        identification: Some((&found, settings.method)),
        held_out: None,
        study: Some((&facts, &methods)),
        origin: &report::origin(arguments.seed),
    };
    report::write(Some(&arguments.report), || html(&shown), arguments.figures.as_deref(), || figures(&shown))?;
    Ok(if found.is_complete() { Status::Complete } else { Status::Incomplete })
}

/// How the log came about.
fn notes(scenario: &Scenario, log: &Log) -> Vec<String> {
    vec![
        format!(
            "Simulated: field-oriented control of the paper's motor, {:.0} r/min against {} N m, i_d = 0 and then {} A; inverter switched at {} kHz, {} rows.",
            paper::SPEED_RPM,
            paper::LOAD,
            paper::ID,
            scenario.inverter.carrier / 1e3,
            log.rows(),
        ),
        "To have the log as a file: fluxfit simulate -o rig.csv".to_owned(),
    ]
}
