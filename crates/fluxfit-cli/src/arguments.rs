//! The command line, as clap reads it. `fluxfit-units` and `fluxfit-log` parse the values; nothing is decided here.

use anstyle::Style;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum, builder::Resettable};
use fluxfit::{
    Model,
    motor::Parameter,
    objective::{
        acting_voltage::{VoltageFrame, VoltageReading},
        voltage_error::IdZero,
    },
    optimizer::{METHODS, Method},
};
use fluxfit_answer::export::Target;
use fluxfit_units::{
    Unit, key_value,
    wording::{did_you_mean, list, nearest, quote},
};
use std::path::PathBuf;

/// Identifies a permanent magnet synchronous motor from a log of its drive
#[derive(Debug, Parser)]
#[command(name = "fluxfit", version, max_term_width = 110, subcommand_value_name = "VERB", after_help = EXIT_STATUS, arg_required_else_help = true)]
pub(crate) struct Command {
    #[command(subcommand)]
    pub(crate) verb: Verb,
    #[command(flatten)]
    pub(crate) telling: Telling,
}

/// How much is told on standard error.
#[derive(Debug, Args)]
pub(crate) struct Telling {
    /// Suppress notes and progress; warnings and errors remain
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Print each decision and its time on standard error
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

const EXIT_STATUS: &str = "Exit status: 0 identified, or agrees; 1 not all, or differs; 2 error; 130 Ctrl-C";

/// The verbs as the first help shows them; a verb that no group names comes last.
const GROUPS: [(&str, &[&str]); 3] = [
    ("Motors", &["identify", "validate", "compare"]),
    ("Logs", &["inspect", "formats", "simulate"]),
    ("Program", &["demo", "completions", "man", "help"]),
];

/// The command with its verbs in groups.
pub(crate) fn command() -> clap::Command {
    let command = Command::command();
    let verbs: Vec<(String, String)> = command
        .get_subcommands()
        .map(|verb| (verb.get_name().to_owned(), verb.get_about().map(ToString::to_string).unwrap_or_default()))
        .chain([("help".to_owned(), "Print the help of a verb".to_owned())])
        .collect();
    let width = verbs.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let is_in = |names: &[&str], name: &str| names.contains(&name);
    let rest: Vec<&str> =
        verbs.iter().map(|(name, _)| name.as_str()).filter(|name| !GROUPS.iter().any(|(_, names)| is_in(names, name))).collect();
    let mut text = String::new();
    for (title, names) in GROUPS.into_iter().chain([("Others", rest.as_slice())]) {
        let lines: String = names
            .iter()
            .filter_map(|name| verbs.iter().find(|(verb, _)| verb == name))
            .map(|(name, about)| format!("  {HEAD}{name:width$}{HEAD:#}  {about}\n"))
            .collect();
        if !lines.is_empty() {
            text += &format!("{TITLE}{title}:{TITLE:#}\n{lines}");
        }
    }
    command.help_template(format!("{{about}}\n\n{{usage-heading}} {{usage}}\n\n{text}{TITLE}Options:{TITLE:#}\n{{options}}{{after-help}}"))
}

/// Styles of clap's own headings and names.
const TITLE: Style = Style::new().bold().underline();
const HEAD: Style = Style::new().bold();

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Show how a log is read: columns, units, ranges, repairs
    ///
    /// Also writes a mapping file to start from, with -o.
    Inspect(Inspect),
    /// List the known layouts of logs
    Formats,
    /// Run everything on the paper's rig, and write a report
    ///
    /// Simulates the paper's motor in its drive, identifies it, compares four optimizers, and writes a report.
    Demo(Demo),
    /// Identify the parameters, with intervals and verdicts
    Identify(Identify),
    /// Compare swarm optimizers: many runs of each, against the minimum
    ///
    /// They minimize the paper's fitness (11), or the output error. After Ctrl-C, the finished runs are shown.
    Compare(Compare),
    /// Simulate a motor in a drive; write its log and true parameters
    Simulate(Simulate),
    /// Validate given parameters on another log
    ///
    /// Predicts the log with the given parameters and tests the prediction.
    Validate(Validate),
    /// Print the completions for a shell
    ///
    /// bash: fluxfit completions bash > ~/.local/share/bash-completion/completions/fluxfit. zsh: write to a file _fluxfit in a directory of
    /// fpath. fish: fluxfit completions fish > ~/.config/fish/completions/fluxfit.fish. PowerShell: append to the file $PROFILE.
    Completions(Completions),
    /// Write the manual pages, one for each verb
    Man(Man),
}

