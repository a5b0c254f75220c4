//! What both verbs read: the logs as one, the motor file, the search box.

use super::not_a_log;
use crate::{
    arguments::{ColumnArguments, LogArguments, by_parameter},
    error::CommandError,
    terminal::{self, mending, told::Told},
};
use fluxfit::{Error, ErrorKind, Log, Nameplate, Rating, Request, check_samples, log::Source, optimizer};
use fluxfit_files::FileError;
use fluxfit_log::{
    LogOptions, MemoryTable, Note, ReadColumn, ReadLog, column_findings, read_log, read_log_with_progress, read_mapping, read_table,
};
use fluxfit_setup::{MotorFile, read_motor};
use fluxfit_units::wording::one_line;
use std::{fs, path::Path, sync::Arc};

/// The logs, joined, and the motor file.
pub(crate) struct Input {
    /// Shared with what shows a rough answer where the whole one is interrupted.
    pub(crate) log: Arc<Log>,
    pub(crate) motor: MotorFile,
    /// Names of the logs, for headings.
    pub(crate) name: String,
    /// The same without directories, for the title of a page.
    pub(crate) title: String,
    /// Pole pairs, from whoever tells them.
    pub(crate) pole_pairs: Option<u32>,
    /// The columns of each log, as they were read.
    columns: Vec<Vec<ReadColumn>>,
    /// What was inferred, with what changes it.
    notes: Vec<Note>,
}

impl Input {
    /// What was read as what, and what was inferred: for a page that stands alone.
    pub(crate) fn said(&self) -> Vec<String> {
        let Source { columns, notes } = self.log.source();
        // What has no number in the answer stands beside it.
        let findings = self.findings().into_iter().map(|finding| finding.sentence.trim_end_matches(':').to_owned());
        columns.iter().chain(notes).cloned().chain(findings).chain(self.samples().into_iter().map(|finding| finding.sentence)).collect()
    }
}

impl Input {
    /// What the columns contradict each other in, with what mends it. Of several logs, all of them together: they are of one motor and
    /// mostly of one drive, and what is proposed is for the first.
    pub(crate) fn findings(&self) -> Vec<Told> {
        let columns = self.columns.first().map_or(&[][..], Vec::as_slice);
        column_findings(&self.log, columns).iter().map(|finding| mending::told(finding, columns, self.pole_pairs)).collect()
    }
}

impl Input {
    /// Outliers and stale samples.
    pub(crate) fn samples(&self) -> Vec<Told> {
        check_samples(&self.log).iter().map(Told::of_samples).collect()
    }
}

/// Reads everything that the arguments name; what was inferred is said on standard error.
pub(crate) fn read(arguments: &LogArguments) -> Result<Input, CommandError> {
    let motor = arguments.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
    read_beside(arguments, motor)
}

/// Reads the logs, where the motor file is read already.
pub(crate) fn read_beside(arguments: &LogArguments, motor: MotorFile) -> Result<Input, CommandError> {
    let input = read_each(arguments, motor, |path, options| {
        let progress = terminal::reading(&format!("reading {}", name(path)), fs::metadata(path).map_or(0, |metadata| metadata.len()));
        read_log_with_progress(path, options, progress.teller())
    })?;
    input.notes.iter().for_each(|note| terminal::note(&terminal::advice::with_options(&note.sentence, &note.advice)));
    input.log.source().columns.iter().for_each(|columns| terminal::detail(|| columns.clone()));
    Ok(input)
}

/// Takes a table in memory in place of the one log that the arguments name.
pub(crate) fn read_held(arguments: &LogArguments, motor: MotorFile, table: MemoryTable) -> Result<Input, CommandError> {
    let mut table = Some(table);
    read_each(arguments, motor, |path, options| read_table(&name(path), table.take().unwrap_or_default(), options))
}

/// Reads the logs, and shows nothing.
pub(crate) fn read_silently(arguments: &LogArguments, motor: MotorFile) -> Result<Input, CommandError> {
    read_each(arguments, motor, read_log)
}

