//! `fluxfit identify`: arguments to a request, the library's answer to the terminal, to JSON, to a report and to exports.

mod characteristics;
mod current_loop;
mod decisions;
mod details;
pub(crate) mod display;
pub(crate) mod export;

use super::{Status, input, report};
use crate::{
    arguments::{AccuracyArguments, LogArguments, ModelArgument, by_parameter, method_keys},
    error::CommandError,
    interrupt, json,
    terminal::{self, told::Told},
};
use clap::Args;
use fluxfit::{
    Answer, Known, Model, Request, Step, Swarm, Warning, identify_with_progress,
    motor::{PARAMETERS, Parameter},
    optimizer::Method,
};
use fluxfit_answer::export::Target;
use fluxfit_report::{Report, figures, html};
use std::{path::PathBuf, sync::Arc};

#[derive(Debug, Clone, Args)]
pub(crate) struct Identify {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    /// Model that is fitted to the log
    #[arg(long, help_heading = "Model", value_enum, default_value_t = ModelArgument::Auto)]
    model: ModelArgument,
    // Its help lists the methods: `help_of_search_method`.
    #[arg(long, help_heading = "Search", default_value = "auto", value_parser = parse_search_method,
          help = help_of_search_method(), long_help = long_help_of_search_method())]
    method: SearchMethod,
    #[command(flatten)]
    accuracy: AccuracyArguments,
    /// A parameter known exactly, e.g. rs=0.96 or ld=5.25mH; a bare number is SI
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE,..", value_delimiter = ',', value_parser = fluxfit_units::parse_fix, allow_hyphen_values = true)]
    fix: Vec<(Parameter, f64)>,
    /// A parameter known with a standard error (the ± of an answer is about twice that), e.g. rs=0.96±1% or rs=0.96+-0.01
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE±ERROR,..", value_delimiter = ',', value_parser = fluxfit_units::parse_prior, allow_hyphen_values = true)]
    prior: Vec<(Parameter, f64, f64)>,
    /// Change of the magnets' flux with temperature, e.g. -0.12%/K, for psi_f at 20 degC
    ///
    /// It is used where the log has the winding's temperature; the magnets are taken to be as warm. [default: that of the motor file]
    #[arg(long, help_heading = "Prior knowledge", value_name = "FRACTION/K", allow_hyphen_values = true, value_parser = fluxfit_units::parse_coefficient)]
    magnet_coefficient: Option<f64>,
    /// Identify without the last log (of one log: the last segment), and validate on it
    #[arg(long, help_heading = "Output")]
    hold_out: bool,
    // Its help lists the targets: `export::help`.
    #[arg(long, help_heading = "Output", value_name = "TARGET=FILE", value_parser = export::parse, help = export::help())]
    export: Vec<(Target, PathBuf)>,
    /// Compute the current controllers' gains for this bandwidth, e.g. 500Hz
    #[arg(long, help_heading = "Output", value_name = "FREQUENCY", value_parser = fluxfit_units::parse_frequency)]
    bandwidth: Option<f64>,
    /// Rate of the current controllers, for the phase margin, e.g. 10kHz [default: the log's sample rate]
    #[arg(long, help_heading = "Output", value_name = "FREQUENCY", value_parser = fluxfit_units::parse_frequency, requires = "bandwidth")]
    control_rate: Option<f64>,
}

/// Who searches in `identify`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SearchMethod {
    Auto,
    LeastSquares,
    Swarm(Method),
}

fn help_of_search_method() -> String {
    format!("Optimizer that is run for comparison: least-squares (none), {}", method_keys())
}

fn long_help_of_search_method() -> String {
    let auto = "The identified parameters do not depend on it. auto is tgfpa with the steady model, and none with the output error, where a run \
                takes seconds.";
    format!("{}\n\n{auto}", help_of_search_method())
}

fn parse_search_method(text: &str) -> Result<SearchMethod, String> {
    match text {
        "auto" => Ok(SearchMethod::Auto),
        "least-squares" => Ok(SearchMethod::LeastSquares),
        _ => {
            let unknown = || format!("no method '{text}'; there are auto, least-squares, {}", method_keys());
            Method::named(text).map(SearchMethod::Swarm).ok_or_else(unknown)
        }
    }
}

