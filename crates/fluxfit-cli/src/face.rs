//! For other faces of the program, such as the Python package: the words of a command line in, answers out, nothing printed. The words are
//! parsed and the logs read as the command does it, so that every face gives the same answers, to the bit, and the same sentences.

use crate::{
    commands::{
        compare, fleet, fleet::motors::Motors, fleet::page::Page, fleet::work::Onlooker, identify, identify::export, input, inspect,
        not_a_log, report, track, validate,
    },
    error::CommandError,
    explanations, json,
    terminal::{self, Detail, options},
};
use clap::{Args, Command, FromArgMatches};
use fluxfit::{Answer, Columns, Log, Progress, Request, document::StudyDocument, document::ValidationDocument, identify_with_progress};
use fluxfit_answer::export::Target;
use fluxfit_drive::{Recording, simulate};
use fluxfit_files::{FileErrorKind, write_atomically};
use fluxfit_log::{MemoryTable, document::InspectionDocument, inspect as inspect_log, read_table};
use fluxfit_report::{Report, html};
use fluxfit_setup::{GivenMotor, ReadScenario, paper_scenario, read_given_motor, read_motor, read_scenario, truth_of};
use serde_json::{Map, Value};
use std::{ffi::OsString, ops::ControlFlow, path::Path, sync::Arc};

pub use crate::commands::{fleet::motors::HeldMotors, track::alarm::Left};

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// What it is about.
    pub about: About,
    /// The sentence of the command, with its options.
    pub sentence: String,
}

/// What a refusal is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum About {
    /// A file that cannot be read or written.
    File,
    /// What a log or another file holds.
    Data,
    /// What was asked for.
    Request,
}

impl From<CommandError> for Refusal {
    fn from(error: CommandError) -> Self {
        let about = match &error {
            CommandError::File(error) => match error.kind() {
                FileErrorKind::Access => About::File,
                FileErrorKind::Request => About::Request,
                _ => About::Data,
            },
            CommandError::Output(_) => About::File,
            CommandError::Log { .. } | CommandError::Columns { .. } | CommandError::Simulation { .. } => About::Data,
            CommandError::Library(error) if error.column().is_some() => About::Data,
            CommandError::Library(_) | CommandError::Search(_) | CommandError::Drive(_) | CommandError::Usage(_) => About::Request,
        };
        let sentence = options::with_option(&error.to_string(), error.option());
        Self { about, sentence: format!("{sentence}\n{}", error.lines()).trim_end().to_owned() }
    }
}

impl From<fluxfit_files::FileError> for Refusal {
    fn from(error: fluxfit_files::FileError) -> Self {
        CommandError::from(error).into()
    }
}

impl From<std::io::Error> for Refusal {
    fn from(error: std::io::Error) -> Self {
        CommandError::from(error).into()
    }
}

fn misuse(sentence: impl Into<String>) -> Refusal {
    Refusal { about: About::Request, sentence: sentence.into() }
}

/// The arguments of a verb. Its words are parsed alone: the whole command line takes longer to build than a small log to read.
fn parse<T: Args + FromArgMatches>(words: &[OsString]) -> Result<T, Refusal> {
    terminal::tell(Detail::Quiet, false);
    let parsed = T::augment_args(Command::new("fluxfit")).try_get_matches_from(words);
    let sentence = |error: clap::Error| {
        let text = error.render().to_string();
        let text = text.split("\n\nUsage:").next().unwrap_or(&text).split("\n\nFor more").next().unwrap_or_default();
        text.trim_start_matches("error: ").split_whitespace().collect::<Vec<_>>().join(" ")
    };
    parsed.and_then(|matches| T::from_arg_matches(&matches)).map_err(|error| misuse(sentence(error)))
}

/// An identification that is ready to be made: the log is read, and what is asked is checked.
pub struct Task {
    arguments: identify::Identify,
    input: input::Input,
    request: Request,
}

impl Task {
    /// Reads what the words of `fluxfit identify` name; a table in memory takes the place of the log.
    ///
    /// # Errors
    /// As the command.
    pub fn read(words: &[OsString], table: Option<MemoryTable>) -> Result<Self, Refusal> {
        let task = Self::read_log(words, table)?;
        identify::accepted(&task.arguments, &task.input)?;
        Ok(task)
    }