impl Verb {
    /// Whether standard output is for a program.
    pub(crate) fn is_json(&self) -> bool {
        match self {
            Self::Identify(Identify { log, .. }) | Self::Compare(Compare { log, .. }) | Self::Validate(Validate { log, .. }) => log.json,
            _ => false,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// Directory for the pages, for example ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
}

/// Which log, and how to read it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Log")]
pub(crate) struct LogArguments {
    /// Logs of one motor: CSV, Parquet, MATLAB, HDF5 or MDF 4; - is standard input
    #[arg(required = true, value_name = "LOG", help_heading = Resettable::Reset)]
    pub(crate) logs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) columns: ColumnArguments,
    /// Use this time window of the log, in seconds, e.g. 0.48:0.595; repeatable
    ///
    /// [default: all rows; the steady model finds its windows]
    #[arg(long, value_name = "T0:T1", value_parser = fluxfit_units::parse_window, allow_hyphen_values = true)]
    pub(crate) window: Vec<(f64, f64)>,
    /// When the voltages ud, uq of a row are applied
    ///
    /// Either they are the mean of the two periods around the row (centered), or the vector of one period that begins 0, 1 or 2 periods
    /// after the row.
    #[arg(long, value_enum, default_value_t = Timing::Auto)]
    pub(crate) voltage_timing: Timing,
    /// Motor file: pole pairs, nameplate values, rating
    ///
    /// fluxfit identify compares its result with the nameplate values. The rating widens the search box of the swarms.
    #[arg(long, value_name = "MOTOR.toml", help_heading = "Prior knowledge")]
    pub(crate) motor: Option<PathBuf>,
    /// Search box of the swarms, e.g. rs=0:5,ld=0:50mH; a bare number is SI
    ///
    /// [default: from the rating of the motor file or from the log, whichever is larger]
    #[arg(long, help_heading = "Search", value_name = "NAME=LOW:HIGH,..", value_delimiter = ',', value_parser = fluxfit_units::parse_bounds, allow_hyphen_values = true)]
    pub(crate) bounds: Vec<(Parameter, f64, f64)>,
    /// Seed of all random numbers
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Print the result as one JSON document and nothing else
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Also write the results as an HTML page
    #[arg(long, help_heading = "Output", value_name = "FILE.html")]
    pub(crate) report: Option<PathBuf>,
    /// Also write every figure of that page as SVG and PNG
    ///
    /// Each figure is NAME.svg and NAME.png in this directory, which is created if it does not exist.
    #[arg(long, help_heading = "Output", value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
}

/// What a log's columns mean.
#[derive(Debug, Args)]
#[command(next_help_heading = "Log")]
pub(crate) struct ColumnArguments {
    /// Columns with other names, e.g. ud=motor_vd_V,omega_e=speed
    ///
    /// The standard names are t, ud, uq, id, iq, omega_e, and optionally theta_e, u_dc. Phase quantities ia, ib, ic, ua, ub, uc with
    /// theta_e may replace id, iq, ud, uq. [default: the standard names, or a known layout]
    #[arg(long, value_name = "NAME=COLUMN,..", value_parser = parse_columns)]
    pub(crate) map: Vec<MappedColumns>,
    /// Units of columns, e.g. omega=rpm-mech,t=ms
    ///
    /// [default: the unit in the column's header, else that of the known layout, else SI]
    #[arg(long, value_name = "NAME=UNIT,..", value_delimiter = ',', value_parser = fluxfit_log::parse_unit)]
    pub(crate) unit: Vec<(String, Unit)>,
    /// Number of pole pairs, for speeds and angles in mechanical units
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) pole_pairs: Option<u32>,
    /// Mapping file: names, units, scales and signs of columns
    ///
    /// fluxfit inspect LOG -o MAPPING.toml writes one to start from.
    #[arg(long, value_name = "MAPPING.toml")]
    pub(crate) mapping: Option<PathBuf>,
}

