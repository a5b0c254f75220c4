//! The command line, as clap reads it. Texts of values are turned into values by `fluxfit-files`; nothing is decided here.

use clap::{Args, Parser, Subcommand, ValueEnum};
use fluxfit::{
    identify::model,
    motor::Parameter,
    objective::{
        acting_voltage::{VoltageFrame, VoltageReading},
        voltage_error::IdZero,
    },
    optimizer::Method,
};
use fluxfit_files::Unit;
use std::path::PathBuf;

/// Finds the electrical parameters of a permanent magnet synchronous motor from a log of its drive.
#[derive(Debug, Parser)]
#[command(name = "fluxfit", version, max_term_width = 110, after_help = EXIT_STATUS)]
pub(crate) struct Command {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

const EXIT_STATUS: &str = "Exit status: 0 everything asked for was identified, or the log agrees; 1 the log cannot carry some parameter, or differs; 2 misuse or unreadable input.";

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// See all of it on the paper's rig: simulate, identify, compare four methods, write a report
    Demo(Demo),
    /// Identify a motor: four parameters, each with an interval and a verdict
    Identify(Identify),
    /// Compare swarm optimizers on the paper's fitness, or on the output error: many runs of each, beside the minimum
    Compare(Compare),
    /// Simulate a motor in a drive: a log, and its truth beside it
    Simulate(Simulate),
    /// Validate parameters on a log that they were not found from: predicted, compared, tested
    Validate(Validate),
}

/// Which log, and how to read it.
#[derive(Debug, Args)]
pub(crate) struct LogArguments {
    /// Logs of one motor, as CSV with a header; - is standard input
    #[arg(required = true, value_name = "LOG")]
    pub(crate) logs: Vec<PathBuf>,
    /// Columns that are named otherwise, e.g. ud=motor_vd_V,omega_e=speed; canonical are t, ud, uq, id, iq, omega_e, and optionally
    /// theta_e, u_dc
    #[arg(long, value_name = "NAME=COLUMN,..", value_delimiter = ',', value_parser = fluxfit_files::parse_map)]
    pub(crate) map: Vec<(String, String)>,
    /// Units of columns, e.g. omega=rpm-mech,t=ms; without, the column's name or SI decides
    #[arg(long, value_name = "NAME=UNIT,..", value_delimiter = ',', value_parser = fluxfit_files::parse_unit)]
    pub(crate) unit: Vec<(String, Unit)>,
    /// Pole pairs, for speeds and angles in mechanical units
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) pole_pairs: Option<u32>,
    /// A steady window in seconds of the log's own time, e.g. 0.48:0.595; may be repeated; without, windows are found
    #[arg(long, value_name = "T0:T1", value_parser = fluxfit_files::parse_window, allow_hyphen_values = true)]
    pub(crate) window: Vec<(f64, f64)>,
    /// What ud, uq of a row mean: the mean of the two periods around it (centered), or the vector of one period, so many periods later
    #[arg(long, value_enum, default_value_t = Timing::Auto)]
    pub(crate) voltage_timing: Timing,
    /// Motor file: pole pairs, a rating for the search box, and for identify nameplate values that the log is held against
    #[arg(long, value_name = "MOTOR.toml")]
    pub(crate) motor: Option<PathBuf>,
    /// Search box of the swarms, e.g. ld=0:50mH; what is not named comes from the rating or the log
    #[arg(long, value_name = "NAME=LOW:HIGH,..", value_delimiter = ',', value_parser = fluxfit_files::parse_bounds, allow_hyphen_values = true)]
    pub(crate) bounds: Vec<(Parameter, f64, f64)>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Print one JSON document and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Write the results as a page for a browser, beside the answer
    #[arg(long, value_name = "FILE.html")]
    pub(crate) report: Option<PathBuf>,
    /// Write every figure of that page into a directory, each as NAME.svg and NAME.png
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
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
    #[arg(long, value_enum, default_value_t = Model::Auto)]
    pub(crate) model: Model,
    /// Who searches beside the exact answer; auto is tgfpa at operating points, and nobody on the output error, where it takes seconds
    #[arg(long, default_value = "auto", value_parser = parse_search_method)]
    pub(crate) method: SearchMethod,
    /// Systematic uncertainty of the voltages, as a fraction of the vector
    #[arg(long, value_name = "FRACTION", allow_negative_numbers = true, default_value_t = fluxfit::identify::VOLTAGE_ACCURACY)]
    pub(crate) voltage_accuracy: f64,
    /// A parameter that is known exactly, e.g. rs=0.96
    #[arg(long, value_name = "NAME=VALUE,..", value_delimiter = ',', value_parser = fluxfit_files::parse_fix, allow_hyphen_values = true)]
    pub(crate) fix: Vec<(Parameter, f64)>,
    /// A parameter that is known with a standard error, e.g. rs=0.96±1% or rs=0.96+-0.01
    #[arg(long, value_name = "NAME=VALUE±ERROR,..", value_delimiter = ',', value_parser = fluxfit_files::parse_prior, allow_hyphen_values = true)]
    pub(crate) prior: Vec<(Parameter, f64, f64)>,
    /// Identify from all but the last log (of one log: its last segment), and validate the answer on that
    #[arg(long)]
    pub(crate) hold_out: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) log: LogArguments,
    /// Methods: tgfpa, fpa, lpso, apso
    #[arg(long, value_name = "METHOD,..", value_delimiter = ',', default_value = "tgfpa,fpa,lpso,apso", value_parser = parse_method)]
    pub(crate) methods: Vec<Method>,
    /// What is minimized
    #[arg(long, value_enum, default_value_t = StudyModel::Steady)]
    pub(crate) model: StudyModel,
    /// Independent runs of each method
    #[arg(long, value_name = "N", default_value_t = 50)]
    pub(crate) runs: usize,
    /// Candidates of each run
    #[arg(long, value_name = "N", default_value_t = 50)]
    pub(crate) population: usize,
    /// Iterations of each run
    #[arg(long, value_name = "N", default_value_t = 300)]
    pub(crate) iterations: usize,
    /// Stop a run once its cost is this close to the minimum
    #[arg(long, value_name = "COST")]
    pub(crate) tolerance: Option<f64>,
    /// Stop a run once its cost is at or below this
    #[arg(long, value_name = "COST")]
    pub(crate) target_cost: Option<f64>,
    /// What stands for i_d in the mode i_d = 0: the measured current, or zero as in the paper's equation (3)
    #[arg(long, value_name = "HOW", default_value = "measured", value_parser = parse_id_zero)]
    pub(crate) id_zero: IdZero,
    /// True parameters (LOG.truth.json), for the errors of Table 2
    #[arg(long, value_name = "FILE")]
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
    #[arg(long, value_enum, default_value_t = Model::Auto)]
    pub(crate) model: Model,
    /// Systematic uncertainty of the voltages, as a fraction of the vector
    #[arg(long, value_name = "FRACTION", allow_negative_numbers = true, default_value_t = fluxfit::identify::VOLTAGE_ACCURACY)]
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

fn parse_search_method(text: &str) -> Result<SearchMethod, String> {
    match text {
        "auto" => Ok(SearchMethod::Auto),
        "least-squares" => Ok(SearchMethod::LeastSquares),
        _ => {
            parse_method(text).map(SearchMethod::Swarm).map_err(|_| format!("no method '{text}'; there are auto, least-squares, {METHODS}"))
        }
    }
}

const METHODS: &str = "tgfpa, fpa, lpso, apso";

fn parse_method(text: &str) -> Result<Method, String> {
    Method::named(text).ok_or_else(|| format!("no method '{text}'; there are {METHODS}"))
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
