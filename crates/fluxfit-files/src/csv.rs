//! A log from a table of text.
//!
//! ```text
//! log = bytes -> text -> header -> columns -> rows -> SI units -> checked
//! ```
//!
//! Read without being told: comma, semicolon or tab, also at the end of a line; quotes and spaces around names and values; a byte
//! order mark; `#` and `%` comments above the header; blank lines; columns in any order, and others among them; a decimal comma,
//! unless the comma separates. Of a log of millions of rows only the needed cells become numbers.
//!
//! Angle and DC voltage are optional. Where nobody asked for them, by `map`, nothing about them refuses a log: what cannot be read
//! is left out, with a note.

mod columns;
pub(crate) mod flux_map;
mod header;
mod resemblance;
mod rows;

use crate::{
    channel::Channel,
    error::{FileError, Problem},
    input,
    unit::Unit,
};
use columns::Chosen;
use fluxfit::log::{self, Columns, Log};
use std::path::Path;

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
}

/// A log, and what had to be inferred to read it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadLog {
    /// The log, in SI units.
    pub log: Log,
    /// Sentences for the user: units that headers named, columns taken under another name, what looks odd.
    pub notes: Vec<String>,
}

/// The options with their names understood.
struct Told {
    headers: Vec<(Channel, String)>,
    units: Vec<(Channel, Unit)>,
    pole_pairs: Option<u32>,
}

/// Reads a log; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, or as [`parse_log`].
pub fn read_log(path: &Path, options: &LogOptions) -> Result<ReadLog, FileError> {
    parse_log(&input::name(path), &input::read(path)?, options)
}

/// Reads a log from memory; `name` is the file's name in messages.
///
/// # Errors
/// If an option names no column of a log or none of the file, if the bytes are no table of numbers below a header, or if the
/// numbers are refused by [`Log::new`].
pub fn parse_log(name: &str, bytes: &[u8], options: &LogOptions) -> Result<ReadLog, FileError> {
    let told = Told::from(options)?;
    let parsed = input::text(bytes, "CSV text").and_then(|text| parse(text, &told));
    parsed.map_err(|error| error.in_file(name))
}

fn parse(text: &str, told: &Told) -> Result<ReadLog, FileError> {
    let mut notes = Vec::new();
    let header = header::find(text, &mut notes)?;
    let chosen = columns::choose(&header, told, &mut notes)?;
    let mut rows = rows::read(text, &header, &chosen, &mut notes)?;
    if looks_normalized(&rows.values[1..]) {
        notes.push(NORMALIZED.to_owned());
    }
    let to_si = |column: &Chosen, values: &mut [f64]| column.unit.to_si(values, told.pole_pairs.unwrap_or(1));
    for (column, values) in chosen.iter().zip(&mut rows.values) {
        to_si(column, values);
    }
    let [t, ud, uq, id, iq, omega_e] = rows.values;
    let mut columns = Columns { t, ud, uq, id, iq, omega_e, ..Columns::default() };
    let refuse = |error| located(error, text, &chosen, &rows.starts);
    for (column, mut values) in rows.optional {
        to_si(column, &mut values);
        // The library would refuse the log for it.
        if column.dispensable
            && let Err(error) = log::check_values(column.channel.name(), &values)
        {
            notes.push(columns::left_out(column.channel, &refuse(error)));
            continue;
        }
        match column.channel {
            Channel::ThetaE => columns.theta_e = Some(values),
            _ => columns.u_dc = Some(values),
        }
    }
    let log = Log::new(columns).map_err(refuse)?;
    Ok(ReadLog { log, notes })
}

/// The library's error, at the line and under the header that the row and the column have in the file.
fn located(error: fluxfit::error::Error, text: &str, chosen: &[Chosen], starts: &[usize]) -> FileError {
    let line = error.row().and_then(|row| starts.get(row)).map(|start| rows::line_of(text, *start));
    let header = error.column().and_then(|name| chosen.iter().find(|column| column.channel.name() == name)).map(|column| &column.header);
    let mut located = FileError::from(Problem::Log(error));
    if let Some(line) = line {
        located = located.at_line(line);
    }
    if let Some(header) = header {
        located = located.in_column(header);
    }
    located
}

const NORMALIZED: &str = "ud, uq, id, iq and omega_e all have a mean near 0 and a standard deviation near 1: this looks like a normalized file, whose values are not in V, A and rad/s; \
                          identify from the original";

/// A mean of less than this many standard deviations is near zero,
const NORMALIZED_MEAN: f64 = 0.2;

/// and a standard deviation in this range near one. An excerpt of a normalized file is neither exactly; of a drive, no five
/// channels are all like that: its speed alone would have to swing by about 1 rad/s around standstill.
const NORMALIZED_DEVIATION: std::ops::Range<f64> = 0.5..1.5;

/// Fewest rows whose mean and deviation say anything.
const NORMALIZED_ROWS: usize = 20;

fn looks_normalized(channels: &[Vec<f64>]) -> bool {
    channels.iter().all(|values| {
        let rows = values.len() as f64;
        let mean = values.iter().sum::<f64>() / rows;
        let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / rows).sqrt();
        values.len() >= NORMALIZED_ROWS && NORMALIZED_DEVIATION.contains(&deviation) && mean.abs() < NORMALIZED_MEAN * deviation
    })
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
        Ok(Self { headers, units, pole_pairs: options.pole_pairs })
    }

    fn header(&self, channel: Channel) -> Option<&str> {
        self.headers.iter().find(|(told, _)| *told == channel).map(|(_, header)| header.as_str())
    }

    fn unit(&self, channel: Channel) -> Option<Unit> {
        self.units.iter().find(|(told, _)| *told == channel).map(|(_, unit)| *unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normalized_file_is_noted_and_a_drive_is_not() {
        let wave = |phase: f64| (0..100).map(|i| 1.3 * (f64::from(i) * 0.3 + phase).sin()).collect::<Vec<_>>();
        let normalized: Vec<Vec<f64>> = (0..5).map(|i| wave(f64::from(i))).collect();
        assert!(looks_normalized(&normalized));
        let mut turning = normalized.clone();
        turning[4].iter_mut().for_each(|speed| *speed += 100.0);
        assert!(!looks_normalized(&turning));
        assert!(!looks_normalized(&[vec![f64::NAN; 50]]));
        assert!(!looks_normalized(&[vec![]]));
    }

    #[test]
    fn options_that_contradict_are_refused() {
        let refusal = |options: LogOptions| parse_log("a.csv", b"", &options).unwrap_err().to_string();
        let map = |pairs: &[(&str, &str)]| LogOptions {
            map: pairs.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect(),
            ..LogOptions::default()
        };
        assert_eq!(refusal(map(&[("omega", "a"), ("omega_e", "b")])), "omega_e is given twice; give it once");
        assert_eq!(
            refusal(map(&[("uxx", "a")])),
            "\"uxx\" is no column of a log; the columns are t, ud, uq, id, iq and omega_e, and optionally theta_e and u_dc"
        );
        let units = LogOptions { units: vec![("ud".into(), Unit::RpmMechanical)], ..LogOptions::default() };
        assert_eq!(refusal(units), "\"rpm-mech\" is no unit of ud; it can be V or mV");
        assert_eq!(
            refusal(LogOptions { pole_pairs: Some(0), ..LogOptions::default() }),
            "0 pole pairs are no motor; give --pole-pairs 1 or more"
        );
    }
}