/// Canonical names and headers of one `--map`.
#[derive(Debug, Clone)]
pub(crate) struct MappedColumns(pub(crate) Vec<(String, String)>);

fn parse_columns(text: &str) -> Result<MappedColumns, fluxfit_files::FileError> {
    fluxfit_log::parse_maps(text).map(MappedColumns)
}

/// `vesc=motor.xml`: a tool, and the file that is written for it.
fn parse_export(text: &str) -> Result<(Target, PathBuf), String> {
    let (name, file) = key_value(text, "TARGET=FILE", "vesc=motor.xml").map_err(|error| error.to_string())?;
    let keys = Target::ALL.map(Target::key);
    let unknown = || format!("{} is no target of --export; there are {}{}", quote(name), list(&keys), did_you_mean(nearest(name, keys)));
    Ok((Target::named(name).ok_or_else(unknown)?, PathBuf::from(file)))
}

#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// The log; - is standard input
    #[arg(value_name = "LOG")]
    pub(crate) log: PathBuf,
    #[command(flatten)]
    pub(crate) columns: ColumnArguments,
    /// Write a mapping file with the columns recognized, to be completed by hand
    #[arg(short, long, help_heading = "Output", value_name = "MAPPING.toml")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// File for the report
    #[arg(long, value_name = "FILE.html", default_value = "fluxfit-demo.html")]
    pub(crate) report: PathBuf,
    /// Also write every figure of the report into this directory, as NAME.svg and NAME.png
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct Identify {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    /// Model that is fitted to the log
    #[arg(long, help_heading = "Model", value_enum, default_value_t = ModelArgument::Auto)]
    pub(crate) model: ModelArgument,
    // Its help lists the methods: `help_of_search_method`.
    #[arg(long, help_heading = "Search", default_value = "auto", value_parser = parse_search_method,
          help = help_of_search_method(), long_help = long_help_of_search_method())]
    pub(crate) method: SearchMethod,
    /// Standard uncertainty of the voltages, as a fraction of the vector
    #[arg(long, help_heading = "Prior knowledge", value_name = "FRACTION", allow_negative_numbers = true, default_value_t = fluxfit::evidence::VOLTAGE_ACCURACY)]
    pub(crate) voltage_accuracy: f64,
    /// A parameter known exactly, e.g. rs=0.96 or ld=5.25mH; a bare number is SI
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE,..", value_delimiter = ',', value_parser = fluxfit_units::parse_fix, allow_hyphen_values = true)]
    pub(crate) fix: Vec<(Parameter, f64)>,
    /// A parameter known with a standard error, e.g. rs=0.96±1% or rs=0.96+-0.01
    #[arg(long, help_heading = "Prior knowledge", value_name = "NAME=VALUE±ERROR,..", value_delimiter = ',', value_parser = fluxfit_units::parse_prior, allow_hyphen_values = true)]
    pub(crate) prior: Vec<(Parameter, f64, f64)>,
    /// Identify without the last log (of one log: the last segment), and validate on it
    #[arg(long, help_heading = "Output")]
    pub(crate) hold_out: bool,
    /// Write the result as a file for another tool: vesc, moteus, mcsdk, matlab; repeatable
    #[arg(long, help_heading = "Output", value_name = "TARGET=FILE", value_parser = parse_export)]
    pub(crate) export: Vec<(Target, PathBuf)>,
    /// Compute the current controllers' gains for this bandwidth, e.g. 500Hz
    #[arg(long, help_heading = "Output", value_name = "FREQUENCY", value_parser = fluxfit_units::parse_frequency)]
    pub(crate) bandwidth: Option<f64>,
    /// Rate of the current controllers, for the phase margin, e.g. 10kHz [default: the log's sample rate]
    #[arg(long, help_heading = "Output", value_name = "FREQUENCY", value_parser = fluxfit_units::parse_frequency, requires = "bandwidth")]
    pub(crate) control_rate: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    // The paper's four, unless others are asked for.
    #[arg(long, help_heading = "Search", value_name = "METHOD,..", value_delimiter = ',', default_value = "tgfpa,fpa,lpso,apso", value_parser = parse_method,
          help = format!("Optimizers to compare: {}", method_keys()))]
    pub(crate) methods: Vec<Method>,
    /// Fitness that is minimized
    #[arg(long, help_heading = "Model", value_enum, default_value_t = StudyModel::Steady)]
    pub(crate) model: StudyModel,
    /// Number of independent runs of each optimizer
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 50)]
    pub(crate) runs: usize,
    /// Number of candidates in each run
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 50)]
    pub(crate) population: usize,
    /// Number of iterations of each run
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 300)]
    pub(crate) iterations: usize,
    /// Stop a run when its cost is this close to the minimum (V², or A² with the output error)
    #[arg(long, help_heading = "Search", value_name = "COST")]
    pub(crate) tolerance: Option<f64>,
    /// Stop a run when its cost is at or below this value (V², or A² with the output error)
    #[arg(long, help_heading = "Search", value_name = "COST")]
    pub(crate) target_cost: Option<f64>,
    /// Value of i_d in windows at i_d = 0: measured, or as-paper (zero, the paper's equation (3))
    #[arg(long, help_heading = "Search", value_name = "HOW", default_value = "measured", value_parser = parse_id_zero)]
    pub(crate) id_zero: IdZero,
    /// File of true parameters (LOG.truth.json), for the errors of the runs
    #[arg(long, help_heading = "Prior knowledge", value_name = "FILE")]
    pub(crate) truth: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(override_usage = "fluxfit simulate [SCENARIO.toml] -o <LOG> [OPTIONS]\n       fluxfit simulate --template")]
