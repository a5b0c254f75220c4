//! `fluxfit fleet`: many motors, one row each. Groups of rows are read one after the other, identified on all cores, and written into a
//! journal, from which a run that was killed goes on.

mod journal;
pub(crate) mod motors;
pub(crate) mod row;
pub(crate) mod table;
pub(crate) mod work;

use super::Status;
use crate::{error::CommandError, interrupt, terminal};
use clap::Args;
use fluxfit::Parameter;
use fluxfit_files::check_writable;
use fluxfit_setup::MotorFile;
use journal::Journal;
use motors::{HeldMotors, Motors};
use row::Row;
use std::{
    fmt,
    path::{Path, PathBuf},
};
use work::{Onlooker, work};

#[derive(Debug, Clone, Args)]
#[command(mut_arg("json", |arg| arg.hide(true)), mut_arg("report", |arg| arg.hide(true)), mut_arg("figures", |arg| arg.hide(true)))]
#[command(mut_arg("export", |arg| arg.hide(true)), mut_arg("hold_out", |arg| arg.hide(true)), mut_arg("bandwidth", |arg| arg.hide(true)))]
#[command(mut_arg("control_rate", |arg| arg.hide(true)), mut_arg("window", |arg| arg.hide(true)))]
pub(crate) struct Fleet {
    #[command(flatten)]
    motors: Motors,
    /// The results: one row for each motor and window, as .parquet or .csv
    #[arg(short, long, help_heading = "Fleet", value_name = "RESULTS")]
    output: PathBuf,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Fleet) -> Result<Status, CommandError> {
    let Fleet { motors, output } = arguments;
    let motor = motors.check()?;
    let mut journal = open(motors, &motor, output)?;
    if journal.motors() > 0 {
        terminal::note(&format!("{} motors are finished already; the rest follows", journal.motors()));
    }
    let progress = terminal::counting("motors", 0);
    let told = |done, of: Option<usize>| progress.count("motors", done, of.unwrap_or(done));
    let onlooker = Onlooker { go_on: &interrupt::go_on, told: &told };
    interrupt::gently(|| work(motors, &motor, None, &mut journal, &onlooker))?;
    drop(progress);
    if interrupt::exit_status().is_some() {
        terminal::note(&format!("{} motors are finished; the same command goes on", journal.motors()));
        return Ok(Status::Incomplete);
    }
    interrupt::doing("writing the results");
    let count = Count::of(&finish(journal, Some(output))?);
    terminal::print(&format!("{count}.\n"))?;
    terminal::wrote("results", output);
    Ok(if count.whole == count.rows { Status::Complete } else { Status::Incomplete })
}

/// The rows of a fleet for another face: of the logs, or of a table in their place; as a file too, with a journal beside it. None if
/// whoever looks on broke off.
pub(crate) fn rows(
    motors: &Motors,
    table: Option<&HeldMotors>,
    output: Option<&Path>,
    onlooker: &Onlooker,
) -> Result<Option<Vec<Row>>, CommandError> {
    let motor = motors.check()?;
    let mut journal = output.map(|output| open(motors, &motor, output)).transpose()?.unwrap_or_default();
    work(motors, &motor, table, &mut journal, onlooker)?;
    if (onlooker.go_on)().is_break() {
        return Ok(None);
    }
    finish(journal, output).map(Some)
}

/// The journal of results that can be written.
fn open(motors: &Motors, motor: &MotorFile, output: &Path) -> Result<Journal, CommandError> {
    table::Format::of(output)?;
    check_writable(output)?;
    Journal::open(output, &motors.words(motor))
}

/// Writes the results, where they are to be written; the journal is of no use any more.
fn finish(journal: Journal, output: Option<&Path>) -> Result<Vec<Row>, CommandError> {
    if let Some(output) = output {
        table::write(output, journal.rows())?;
    }
    journal.close()
}

/// How many motors have what.
pub(crate) struct Count {
    motors: usize,
    rows: usize,
    /// Rows with all parameters identified.
    whole: usize,
    /// Rows without an answer.
    failed: usize,
}

impl Count {
    /// Of rows by motor.
    pub(crate) fn of(rows: &[Row]) -> Self {
        let is_whole = |row: &&Row| Parameter::ALL.iter().all(|p| row[&format!("{}_verdict", p.key())] == "identified");
        Self {
            motors: rows.chunk_by(|one, next| one["motor"] == next["motor"]).count(),
            rows: rows.len(),
            whole: rows.iter().filter(is_whole).count(),
            failed: rows.iter().filter(|row| !row["error"].is_null()).count(),
        }
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { motors, rows, whole, failed } = self;
        let fewer = rows - whole - failed;
        let (motors, rows) = (terminal::count(*motors, "motor"), terminal::count(*rows, "row"));
        write!(f, "{motors}, {rows}: {whole} with all 4 parameters identified, {fewer} with fewer, {failed} without an answer")
    }
}
