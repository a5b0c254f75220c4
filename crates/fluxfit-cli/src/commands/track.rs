//! `fluxfit track`: the parameters of a running motor over time, from a log or from rows as they arrive.

pub(crate) mod alarm;
mod display;
mod faults;
mod live;
mod source;
pub(crate) mod state;
pub(crate) mod tracking;
mod value;

use super::{Status, input};
use crate::{
    arguments::{ColumnArguments, Timing as TimingArgument, by_parameter},
    error::CommandError,
    interrupt, terminal,
};
use alarm::{Alarm, Watch};
use clap::Args;
use display::{Format, Lines};
use fluxfit::{Parameter, log::Row};
use fluxfit_log::LogOptions;
use fluxfit_setup::{MotorFile, read_motor};
use fluxfit_track::{Method, Start, Thermometer, Timing, TrackSettings, Tracker};
use fluxfit_units::{Dimension, parse_quantity};
use std::path::{Path, PathBuf};
use tracking::Tracking;

#[derive(Debug, Args)]
pub(crate) struct Track {
    /// The log of a motor; - is standard input, read line by line
    #[arg(value_name = "LOG", required_unless_present = "listen")]
    log: Option<PathBuf>,
    #[command(flatten)]
    columns: ColumnArguments,
    /// When the voltages ud, uq of a row are applied [default: the stream decides between centered, 0, 1 and 2]
    #[arg(long, help_heading = "Log", value_enum, default_value_t = TimingArgument::Auto, allow_hyphen_values = true)]
    voltage_timing: TimingArgument,
    /// Go on when the end of the file is reached: it is still being written
    ///
    /// A file that is rotated or truncated is followed on. Ctrl-C ends it.
    #[arg(long, help_heading = "Log", conflicts_with = "listen")]
    follow: bool,
    /// Wait here for a connection that sends rows as lines, e.g. 127.0.0.1:7000
    ///
    /// The first line is the header. When a connection is closed, the next one is waited for. Ctrl-C ends it.
    #[arg(long, help_heading = "Log", value_name = "HOST:PORT", conflicts_with = "log")]
    listen: Option<String>,
    // Its help lists the estimators.
    #[arg(long, help_heading = "Model", default_value = "ekf-tracking", value_parser = parse_method, help = help_of_methods())]
    method: Method,
    /// The JSON of fluxfit identify, from a log of the same drive: its dead time, sensor offset and angle offset are undone
    #[arg(long, value_name = "ANSWER.json", help_heading = "Prior knowledge", conflicts_with = "resume")]
    faults: Option<PathBuf>,
    /// Motor file: pole pairs, values to begin with, rating, magnets' coefficient
    #[arg(long, value_name = "MOTOR.toml", help_heading = "Prior knowledge")]
    motor: Option<PathBuf>,
    /// A value to begin with, e.g. rs=1,ld=5mH [default: that of the motor file, else from the first samples]
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE,..", value_delimiter = ',', value_parser = fluxfit_units::parse_fix, allow_hyphen_values = true)]
    start: Vec<(Parameter, f64)>,
    /// A parameter known exactly, e.g. rs=0.96 or ld=5.25mH; a bare number is SI
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE,..", value_delimiter = ',', value_parser = fluxfit_units::parse_fix, allow_hyphen_values = true)]
    fix: Vec<(Parameter, f64)>,
    /// A parameter known at the start with a standard error, e.g. rs=0.96±1% or rs=0.96+-0.01
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE±ERROR,..", value_delimiter = ',', value_parser = fluxfit_units::parse_prior, allow_hyphen_values = true)]
    prior: Vec<(Parameter, f64, f64)>,
    /// Temperature of motor and magnets, degC, at which they have the values of the motor file: then temperatures are told
    ///
    /// What the motor file does not state is taken from the first minute.
    #[arg(long, help_heading = "Prior knowledge", value_name = "DEGC", allow_hyphen_values = true, value_parser = parse_temperature)]
    reference_temperature: Option<f64>,
    /// Change of the magnets' flux with temperature, e.g. -0.12%/K [default: that of the motor file]
    #[arg(long, help_heading = "Prior knowledge", value_name = "FRACTION/K", allow_hyphen_values = true, value_parser = fluxfit_units::parse_coefficient)]
    magnet_coefficient: Option<f64>,
    /// Time from line to line of the output, in the log's time, e.g. 100ms
    #[arg(long, help_heading = "Output", value_name = "TIME", default_value = "100ms", value_parser = parse_time)]
    every: f64,
    /// Print a line of CSV for each time, while it runs
    #[arg(long, help_heading = "Output", conflicts_with = "json")]
    csv: bool,
    /// Print a JSON document in a line for each time, while it runs
    #[arg(long, help_heading = "Output")]
    json: bool,
    /// Exit with status 3 if a parameter leaves a band around its start, e.g. rs=+20% or psi_f=-5%; repeatable
    ///
    /// The start is the value of --start, --prior or the motor file, else the first value that is identified. Without a sign both
    /// directions count.
    #[arg(long, help_heading = "Output", value_name = "NAME=CHANGE,..", value_delimiter = ',', value_parser = alarm::parse, allow_hyphen_values = true)]
    alarm: Vec<Alarm>,
    /// Save what is known at the end
    #[arg(long, help_heading = "Output", value_name = "FILE")]
    save_state: Option<PathBuf>,
    /// Go on from a saved state, to the same bits
    #[arg(long, help_heading = "Prior knowledge", value_name = "FILE", conflicts_with_all = ["start", "fix", "prior"])]
    resume: Option<PathBuf>,
}