    /// The same, without the check of what the columns contradict each other in: for those who want the log alone.
    ///
    /// # Errors
    /// As the command.
    pub fn read_log(words: &[OsString], table: Option<MemoryTable>) -> Result<Self, Refusal> {
        let arguments: identify::Identify = parse(words)?;
        let motor = arguments.log.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
        let input = match table {
            Some(table) => input::read_held(&arguments.log, motor, table)?,
            None => input::read_beside(&arguments.log, motor)?,
        };
        let request = identify::request(&arguments, &input)?;
        Ok(Self { arguments, input, request })
    }

    /// The log.
    pub fn log(&self) -> &Arc<Log> {
        &self.input.log
    }

    /// What is asked.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Names of the logs, for headings.
    pub fn name(&self) -> &str {
        &self.input.name
    }

    /// What was read as what, and what was inferred.
    pub fn said(&self) -> Vec<String> {
        self.input.said()
    }

    /// Identifies.
    ///
    /// # Errors
    /// As the command.
    pub fn identify(&self, progress: Progress) -> Result<Answer, Refusal> {
        identify_with_progress(&self.input.log, &self.request, progress).map_err(|found| {
            let suspected = found.suspected_units.as_ref().map(|warning| format!("; {warning}")).unwrap_or_default();
            let mut refusal = Refusal::from(input::of_log(&self.input.name, found.error));
            refusal.sentence += &suspected;
            refusal
        })
    }

    /// Writes the page of the report; `call` says how it can be made again.
    ///
    /// # Errors
    /// If the name is none of a page, or the file cannot be written.
    pub fn report(&self, answer: &Answer, path: &Path, call: &str) -> Result<(), Refusal> {
        report::check_name(path)?;
        let document = document(answer)?;
        let mut origin = report::origin(self.arguments.log.seed);
        call.clone_into(&mut origin.command);
        let page = html(&Report {
            title: &self.input.title,
            log: &answer.log,
            notes: &self.input.said(),
            operating_points: answer.identification.operating_points(),
            identification: Some((&answer.identification, answer.identification.method)),
            held_out: answer.held_out.as_ref().map(|held_out| (&held_out.log, held_out.validation.as_ref())),
            study: None,
            online: None,
            json: Some(&document),
            options: report::options(),
            origin: &origin,
        });
        Ok(write_atomically(path, page.as_bytes())?)
    }

    /// Writes the file of another tool; `target` is its key, such as `vesc`.
    ///
    /// # Errors
    /// If there is no such target, the answer does not carry it, or the file cannot be written.
    pub fn export(&self, answer: &Answer, target: &str, path: &Path) -> Result<(), Refusal> {
        let (target, path): (Target, _) = export::parse(&format!("{target}={}", path.display())).map_err(misuse)?;
        let logs: Vec<String> = self.arguments.log.logs.iter().map(|path| export::file_name(path)).collect();
        let exported = fluxfit_answer::export::Export {
            logs: &logs,
            identification: &answer.identification,
            pole_pairs: self.input.pole_pairs,
            current_loop: answer.current_loop.as_ref(),
        };
        let text = fluxfit_answer::export::export(target, &exported).map_err(|refusal| misuse(export::with_option(&refusal)))?;
        Ok(write_atomically(&path, text.as_bytes())?)
    }
}

/// The document of an answer, the same bytes as `--json` prints.
///
/// # Errors
/// None in practice: every answer can be written.
pub fn document(answer: &Answer) -> Result<String, Refusal> {
    Ok(json::text(answer)?)
}

/// The document of `fluxfit inspect`.
///
/// # Errors
/// If the file is no table. A table that is no log is inspected all the same.
pub fn inspection(words: &[OsString]) -> Result<String, Refusal> {
    let arguments: inspect::Inspect = parse(words)?;
    let inspect::Inspect { log, columns, .. } = &arguments;
    let inspection = not_a_log::or_what_it_is(inspect_log(log, &input::options(columns, None)?), log)?;
    Ok(json::text(&InspectionDocument::of(&inspection))?)
}

/// The document of `fluxfit validate`; `motor` is the content of a motor file in place of the one that the words name.
///
/// # Errors
/// As the command.
pub fn validation(words: &[OsString], table: Option<MemoryTable>, motor: Option<&[u8]>) -> Result<String, Refusal> {
    let arguments: validate::Validate = parse(words)?;
    let motor = match (motor, arguments.log.motor.as_deref()) {
        (Some(bytes), _) => GivenMotor::parse("motor", bytes)?,
        (None, Some(path)) => read_given_motor(path)?,
        (None, None) => return Err(misuse("there is no motor to validate")),
    };
    let input = match table {
        Some(table) => input::read_held(&arguments.log, motor.file, table)?,
        None => input::read_beside(&arguments.log, motor.file)?,
    };
    let request = validate::request(&arguments, &input)?;
    let found = fluxfit::validate(&input.log, &motor.given, &request).map_err(|error| input::of_log(&input.name, error))?;
    Ok(json::text(&ValidationDocument::of(&input.log, &found))?)
}

