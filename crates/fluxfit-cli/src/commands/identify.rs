//! `fluxfit identify`: arguments to settings, the library's answer to the terminal or to JSON.

use super::{Status, export, input, report};
use crate::{
    arguments::{Identify, SearchMethod, by_parameter},
    error::CommandError,
    interrupt, json, terminal,
};
use fluxfit::{
    current_loop::CurrentLoop,
    document::{IdentificationDocument, Identified},
    error::Error,
    identify::{
        Identification, Known, Provenance, Settings, Step, conventions, identify, identify_watched,
        model::{self, Model},
        search_box::from_points,
    },
    log::Log,
    motor::PARAMETERS,
    optimizer::{self, Method, StopReason, tgfpa::Tgfpa},
    validate::{Given, Validation, validate},
};
use fluxfit_files::number::significant;
use fluxfit_report::{Report, figures, html};

/// Code of the warning that a search was cut.
const INTERRUPTED: &str = "interrupted";

/// Runs the verb.
pub(crate) fn run(arguments: &Identify) -> Result<Status, CommandError> {
    report::check(&arguments.log, [])?;
    export::check(arguments)?;
    let mut input = input::read(&arguments.log)?;
    let held_out = if arguments.hold_out { Some(hold_out(&mut input)?) } else { None };
    let mut settings = settings(arguments)?;
    let nameplate = input::nameplate(&input);
    export::check_pole_pairs(arguments, nameplate.pole_pairs)?;
    let control_rate = control_rate(arguments, &input.log)?;
    let refuse = |error: Error| {
        // A log without an operating point may be one in the wrong units: its rows still say so.
        conventions::check(&input.log, None, &nameplate)
            .warning()
            .iter()
            .for_each(|warning| terminal::warn(warning.code, &warning.message));
        input::of_log(&input.name, error)
    };
    settings.method = searcher(arguments, &input.log, &settings);
    if let Ok(points) = fluxfit::identify::operating_points(&input.log, &settings) {
        settings.bounds = Some(input::search_box(&arguments.log, &input, &from_points(&points)?)?);
    }
    let found = watched(&input.log, &settings);
    let mut found = found.map_err(refuse)?;
    terminal::decisions::tell(&found);
    // Wrong units scale the answer of the operating points alone: the slope of a current knows the time.
    let of_points = identify(&input.log, &Settings { model: Some(Model::Steady), method: None, ..settings.clone() });
    let convention = conventions::check(&input.log, Some((of_points.as_ref().unwrap_or(&found), &settings.known)), &nameplate);
    found.warnings.extend(convention.warning());
    let current_loop = arguments.bandwidth.map(|bandwidth| CurrentLoop::of(&found, bandwidth, control_rate)).transpose()?;
    found.warnings.extend(current_loop.as_ref().and_then(CurrentLoop::warning));
    let validation = held_out.as_ref().map(|log| check(log, &found, &settings)).transpose()?.flatten();
    if arguments.log.json {
        let document = IdentificationDocument::of(&Identified {
            log: &input.log,
            columns: &input.columns,
            notes: &input.notes,
            answer: &found,
            method: settings.method,
            convention: &convention,
            current_loop: current_loop.as_ref(),
            held_out: held_out.as_ref().map(|log| (log, validation.as_ref())),
        });
        terminal::print(&json::text(&document)?)?;
    } else {
        terminal::identification::show(&input.name, &input.log, &found, settings.method.as_ref())?;
        current_loop.as_ref().map(terminal::current_loop::show).transpose()?;
        match (&held_out, &validation) {
            (Some(log), Some(validation)) => {
                terminal::print("\n")?;
                terminal::validation::show("what was held out", "This answer", log, validation)?;
            }
            (Some(_), None) => terminal::note("what was held out is not predicted: that takes all four parameters"),
            (None, _) if input.log.segments().len() > 1 => {
                terminal::note(
                    "how well this predicts a part of the log that it was not found from: --hold-out; another log: fluxfit validate",
                );
            }
            (None, _) => {}
        }
    }
    if let Some(search) = found.search.as_ref().filter(|search| search.report.stop_reason == StopReason::Interrupted) {
        let (done, limit) = (search.report.history.len() - 1, settings.search.iterations);
        terminal::warn(INTERRUPTED, &format!("the swarm made {done} of {limit} iterations; the answer beside it is whole"));
    }
    let exported = export::write(arguments, &input, &found, current_loop.as_ref())?;
    let shown = Report {
        title: &input.name,
        log: &input.log,
        notes: &input.said(),
        operating_points: found.operating_points(),
        identification: Some((&found, settings.method)),
        held_out: held_out.as_ref().map(|log| (log, validation.as_ref())),
        study: None,
        origin: &report::origin(arguments.log.seed),
    };
    report::write(arguments.log.report.as_deref(), || html(&shown), arguments.log.figures.as_deref(), || figures(&shown))?;
    Ok(if found.is_complete() { exported } else { Status::Incomplete })
}

