//! The command line, as clap reads it. Texts of values are turned into values by `fluxfit-files`; nothing is decided here.

use anstyle::Style;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum, builder::Resettable};
use fluxfit::{
    identify::model,
    motor::Parameter,
    objective::{
        acting_voltage::{VoltageFrame, VoltageReading},
        voltage_error::IdZero,
    },
    optimizer::{METHODS, Method},
};
use fluxfit_files::{Unit, export::Target};
use std::path::PathBuf;

/// Finds the parameters of a permanent magnet synchronous motor from a drive's log
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
    /// Say no notes and show no progress; warnings and errors stay
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say on standard error what is decided on the way, and when
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

const EXIT_STATUS: &str = "Exit: 0 all identified, or agrees; 1 not all, or differs; 2 misuse; 130 Ctrl-C";

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
        .chain([("help".to_owned(), "Help for a verb".to_owned())])
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
    /// Inspect a log: its columns, units and repairs
    ///
    /// Shows what is understood of it, and writes a mapping file to start from.
    Inspect(Inspect),
    /// List the layouts of logs that are known
    Formats,
    /// See all of it on the paper's rig, with a report
    ///
    /// Simulates the paper's motor in its drive, identifies it, compares four methods, and writes a report.
    Demo(Demo),
    /// Identify a motor: four parameters with interval and verdict
    Identify(Identify),
    /// Compare swarm optimizers: many runs of each, beside the minimum
    ///
    /// They minimize the paper's fitness, or the output error. Interrupted, the runs that are finished are shown.
    Compare(Compare),
    /// Simulate a motor in a drive: a log, and its truth beside it
    Simulate(Simulate),
    /// Validate parameters on a log that they were not found from
    ///
    /// The log is predicted, compared and tested.
    Validate(Validate),
    /// Print the completions of a shell
    ///
    /// For bash: fluxfit completions bash > ~/.local/share/bash-completion/completions/fluxfit. For zsh: into a file _fluxfit of a
    /// directory in fpath. For fish: fluxfit completions fish > ~/.config/fish/completions/fluxfit.fish. For PowerShell: into the file
    /// $PROFILE.
    Completions(Completions),
    /// Write the manual, a page for each verb
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
    /// Which shell
    #[arg(value_name = "SHELL", value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// The directory, as ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
}

/// Which log, and how to read it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Log")]
pub(crate) struct LogArguments {
    /// Logs of one motor, as CSV with a header; - is standard input
    #[arg(required = true, value_name = "LOG", help_heading = Resettable::Reset)]
    pub(crate) logs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) columns: ColumnArguments,
    /// A steady window in the log's seconds, e.g. 0.48:0.595; repeatable
    ///
    /// Without, windows are found.
    #[arg(long, value_name = "T0:T1", value_parser = fluxfit_files::parse_window, allow_hyphen_values = true)]
    pub(crate) window: Vec<(f64, f64)>,
    /// When the voltages ud, uq of a row act
    ///
    /// The mean of the two periods around it (centered), or the vector of one period, so many periods later.
    #[arg(long, value_enum, default_value_t = Timing::Auto)]
    pub(crate) voltage_timing: Timing,
    /// Motor file: pole pairs, rating, nameplate
    ///
    /// The rating widens the search box; what identify finds is held against the nameplate.
    #[arg(long, value_name = "MOTOR.toml", help_heading = "Knowledge")]
    pub(crate) motor: Option<PathBuf>,
    /// Search box of the swarms, e.g. ld=0:50mH
    ///
    /// What is not named comes from the rating or the log.
    #[arg(long, help_heading = "Search", value_name = "NAME=LOW:HIGH,..", value_delimiter = ',', value_parser = fluxfit_files::parse_bounds, allow_hyphen_values = true)]
    pub(crate) bounds: Vec<(Parameter, f64, f64)>,
    /// Seed of all random numbers
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Print one JSON document and nothing else
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Write the results as a page for a browser, beside the answer
    #[arg(long, help_heading = "Output", value_name = "FILE.html")]
    pub(crate) report: Option<PathBuf>,
    /// Write every figure of that page as SVG and PNG
    ///
    /// Into this directory, which is made if it is not there.
    #[arg(long, help_heading = "Output", value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
}

