//! LabVIEW measurement files (LVM): a header, and segments of rows with headers of their own.
//!
//! `X_Columns` says how times are written: one column for all channels, one for each channel, or none, where they follow from `X0` and
//! `Delta_X`.

use super::memory::Table;
use crate::{block::ColumnHead, container::MOST_COLUMNS, csv::Text, instant::Instants, problem::Problem};
use fluxfit_files::{FileError, Problem as FileProblem, csv::record::number, input::io_problem};
use std::io::{BufRead, BufReader, Cursor, Read};

const START: &str = "LabVIEW Measurement";
const END_OF_HEADER: &str = "***End_of_Header***";

/// Bytes of the longest line.
const LONGEST_LINE: u64 = 1 << 20;

/// Whether a text is such a file.
pub(super) fn is_lvm(head: &str) -> bool {
    head.starts_with(START)
}

/// How times are written.
#[derive(Clone, Copy, PartialEq)]
enum Times {
    One,
    Each,
    None,
}

/// What the headers say.
struct Lvm {
    separator: char,
    is_comma: bool,
    times: Times,
    /// Of the current segment: values of its header by key, and its names.
    keys: Vec<(String, Vec<String>)>,
    names: Vec<String>,
    /// When the first segment started.
    start: Option<Instants>,
    /// What is added to the times of the current segment, s.
    offset: f64,
    columns: Vec<Vec<f64>>,
    lines: Vec<u64>,
}