fn help_of_methods() -> String {
    let keys: Vec<&str> = Method::ALL.iter().map(|method| method.key()).collect();
    format!("Estimator: {}", keys.join(", "))
}

fn parse_method(text: &str) -> Result<Method, String> {
    Method::named(text).ok_or_else(|| format!("no estimator '{text}'; there are {}", Method::ALL.map(Method::key).join(", ")))
}

fn parse_time(text: &str) -> Result<f64, String> {
    let seconds = parse_quantity(text, Dimension::Time).map_err(|error| error.to_string())?;
    if seconds > 0.0 { Ok(seconds) } else { Err("the time must be above zero".to_owned()) }
}

fn parse_temperature(text: &str) -> Result<f64, String> {
    let bare = text.trim().trim_end_matches("degC").trim();
    let celsius: Option<f64> = bare.parse().ok().filter(|celsius: &f64| celsius.is_finite() && *celsius > -273.15);
    celsius.ok_or_else(|| format!("\"{text}\" is not a temperature; write a number, in degC, as in 25"))
}

/// Runs the verb.
pub(crate) fn run(arguments: &Track) -> Result<Status, CommandError> {
    let (tracking, watch, options) = begun(arguments)?;
    if let Some(path) = &arguments.save_state {
        fluxfit_files::check_writable(path)?;
    }
    let mut run = Running { watch, lines: Lines::new(format_of(arguments)), tracking };
    run.lines.begin()?;
    let name = match (&arguments.listen, &arguments.log) {
        (Some(place), _) => {
            source::listen(place, &options, &mut |row| run.take(row))?;
            place.clone()
        }
        (None, Some(path)) if arguments.follow || path == Path::new("-") => {
            source::stream(path, &options, &mut |row| run.take(row))?;
            input::name(path)
        }
        (None, Some(path)) => {
            source::file(path, &options, &mut |row| run.take(row))?;
            input::name(path)
        }
        (None, None) => return Err(CommandError::Usage("a log is missing; name one, or - for standard input".to_owned())),
    };
    run.end(&name)?;
    if let Some(path) = &arguments.save_state {
        state::write(path, &run.tracking.tracker)?;
        terminal::wrote("state", path);
    }
    Ok(run.status())
}

/// A tracker as it is asked for, the bands around what it begins with, and how rows are read.
pub(crate) fn begun(arguments: &Track) -> Result<(Tracking, Watch, LogOptions), CommandError> {
    let motor = arguments.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
    let options = input::options(&arguments.columns, motor.pole_pairs)?;
    let start = start(arguments, &motor, options.pole_pairs)?;
    let watch = Watch::new(&arguments.alarm, &start.values);
    let faults = arguments.faults.as_deref().map(faults::read).transpose()?.unwrap_or_default();
    let tracker = match &arguments.resume {
        Some(path) => state::read(path)?,
        None => Tracker::new(TrackSettings { start, faults, ..TrackSettings::new(arguments.method, timing(arguments)?) }),
    };
    Ok((Tracking::new(tracker, thermometer(arguments, &motor), arguments.every), watch, options))
}

