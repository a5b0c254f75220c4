//! `fluxfit fleet`: many motors, one row each. Groups of rows are read one after the other, identified on all cores, and written into a
//! journal, from which a run that was killed goes on.

mod journal;
pub(crate) mod row;
mod table;

use super::{Status, identify::Identify, input};
use crate::{error::CommandError, interrupt, terminal};
use clap::Args;
use fluxfit::Parameter;
use fluxfit_files::check_writable;
use fluxfit_log::{Group, GroupRows, LogOptions, parse_log, read_groups, read_table};
use fluxfit_setup::{MotorFile, read_motor};
use fluxfit_units::{Dimension, parse_quantity};
use journal::Journal;
use row::Row;
use std::{
    collections::BTreeSet,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        mpsc::{SyncSender, sync_channel},
    },
};

#[derive(Debug, Clone, Args)]
#[command(mut_arg("json", |arg| arg.hide(true)), mut_arg("report", |arg| arg.hide(true)), mut_arg("figures", |arg| arg.hide(true)))]
#[command(mut_arg("export", |arg| arg.hide(true)), mut_arg("hold_out", |arg| arg.hide(true)), mut_arg("bandwidth", |arg| arg.hide(true)))]
#[command(mut_arg("control_rate", |arg| arg.hide(true)), mut_arg("window", |arg| arg.hide(true)))]
pub(crate) struct Fleet {
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
    /// The results: one row for each motor and window, as .parquet or .csv
    #[arg(short, long, help_heading = "Fleet", value_name = "RESULTS")]
    output: PathBuf,
    /// Number of motors identified at once [default: the number of cores]
    #[arg(long, help_heading = "Fleet", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
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

/// A motor that waits to be identified.
struct Waiting {
    motor: String,
    source: String,
    /// It came before: this is the refusal, which takes the place of any answer.
    is_duplicate: bool,
    rows: Result<Source, CommandError>,
}

/// A motor that is identified.
struct Done {
    motor: String,
    is_duplicate: bool,
    rows: Vec<Row>,
}

/// Where its rows are.
enum Source {
    File(PathBuf),
    Group(GroupRows),
}

/// Runs the verb.
pub(crate) fn run(arguments: &Fleet) -> Result<Status, CommandError> {
    check(arguments)?;
    let motor = arguments.identify.log.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
    // What cannot be read or asked is refused once, not for every motor.
    input::options(&arguments.identify.log.columns, motor.pole_pairs)?;
    let mut journal = Journal::open(&arguments.output, &words(arguments))?;
    if journal.motors() > 0 {
        terminal::note(&format!("{} motors are finished already; the rest follows", journal.motors()));
    }
    work(arguments, &motor, &mut journal)?;
    if interrupt::exit_status().is_some() {
        terminal::note(&format!("{} motors are finished; the same command goes on", journal.motors()));
        return Ok(Status::Incomplete);
    }
    interrupt::doing("writing the results");
    table::write(&arguments.output, journal.rows())?;
    let status = show(arguments, &journal)?;
    journal.close()?;
    Ok(status)
}

/// Refuses what has no meaning for many motors.
fn check(arguments: &Fleet) -> Result<(), CommandError> {
    let log = &arguments.identify.log;
    let stated = [
        ("--json", log.json),
        ("--report", log.report.is_some()),
        ("--figures", log.figures.is_some()),
        ("--window", !log.window.is_empty()),
    ];
    let stated = stated.into_iter().filter(|(_, is_stated)| *is_stated).map(|(option, _)| option);
    if let Some(option) = stated.chain(arguments.identify.outputs_of_one()).next() {
        return Err(CommandError::Usage(format!("{option} is for one motor; leave it out, or identify that motor alone")));
    }
    table::Format::of(&arguments.output)?;
    Ok(check_writable(&arguments.output)?)
}

/// What makes two runs the same: everything but the number of jobs.
fn words(arguments: &Fleet) -> Vec<String> {
    let Fleet { identify, by, every, output, jobs: _ } = arguments;
    vec![format!("{identify:?}"), format!("{by:?}"), format!("{every:?}"), output.display().to_string()]
}

/// Reads, identifies and writes into the journal: a thread reads, others identify, this one writes.
fn work(arguments: &Fleet, motor: &MotorFile, journal: &mut Journal) -> Result<(), CommandError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = arguments.jobs.map_or(cores, usize::from);
    let progress = terminal::counting("motors", 0);
    let finished: BTreeSet<String> = journal.finished().map(str::to_owned).collect();
    // Few wait at a time: that bounds the memory.
    let (send, waiting) = sync_channel::<Waiting>(jobs);
    let waiting = Mutex::new(waiting);
    let (give, take) = sync_channel::<Done>(jobs);
    interrupt::be_gentle(true);
    let done = std::thread::scope(|scope| {
        scope.spawn(|| read(arguments, &finished, send));
        for _ in 0..jobs {
            let give = give.clone();
            let waiting = &waiting;
            scope.spawn(move || {
                // One thread for each motor: several motors at once use the cores better than one motor on all of them.
                let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
                loop {
                    let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    let Ok(next) = next else { return };
                    let (motor_name, is_duplicate) = (next.motor.clone(), next.is_duplicate);
                    let rows = pool.install(|| rows_of(next, arguments, motor));
                    if give.send(Done { motor: motor_name, is_duplicate, rows }).is_err() {
                        return;
                    }
                }
            });
        }
        drop(give);
        let mut outcome = Ok(());
        let mut refused = BTreeSet::new();
        for Done { motor, is_duplicate, rows } in take {
            // The answer of the first rows may come after the refusal of the others.
            if outcome.is_ok() && (is_duplicate || !refused.contains(&motor)) {
                outcome = journal.add(&motor, rows);
            }
            if is_duplicate {
                refused.insert(motor);
            }
            progress.count("motors", journal.motors(), journal.motors());
        }
        outcome
    });
    interrupt::be_gentle(false);
    done
}