pub(crate) struct Simulate {
    /// The scenario; - is standard input [default: the paper's rig]
    #[arg(value_name = "SCENARIO.toml")]
    pub(crate) scenario: Option<PathBuf>,
    /// The log, as CSV; - is standard output. The true parameters are written beside it: rig.truth.json for rig.csv
    #[arg(short, long, value_name = "LOG", required_unless_present = "template")]
    pub(crate) output: Option<PathBuf>,
    /// Seed of all noise [default: that of the scenario]
    // No larger than TOML can hold: with the truth's scenario the log can be made again.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    pub(crate) seed: Option<u64>,
    /// Number of the noise realization; each is independent of the others
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) draw: u64,
    /// Print the paper's rig as a scenario to start from; nothing is simulated
    #[arg(long, exclusive = true)]
    pub(crate) template: bool,
}

#[derive(Debug, Args)]
#[command(override_usage = "fluxfit validate <LOG>... --motor <MOTOR> [OPTIONS]")]
#[command(mut_arg("motor", |motor| motor.required(true).value_name("MOTOR").help(VALIDATED).long_help(VALIDATED)))]
#[command(mut_arg("bounds", |bounds| bounds.hide(true)), mut_arg("seed", |seed| seed.hide(true)))]
pub(crate) struct Validate {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    /// Model that predicts the log
    #[arg(long, help_heading = "Model", value_enum, default_value_t = ModelArgument::Auto)]
    pub(crate) model: ModelArgument,
    /// Standard uncertainty of the voltages, as a fraction of the vector
    #[arg(long, help_heading = "Prior knowledge", value_name = "FRACTION", allow_negative_numbers = true, default_value_t = fluxfit::evidence::VOLTAGE_ACCURACY)]
    pub(crate) voltage_accuracy: f64,
}

