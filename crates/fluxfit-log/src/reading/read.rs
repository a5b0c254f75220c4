//! Reading: from a table to a log.
//!
//! ```text
//! log = table -> layout -> columns -> rows, in SI -> common instants -> repairs -> dq, speed -> checked
//! ```

use super::{
    align,
    channels::Channels,
    chosen::{self, ChosenColumn},
    columns, even_time, event_times,
    gather::{Gathered, gather},
    layout::Layout,
    lines::Lines,
    options::{LogOptions, ResolvedOptions},
    phases, plausibility, repair, rounded_time, scope_trace,
    table::Table,
    turned_frame, turning,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    file_part::FilePart,
    memory_table::{Held, MemoryTable},
    note::Note,
    problem::Problem,
};
use fluxfit::{
    ColumnFinding, check_columns,
    log::{Columns, Log, Source, check_values, without_gaps},
};
use fluxfit_files::{
    FileError,
    input::{self, Bytes},
};
use fluxfit_units::{Unit, significant};
use std::{
    io::{Cursor, Read},
    path::Path,
};

/// A log, and what had to be inferred to read it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadLog {
    /// The log, in SI units. Its [`source`](Log::source) has what was read as what, and the sentences of the notes.
    pub log: Log,
    /// The recognized layout, if it is one of [`LAYOUTS`](crate::LAYOUTS).
    pub layout: Option<&'static Layout>,
    /// What was inferred, repaired or looks wrong.
    pub notes: Vec<Note>,
    /// The columns of the file that were read.
    pub columns: Vec<ReadColumn>,
    /// The gaps in time that the file has: time of the last row before each and of the first one behind it, s. Rows that were left out
    /// are none, though nothing is computed across them either.
    pub gaps: Vec<(f64, f64)>,
}

/// A column of a file, as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadColumn {
    /// The channel that it was read as.
    pub channel: &'static str,
    /// Its name in the file.
    pub header: String,
    /// The unit in which it was read.
    pub unit: Unit,
    /// The factor besides the unit: scale and sign.
    pub scale: f64,
    /// Whether the file or the user writes its unit or a scale: SI does not only follow from its name.
    pub is_unit_written: bool,
}

impl ReadLog {
    /// Times between which nothing is computed: those with a gap of the file, or those where only rows were left out.
    pub fn breaks(&self, of_file: bool) -> Vec<(f64, f64)> {
        let (t, segments) = (&self.log.columns().t, self.log.segments());
        let times = segments.windows(2).map(|pair| (t[pair[0].rows.end - 1], t[pair[1].rows.start]));
        let has_gap = |(from, to): &(f64, f64)| self.gaps.iter().any(|(t0, t1)| t0 >= from && t1 <= to);
        times.filter(|times| has_gap(times) == of_file).collect()
    }
}

impl ReadColumn {
    fn of(column: &ChosenColumn) -> Self {
        Self {
            channel: column.channel.name(),
            header: column.header.clone(),
            unit: column.unit,
            scale: column.scale,
            is_unit_written: column.is_unit_written,
        }
    }

    /// Whether it is a voltage of the motor.
    pub fn is_voltage(&self) -> bool {
        ["ud", "uq", "ua", "ub", "uc", "ualpha", "ubeta"].contains(&self.channel)
    }
}

/// Whether the file or the user writes the unit of every voltage of the motor.
pub fn are_volts_written(columns: &[ReadColumn]) -> bool {
    columns.iter().filter(|column| column.is_voltage()).all(|column| column.is_unit_written)
}

/// What the columns of a log contradict each other in. What only the size of the voltages says is left out where their unit is written,
/// unless it is certain.
pub fn column_findings(log: &Log, columns: &[ReadColumn]) -> Vec<ColumnFinding> {
    let is_written = are_volts_written(columns);
    let mut findings = check_columns(log);
    findings.retain(|finding| !is_written || finding.is_certain() || !finding.is_of_unwritten_volts());
    findings
}

/// Reads a log; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, or as [`parse_log`].
pub fn read_log(path: &Path, options: &LogOptions) -> Result<ReadLog, FileError> {
    read_log_with_progress(path, options, |_| ())
}

/// Reads a log and reports progress: of a file of text, `progress` is called with the number of further bytes read, several times a
/// second.
///
/// # Errors
/// As [`read_log`].
pub fn read_log_with_progress(path: &Path, options: &LogOptions, progress: impl Fn(u64) + 'static) -> Result<ReadLog, FileError> {
    let options = ResolvedOptions::resolve(options)?;
    let read = input::open(path)
        .and_then(|bytes| Table::open(bytes.with_progress(progress), options.dbc.as_deref()))
        .and_then(|table| read(table, &options));
    read.map_err(|error| error.in_file(&input::name(path)))
}