/// What a log's columns mean.
#[derive(Debug, Args)]
#[command(next_help_heading = "Log")]
pub(crate) struct ColumnArguments {
    /// Columns that are named otherwise, e.g. ud=motor_vd_V,omega_e=speed
    ///
    /// Canonical are t, ud, uq, id, iq, omega_e, and optionally theta_e, u_dc; with theta_e the phases ia, ib, ic, ua, ub, uc do.
    #[arg(long, value_name = "NAME=COLUMN,..", value_parser = parse_columns)]
    pub(crate) map: Vec<MappedColumns>,
    /// Units of columns, e.g. omega=rpm-mech,t=ms
    ///
    /// Without, the column's name, its layout or SI decides.
    #[arg(long, value_name = "NAME=UNIT,..", value_delimiter = ',', value_parser = fluxfit_files::parse_unit)]
    pub(crate) unit: Vec<(String, Unit)>,
    /// Pole pairs, for speeds and angles in mechanical units
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) pole_pairs: Option<u32>,
    /// Mapping file: names, units, scales and signs of columns
    ///
    /// fluxfit inspect writes one to start from.
    #[arg(long, value_name = "MAPPING.toml")]
    pub(crate) mapping: Option<PathBuf>,
}

/// Canonical names and headers of one `--map`.
#[derive(Debug, Clone)]
pub(crate) struct MappedColumns(pub(crate) Vec<(String, String)>);

fn parse_columns(text: &str) -> Result<MappedColumns, fluxfit_files::FileError> {
    fluxfit_files::parse_maps(text).map(MappedColumns)
}

#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// A log; - is standard input
    #[arg(value_name = "LOG")]
    pub(crate) log: PathBuf,
    #[command(flatten)]
    pub(crate) columns: ColumnArguments,
    /// Write a mapping file that says what was understood, with places for what was not
    #[arg(short, long, value_name = "MAPPING.toml")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// Where the report goes
    #[arg(long, value_name = "FILE.html", default_value = "fluxfit-demo.html")]
    pub(crate) report: PathBuf,
    /// Write every figure of the report into a directory, each as NAME.svg and NAME.png
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
    /// What is fitted to what
    #[arg(long, help_heading = "Search", value_enum, default_value_t = Model::Auto)]
    pub(crate) model: Model,
    // Its help lists the methods: `help_of_search_method`.
    #[arg(long, help_heading = "Search", default_value = "auto", value_parser = parse_search_method,
          help = help_of_search_method(), long_help = long_help_of_search_method())]
    pub(crate) method: SearchMethod,
    /// Systematic uncertainty of the voltages, as a fraction of the vector
    #[arg(long, help_heading = "Knowledge", value_name = "FRACTION", allow_negative_numbers = true, default_value_t = fluxfit::identify::VOLTAGE_ACCURACY)]
    pub(crate) voltage_accuracy: f64,
    /// A parameter that is known exactly, e.g. rs=0.96
    #[arg(long, help_heading = "Knowledge", value_name = "NAME=VALUE,..", value_delimiter = ',', value_parser = fluxfit_files::parse_fix, allow_hyphen_values = true)]
    pub(crate) fix: Vec<(Parameter, f64)>,
    /// A parameter that is known with a standard error, e.g. rs=0.96±1% or rs=0.96+-0.01
    #[arg(long, help_heading = "Knowledge", value_name = "NAME=VALUE±ERROR,..", value_delimiter = ',', value_parser = fluxfit_files::parse_prior, allow_hyphen_values = true)]
    pub(crate) prior: Vec<(Parameter, f64, f64)>,
    /// Identify from all but the last log or segment, and validate on that
    #[arg(long, help_heading = "Output")]
    pub(crate) hold_out: bool,
    /// Write the answer as the file of another tool: vesc, moteus, mcsdk, matlab; may be repeated
    #[arg(long, value_name = "TARGET=FILE", value_parser = fluxfit_files::parse_export)]
    pub(crate) export: Vec<(Target, PathBuf)>,
    /// Gains of the current controllers for this bandwidth, e.g. 500Hz, with their intervals
    #[arg(long, value_name = "FREQUENCY", value_parser = fluxfit_files::parse_frequency)]
    pub(crate) bandwidth: Option<f64>,
    /// How often the current controllers run, for their phase margin; without, as often as the log samples
    #[arg(long, value_name = "FREQUENCY", value_parser = fluxfit_files::parse_frequency, requires = "bandwidth")]
    pub(crate) control_rate: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    // The paper's four, unless others are asked for.
    #[arg(long, help_heading = "Search", value_name = "METHOD,..", value_delimiter = ',', default_value = "tgfpa,fpa,lpso,apso", value_parser = parse_method,
          help = format!("Methods: {}", method_keys()))]
    pub(crate) methods: Vec<Method>,
    /// What is minimized
    #[arg(long, help_heading = "Search", value_enum, default_value_t = StudyModel::Steady)]
    pub(crate) model: StudyModel,
    /// Independent runs of each method
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 50)]
    pub(crate) runs: usize,
    /// Candidates of each run
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 50)]
    pub(crate) population: usize,
    /// Iterations of each run
    #[arg(long, help_heading = "Search", value_name = "N", default_value_t = 300)]
    pub(crate) iterations: usize,
    /// Stop a run once its cost is this close to the minimum
    #[arg(long, help_heading = "Search", value_name = "COST")]
    pub(crate) tolerance: Option<f64>,
    /// Stop a run once its cost is at or below this
    #[arg(long, help_heading = "Search", value_name = "COST")]
    pub(crate) target_cost: Option<f64>,
    /// What stands for i_d in the mode i_d = 0: the measured current, or zero as in the paper's equation (3)
    #[arg(long, help_heading = "Search", value_name = "HOW", default_value = "measured", value_parser = parse_id_zero)]
    pub(crate) id_zero: IdZero,
    /// True parameters (LOG.truth.json), for the errors of Table 2
    #[arg(long, help_heading = "Knowledge", value_name = "FILE")]
    pub(crate) truth: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(override_usage = "fluxfit simulate [SCENARIO.toml] -o <LOG> [OPTIONS]\n       fluxfit simulate --template")]
