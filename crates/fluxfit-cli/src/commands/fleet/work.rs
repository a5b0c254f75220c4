//! Motors to rows: a thread reads them one after the other, others identify, and the rows go into the journal.

use super::{
    journal::Journal,
    motors::{HeldMotors, Motors},
    row::{self, Row},
};
use crate::{commands::input, error::CommandError};
use fluxfit_log::{Group, GroupRows, LogOptions, MemoryTable, parse_log, read_groups, read_part, read_table};
use fluxfit_setup::MotorFile;
use std::{
    collections::BTreeSet,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        mpsc::{SyncSender, sync_channel},
    },
};

/// Who looks on.
pub(crate) struct Onlooker<'a> {
    /// Says whether to go on, before each motor is read.
    pub(crate) go_on: &'a (dyn Fn() -> ControlFlow<()> + Sync),
    /// Is told how many motors are finished, and of how many if that is known.
    pub(crate) told: &'a dyn Fn(usize, Option<usize>),
}

/// A motor that waits to be identified.
struct Waiting<'a> {
    motor: String,
    source: String,
    /// It came before: this is the refusal, which takes the place of any answer.
    is_duplicate: bool,
    rows: Result<Source<'a>, CommandError>,
}

/// A motor that is identified.
struct Done {
    motor: String,
    is_duplicate: bool,
    rows: Vec<Row>,
}

/// Where its rows are.
enum Source<'a> {
    File(PathBuf),
    Group(GroupRows),
    Held(MemoryTable<'a>),
}

/// Identifies the motors of the logs, or of a table in their place, and writes them into the journal. Those that are in it are left out.
pub(super) fn work(
    arguments: &Motors,
    motor: &MotorFile,
    table: Option<&HeldMotors>,
    journal: &mut Journal,
    onlooker: &Onlooker,
) -> Result<(), CommandError> {
    let jobs = arguments.jobs();
    let finished: BTreeSet<String> = journal.finished().map(str::to_owned).collect();
    let motors = match (table, &arguments.by) {
        (Some(table), _) => Some(table.runs.len()),
        (None, Some(_)) => None,
        (None, None) => Some(arguments.identify.log.logs.len()),
    };
    // Few wait at a time: that bounds the memory.
    let (send, waiting) = sync_channel::<Waiting>(jobs);
    let waiting = Mutex::new(waiting);
    let (give, take) = sync_channel::<Done>(jobs);
    std::thread::scope(|scope| {
        let by = arguments.by.as_deref();
        let queue = Queue { by, finished: &finished, seen: BTreeSet::new(), go_on: onlooker.go_on, send };
        scope.spawn(|| match table {
            Some(table) => read_held(table, queue),
            None => read_logs(&arguments.identify.log.logs, queue),
        });
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
            (onlooker.told)(journal.motors(), motors);
        }
        outcome
    })
}

/// The motors that were read, on their way to be identified.
struct Queue<'a> {
    by: Option<&'a str>,
    finished: &'a BTreeSet<String>,
    seen: BTreeSet<String>,
    go_on: &'a (dyn Fn() -> ControlFlow<()> + Sync),
    send: SyncSender<Waiting<'a>>,
}

impl<'a> Queue<'a> {
    /// Takes a motor. One that comes again after others is refused: its rows are in two places.
    fn pass(&mut self, motor: String, source: &str, rows: Result<Source<'a>, CommandError>) -> ControlFlow<()> {
        (self.go_on)()?;
        // Rows without a motor are refused wherever they stand.
        let is_new = self.seen.insert(motor.clone()) || motor.is_empty();
        let rows = if is_new { rows } else { Err(duplicate(&motor, self.by)) };
        if is_new && self.finished.contains(&motor) {
            return ControlFlow::Continue(());
        }
        let sent = self.send.send(Waiting { motor, source: source.to_owned(), is_duplicate: !is_new, rows });
        if sent.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Takes the motor of a group, or refuses rows without one.
    fn pass_group(&mut self, key: Option<String>, source: &str, rows: Result<Source<'a>, CommandError>) -> ControlFlow<()> {
        let rows = if key.is_some() { rows } else { Err(nameless(source, self.by.unwrap_or_default())) };
        self.pass(key.unwrap_or_default(), source, rows)
    }
}

/// Reads log after log: each is a motor, or a table of motors.
fn read_logs(logs: &[PathBuf], mut queue: Queue) {
    for path in logs {
        let source = input::name(path);
        let Some(by) = queue.by else {
            if queue.pass(source.clone(), &source, Ok(Source::File(path.clone()))).is_break() {
                return;
            }
            continue;
        };
        let (mut is_over, mut is_empty) = (false, true);
        let read = read_groups(path, by, &mut |Group { key, rows }| {
            is_empty = false;
            let passed = queue.pass_group(key, &source, Ok(Source::Group(rows)));
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
            is_over = queue.pass(source.clone(), &source, Err(refusal)).is_break();
        }
        if is_over {
            return;
        }
    }
}

/// Passes on motor after motor of a table in memory.
fn read_held<'a>(held: &'a HeldMotors, mut queue: Queue<'a>) {
    let mut start = 0;
    for (key, rows) in held.runs {
        let part = held.table.part(start..start + rows);
        start += rows;
        if queue.pass_group(key.clone(), held.source, Ok(Source::Held(part))).is_break() {
            return;
        }
    }
    if held.runs.is_empty() {
        let _ = queue.pass(held.source.to_owned(), held.source, Err(rowless(held.source)));
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
fn rows_of(waiting: Waiting, arguments: &Motors, motor: &MotorFile) -> Vec<Row> {
    let Waiting { motor: name, source, rows, .. } = waiting;
    let one = |path: &Path| {
        let mut identify = arguments.identify.clone();
        identify.log.logs = vec![path.to_owned()];
        identify
    };
    let label = format!("motor {name} of {source}");
    let of_table = |table: MemoryTable| {
        let mut table = Some(table);
        let parse = |_: &Path, options: &LogOptions| read_table(&label, table.take().unwrap_or_default(), options);
        input::read_each(&one(Path::new(&label)).log, *motor, parse)
    };
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
        Ok(Source::Group(GroupRows::Part(part))) => {
            let parse = |_: &Path, options: &LogOptions| read_part(&label, &part, options);
            input::read_each(&one(Path::new(&label)).log, *motor, parse)
        }
        Ok(Source::Group(GroupRows::Numbers(columns))) => of_table(GroupRows::table(&columns)),
        Ok(Source::Held(table)) => of_table(table),
    };
    row::rows(&name, &source, read, &arguments.identify, arguments.every)
}