/// Reads a log from a socket, a pipe or anything else that can be read to its end; `name` stands for the file in messages. Text is
/// read in blocks, other formats are read into memory first.
///
/// A drive that sends its rows while it runs needs no file format: push them into a [`LogBuilder`](fluxfit::log::LogBuilder).
///
/// ```
/// use fluxfit_log::{LogOptions, read_log_from};
/// use std::io::Write;
///
/// let (receiver, mut drive) = std::io::pipe()?;
/// drive.write_all(b"t,ud,uq,id,iq,omega_e\n0,1.5,20,0,3,400\n0.001,1.5,20,0,3,400\n")?;
/// drop(drive);
///
/// let read = read_log_from("drive", receiver, &LogOptions::default())?;
/// assert_eq!(read.log.rows(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If reading fails, or as [`parse_log`].
pub fn read_log_from(name: &str, reader: impl Read + 'static, options: &LogOptions) -> Result<ReadLog, FileError> {
    let options = ResolvedOptions::resolve(options)?;
    let read = Table::open(Bytes::Stream(Box::new(reader)), options.dbc.as_deref()).and_then(|table| read(table, &options));
    read.map_err(|error| error.in_file(name))
}

/// Reads a log from memory; `name` stands for the file in messages.
///
/// # Errors
/// If an option names no channel or no column of the file, if the bytes are not a table of numbers with a header, or if [`Log::new`]
/// refuses the values.
pub fn parse_log(name: &str, bytes: &[u8], options: &LogOptions) -> Result<ReadLog, FileError> {
    read_log_from(name, Cursor::new(bytes.to_vec()), options)
}

/// Reads a log from a table in memory; `name` stands for the file in messages, and rows count from 1.
///
/// # Errors
/// As [`parse_log`], or if the columns have different lengths.
pub fn read_table(name: &str, table: MemoryTable, options: &LogOptions) -> Result<ReadLog, FileError> {
    let options = ResolvedOptions::resolve(options)?;
    Held::of(table).and_then(|held| read(Table::Held(held), &options)).map_err(|error| error.in_file(name))
}

/// Reads a log from some rows of a file; `name` stands for the file in messages, and rows count from the first of them.
///
/// # Errors
/// As [`parse_log`].
pub fn read_part(name: &str, part: &FilePart, options: &LogOptions) -> Result<ReadLog, FileError> {
    let options = ResolvedOptions::resolve(options)?;
    let read = Table::of_part(part, options.dbc.as_deref()).and_then(|table| read(table, &options));
    read.map_err(|error| error.in_file(name))
}

/// Reads a log from a table.
///
/// Rows do not go into a [`LogBuilder`](fluxfit::log::LogBuilder) block by block: selection, alignment, repairs and the transforms
/// to dq need whole columns. The finished columns become the log at once, without a copy.
pub(super) fn read(mut table: Table, options: &ResolvedOptions) -> Result<ReadLog, FileError> {
    let mut notes: Vec<Note> = table.notes().iter().cloned().map(Note::from).collect();
    let line = table.line();
    let at_header = |error: FileError| line.map_or(error.clone(), |line| error.at_line(line));
    let layout = recognize(table.heads(), &mut notes).map_err(at_header)?;
    let named = layout.filter(|layout| !layout.is_canonical());
    let chosen = columns::choose(&table, named, options, &mut notes).map_err(|error| scope_trace::named(&mut table, options, error))?;
    let Gathered { mut channels, lines, is_interpolated, dropped_before } = gather(&mut table, &chosen, layout, options, &mut notes)?;
    notes.extend(event_times::settle(&mut channels).map(Note::from));
    rounded_time::refuse(&chosen, &channels)?;
    notes.extend(even_time::settle(&mut channels).map(Note::from));
    let aligned = align::align(&mut channels, &lines)?;
    let gaps = gaps_of_file(&channels, &dropped_before);
    plausibility::refuse_duties(&chosen, &channels)?;
    plausibility::refuse_digits(&chosen, &channels)?;
    channels.times_bus(&chosen)?;
    plausibility::refuse_standardized(&chosen, &channels)?;
    plausibility::refuse_per_unit(&chosen, &channels)?;
    plausibility::refuse_high_voltage(&chosen, &channels)?;
    plausibility::refuse_thousandths(&chosen, &channels)?;
    let is_interpolated = is_interpolated || aligned.is_some();
    let mut more: Vec<String> = aligned.into_iter().collect();
    phases::of_stator_frame(&mut channels);
    turning::settle(&mut channels, &chosen, &mut notes)?;
    more.extend(repair::repair(&mut channels));
    let of_phases = phases::give_all_axes(&channels);
    more.extend(phases::transform(&mut channels));
    more.extend(plausibility::note_references(&channels));
    notes.extend(more.into_iter().map(Note::from));
    let log = turned_frame::undone(log(channels, &chosen, &lines, &mut notes)?, of_phases, &mut notes);
    if !log.spikes().is_empty() {
        notes.push(log.spikes().to_string().into());
    }
    notes.extend(note_gaps(&gaps).into_iter().chain(plausibility::note_small_voltages(&chosen, &log)).map(Note::from));
    let source = Source { columns: vec![chosen::describe(&chosen)], notes: notes.iter().map(|note| note.sentence.clone()).collect() };
    let log = log.with_source(source);
    // Columns that were found without a mapping and without another layout have the canonical names.
    let layout = layout.or_else(|| (!options.has_headers()).then(Layout::canonical));
    let columns = chosen.iter().map(ReadColumn::of).collect();
    Ok(ReadLog { log: if is_interpolated { log.of_different_instants() } else { log }, layout, notes, columns, gaps })
}

