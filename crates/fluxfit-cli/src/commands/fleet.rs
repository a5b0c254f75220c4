//! `fluxfit fleet`: many motors, one row each. Groups of rows are read one after the other, identified on all cores, and written into a
//! journal, from which a run that was killed goes on.

mod journal;
pub(crate) mod motors;
pub(crate) mod page;
mod results;
pub(crate) mod row;
pub(crate) mod table;
pub(crate) mod work;

use super::{Status, input, report};
use crate::{error::CommandError, interrupt, terminal};
use clap::Args;
use fluxfit::Parameter;
use fluxfit_files::check_writable;
use fluxfit_setup::MotorFile;
use journal::Journal;
use motors::{HeldMotors, Motors};
use page::Page;
use row::Row;
use serde_json::Value;
use std::{
    fmt,
    ops::ControlFlow,
    path::{Path, PathBuf},
};
use table::ResultsFile;
use work::{Onlooker, work};

#[derive(Debug, Clone, Args)]
#[command(mut_arg("json", |arg| arg.hide(true)), mut_arg("export", |arg| arg.hide(true)), mut_arg("hold_out", |arg| arg.hide(true)))]
#[command(mut_arg("bandwidth", |arg| arg.hide(true)), mut_arg("control_rate", |arg| arg.hide(true)), mut_arg("window", |arg| arg.hide(true)))]
#[command(mut_arg("logs", |arg| arg.help(LOGS)))]
pub(crate) struct Fleet {
    #[command(flatten)]
    motors: Motors,
    /// The results: one row for each motor and window, as .parquet or .csv
    ///
    /// Without it, the logs are finished results, of which --report or --figures shows the page.
    #[arg(short, long, help_heading = "Fleet", value_name = "RESULTS", required_unless_present_any = ["report", "figures"])]
    output: Option<PathBuf>,
}

/// The help of the logs.
const LOGS: &str = "Logs of one motor each, or with --by tables of many; without -o, finished results";

/// Runs the verb.
pub(crate) fn run(arguments: &Fleet) -> Result<Status, CommandError> {
    let Fleet { motors, output } = arguments;
    let log = &motors.identify.log;
    report::check(log, output.as_deref())?;
    let is_shown = log.report.is_some() || log.figures.is_some();
    let (mut count, mut page) = (Count::default(), is_shown.then(Page::default));
    let mut take = |row: &Row| {
        count.add(row);
        page.iter_mut().for_each(|page| page.add(row));
    };
    match output {
        Some(output) if identified(motors, output, &mut take)?.is_break() => return Ok(Status::Incomplete),
        Some(_) => (),
        None => finished(motors, &mut take)?,
    }
    terminal::print(&format!("{count}.\n"))?;
    if let Some(output) = output {
        terminal::wrote("results", output);
    }
    if let Some(page) = page {
        page.write(&title(&log.logs, output.as_deref(), "files of results"), log)?;
    }
    Ok(if count.whole == count.rows { Status::Complete } else { Status::Incomplete })
}

/// Writes the rows of all motors as results, and passes them on; a break if the run was interrupted.
fn identified(motors: &Motors, output: &Path, take: &mut dyn FnMut(&Row)) -> Result<ControlFlow<()>, CommandError> {
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
        return Ok(ControlFlow::Break(()));
    }
    interrupt::doing("writing the results");
    finish(journal, Some(output), take).map(ControlFlow::Continue)
}

/// Passes on the rows of finished results, which stand in place of the logs.
fn finished(motors: &Motors, take: &mut dyn FnMut(&Row)) -> Result<(), CommandError> {
    if motors.by.is_some() || motors.every.is_some() {
        return Err(CommandError::Usage("--by and --every are for motors to be identified; name their results with -o".to_owned()));
    }
    results::read(&motors.identify.log.logs, take)
}

/// What the page is of: the results, or what takes their place; `files` says what several of these are.
pub(crate) fn title(logs: &[PathBuf], output: Option<&Path>, files: &str) -> String {
    match (output, logs) {
        (Some(output), _) => input::file_name(output),
        (None, [one]) => input::file_name(one),
        (None, several) => format!("{} {files}", several.len()),
    }
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
    let mut rows = Vec::new();
    finish(journal, output, &mut |row| rows.push(row.clone()))?;
    Ok(Some(rows))
}

/// The journal of results that can be written.
fn open(motors: &Motors, motor: &MotorFile, output: &Path) -> Result<Journal, CommandError> {
    table::Format::of(output)?;
    check_writable(output)?;
    Journal::open(output, &motors.words(motor))
}

/// Writes the results, where they are to be written, and passes on their rows; the journal is of no use any more.
fn finish(mut journal: Journal, output: Option<&Path>, take: &mut dyn FnMut(&Row)) -> Result<(), CommandError> {
    let mut file = output.map(ResultsFile::begin).transpose()?;
    journal.rows(&mut |row| {
        take(row);
        file.as_mut().map_or(Ok(()), |file| file.add(row))
    })?;
    if let Some(file) = file {
        file.end()?;
    }
    journal.close()
}

/// How many motors have what.
#[derive(Default)]
pub(crate) struct Count {
    /// The motor of the last row.
    last: Option<Value>,
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
        let mut count = Self::default();
        rows.iter().for_each(|row| count.add(row));
        count
    }

    /// Counts a row; those of a motor come one after the other.
    fn add(&mut self, row: &Row) {
        if self.last.as_ref() != Some(&row["motor"]) {
            self.motors += 1;
            self.last = Some(row["motor"].clone());
        }
        self.rows += 1;
        self.whole += usize::from(Parameter::ALL.iter().all(|p| row[&format!("{}_verdict", p.key())] == "identified"));
        self.failed += usize::from(!row["error"].is_null());
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { motors, rows, whole, failed, last: _ } = self;
        let fewer = rows - whole - failed;
        let (motors, rows) = (terminal::count(*motors, "motor"), terminal::count(*rows, "row"));
        write!(f, "{motors}, {rows}: {whole} with all 4 parameters identified, {fewer} with fewer, {failed} without an answer")
    }
}