/// A tracker, and who looks at it.
struct Running {
    tracking: Tracking,
    watch: Watch,
    lines: Lines,
}

impl Running {
    /// Takes a row. False if no more are wanted.
    fn take(&mut self, row: &Row) -> Result<bool, CommandError> {
        if self.tracking.take(row)? {
            self.lines.show(&self.tracking, false)?;
            self.look();
        }
        Ok(interrupt::go_on().is_continue())
    }

    fn look(&mut self) {
        for left in self.watch.look(self.tracking.tracker.time(), &self.tracking.tracker.parameters_or_nothing()) {
            terminal::warn_of("alarm", &left.to_string());
        }
    }

    fn end(&mut self, name: &str) -> Result<(), CommandError> {
        self.tracking.end();
        self.look();
        self.lines.end(name, &self.tracking)?;
        let left_out = self.tracking.tracker.left_out();
        if left_out.not_numbers + left_out.spikes > 0 {
            terminal::note(&format!(
                "rows left out: {} with a value that is no number or cut off, {} with a value that no drive had",
                left_out.not_numbers, left_out.spikes
            ));
        }
        Ok(())
    }

    fn status(&self) -> Status {
        let is_known = self.tracking.tracker.parameters_or_nothing().iter().all(|parameter| parameter.value.is_some());
        match (self.watch.has_rung(), is_known) {
            (true, _) => Status::Alarm,
            (false, true) => Status::Complete,
            (false, false) => Status::Incomplete,
        }
    }
}

fn format_of(arguments: &Track) -> Format {
    match (arguments.json, arguments.csv) {
        (true, _) => Format::Json,
        (false, true) => Format::Csv,
        (false, false) => Format::Table,
    }
}

fn timing(arguments: &Track) -> Result<Option<Timing>, CommandError> {
    let Some(stated) = arguments.voltage_timing.stated() else { return Ok(None) };
    let unsupported = || {
        let sentence = "this --voltage-timing is for fluxfit identify; track knows centered, 0, 1, 2 and 0-row to 2-row";
        CommandError::Usage(sentence.to_owned())
    };
    Timing::of(stated).map(Some).ok_or_else(unsupported)
}

fn start(arguments: &Track, motor: &MotorFile, pole_pairs: Option<u32>) -> Result<Start, CommandError> {
    let (fixed, stated) = (by_parameter(&arguments.fix, "--fix")?, by_parameter(&arguments.start, "--start")?);
    let priors: Vec<_> = arguments.prior.iter().map(|(parameter, value, error)| (*parameter, (*value, *error))).collect();
    let priors = by_parameter(&priors, "--prior")?;
    let of_file = [motor.rs, motor.ld, motor.lq, motor.psi_f];
    let mut start = Start::default();
    for parameter in Parameter::ALL {
        let j = parameter as usize;
        if [fixed[j].is_some(), priors[j].is_some(), stated[j].is_some()].iter().filter(|given| **given).count() > 1 {
            let key = parameter.key();
            return Err(CommandError::Usage(format!("{key} is given twice among --start, --prior and --fix; give it once")));
        }
        let prior = priors[j].map(|(value, _)| value);
        start.values[j] = fixed[j].or(prior).or(stated[j]).or(of_file[j]);
        start.standard_errors[j] = fixed[j].map(|_| 0.0).or(priors[j].map(|(_, error)| error));
        if start.values[j].is_some_and(|value| value <= 0.0) {
            let key = parameter.key();
            return Err(CommandError::Usage(format!("{key} must be above zero to begin with; give a positive value")));
        }
    }
    start.rating = match (motor.rating.current, motor.rating.speed, pole_pairs) {
        (Some(current), Some(speed), Some(pole_pairs)) => Some([current, speed * f64::from(pole_pairs)]),
        _ => None,
    };
    Ok(start)
}

fn thermometer(arguments: &Track, motor: &MotorFile) -> Option<Thermometer> {
    let coefficient = arguments.magnet_coefficient.or(motor.magnet_coefficient);
    arguments.reference_temperature.map(|reference| Thermometer::new(reference, motor.rs, motor.psi_f, coefficient))
}
