//! `fluxfit validate`: a motor held against a log that it was not found from.

use super::{Status, input, report};
use crate::{arguments::Validate, error::CommandError, json, terminal};
use fluxfit::{
    document::ValidationDocument,
    identify::Settings,
    validate::{Outcome, validate},
};
use fluxfit_files::read_given_motor;
use fluxfit_report::{ValidationReport, validation_figures, validation_html};
use std::path::Path;

/// Runs the verb.
pub(crate) fn run(arguments: &Validate) -> Result<Status, CommandError> {
    report::check(&arguments.log, [])?;
    let Some(path) = arguments.log.motor.as_deref() else {
        return Err(CommandError::Usage("there is no motor to validate; name one with --motor".to_owned()));
    };
    if path == Path::new("-") && arguments.log.logs.iter().any(|log| log == path) {
        return Err(CommandError::Usage("standard input can be read only once; give the motor or the log as a file".to_owned()));
    }
    let motor = read_given_motor(path)?;
    let input = input::read_beside(&arguments.log, motor.file)?;
    let settings = Settings {
        model: arguments.model.stated(),
        windows: arguments.log.window.clone(),
        voltage_timing: arguments.log.voltage_timing.stated(),
        voltage_accuracy: arguments.voltage_accuracy,
        ..Settings::default()
    };
    let found = terminal::working(format!("fitting {} rows", input.log.rows()), || validate(&input.log, &motor.given, &settings));
    let found = found.map_err(|error| input::of_log(&input.name, error))?;
    let name = path.display().to_string();
    if arguments.log.json {
        terminal::print(&json::text(&ValidationDocument::of(&input.log, &found))?)?;
    } else {
        terminal::validation::show(&input.name, &name, &input.log, &found)?;
    }
    let origin = report::origin(arguments.log.seed);
    let shown =
        ValidationReport { title: &input.name, motor: &name, log: &input.log, notes: &input.said(), found: &found, origin: &origin };
    let (page, figures) = (|| validation_html(&shown), || validation_figures(&shown));
    report::write(arguments.log.report.as_deref(), page, arguments.log.figures.as_deref(), figures)?;
    Ok(if found.outcome == Outcome::Agrees { Status::Complete } else { Status::Incomplete })
}