pub(crate) struct Simulate {
    /// What is simulated (docs/drive.md); without, the paper's rig; - is standard input
    #[arg(value_name = "SCENARIO.toml")]
    pub(crate) scenario: Option<PathBuf>,
    /// The log, as CSV; its truth is written beside it, rig.truth.json for rig.csv; - is standard output, without a truth
    #[arg(short, long, value_name = "LOG", required_unless_present = "template")]
    pub(crate) output: Option<PathBuf>,
    /// Seed of all noise, instead of the scenario's
    // No larger than TOML can hold: with the truth's scenario the log can be made again.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    pub(crate) seed: Option<u64>,
    /// Number of the noise's draw: each is independent of the others
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) draw: u64,
    /// Print the paper's rig as a scenario to start from, and simulate nothing
    #[arg(long, exclusive = true)]
    pub(crate) template: bool,
}

#[derive(Debug, Args)]
#[command(override_usage = "fluxfit validate <LOG>... --motor <MOTOR> [OPTIONS]")]
#[command(mut_arg("motor", |motor| motor.required(true).value_name("MOTOR").help(VALIDATED)))]
pub(crate) struct Validate {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    /// What is predicted: currents or steady voltages
    #[arg(long, help_heading = "Search", value_enum, default_value_t = Model::Auto)]
    pub(crate) model: Model,
    /// Systematic uncertainty of the voltages, as a fraction of the vector
    #[arg(long, help_heading = "Knowledge", value_name = "FRACTION", allow_negative_numbers = true, default_value_t = fluxfit::identify::VOLTAGE_ACCURACY)]
    pub(crate) voltage_accuracy: f64,
}

const VALIDATED: &str = "The motor that is validated: a motor file with all four parameters, the JSON of fluxfit identify with its standard errors, or a truth file";

/// Models that `identify` and `validate` know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Model {
    /// The one that suits the log
    Auto,
    /// Equation (2) on the means of steady windows
    Steady,
    /// Currents simulated row by row from the voltages
    OutputError,
}

impl Model {
    /// What is stated; nothing, if it is for the library to choose.
    pub(crate) fn stated(self) -> Option<model::Model> {
        match self {
            Self::Auto => None,
            Self::Steady => Some(model::Model::Steady),
            Self::OutputError => Some(model::Model::OutputError),
        }
    }
}

/// Models that `compare` knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyModel {
    /// Fitness (11) on the samples of steady windows
    Steady,
    /// The simulated currents against the measured ones, on every row: slow, half an hour a core for the whole study
    OutputError,
}

/// Timing of the voltage columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Timing {
    /// Found by the output error; at operating points centred, the doubt counted as uncertainty
    Auto,
    /// The mean of the two periods around the row
    Centered,
    /// The vector acts over the period that starts at the row
    #[value(name = "0")]
    Zero,
    /// One period later
    #[value(name = "1")]
    One,
    /// Two periods later
    #[value(name = "2")]
    Two,
}

impl Timing {
    /// What is stated; nothing, if it is for the library to choose.
    pub(crate) fn stated(self) -> Option<VoltageReading> {
        let delayed = |delay| Some(VoltageReading::Delayed { delay, frame: VoltageFrame::Middle });
        match self {
            Self::Auto => None,
            Self::Centered => Some(VoltageReading::Centered),
            Self::Zero => delayed(0),
            Self::One => delayed(1),
            Self::Two => delayed(2),
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
    format!("Who searches beside the exact answer: least-squares (nobody), {}", method_keys())
}

fn long_help_of_search_method() -> String {
    let auto = "auto is tgfpa at operating points, and nobody on the output error, where it takes seconds.";
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
