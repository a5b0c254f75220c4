//! A log from a table, whatever it came in.
//!
//! ```text
//! log = table -> layout -> columns -> rows, in SI -> common instants -> repairs -> dq, speed -> checked
//! ```
//!
//! Whatever is done on the way that the file did not ask for is said in a note. What means nothing is refused: a standardized file,
//! references in place of measured currents, a flux map.
//!
//! Angle and DC voltage are optional. Where nobody asked for them, by `map`, nothing about them refuses a log: what cannot be read
//! is left out, with a note.

mod align;
mod clock;
mod columns;
mod doubt;
mod gather;
pub mod inspect;
mod kept;
pub mod layout;
pub mod mapping;
mod phases;
mod repair;
mod resemblance;
mod table;

use crate::block::Head;
use crate::{channel::Channel, problem::Problem};
use columns::Chosen;
use fluxfit::log::{self, Columns, Log};
use fluxfit_files::{FileError, input};
use fluxfit_units::{number::significant, unit::Unit};
use gather::Gathered;
use kept::Lines;
use layout::Layout;
use mapping::Mapping;
use std::path::Path;
use table::Table;

/// What the reader is told about a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LogOptions {
    /// Canonical name (`omega` and `theta` too) and header of the columns that the file names otherwise, as from
    /// [`parse_map`](crate::parse_map).
    pub map: Vec<(String, String)>,
    /// Canonical name and unit of the columns whose header does not say it, as from [`parse_unit`](crate::parse_unit).
    pub units: Vec<(String, Unit)>,
    /// Pole pairs: only a mechanical speed or angle needs them.
    pub pole_pairs: Option<u32>,
    /// What a mapping file says; the three above say otherwise where they speak.
    pub mapping: Mapping,
}

/// A log, and what had to be inferred to read it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadLog {
    /// The log, in SI units.
    pub log: Log,
    /// The layout that was recognized, if it is one of [`layout::LAYOUTS`].
    pub layout: Option<&'static Layout>,
    /// What was read as what, in a line: `t = 'time_s' (s), ..`.
    pub columns: String,
    /// Sentences for the user: units that headers named, columns taken under another name, what was repaired, what looks odd.
    pub notes: Vec<String>,
}

/// The options with their names understood.
#[derive(Clone)]
struct Told {
    headers: Vec<(Channel, String)>,
    units: Vec<(Channel, Unit)>,
    factors: Vec<(Channel, f64)>,
    pole_pairs: Option<u32>,
    sample_period: Option<f64>,
    /// Rows that are kept of a log that has more.
    most_rows: usize,
}

/// Columns of a log on their way, in SI.
#[derive(Debug, Clone, Default, PartialEq)]
struct Channels {
    columns: Vec<(Channel, Vec<f64>)>,
    /// The row of the file that each row was; empty while they are the same.
    origins: Vec<usize>,
    /// Headers, for messages.
    headers: Vec<(Channel, String)>,
}

/// Reads a log; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, or as [`parse_log`].
pub fn read_log(path: &Path, options: &LogOptions) -> Result<ReadLog, FileError> {
    read_log_watched(path, options, |_| ())
}

/// The same, for who waits: of a file of text, `watch` is told how many bytes more were read, several times a second.
///
/// # Errors
/// As [`read_log`].
pub fn read_log_watched(path: &Path, options: &LogOptions, watch: impl Fn(u64) + 'static) -> Result<ReadLog, FileError> {
    let told = Told::from(options)?;
    let read = input::open(path).and_then(|raw| Table::open(raw.watched(watch))).and_then(|table| read(table, &told));
    read.map_err(|error| error.in_file(&input::name(path)))
}

/// Reads a log from memory; `name` is the file's name in messages.
///
/// # Errors
/// If an option names no column of a log or none of the file, if the bytes are no table of numbers below a header, or if the
/// numbers are refused by [`Log::new`].
pub fn parse_log(name: &str, bytes: &[u8], options: &LogOptions) -> Result<ReadLog, FileError> {
    let told = Told::from(options)?;
    let raw = input::Raw::Stream(Box::new(std::io::Cursor::new(bytes.to_vec())));
    let read = Table::open(raw).and_then(|table| read(table, &told));
    read.map_err(|error| error.in_file(name))
}