impl Identify {
    /// The options that are given and write something of one motor.
    pub(crate) fn outputs_of_one(&self) -> impl Iterator<Item = &'static str> {
        let options = [("--export", !self.export.is_empty()), ("--hold-out", self.hold_out), ("--bandwidth", self.bandwidth.is_some())];
        options.into_iter().filter(|(_, is_stated)| *is_stated).map(|(option, _)| option)
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Identify) -> Result<Status, CommandError> {
    if !arguments.log.json {
        terminal::hold_notes();
    }
    report::check(&arguments.log, [])?;
    export::check(&arguments.log, &arguments.export)?;
    if let Some(status) = characteristics::run(&arguments.log, &for_logs(arguments), &input::options_of_motor(&arguments.log)?)? {
        return Ok(status);
    }
    let input = input::read(&arguments.log)?;
    accepted(arguments, &input)?.iter().chain(&input.samples()).for_each(terminal::warn_of_columns);
    let request = request(arguments, &input)?;
    export::check_pole_pairs(&arguments.export, input.pole_pairs)?;
    let answer = identified(&input, &request, !arguments.log.json)?;
    decisions::show(&answer.identification);
    if arguments.log.json {
        terminal::print(&json::text(&answer)?)?;
        // The document lists it among others; whoever interrupted the search is told at once.
        answer.warnings().iter().filter(|warning| matches!(warning, Warning::Interrupted { .. })).for_each(terminal::warn_at_length);
    } else {
        display::show(&input.name, &answer)?;
    }
    let exported = export::write(&arguments.log, &arguments.export, &input, &answer)?;
    let document = arguments.log.report.is_some().then(|| json::text(&answer)).transpose()?;
    let shown = Report {
        title: &input.title,
        log: &answer.log,
        notes: &input.said(),
        operating_points: answer.identification.operating_points(),
        identification: Some((&answer.identification, answer.identification.method)),
        held_out: answer.held_out.as_ref().map(|held_out| (&held_out.log, held_out.validation.as_ref())),
        study: None,
        online: None,
        json: document.as_deref(),
        options: report::options(),
        origin: &report::origin(arguments.log.seed),
    };
    report::write(arguments.log.report.as_deref(), || html(&shown), arguments.log.figures.as_deref(), || figures(&shown))?;
    Ok(if answer.is_complete() { exported } else { Status::Incomplete })
}

/// What the columns contradict each other in, if the model is stated all the same or nothing of it is certain.
pub(crate) fn accepted(arguments: &Identify, input: &input::Input) -> Result<Vec<Told>, CommandError> {
    let findings = input.findings();
    match findings.iter().find(|finding| finding.refuses && arguments.model == ModelArgument::Auto) {
        Some(finding) => Err(CommandError::Columns { log: input.name.clone(), finding: finding.clone() }),
        None => Ok(findings),
    }
}

/// The options that are given and have no meaning for tables of a test bench.
fn for_logs(arguments: &Identify) -> Vec<&'static str> {
    let options = [
        ("--export", !arguments.export.is_empty()),
        ("--fix", !arguments.fix.is_empty()),
        ("--prior", !arguments.prior.is_empty()),
        ("--hold-out", arguments.hold_out),
        ("--bandwidth", arguments.bandwidth.is_some()),
        ("--model", arguments.model != ModelArgument::Auto),
    ];
    options.into_iter().filter(|(_, is_stated)| *is_stated).map(|(option, _)| option).collect()
}

/// Identifies, and shows the progress. The swarm's search can be interrupted; before it, people get a rough answer.
fn identified(input: &input::Input, request: &Request, is_for_people: bool) -> Result<Answer, CommandError> {
    let fitting = format!("fitting {} rows", input.log.rows());
    let progress = terminal::unknown(&fitting);
    let show = |step: Step| {
        match step {
            Step::OperatingPoints => progress.turn_to("solving the operating points"),
            Step::VoltageTiming => progress.turn_to("trying the timings of the voltages"),
            Step::Faults => progress.turn_to("looking for faults of the drive"),
            Step::Fit { simulations, usual } => progress.count(&fitting, simulations, usual),
            Step::Uncertainty => progress.turn_to("computing the uncertainty"),
            Step::Search { iteration: 0, limit } => {
                interrupt::be_gentle(true);
                progress.count("searching", 0, limit);
            }
            Step::Search { iteration, limit } => progress.count("searching", iteration, limit),
            Step::Nameplate => interrupt::be_gentle(false),
            Step::Validation => progress.turn_to("predicting what was held out"),
            _ => {}
        }
        interrupt::go_on()
    };
    let identify = || identify_with_progress(&input.log, request, &show);
    let answer = if is_for_people {
        let (name, log) = (input.name.clone(), Arc::clone(&input.log));
        let request = Request { model: Some(Model::Steady), swarm: Swarm::Off, bandwidth: None, hold_out: false, ..request.clone() };
        interrupt::or_roughly(move || display::show_roughly(&name, &log, &request), identify)
    } else {
        identify()
    };
    interrupt::be_gentle(false);
    answer.map_err(|found| {
        found.suspected_units.iter().for_each(terminal::warn_at_length);
        input::of_log(&input.name, found.error)
    })
}

/// What is asked of the library.
pub(crate) fn request(arguments: &Identify, input: &input::Input) -> Result<Request, CommandError> {
    let mut request = input::request(&arguments.log, input)?;
    request.model = arguments.model.stated();
    arguments.accuracy.apply(input.motor.sensors, &mut request);
    request.magnet_coefficient = arguments.magnet_coefficient.or(input.motor.magnet_coefficient);
    if arguments.magnet_coefficient.is_some() && input.log.columns().temperature.is_none() {
        terminal::note("--magnet-coefficient is not used: the log has no temperature");
    }
    request.known = known(arguments)?;
    request.swarm = match arguments.method {
        SearchMethod::Auto => Swarm::Auto,
        SearchMethod::LeastSquares => Swarm::Off,
        SearchMethod::Swarm(method) => Swarm::Method(method),
    };
    request.bandwidth = arguments.bandwidth;
    request.control_rate = arguments.control_rate;
    request.hold_out = arguments.hold_out;
    Ok(request)
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
                let key = Parameter::ALL[p].key();
                return Err(CommandError::Usage(format!("{key} is given with --fix and with --prior; give one of them")));
            }
        };
    }
    Ok(known)
}
