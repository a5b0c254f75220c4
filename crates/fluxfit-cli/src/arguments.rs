//! Arguments that several verbs have, as clap reads them. `fluxfit-units` and `fluxfit-log` parse the values. The arguments of one verb
//! stand in its own file.

use clap::{Args, ValueEnum, builder::Resettable};
use fluxfit::{MeansOf, Model, Request, TimeWindow, VoltageFrame, VoltageTiming, motor::Parameter, optimizer::METHODS};
use fluxfit_log::CONTAINERS;
use fluxfit_setup::SensorAccuracy;
use fluxfit_units::{Unit, wording::choice};
use std::path::PathBuf;

/// Which log, and how to read it.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Log")]
pub(crate) struct LogArguments {
    // Its help lists the containers: `help_of_logs`.
    #[arg(required = true, value_name = "LOG", help_heading = Resettable::Reset, help = help_of_logs())]
    pub(crate) logs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) columns: ColumnArguments,
    /// Use this time window of the log, in seconds, e.g. 0.48:0.595; repeatable
    ///
    /// [default: all rows; the steady model finds its windows]
    #[arg(long, value_name = "T0:T1", value_parser = fluxfit_units::parse_window, allow_hyphen_values = true)]
    pub(crate) window: Vec<TimeWindow>,
    /// When the voltages ud, uq of a row are applied
    ///
    /// Either they are the mean of the two periods around the row (centered), or the vector of one period that begins 0, 1 or 2 periods
    /// after the row, half a period before or after it (-0.5, 0.5), or ended at it (-1).
    #[arg(long, value_enum, default_value_t = Timing::Auto, allow_hyphen_values = true)]
    pub(crate) voltage_timing: Timing,
    /// Motor file: pole pairs, nameplate values, rating, accuracy of the sensors, magnets' coefficient
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

fn help_of_logs() -> String {
    let formats: Vec<&str> = ["CSV"].into_iter().chain(CONTAINERS.iter().flat_map(|container| container.names).copied()).collect();
    format!("Logs of one motor: {}; - is standard input", choice(&formats))
}

/// How accurate the drive's measurements are.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Prior knowledge")]
pub(crate) struct AccuracyArguments {
    /// Standard uncertainty of the voltages, as a part of the vector, e.g. 0.1%
    #[arg(long, value_name = "FRACTION", allow_hyphen_values = true, value_parser = fluxfit_units::parse_fraction, default_value_t = fluxfit::evidence::VOLTAGE_ACCURACY)]
    pub(crate) voltage_accuracy: f64,
    /// Largest error that all current sensors have in common, e.g. 1%
    ///
    /// The limit in their data sheet, to either side. It is half of a 95 % interval. R_s, L_d and L_q are uncertain by it.
    /// [default: that of the motor file, else not counted]
    #[arg(long, value_name = "FRACTION", allow_hyphen_values = true, value_parser = fluxfit_units::parse_fraction)]
    pub(crate) current_accuracy: Option<f64>,
    /// Largest error of the DC voltage, e.g. 0.5%
    ///
    /// The same for the voltage from which the drive computes its voltages. All four parameters are uncertain by it.
    /// [default: that of the motor file, else not counted]
    #[arg(long, value_name = "FRACTION", allow_hyphen_values = true, value_parser = fluxfit_units::parse_fraction)]
    pub(crate) bus_accuracy: Option<f64>,
}

impl AccuracyArguments {
    /// Writes them into a request, with those of the motor file where the arguments state none.
    pub(crate) fn apply(&self, sensors: SensorAccuracy, request: &mut Request) {
        request.voltage_accuracy = self.voltage_accuracy;
        request.current_accuracy = self.current_accuracy.or(sensors.current);
        request.bus_accuracy = self.bus_accuracy.or(sensors.bus);
    }
}

/// What a log's columns mean.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Log")]
pub(crate) struct ColumnArguments {
    /// Columns with other names, e.g. ud=motor_vd_V,omega_e=speed
    ///
    /// The standard names are t, ud, uq, id, iq, omega_e, and optionally theta_e, u_dc, temperature. Phase quantities ia, ib, ic, ua, ub,
    /// uc with theta_e may replace id, iq, ud, uq. [default: the standard names, or a known layout]
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
    /// DBC file that names the signals in a log of CAN frames (candump)
    #[arg(long, value_name = "FILE.dbc")]
    pub(crate) dbc: Option<PathBuf>,
}

/// Canonical names and headers of one `--map`.
#[derive(Debug, Clone)]
pub(crate) struct MappedColumns(pub(crate) Vec<(String, String)>);

fn parse_columns(text: &str) -> Result<MappedColumns, fluxfit_files::FileError> {
    fluxfit_log::parse_maps(text).map(MappedColumns)
}

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
    /// As 0, held in the rotor's frame
    #[value(name = "0-rotor")]
    ZeroRotor,
    /// As 1, held in the rotor's frame
    #[value(name = "1-rotor")]
    OneRotor,
    /// Vector of the period that ended at the row, as measured
    #[value(name = "-1")]
    MinusOne,
    /// Vector that acts while the row is sampled, in mid-period
    #[value(name = "-0.5")]
    MinusHalf,
    /// Vector that acts from half a period after the row on
    #[value(name = "0.5")]
    Half,
    /// Mean over the row's own span, as the currents
    Averaged,
    /// The same of four to eight commands, which act later
    AveragedCommands,
    /// The same of two commands
    AveragedTwoCommands,
    /// Of a simulator that goes from row to row by Euler's rule
    Euler,
    /// The same, logged with the current after the step
    EulerAfter,
}

impl Timing {
    /// What is stated; nothing, if it is for the library to choose.
    pub(crate) fn stated(self) -> Option<VoltageTiming> {
        let delayed = |delay| Some(VoltageTiming::Delayed { delay, frame: VoltageFrame::Middle });
        let at_row = |delay| Some(VoltageTiming::Delayed { delay, frame: VoltageFrame::Row });
        let in_rotor = |delay| Some(VoltageTiming::Delayed { delay, frame: VoltageFrame::Rotor });
        match self {
            Self::Auto => None,
            Self::Centered => Some(VoltageTiming::Centered),
            Self::Zero => delayed(0),
            Self::One => delayed(1),
            Self::Two => delayed(2),
            Self::ZeroRow => at_row(0),
            Self::OneRow => at_row(1),
            Self::TwoRow => at_row(2),
            Self::ZeroRotor => in_rotor(0),
            Self::OneRotor => in_rotor(1),
            Self::MinusOne => Some(VoltageTiming::Ended),
            Self::MinusHalf => Some(VoltageTiming::MidPeriod { later: false }),
            Self::Half => Some(VoltageTiming::MidPeriod { later: true }),
            Self::Averaged => Some(VoltageTiming::Averaged { of: MeansOf::Voltages }),
            Self::AveragedCommands => Some(VoltageTiming::Averaged { of: MeansOf::Commands }),
            Self::AveragedTwoCommands => Some(VoltageTiming::Averaged { of: MeansOf::TwoCommands }),
            Self::Euler => Some(VoltageTiming::Euler { after: false }),
            Self::EulerAfter => Some(VoltageTiming::Euler { after: true }),
        }
    }
}

/// The keys of all methods that search.
pub(crate) fn method_keys() -> String {
    METHODS.iter().map(|facts| facts.key).collect::<Vec<_>>().join(", ")
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