fn read(mut table: Table, told: &Told) -> Result<ReadLog, FileError> {
    let mut notes = table.notes().to_vec();
    let line = table.line();
    let at_header = |error: FileError| line.map_or(error.clone(), |line| error.at_line(line));
    let layout = recognize(table.heads(), &mut notes).map_err(at_header)?;
    let named = layout.filter(|layout| !layout.is_canonical());
    let chosen = columns::choose(&table, named, told, &mut notes)?;
    let Gathered { mut channels, lines, is_moved } = gather::gather(&mut table, &chosen, layout, told, &mut notes)?;
    let aligned = align::align(&mut channels, &lines)?;
    doubt::refuse_standardized(&chosen, &channels)?;
    let is_interpolated = is_moved || aligned.is_some();
    notes.extend(aligned);
    notes.extend(repair::repair(&mut channels));
    notes.extend(phases::transform(&mut channels));
    notes.extend(doubt::note_references(&channels));
    let log = log(channels, &chosen, &lines, &mut notes)?;
    notes.extend(gaps(&log));
    // Columns that nobody and no layout named have the canonical names.
    let layout = layout.or_else(|| told.headers.is_empty().then(Layout::canonical));
    Ok(ReadLog {
        log: if is_interpolated { log.of_different_instants() } else { log },
        layout,
        columns: columns::described(&chosen),
        notes,
    })
}

/// The layout that the names tell, if it is a log's.
fn recognize(heads: &[Head], notes: &mut Vec<String>) -> Result<Option<&'static Layout>, FileError> {
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let Some(layout) = Layout::recognize(&names) else { return Ok(None) };
    if let Some(reason) = layout.refusal {
        return Err(Problem::NoLog { layout: layout.name, reason }.into());
    }
    if !layout.is_canonical() {
        notes.push(format!("the layout is that of {}: {}", layout.name, layout.remark));
    }
    Ok(Some(layout))
}

/// The log, checked; an optional column that nobody asked for is left out where the library would refuse the log for it.
fn log(mut channels: Channels, chosen: &[Chosen], lines: &Lines, notes: &mut Vec<String>) -> Result<Log, FileError> {
    let place = channels.placing(lines);
    let mut optional = [Channel::ThetaE, Channel::UDc].map(|channel| {
        let values = channels.take(channel)?;
        let is_dispensable = chosen.iter().any(|column| column.channel == channel && column.dispensable);
        match log::check_values(channel.name(), &values) {
            Err(error) if is_dispensable => {
                notes.push(columns::left_out(channel, &place.refuse(error)));
                None
            }
            _ => Some(values),
        }
    });
    let [theta_e, u_dc] = [0, 1].map(|k| optional[k].take());
    let [t, ud, uq, id, iq, omega_e] = Channel::NEEDED.map(|channel| channels.take(channel).unwrap_or_default());
    Log::new(Columns { t, ud, uq, id, iq, omega_e, theta_e, u_dc }).map_err(|error| place.refuse(error))
}

/// Where time jumps.
fn gaps(log: &Log) -> Option<String> {
    let t = &log.columns().t;
    let gap = |pair: &[log::Segment]| (t[pair[0].rows.end - 1], t[pair[1].rows.start]);
    let gaps: Vec<(f64, f64)> = log.segments().windows(2).map(gap).collect();
    let (from, to) = *gaps.iter().max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))?;
    let longest = format!("{} s at t = {} s", significant(to - from, 3), significant(from, 6));
    Some(match gaps.len() {
        1 => format!("a gap of {longest}: nothing is computed across it"),
        count => format!("{count} gaps, the longest of {longest}: nothing is computed across them"),
    })
}

/// Where rows and columns stand in the file.
struct Place {
    origins: Vec<usize>,
    headers: Vec<(Channel, String)>,
    lines: Lines,
}

impl Place {
    /// The library's error, at the line and under the header that the row and the column have in the file.
    fn refuse(&self, error: fluxfit::error::Error) -> FileError {
        let row = error.row().map(|row| self.origins.get(row).copied().unwrap_or(row));
        let header = error.column().and_then(|name| self.headers.iter().find(|(channel, _)| channel.name() == name));
        let mut located = FileError::from(Problem::Log(error));
        if let Some(row) = row {
            located = self.lines.place(located, row);
        }
        if let Some((_, header)) = header {
            located = located.in_column(header);
        }
        located
    }
}

