//! `fluxfit identify`: arguments to a request, the library's answer to the terminal, to JSON, to a report and to exports.

use super::{Status, export, input, report};
use crate::{
    arguments::{Identify, SearchMethod, by_parameter},
    error::CommandError,
    interrupt, json, terminal,
};
use fluxfit::{
    Answer, Known, Request, Step, Swarm, Warning, identify_with_progress,
    motor::{PARAMETERS, Parameter},
    suspect_units,
};
use fluxfit_report::{Report, figures, html};

/// Runs the verb.
pub(crate) fn run(arguments: &Identify) -> Result<Status, CommandError> {
    report::check(&arguments.log, [])?;
    export::check(arguments)?;
    let input = input::read(&arguments.log)?;
    let request = request(arguments, &input)?;
    export::check_pole_pairs(arguments, input.pole_pairs)?;
    let answer = identified(&input, &request)?;
    terminal::decisions::show(&answer.identification);
    if arguments.log.json {
        terminal::print(&json::text(&answer)?)?;
        // The document lists it among others; whoever interrupted the search is told at once.
        answer.warnings().iter().filter(|warning| matches!(warning, Warning::Interrupted { .. })).for_each(terminal::warn);
    } else {
        terminal::identification::show(&input.name, &answer)?;
    }
    let exported = export::write(arguments, &input, &answer)?;
    let shown = Report {
        title: &input.name,
        log: &answer.log,
        notes: &input.said(),
        operating_points: answer.identification.operating_points(),
        identification: Some((&answer.identification, answer.identification.method)),
        held_out: answer.held_out.as_ref().map(|held_out| (&held_out.log, held_out.validation.as_ref())),
        study: None,
        origin: &report::origin(arguments.log.seed),
    };
    report::write(arguments.log.report.as_deref(), || html(&shown), arguments.log.figures.as_deref(), || figures(&shown))?;
    Ok(if answer.is_complete() { exported } else { Status::Incomplete })
}

/// Identifies, and shows the progress. The swarm's search can be interrupted.
fn identified(input: &input::Input, request: &Request) -> Result<Answer, CommandError> {
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
    let answer = identify_with_progress(&input.log, request, &show);
    interrupt::be_gentle(false);
    answer.map_err(|error| {
        // A log without an operating point may be one in the wrong units: its rows still say so.
        suspect_units(&input.log, request).iter().for_each(terminal::warn);
        input::of_log(&input.name, error)
    })
}

fn request(arguments: &Identify, input: &input::Input) -> Result<Request, CommandError> {
    let mut request = input::request(&arguments.log, input)?;
    request.model = arguments.model.stated();
    request.voltage_accuracy = arguments.voltage_accuracy;
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