/// The document of `fluxfit compare`; `go_on` is asked after every iteration.
///
/// # Errors
/// As the command.
pub fn comparison(words: &[OsString], table: Option<MemoryTable>, go_on: &(dyn Fn() -> ControlFlow<()> + Sync)) -> Result<String, Refusal> {
    let arguments: compare::Compare = parse(words)?;
    compare::check(&arguments)?;
    let motor = arguments.log.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
    let input = match table {
        Some(table) => input::read_held(&arguments.log, motor, table)?,
        None => input::read_beside(&arguments.log, motor)?,
    };
    let asked = compare::request(&arguments, &input)?;
    let (comparison, methods) = compare::compared(&input.log, &asked, go_on).map_err(|error| input::of_log(&input.name, error))?;
    Ok(json::text(&StudyDocument::of(&comparison, &methods, !comparison.is_whole()))?)
}

/// The rows of a fleet, by motor and window.
pub struct Fleet {
    rows: Vec<Map<String, Value>>,
    /// What its page is of.
    title: String,
    seed: u64,
}

impl Fleet {
    /// The rows; each has a value for each of [`fleet_columns`].
    pub fn rows(&self) -> &[Map<String, Value>] {
        &self.rows
    }

    /// How many motors have what, as the command says it.
    pub fn count(&self) -> String {
        fleet::Count::of(&self.rows).to_string()
    }

    /// Writes the results as the command does: Parquet or CSV, by the ending of the name.
    ///
    /// # Errors
    /// If the name has another ending, or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Refusal> {
        Ok(fleet::table::write(path, &self.rows)?)
    }

    /// Writes the page of the fleet, as `--report` does; `call` says how it can be made again.
    ///
    /// # Errors
    /// If the name is none of a page, or the file cannot be written.
    pub fn report(&self, path: &Path, call: &str) -> Result<(), Refusal> {
        report::check_name(path)?;
        let mut origin = report::origin(self.seed);
        call.clone_into(&mut origin.command);
        Ok(write_atomically(path, Page::of(&self.rows).html(&self.title, &origin).as_bytes())?)
    }
}

/// Identifies the motors that the words of `fluxfit fleet` name; those of a table in memory take their place. With `output`, the results
/// are written as the command does it: killed and started again, it goes on. `go_on` is asked before each motor is read, and `told` after
/// each how many are finished, and of how many if that is known. `None` if it was broken off.
///
/// # Errors
/// As the command. What fails of a motor is a row with its reason.
pub fn fleet(
    words: &[OsString],
    table: Option<&HeldMotors>,
    output: Option<&Path>,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
    told: &dyn Fn(usize, Option<usize>),
) -> Result<Option<Fleet>, Refusal> {
    if let Some(HeldMotors { table, runs, .. }) = table {
        let (rows, named) = (table.rows()?, runs.iter().map(|(_, rows)| rows).sum::<usize>());
        if rows != named {
            return Err(misuse(format!(
                "the table has {rows} rows, and the column that names their motors {named}; name the motor of each"
            )));
        }
    }
    let motors: Motors = parse(words)?;
    let log = &motors.identify.log;
    let title = table.map_or_else(|| fleet::title(&log.logs, output, "logs"), |table| table.source.to_owned());
    let rows = fleet::rows(&motors, table, output, &Onlooker { go_on, told })?;
    Ok(rows.map(|rows| Fleet { rows, title, seed: log.seed }))
}

/// The rows of a fleet for one motor, whose rows are a table in memory: a JSON list of objects with a value for each of [`fleet_columns`].
/// What fails is a row with its reason; an error is what was asked.
///
/// # Errors
/// If the words are none of the verb `fleet`, or name what cannot be read.
pub fn fleet_rows(words: &[OsString], motor: &str, source: &str, table: MemoryTable) -> Result<String, Refusal> {
    let arguments: Motors = parse(words)?;
    let log = &arguments.identify.log;
    let file = arguments.check()?;
    let mut table = Some(table);
    let label = format!("motor {motor} of {source}");
    let read = match (&arguments.by, motor) {
        (Some(by), "") => Err(fleet::work::nameless(source, by)),
        _ => input::read_each(log, file, |_, options| read_table(&label, table.take().unwrap_or_default(), options)),
    };
    Ok(json::text(&fleet::row::rows(motor, source, read, &arguments.identify, arguments.every))?)
}