/// The layout with these names, if it is one of the table and that of a log.
fn recognize(heads: &[ColumnHead], notes: &mut Vec<Note>) -> Result<Option<&'static Layout>, FileError> {
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let Some(layout) = Layout::recognize(&names) else { return Ok(None) };
    if let Some(refusal) = layout.refusal {
        return Err(Problem::NotALog { layout: layout.name, reason: refusal.reason(), advice: refusal.advice() }.into());
    }
    if !layout.is_canonical() {
        notes.push(format!("recognized the layout '{}': {}", layout.name, layout.remark).into());
    }
    Ok(Some(layout))
}

/// The checked log. An optional column that was not asked for is left out where the check would refuse the log because of it.
fn log(mut channels: Channels, chosen: &[ChosenColumn], lines: &Lines, notes: &mut Vec<Note>) -> Result<Log, FileError> {
    let locator = channels.locator(lines);
    let optional = Channel::OPTIONAL.map(|channel| {
        let values = channels.take(channel)?;
        let is_optional = chosen.iter().any(|column| column.channel == channel && column.is_optional);
        match check_values(channel.name(), &values) {
            Err(error) if is_optional => {
                notes.push(chosen::left_out(channel, &locator.locate(error)).into());
                None
            }
            _ => Some(values),
        }
    });
    let [theta_e, u_dc, temperature] = optional;
    let [t, ud, uq, id, iq, omega_e] = Channel::NEEDED.map(|channel| channels.take(channel).unwrap_or_default());
    Log::new(Columns { t, ud, uq, id, iq, omega_e, theta_e, u_dc, temperature }).map_err(|error| locator.locate(error))
}

/// Gaps in time between the rows of the file; not those where rows were dropped because there were too many.
fn gaps_of_file(channels: &Channels, dropped_before: &[usize]) -> Vec<(f64, f64)> {
    let Some(t) = channels.get(Channel::T) else { return Vec::new() };
    let stretches = without_gaps(t);
    let starts = stretches.iter().skip(1).map(|rows| rows.start).filter(|row| !dropped_before.contains(row));
    starts.map(|row| (t[row - 1], t[row])).collect()
}