impl Channels {
    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, values)| values.len())
    }

    fn iter(&self) -> impl Iterator<Item = (Channel, &[f64])> {
        self.columns.iter().map(|(channel, values)| (*channel, values.as_slice()))
    }

    fn get(&self, channel: Channel) -> Option<&[f64]> {
        self.iter().find(|(other, _)| *other == channel).map(|(_, values)| values)
    }

    fn set(&mut self, channel: Channel, values: Vec<f64>) {
        match self.columns.iter_mut().find(|(other, _)| *other == channel) {
            Some((_, old)) => *old = values,
            None => self.columns.push((channel, values)),
        }
    }

    fn take(&mut self, channel: Channel) -> Option<Vec<f64>> {
        let place = self.columns.iter().position(|(other, _)| *other == channel)?;
        Some(self.columns.swap_remove(place).1)
    }

    /// Keeps the rows that are marked.
    fn retain(&mut self, kept: &[bool]) {
        let marked = |row: &usize| kept.get(*row).copied().unwrap_or(false);
        self.origins = match self.origins.is_empty() {
            true => (0..kept.len()).filter(marked).collect(),
            false => (0..kept.len()).filter(marked).filter_map(|row| self.origins.get(row).copied()).collect(),
        };
        for (_, values) in &mut self.columns {
            let mut row = 0;
            values.retain(|_| {
                row += 1;
                kept[row - 1]
            });
        }
    }

    /// The refusal of a value in a column.
    fn refuse(&self, problem: Problem, channel: Channel, lines: &Lines, row: usize) -> FileError {
        let refused = lines.place(problem.into(), row);
        let header = self.headers.iter().find(|(other, _)| *other == channel);
        header.map_or(refused.clone(), |(_, header)| refused.in_column(header))
    }

    fn placing(&self, lines: &Lines) -> Place {
        Place { origins: self.origins.clone(), headers: self.headers.clone(), lines: lines.clone() }
    }
}

impl Told {
    fn from(options: &LogOptions) -> Result<Self, FileError> {
        if options.pole_pairs == Some(0) {
            return Err(Problem::ZeroPolePairs.into());
        }
        let mut headers: Vec<(Channel, String)> = Vec::new();
        for (name, header) in &options.map {
            let channel = Channel::from_name(name)?;
            if headers.iter().any(|(earlier, _)| *earlier == channel) {
                return Err(Problem::Twice { channel: channel.name() }.into());
            }
            headers.push((channel, header.trim().to_owned()));
        }
        let mut units: Vec<(Channel, Unit)> = Vec::new();
        for (name, unit) in &options.units {
            let channel = Channel::from_name(name)?;
            if unit.dimension() != channel.dimension() {
                return Err(crate::argument::wrong_unit(channel, unit.name()));
            }
            if units.iter().any(|(earlier, _)| *earlier == channel) {
                return Err(Problem::Twice { channel: channel.name() }.into());
            }
            units.push((channel, *unit));
        }
        let Mapping { pole_pairs, sample_period, park, columns } = &options.mapping;
        let mut factors: Vec<(Channel, f64)> =
            [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq].map(|channel| (channel, park.factor())).to_vec();
        for column in columns {
            if let Some(header) = column.header.clone().filter(|_| headers.iter().all(|(told, _)| *told != column.channel)) {
                headers.push((column.channel, header));
            }
            if let Some(unit) = column.unit.filter(|_| units.iter().all(|(told, _)| *told != column.channel)) {
                units.push((column.channel, unit));
            }
            factors.push((column.channel, column.factor));
        }
        let pole_pairs = options.pole_pairs.or(*pole_pairs);
        Ok(Self { headers, units, factors, pole_pairs, sample_period: *sample_period, most_rows: kept::MOST_ROWS })
    }

    fn header(&self, channel: Channel) -> Option<&str> {
        self.headers.iter().find(|(told, _)| *told == channel).map(|(_, header)| header.as_str())
    }

    fn unit(&self, channel: Channel) -> Option<Unit> {
        self.units.iter().find(|(told, _)| *told == channel).map(|(_, unit)| *unit)
    }

    fn factor(&self, channel: Channel) -> f64 {
        self.factors.iter().filter(|(told, _)| *told == channel).map(|(_, factor)| factor).product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_contradict_are_refused() {
        let refusal = |options: LogOptions| parse_log("a.csv", b"", &options).unwrap_err().to_string();
        let map = |pairs: &[(&str, &str)]| LogOptions {
            map: pairs.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect(),
            ..LogOptions::default()
        };
        assert_eq!(refusal(map(&[("omega", "a"), ("omega_e", "b")])), "omega_e is given twice; give it once");
        assert!(refusal(map(&[("uxx", "a")])).starts_with("\"uxx\" is no column of a log; the columns are t, ud, uq, id, iq and omega_e"));
        let units = LogOptions { units: vec![("ud".into(), Unit::RpmMechanical)], ..LogOptions::default() };
        assert_eq!(refusal(units), "\"rpm-mech\" is no unit of ud; it can be V or mV");
        assert_eq!(
            refusal(LogOptions { pole_pairs: Some(0), ..LogOptions::default() }),
            "0 pole pairs are no motor; give --pole-pairs 1 or more"
        );
    }
}
