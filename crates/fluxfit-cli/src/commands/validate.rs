//! `fluxfit validate`: a motor held against a log that it was not found from.

pub(crate) mod display;

use super::{Status, input, report};
use crate::{
    arguments::{AccuracyArguments, LogArguments, ModelArgument},
    error::CommandError,
    json, terminal,
};
use clap::Args;
use fluxfit::{Request, document::ValidationDocument, validate, validation::validate::Outcome};
use fluxfit_report::{ValidationReport, validation_figures, validation_html};
use fluxfit_setup::read_given_motor;
use std::path::Path;

#[derive(Debug, Args)]
#[command(override_usage = "fluxfit validate <LOG>... --motor <MOTOR> [OPTIONS]")]
#[command(mut_arg("motor", |motor| motor.required(true).value_name("MOTOR").help(VALIDATED).long_help(VALIDATED)))]
#[command(mut_arg("bounds", |bounds| bounds.hide(true)), mut_arg("seed", |seed| seed.hide(true)))]
pub(crate) struct Validate {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    /// Model that predicts the log
    #[arg(long, help_heading = "Model", value_enum, default_value_t = ModelArgument::Auto)]
    model: ModelArgument,
    #[command(flatten)]
    accuracy: AccuracyArguments,
}

const VALIDATED: &str = "The parameters to validate: a motor file with all four, the JSON document of fluxfit identify (with its standard errors), or a file of true parameters";

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
    input.findings().iter().for_each(terminal::warn_of_columns);
    let request = request(arguments, &input)?;
    let found = terminal::working(format!("fitting {} rows", input.log.rows()), || validate(&input.log, &motor.given, &request));
    let found = found.map_err(|error| input::of_log(&input.name, error))?;
    let name = path.display().to_string();
    if arguments.log.json {
        terminal::print(&json::text(&ValidationDocument::of(&input.log, &found))?)?;
    } else {
        display::show(&input.name, &name, &input.log, &found)?;
    }
    let origin = report::origin(arguments.log.seed);
    let document = arguments.log.report.is_some().then(|| json::text(&ValidationDocument::of(&input.log, &found))).transpose()?;
    let shown = ValidationReport {
        title: &input.title,
        motor: &input::file_name(path),
        log: &input.log,
        notes: &input.said(),
        found: &found,
        json: document.as_deref(),
        origin: &origin,
    };
    let (page, figures) = (|| validation_html(&shown), || validation_figures(&shown));
    report::write(arguments.log.report.as_deref(), page, arguments.log.figures.as_deref(), figures)?;
    Ok(if found.outcome == Outcome::Agrees { Status::Complete } else { Status::Incomplete })
}

/// What is asked of the library.
pub(crate) fn request(arguments: &Validate, input: &input::Input) -> Result<Request, CommandError> {
    let mut request = Request { model: arguments.model.stated(), ..input::request(&arguments.log, input)? };
    arguments.accuracy.apply(input.motor.sensors, &mut request);
    Ok(request)
}