/// A note on gaps in time.
fn note_gaps(gaps: &[(f64, f64)]) -> Option<String> {
    let (from, to) = *gaps.iter().max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))?;
    let longest = format!("{} s at t = {} s", significant(to - from, 3), significant(from, 6));
    Some(match gaps.len() {
        1 => format!("a gap of {longest}: nothing is computed across it"),
        count => format!("{count} gaps, the longest of {longest}: nothing is computed across them"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contradicting_options_are_refused() {
        let refusal = |options: LogOptions| parse_log("a.csv", b"", &options).unwrap_err().to_string();
        let map = |pairs: &[(&str, &str)]| LogOptions {
            map: pairs.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect(),
            ..LogOptions::default()
        };
        assert_eq!(refusal(map(&[("omega", "a"), ("omega_e", "b")])), "omega_e is given twice; give it once");
        let unknown = refusal(map(&[("uxx", "a")]));
        assert!(unknown.starts_with("\"uxx\" is not a channel of a log; the channels are t, ud, uq, id, iq and omega_e"), "{unknown}");
        let units = LogOptions { units: vec![("ud".into(), Unit::RpmMechanical)], ..LogOptions::default() };
        assert_eq!(refusal(units), "\"rpm-mech\" is not a unit of ud; it can be V, mV, kV or Vrms");
        let no_poles = LogOptions { pole_pairs: Some(0), ..LogOptions::default() };
        assert_eq!(refusal(no_poles), "the number of pole pairs is 0; it must be at least 1");
    }

    #[test]
    fn rows_that_no_drive_had_are_left_out_with_a_note() {
        let row = |k: usize| format!("{},1,20,0.1,3,{}\n", k as f64 * 1e-3, if k == 80 { 1e6 } else { 400.0 + (k % 3) as f64 });
        let text = format!("t,ud,uq,id,iq,omega_e\n{}", (0..160).map(row).collect::<String>());
        let read = parse_log("a.csv", text.as_bytes(), &LogOptions::default()).unwrap();
        assert_eq!((read.log.rows(), read.log.segments().len()), (159, 2));
        let sentence = "1 row with a value that no drive had is left out, as a gap: omega_e is 1e6 rad/s at t = 0.0800 s";
        assert!(read.log.source().notes.iter().any(|note| note == sentence), "{:?}", read.notes);
    }

    /// Ten seconds at 5 kHz, quiet from 2 to 8 s, and one lost second near the end; room for half of the rows.
    #[test]
    fn rows_that_are_dropped_are_no_gap_of_the_file() {
        let row = |k: usize| {
            let t = k as f64 * 2e-4 + if k >= 49_500 { 1.0 } else { 0.0 };
            let wave = if (10_000..40_000).contains(&k) { 0.0 } else { (k as f64 * 1e-3).sin() };
            format!("{t:.4},{},20,{wave},3,{}\n", 1.0 + wave, 400.0 + (k % 3) as f64)
        };
        let text = format!("t,ud,uq,id,iq,omega_e\n{}", (0..50_000).map(row).collect::<String>());
        let mut options = ResolvedOptions::resolve(&LogOptions::default()).unwrap();
        options.most_rows = 25_000;
        let table = Table::open(Bytes::Stream(Box::new(Cursor::new(text.into_bytes()))), None).unwrap();
        let read = read(table, &options).unwrap();
        assert_eq!(read.gaps.len(), 1, "{:?}", read.gaps);
        let (from, to) = read.gaps[0];
        assert!((from - 9.8998).abs() < 1e-9 && (to - 10.9).abs() < 1e-9, "{from} {to}");
        assert!(read.breaks(true).len() == 1 && !read.breaks(false).is_empty(), "{:?}", read.log.segments());
        let notes = &read.log.source().notes;
        assert!(notes.iter().any(|note| note.starts_with("a gap of 1.00 s at t = 9.89980 s")), "{notes:?}");
    }

    /// One row more than are selected of a long log, all of the same operating point.
    #[test]
    fn all_rows_of_a_long_log_are_used_where_they_are_asked_for() {
        let rows = crate::reading::selection::MOST_ROWS + 1;
        let row = |k: usize| format!("{:.4},1,20,0,3,400\n", k as f64 * 1e-4);
        let text = format!("t,ud,uq,id,iq,omega_e\n{}", (0..rows).map(row).collect::<String>());
        let read = parse_log("a.csv", text.as_bytes(), &LogOptions { all_rows: true, ..LogOptions::default() }).unwrap();
        assert_eq!((read.log.rows(), read.log.segments().len()), (rows, 1));
        let read = parse_log("a.csv", text.as_bytes(), &LogOptions::default()).unwrap();
        assert!(read.log.rows() < rows);
    }

    #[test]
    fn a_log_carries_its_columns_and_notes() {
        let read = parse_log("a.csv", b"t_ms,ud,uq,id,iq,omega_e\n0,1,2,3,4,5\n1,1,2,3,4,5\n", &LogOptions::default()).unwrap();
        let source = read.log.source();
        assert_eq!(source.notes, ["t: column 't_ms' read as ms"]);
        assert!(source.columns[0].starts_with("t = 't_ms' (ms), ud = 'ud' (V), "), "{source:?}");
    }
}
