//! `fluxfit demo`: the paper's rig, end to end: simulate, identify, compare four methods, write a report.

use super::{Status, compare, identify::display, report};
use crate::{error::CommandError, interrupt, terminal};
use clap::Args;
use fluxfit::{Error, Log, Request, identify, optimizer::SearchSettings, paper, study::comparison::ComparisonRequest};
use fluxfit_drive::{Scenario, simulate};
use fluxfit_report::{Report, figures, html};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// File for the report
    #[arg(long, value_name = "FILE.html", default_value = "fluxfit-demo.html")]
    report: PathBuf,
    /// Also write every figure of the report into this directory, as NAME.svg and NAME.png
    #[arg(long, value_name = "DIR")]
    figures: Option<PathBuf>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// What stands where a log's name would.
const NAME: &str = "The paper's rig, simulated";

/// Runs the verb.
pub(crate) fn run(arguments: &Demo) -> Result<Status, CommandError> {
    report::check_name(&arguments.report)?;
    report::check_directory(arguments.figures.as_deref())?;
    let scenario = Scenario::paper();
    let log = terminal::working("simulating".to_owned(), || simulate(&scenario, 0, || ()))?.log()?;
    let search = SearchSettings { seed: arguments.seed, ..SearchSettings::default() };
    let request = Request { search, bounds: paper::SEARCH_BOX.map(|upper| Some((0.0, upper))), ..Request::default() };
    let answer = identify(&log, &request).map_err(Error::from)?;
    let found = &answer.identification;
    display::show(NAME, &answer)?;

    let asked = ComparisonRequest { request, truth: Some(paper::MOTOR), ..ComparisonRequest::default() };
    let (comparison, methods) = compare::compared(&log, &asked, &interrupt::go_on)?;
    terminal::print("\n")?;
    compare::display::show(NAME, &comparison, &methods)?;
    if !comparison.is_whole() {
        compare::display::interrupted(&comparison);
        return Ok(Status::Incomplete);
    }

    let shown = Report {
        title: NAME,
        log: &log,
        notes: &notes(&scenario, &log),
        operating_points: found.operating_points(),
        identification: Some((found, found.method)),
        held_out: None,
        study: Some((&comparison, &methods)),
        online: None,
        json: None,
        options: report::options(),
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