const VALIDATED: &str = "The parameters to validate: a motor file with all four, the JSON document of fluxfit identify (with its standard errors), or a file of true parameters";

/// Models that `identify` and `validate` know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModelArgument {
    /// Output error if the log has the drive's own sample rate, else steady
    Auto,
    /// Voltage equations (2) of the paper, on the means of steady windows
    Steady,
    /// Currents simulated from the voltages, compared with all rows
    OutputError,
}

impl ModelArgument {
    /// What is stated; nothing, if it is for the library to choose.
    pub(crate) fn stated(self) -> Option<Model> {
        match self {
            Self::Auto => None,
            Self::Steady => Some(Model::Steady),
            Self::OutputError => Some(Model::OutputError),
        }
    }
}

/// Models that `compare` knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyModel {
    /// Fitness (11) of the paper, on the samples of steady windows
    Steady,
    /// Simulated minus measured currents, on all rows; slow: half an hour on one core for the default study
    OutputError,
}

/// Timing of the voltage columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Timing {
    /// The output error finds it; the steady model takes centered, and counts the difference as uncertainty
    Auto,
    /// Mean of the two periods around the row
    Centered,
    /// Vector of the period that begins at the row
    #[value(name = "0")]
    Zero,
    /// Vector of the next period
    #[value(name = "1")]
    One,
    /// Vector of the period after the next
    #[value(name = "2")]
    Two,
    /// As 0, with the vector given in the dq frame at the row
    #[value(name = "0-row")]
    ZeroRow,
    /// As 1, with the vector given in the dq frame at the row
    #[value(name = "1-row")]
    OneRow,
    /// As 2, with the vector given in the dq frame at the row
    #[value(name = "2-row")]
    TwoRow,
}

impl Timing {
    /// What is stated; nothing, if it is for the library to choose.
    pub(crate) fn stated(self) -> Option<VoltageReading> {
        let delayed = |delay| Some(VoltageReading::Delayed { delay, frame: VoltageFrame::Middle });
        let at_row = |delay| Some(VoltageReading::Delayed { delay, frame: VoltageFrame::Row });
        match self {
            Self::Auto => None,
            Self::Centered => Some(VoltageReading::Centered),
            Self::Zero => delayed(0),
            Self::One => delayed(1),
            Self::Two => delayed(2),
            Self::ZeroRow => at_row(0),
            Self::OneRow => at_row(1),
            Self::TwoRow => at_row(2),
        }
    }
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

/// The keys of all methods that search.
fn method_keys() -> String {
    METHODS.iter().map(|facts| facts.key).collect::<Vec<_>>().join(", ")
}

fn parse_method(text: &str) -> Result<Method, String> {
    Method::named(text).ok_or_else(|| format!("no method '{text}'; there are {}", method_keys()))
}

fn parse_id_zero(text: &str) -> Result<IdZero, String> {
    match text {
        "measured" => Ok(IdZero::Measured),
        "as-paper" => Ok(IdZero::AsPaper),
        _ => Err(format!("no way '{text}'; there are measured, as-paper")),
    }
}

/// The last value given for each parameter, by its index.
pub(crate) fn by_parameter<T: Copy>(given: &[(Parameter, T)], option: &str) -> Result<[Option<T>; 4], crate::error::CommandError> {
    let mut values = [None; 4];
    for (parameter, value) in given {
        if values[*parameter as usize].replace(*value).is_some() {
            return Err(crate::error::CommandError::Usage(format!("{option} names {} twice; give it once", parameter.key())));
        }
    }
    Ok(values)
}