/// Reads group after group. A motor that comes again after others is refused: its rows are in two places.
fn read(arguments: &Fleet, finished: &BTreeSet<String>, send: SyncSender<Waiting>) {
    let mut seen = BTreeSet::new();
    for path in &arguments.identify.log.logs {
        let source = input::name(path);
        let mut pass = |motor: String, rows: Result<Source, CommandError>| {
            if interrupt::go_on().is_break() {
                return ControlFlow::Break(());
            }
            // Rows without a motor are refused wherever they stand.
            let is_new = seen.insert(motor.clone()) || motor.is_empty();
            let rows = if is_new { rows } else { Err(duplicate(&motor, arguments.by.as_deref())) };
            if is_new && finished.contains(&motor) {
                return ControlFlow::Continue(());
            }
            if send.send(Waiting { motor, source: source.clone(), is_duplicate: !is_new, rows }).is_err() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let Some(by) = &arguments.by else {
            if pass(source.clone(), Ok(Source::File(path.clone()))).is_break() {
                return;
            }
            continue;
        };
        let (mut is_over, mut is_empty) = (false, true);
        let read = read_groups(path, by, &mut |Group { key, rows }| {
            is_empty = false;
            let rows = if key.is_some() { rows.map(Source::Group).map_err(CommandError::from) } else { Err(nameless(&source, by)) };
            let passed = pass(key.unwrap_or_default(), rows);
            is_over |= passed.is_break();
            passed
        });
        // The motors before the place of the error are read; the rest of the file is a row of its own. So is a file without rows: whoever
        // counts the files of a fleet finds it.
        let refusal = match read {
            Err(error) => Some(error.into()),
            Ok(()) => is_empty.then(|| rowless(&source)),
        };
        if let Some(refusal) = refusal
            && !is_over
        {
            is_over = pass(source.clone(), Err(refusal)).is_break();
        }
        if is_over {
            return;
        }
    }
}

/// Why rows without a motor are not identified.
pub(crate) fn nameless(source: &str, by: &str) -> CommandError {
    CommandError::Usage(format!("rows of {source} have no {by}; name their motor"))
}

/// Why a table without rows is no motor.
fn rowless(source: &str) -> CommandError {
    CommandError::Usage(format!("{source}: there is no row below the header; leave the file out, or export it with its rows"))
}

fn duplicate(motor: &str, by: Option<&str>) -> CommandError {
    CommandError::Usage(match by {
        Some(by) => format!("the rows of {motor} stand in several places; sort the table by {by}, or give each motor one name"),
        None => format!("{motor} is given twice; give it once"),
    })
}

/// The rows of the results for a motor.
fn rows_of(waiting: Waiting, arguments: &Fleet, motor: &MotorFile) -> Vec<Row> {
    let Waiting { motor: name, source, rows, .. } = waiting;
    let one = |path: &Path| {
        let mut identify = arguments.identify.clone();
        identify.log.logs = vec![path.to_owned()];
        identify
    };
    let label = format!("motor {name} of {source}");
    let read = match rows {
        Err(error) => return vec![row::unread(&name, &source, &arguments.identify, error)],
        Ok(Source::File(path)) => {
            let identify = one(&path);
            return row::rows(&name, &source, input::read_silently(&identify.log, *motor), &identify, arguments.every);
        }
        Ok(Source::Group(GroupRows::Text(text))) => {
            let parse = |_: &Path, options: &LogOptions| parse_log(&label, &text, options);
            input::read_each(&one(Path::new(&label)).log, *motor, parse)
        }
        Ok(Source::Group(GroupRows::Numbers(columns))) => {
            let parse = |_: &Path, options: &LogOptions| read_table(&label, GroupRows::table(&columns), options);
            input::read_each(&one(Path::new(&label)).log, *motor, parse)
        }
    };
    row::rows(&name, &source, read, &arguments.identify, arguments.every)
}

/// Says how many motors have what.
fn show(arguments: &Fleet, journal: &Journal) -> Result<Status, CommandError> {
    let verdict = |row: &Row, verdict: &str| Parameter::ALL.iter().all(|p| row[&format!("{}_verdict", p.key())] == verdict);
    let (rows, failed) = (journal.rows().count(), journal.rows().filter(|row| !row["error"].is_null()).count());
    let whole = journal.rows().filter(|row| verdict(row, "identified")).count();
    terminal::print(&format!(
        "{} motors, {rows} rows: {whole} with all 4 parameters identified, {} with fewer, {failed} without an answer.\n",
        journal.motors(),
        rows - whole - failed
    ))?;
    terminal::wrote("results", &arguments.output);
    Ok(if whole == rows { Status::Complete } else { Status::Incomplete })
}