/// Reads all segments.
pub(super) fn read(text: Text) -> Result<Table, FileError> {
    let mut bytes = BufReader::new(Cursor::new(text.head.into_bytes()).chain(text.rest));
    let mut lvm = Lvm {
        separator: '\t',
        is_comma: false,
        times: Times::One,
        keys: Vec::new(),
        names: Vec::new(),
        start: None,
        offset: 0.0,
        columns: Vec::new(),
        lines: Vec::new(),
    };
    let (mut line, mut number, mut is_special, mut is_header) = (Vec::new(), 0_u64, false, true);
    loop {
        line.clear();
        let count =
            (&mut bytes).take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(|error| FileError::from(io_problem("reading", &error)))?;
        if count == 0 {
            break;
        }
        number += 1;
        if count as u64 == LONGEST_LINE {
            return Err(FileError::from(Problem::Lvm { reason: "a line of it is too long" }).at_line(number));
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end_matches(['\r', '\n']);
        let first = text.trim();
        if first.starts_with("***Start_Special***") || first.starts_with("***End_Special***") {
            is_special = first.starts_with("***Start");
            continue;
        }
        if is_special || first.is_empty() {
            continue;
        }
        let cells: Vec<&str> = text.split(lvm.separator).map(str::trim).collect();
        match (is_header, first.starts_with(END_OF_HEADER)) {
            (_, true) => is_header = false,
            (true, false) => lvm.key(&cells),
            (false, false) if cells[0] == "Channels" => {
                lvm.keys.retain(|(key, _)| {
                    !["Channels", "Samples", "Date", "Time", "Y_Unit_Label", "X_Dimension", "X0", "Delta_X"].contains(&key.as_str())
                });
                lvm.key(&cells);
                is_header = true;
            }
            (false, false) if cells[0] == "X_Value" => lvm.segment(&cells).map_err(|error| error.at_line(number))?,
            (false, false) => lvm.row(&cells, number).map_err(|error| error.at_line(number))?,
        }
    }
    lvm.table()
}

impl Lvm {
    fn key(&mut self, cells: &[&str]) {
        match (cells[0], cells.get(1).copied().unwrap_or_default()) {
            // Before the separator is known, a comma is part of the text.
            ("Separator", "Comma") | ("Separator,Comma", _) => self.separator = ',',
            ("Decimal_Separator", mark) => self.is_comma = mark == ",",
            ("X_Columns", "Multi") => self.times = Times::Each,
            ("X_Columns", "No") => self.times = Times::None,
            (key, _) => self.keys.push((key.to_owned(), cells[1..].iter().map(|cell| (*cell).to_owned()).collect())),
        }
    }

    /// A value that the header of the segment has for a channel.
    fn of_channel(&self, key: &str, channel: usize) -> Option<&str> {
        let (_, values) = self.keys.iter().rfind(|(known, _)| known == key)?;
        values.get(channel).map(String::as_str).filter(|value| !value.is_empty())
    }

    fn number(&self, cell: &str) -> Option<f64> {
        number(cell.as_bytes(), if self.is_comma { b';' } else { b',' }, &mut String::new())
    }

    /// The names of a segment.
    fn segment(&mut self, cells: &[&str]) -> Result<(), FileError> {
        let mut names: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
        while names.last().is_some_and(|name| name.is_empty() || name == "Comment") {
            names.pop();
        }
        if names.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
        if !self.names.is_empty() && self.names != names {
            return Err(Problem::Lvm { reason: "its segments have different channels" }.into());
        }
        let is_layout_clear = match self.times {
            Times::Each => names.len().is_multiple_of(2) && names.iter().step_by(2).all(|name| name == "X_Value"),
            _ => names[1..].iter().all(|name| name != "X_Value"),
        };
        if !is_layout_clear || names.len() < 2 {
            return Err(Problem::Lvm { reason: "its columns are not those that X_Columns says" }.into());
        }
        let stamp = self.of_channel("Date", 0).zip(self.of_channel("Time", 0)).map(|(date, time)| {
            let end = time.len().min(time.find(['.', ',']).map_or(time.len(), |at| at + 10));
            // In a damaged file the ninth digit may be a part of a letter: then it is no time, whole or cut.
            format!("{date} {}", time.get(..end).unwrap_or(time))
        });
        match (&self.start, stamp) {
            (None, Some(stamp)) => self.start = Instants::of(&[&stamp]),
            (Some(start), Some(stamp)) => self.offset = start.seconds(stamp.as_bytes()).unwrap_or(0.0),
            _ => {}
        }
        self.columns.resize(names.len(), Vec::new());
        self.names = names;
        Ok(())
    }

    fn row(&mut self, cells: &[&str], line: u64) -> Result<(), FileError> {
        if self.names.is_empty() {
            return Err(Problem::Lvm { reason: "it has no line with the names of its channels" }.into());
        }
        let last = self.columns[0].iter().rev().find(|value| !value.is_nan()).copied();
        for place in 0..self.names.len() {
            let cell = cells.get(place).copied().unwrap_or_default();
            let value = match self.number(cell) {
                Some(value) => value,
                None if cell.is_empty() => f64::NAN,
                None => return Err(FileError::from(FileProblem::NotANumber { text: cell.to_owned() }).in_column(&self.names[place])),
            };
            let is_time = place == 0 || self.times == Times::Each && place % 2 == 0;
            self.columns[place].push(value);
            if is_time && let (Some(time), Some(last)) = (self.columns[place].last_mut(), last) {
                // A later segment counts from its own start.
                if self.offset > 0.0 && *time + self.offset > last {
                    *time += self.offset;
                }
            }
        }
        self.lines.push(line);
        Ok(())
    }

    fn table(mut self) -> Result<Table, FileError> {
        if self.lines.is_empty() {
            return Err(Problem::NoRows.into());
        }
        let mut table = Table { lines: self.lines.clone(), ..Table::default() };
        let unit = |lvm: &Self, channel: usize| lvm.of_channel("Y_Unit_Label", channel).map(str::to_owned);
        let is_time = self.of_channel("X_Dimension", 0).is_none_or(|dimension| dimension == "Time");
        let time = |name: &str, group: usize| ColumnHead {
            name: name.to_owned(),
            unit: Some("s".to_owned()),
            group,
            is_time,
            ..ColumnHead::default()
        };
        let columns = std::mem::take(&mut self.columns);
        let names = self.names.clone();
        match self.times {
            Times::One => {
                for (place, (name, values)) in names.iter().zip(columns).enumerate() {
                    let head = ColumnHead { name: name.clone(), unit: unit(&self, place.max(1) - 1), ..ColumnHead::default() };
                    table.push(if place == 0 { time(name, 0) } else { head }, values);
                }
            }
            Times::Each => {
                table.lines.clear();
                let mut columns = columns.into_iter();
                for channel in 0..names.len() / 2 {
                    let (Some(t), Some(values)) = (columns.next(), columns.next()) else { break };
                    // The rows are as many as the longest channel has.
                    let (t, values): (Vec<f64>, Vec<f64>) =
                        t.into_iter().zip(values).filter(|(t, value)| !t.is_nan() && !value.is_nan()).unzip();
                    let name = &names[2 * channel + 1];
                    let head = ColumnHead { name: name.clone(), unit: unit(&self, channel), group: channel, ..ColumnHead::default() };
                    table.push(time(&format!("{name}.X_Value"), channel), t);
                    table.push(head, values);
                }
            }
            Times::None => {
                let start = |lvm: &Self, key: &str, channel: usize| lvm.of_channel(key, channel).and_then(|value| lvm.number(value));
                let clocks: Vec<Option<(f64, f64)>> =
                    (0..names.len() - 1).map(|channel| start(&self, "X0", channel).zip(start(&self, "Delta_X", channel))).collect();
                let Some((x0, step)) = clocks[0].filter(|_| clocks.iter().all(|clock| *clock == clocks[0])) else {
                    return Err(Problem::Lvm { reason: "it has no times, and its channels not one X0 and Delta_X" }.into());
                };
                let rows = table.lines.len();
                table.push(time("X_Value", 0), (0..rows).map(|row| x0 + row as f64 * step).collect());
                for (channel, (name, values)) in names.iter().zip(columns).skip(1).enumerate() {
                    table.push(ColumnHead { name: name.clone(), unit: unit(&self, channel), ..ColumnHead::default() }, values);
                }
            }
        }
        Ok(table)
    }
}