/// Reads each log, and joins them.
pub(crate) fn read_each(
    arguments: &LogArguments,
    motor: MotorFile,
    mut read: impl FnMut(&Path, &LogOptions) -> Result<ReadLog, FileError>,
) -> Result<Input, CommandError> {
    if arguments.logs.iter().filter(|path| path.as_os_str() == "-").count() > 1 {
        return Err(CommandError::Usage("standard input can be read only once; give - once".to_owned()));
    }
    let options = options(&arguments.columns, motor.pole_pairs)?;
    let (mut logs, mut notes) = (Vec::new(), Vec::new());
    let mut read_columns = Vec::new();
    let is_only = arguments.logs.len() == 1;
    for path in &arguments.logs {
        let read = not_a_log::or_what_it_is(read(path, &options), path)?;
        let (rows, segments) = (read.log.rows(), read.log.segments().len());
        terminal::detail(|| format!("read {}: {rows} rows, segments without a gap: {segments}", name(path)));
        let of_name = |sentence: &str| format!("{}: {sentence}", name(path));
        let columns = read.log.source().columns.clone();
        read_columns.push(read.columns);
        // The name of the only log is said already.
        let of_this = |note: Note| if is_only { note } else { Note { sentence: of_name(&note.sentence), ..note } };
        let of_log: Vec<Note> = read.notes.into_iter().map(of_this).collect();
        let of_source = of_log.iter().map(|note| note.sentence.clone()).collect();
        logs.push(read.log.with_source(Source { columns, notes: of_source }));
        notes.extend(of_log);
    }
    let log = Log::join(logs)?;
    let names: Vec<String> = arguments.logs.iter().map(|path| name(path)).collect();
    let titles: Vec<String> = arguments.logs.iter().map(|path| file_name(path)).collect();
    Ok(Input {
        log: Arc::new(log),
        motor,
        name: names.join(", "),
        title: titles.join(", "),
        pole_pairs: options.pole_pairs,
        columns: read_columns,
        notes,
    })
}

/// The pole pairs that anything beside the logs tells.
pub(crate) fn options_of_motor(arguments: &LogArguments) -> Result<LogOptions, CommandError> {
    let motor = arguments.motor.as_deref().map(read_motor).transpose()?.unwrap_or_default();
    options(&arguments.columns, motor.pole_pairs)
}

/// What the reader is told; the motor file's pole pairs count where nothing else tells them.
pub(crate) fn options(arguments: &ColumnArguments, of_motor: Option<u32>) -> Result<LogOptions, CommandError> {
    let mapping = arguments.mapping.as_deref().map(read_mapping).transpose()?.unwrap_or_default();
    let pole_pairs = arguments.pole_pairs.or(mapping.pole_pairs).or(of_motor);
    Ok(LogOptions {
        map: arguments.map.iter().flat_map(|pairs| pairs.0.clone()).collect(),
        units: arguments.unit.clone(),
        pole_pairs,
        dbc: arguments.dbc.as_deref().map(read_dbc).transpose()?,
        mapping,
        all_rows: false,
    })
}

/// What the arguments of all verbs ask for.
pub(crate) fn request(arguments: &LogArguments, input: &Input) -> Result<Request, CommandError> {
    let bounds: Vec<_> = arguments.bounds.iter().map(|(parameter, lower, upper)| (*parameter, (*lower, *upper))).collect();
    Ok(Request {
        windows: arguments.window.clone(),
        voltage_timing: arguments.voltage_timing.stated(),
        search: optimizer::SearchSettings { seed: arguments.seed, ..optimizer::SearchSettings::default() },
        bounds: by_parameter(&bounds, "--bounds")?,
        nameplate: nameplate(input),
        ..Request::default()
    })
}

/// What the motor file says of the motor.
fn nameplate(input: &Input) -> Nameplate {
    let MotorFile { rs, ld, lq, psi_f, ref rating, .. } = input.motor;
    let rating = match (rating.voltage, rating.current, rating.speed, input.pole_pairs) {
        (Some(voltage), Some(current), Some(speed), Some(pole_pairs)) => {
            Some(Rating { voltage, current, omega_e: speed * f64::from(pole_pairs) })
        }
        _ => None,
    };
    Nameplate { values: [rs, ld, lq, psi_f], pole_pairs: input.pole_pairs, rating }
}

/// An error of the library: of the log, if it is about the log.
pub(crate) fn of_log(name: &str, error: Error) -> CommandError {
    match error.kind() {
        ErrorKind::TooShort { .. } | ErrorKind::NoOperatingPoint { .. } | ErrorKind::FewRows { .. } | ErrorKind::Window { .. } => {
            CommandError::Log { log: name.to_owned(), error }
        }
        _ => CommandError::Library(error),
    }
}

/// The file's name in a message.
pub(crate) fn name(path: &Path) -> String {
    if path.as_os_str() == "-" { "standard input".to_owned() } else { one_line(&path.display().to_string()) }
}

/// Name of a file without its directory, for the title of a page.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| name(path), |file| name(Path::new(file)))
}

/// The text of a DBC. Old tools write it in Windows-1252, whose letters beyond ASCII are in comments only.
fn read_dbc(path: &Path) -> Result<String, CommandError> {
    let bytes = fluxfit_files::input::read(path)?;
    Ok(String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}').to_owned())
}