/// Rate of the current controllers: the log's, unless stated, if the log comes as fast as a drive controls.
fn control_rate(arguments: &Identify, log: &Log) -> Result<(f64, Provenance), CommandError> {
    if let Some(rate) = arguments.control_rate {
        return Ok((rate, Provenance::Stated));
    }
    let rate = 1.0 / log.segments().iter().map(|segment| segment.sample_period).fold(f64::INFINITY, f64::min);
    if arguments.bandwidth.is_some() && rate < model::SLOWEST_CONTROL {
        let rate = significant(rate, 3);
        let why = format!(
            "--bandwidth needs --control-rate FREQUENCY here: rows at {rate} Hz are a recorder's, not those of the drive's control"
        );
        return Err(CommandError::Usage(why));
    }
    Ok((rate, Provenance::Assumed))
}

/// Identifies, and tells how far it is. The swarm can be interrupted, and is the last.
fn watched(log: &Log, settings: &Settings) -> Result<Identification, Error> {
    let progress = terminal::unknown(&format!("fitting {} rows", log.rows()));
    let told = |what: &str| progress.turn_to(what);
    let watch = |step: Step| {
        match step {
            Step::OperatingPoints => told("solving the operating points"),
            Step::Readings => told("trying the readings of the voltages"),
            Step::Faults => told("looking for faults of the drive"),
            Step::Fit { simulations, usual } => progress.count(&format!("fitting {} rows", log.rows()), simulations, usual),
            Step::Uncertainty => told("telling how uncertain the answer is"),
            Step::Search { iteration: 0, limit } => {
                interrupt::be_gentle(true);
                progress.count("searching", 0, limit);
            }
            Step::Search { iteration, limit } => progress.count("searching", iteration, limit),
        }
        interrupt::go_on()
    };
    let found = identify_watched(log, settings, &watch);
    interrupt::be_gentle(false);
    found
}

/// Takes the last log, or segment, out of what is identified from.
fn hold_out(input: &mut input::Input) -> Result<Log, CommandError> {
    let (rest, last) = input.log.part_last().ok_or_else(|| {
        CommandError::Usage("--hold-out needs several logs, or one with a gap in time: this one has a single segment".to_owned())
    })?;
    input.log = rest;
    Ok(last)
}

/// Validates the answer on what was held out; nothing, if the answer lacks a parameter.
fn check(log: &Log, found: &Identification, settings: &Settings) -> Result<Option<Validation>, CommandError> {
    let Some(given) = Given::of(found) else { return Ok(None) };
    let validation = validate(log, &given, &Settings { windows: Vec::new(), ..settings.clone() });
    validation.map(Some).map_err(|error| input::of_log("what was held out", error))
}

fn settings(arguments: &Identify) -> Result<Settings, CommandError> {
    Ok(Settings {
        windows: arguments.log.window.clone(),
        voltage_timing: arguments.log.voltage_timing.stated(),
        voltage_accuracy: arguments.voltage_accuracy,
        known: known(arguments)?,
        model: arguments.model.stated(),
        method: None,
        search: optimizer::Settings { seed: arguments.log.seed, ..optimizer::Settings::default() },
        bounds: None,
    })
}

/// The swarm: by itself only where it takes no time.
fn searcher(arguments: &Identify, log: &Log, settings: &Settings) -> Option<Method> {
    match arguments.method {
        SearchMethod::Auto => (model::choose(log, settings).0 == Model::Steady).then(|| Method::Tgfpa(Tgfpa::default())),
        SearchMethod::LeastSquares => None,
        SearchMethod::Swarm(method) => Some(method),
    }
}

fn known(arguments: &Identify) -> Result<[Known; PARAMETERS], CommandError> {
    let fixed = by_parameter(&arguments.fix, "--fix")?;
    let given: Vec<_> = arguments.prior.iter().map(|(parameter, value, standard_error)| (*parameter, (*value, *standard_error))).collect();
    let priors = by_parameter(&given, "--prior")?;
    let mut known = [Known::Nothing; PARAMETERS];
    for (p, known) in known.iter_mut().enumerate() {
        *known = match (fixed[p], priors[p]) {
            (None, None) => Known::Nothing,
            (Some(value), None) => Known::Fixed(value),
            (None, Some((value, standard_error))) => Known::Prior { value, standard_error },
            (Some(_), Some(_)) => {
                let key = fluxfit::motor::Parameter::ALL[p].key();
                return Err(CommandError::Usage(format!("{key} is given with --fix and with --prior; give one of them")));
            }
        };
    }
    Ok(known)
}