/// The columns of the rows of a fleet: each with `text`, `number` or `count`.
pub fn fleet_columns() -> Vec<(&'static str, &'static str)> {
    let kind = |kind| match kind {
        fleet::row::Kind::Text => "text",
        fleet::row::Kind::Number => "number",
        fleet::row::Kind::Count => "count",
    };
    fleet::row::COLUMNS.iter().map(|(name, of)| (*name, kind(*of))).collect()
}

/// The parameters of a running motor, from rows as they arrive.
pub struct Tracking {
    tracking: track::tracking::Tracking,
    watch: track::alarm::Watch,
    alarms: Vec<Left>,
}

impl Tracking {
    /// A tracker as the words of `fluxfit track` ask for it. The log that they name is not read.
    ///
    /// # Errors
    /// As the command.
    pub fn begin(words: &[OsString]) -> Result<Self, Refusal> {
        let (tracking, watch, _) = track::begun(&parse(words)?)?;
        Ok(Self { tracking, watch, alarms: Vec::new() })
    }

    /// Takes rows, and gives the documents that the command prints on the way, each of one line.
    ///
    /// # Errors
    /// If the rows have no angle, and the faults of the drive need one.
    pub fn take(&mut self, rows: &Columns) -> Result<Vec<String>, Refusal> {
        let mut documents = Vec::new();
        for row in (0..rows.t.len()).filter_map(|row| rows.row(row)) {
            if self.tracking.take(&row)? {
                documents.push(self.line(false)?);
                self.look();
            }
        }
        Ok(documents)
    }

    /// The document of the state at the end.
    ///
    /// # Errors
    /// None in practice: every state can be written.
    pub fn end(&mut self) -> Result<String, Refusal> {
        self.tracking.end();
        self.look();
        self.line(true)
    }

    /// The parameters that have left their band so far (`--alarm`), each with the sentence of the command as its `Display`.
    pub fn alarms(&self) -> &[Left] {
        &self.alarms
    }

    fn look(&mut self) {
        let tracker = &self.tracking.tracker;
        self.alarms.extend(self.watch.look(tracker.time(), &tracker.parameters_or_nothing()));
    }

    /// Saves what is known, for `--resume`.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), Refusal> {
        Ok(track::state::write(path, &self.tracking.tracker)?)
    }

    fn line(&self, last: bool) -> Result<String, Refusal> {
        Ok(serde_json::to_string(&self.tracking.document(last)).map_err(std::io::Error::from)?)
    }
}

/// The page of a code of a warning or finding.
///
/// # Errors
/// If there is no such code; the sentence names all.
pub fn explanation(code: &str) -> Result<String, Refusal> {
    Ok(explanations::text_of(code)?.to_owned())
}

/// Where a scenario comes from.
#[derive(Debug, Clone, Copy)]
pub enum ScenarioSource<'a> {
    /// The paper's rig.
    Paper,
    /// A file.
    File(&'a Path),
    /// The text of one; the path of a flux map is relative to the working directory.
    Text(&'a str),
}

/// Simulates a scenario: the recording, and the document of its true parameters. `seed` takes the place of the scenario's.
///
/// # Errors
/// If the scenario is refused, or its drive trips.
pub fn simulation(source: ScenarioSource, seed: Option<u32>, draw: u64) -> Result<(Recording, String), Refusal> {
    let mut read = match source {
        ScenarioSource::Paper => paper_scenario()?,
        ScenarioSource::File(path) => read_scenario(path)?,
        ScenarioSource::Text(text) => ReadScenario::parse("scenario", text.as_bytes(), Path::new(""))?,
    };
    if let Some(seed) = seed {
        read.scenario.seed = u64::from(seed);
        // The truth must lead to the same log again.
        read.document["seed"] = seed.into();
    }
    let name = match source {
        ScenarioSource::Paper => "the paper's rig".to_owned(),
        ScenarioSource::File(path) => path.display().to_string(),
        ScenarioSource::Text(_) => "scenario".to_owned(),
    };
    let recording = simulate(&read.scenario, draw, || ()).map_err(|error| CommandError::Simulation { scenario: name, error })?;
    Ok((recording, json::text(&truth_of(&read, draw))?))
}
