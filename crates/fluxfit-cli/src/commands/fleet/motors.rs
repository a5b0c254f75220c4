//! What is asked of every motor, and where the motors are.

use crate::{
    commands::{identify::Identify, input},
    error::CommandError,
};
use clap::Args;
use fluxfit_log::MemoryTable;
use fluxfit_setup::{MotorFile, read_motor};
use fluxfit_units::{Dimension, parse_quantity};

#[derive(Debug, Clone, Args)]
pub(crate) struct Motors {
    #[command(flatten)]
    pub(crate) identify: Identify,
    /// Column that names the motor of each row; a motor's rows stand together
    ///
    /// [default: each log is one motor, named by its file]
    #[arg(long, help_heading = "Fleet", value_name = "COLUMN")]
    pub(crate) by: Option<String>,
    /// Identify in windows of this length, e.g. 1h, 10min, 30s
    ///
    /// They are counted from the first row of each motor.
    #[arg(long, help_heading = "Fleet", value_name = "TIME", value_parser = parse_every)]
    pub(crate) every: Option<f64>,
    /// Number of motors identified at once [default: the number of cores]
    #[arg(long, help_heading = "Fleet", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

/// A table in memory, the motors of which are rows one after the other.
pub struct HeldMotors<'a> {
    /// The table without the column that names the motors.
    pub table: MemoryTable<'a>,
    /// What it is called in messages and results.
    pub source: &'a str,
    /// Consecutive rows with one name, or none: the name, and how many rows.
    pub runs: &'a [(Option<String>, usize)],
}

/// A length of time above zero; hours and days too.
fn parse_every(text: &str) -> Result<f64, String> {
    let factor = |text: &str| {
        let units = [("days", 86_400.0), ("d", 86_400.0), ("min", 60.0), ("h", 3600.0)];
        units.iter().find_map(|(unit, seconds)| Some(text.strip_suffix(unit)?.trim().parse::<f64>().ok()? * seconds))
    };
    let seconds = factor(text.trim()).map_or_else(|| parse_quantity(text, Dimension::Time).map_err(|error| error.to_string()), Ok)?;
    if seconds > 0.0 && seconds.is_finite() { Ok(seconds) } else { Err("a window must be longer than zero".to_owned()) }
}

impl Motors {
    /// Refuses what has no meaning for many motors, and what cannot be read or asked for any: once, not for every motor. Returns what the
    /// motor file says of all.
    ///
    /// # Errors
    /// The refusal.
    pub(crate) fn check(&self) -> Result<MotorFile, CommandError> {
        let log = &self.identify.log;
        let stated = [("--json", log.json), ("--window", !log.window.is_empty())];
        let stated = stated.into_iter().filter(|(_, is_stated)| *is_stated).map(|(option, _)| option);
        if let Some(option) = stated.chain(self.identify.outputs_of_one()).next() {
            return Err(CommandError::Usage(format!("{option} is for one motor; leave it out, or identify that motor alone")));
        }
        let motor = log.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
        input::options(&log.columns, motor.pole_pairs)?;
        Ok(motor)
    }

    /// How many motors are identified at once.
    pub(crate) fn jobs(&self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        self.jobs.map_or(cores, usize::from)
    }

    /// What makes two runs the same: everything but the number of jobs and the page, and what the motor file says in place of its name.
    pub(crate) fn words(&self, motor: &MotorFile) -> Vec<String> {
        let Self { identify, by, every, jobs: _ } = self;
        let mut identify = identify.clone();
        (identify.log.motor, identify.log.report, identify.log.figures) = (None, None, None);
        vec![format!("{identify:?}"), format!("{by:?}"), format!("{every:?}"), format!("{motor:?}")]
    }
}
