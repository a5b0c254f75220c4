//! The rows: six numbers of each, those of the optional columns, and where it begins in the file.

use super::{
    columns::{Chosen, left_out},
    header::Header,
};
use crate::{
    channel::Channel,
    error::{FileError, Problem},
    input::line_at,
};
use ::csv::{ByteRecord, Reader, ReaderBuilder};

/// The columns as they are written, not yet in SI units.
pub(super) struct Rows<'a> {
    /// In the order of [`Channel::NEEDED`].
    pub(super) values: [Vec<f64>; 6],
    pub(super) optional: Vec<(&'a Chosen, Vec<f64>)>,
    /// Offset of each row in the text; its line is counted only when somebody asks.
    pub(super) starts: Vec<usize>,
}

/// A row on its way from cells to numbers.
struct Row<'a> {
    record: &'a ByteRecord,
    text: &'a str,
    start: usize,
    separator: u8,
    first: bool,
}

/// An optional column on its way.
struct Optional<'a> {
    column: &'a Chosen,
    values: Vec<f64>,
    /// Its own until the end: what may be left out does not decide the mark of the others.
    marks: Marks,
    refusal: Option<FileError>,
}

/// Offsets of rows with a decimal point and with a decimal comma.
#[derive(Default)]
struct Marks {
    point: Option<usize>,
    comma: Option<usize>,
}

pub(super) fn read<'a>(text: &str, header: &Header, chosen: &'a [Chosen], notes: &mut Vec<String>) -> Result<Rows<'a>, FileError> {
    let (needed, optional) = chosen.split_at(Channel::NEEDED.len());
    let mut optional: Vec<Optional> = optional.iter().map(Optional::new).collect();
    let mut rows = Rows { values: Default::default(), optional: Vec::new(), starts: Vec::new() };
    let mut marks = Marks::default();
    let mut scratch = String::new();
    let mut record = ByteRecord::new();
    let mut reader = reader(&text[header.body..], header.separator);
    while next(&mut reader, &mut record)? {
        let (start, first) = (header.body + offset(&record), rows.starts.is_empty());
        let row = Row { record: &record, text, start, separator: header.separator, first };
        let at_line = |error: FileError| error.at_line(line_of(text, start));
        if let Some(numbers) = row.numbers(header, needed, &mut marks, &mut scratch).map_err(at_line)? {
            rows.starts.push(start);
            rows.values.iter_mut().zip(numbers).for_each(|(column, number)| column.push(number));
            for column in &mut optional {
                column.push(&row, &mut scratch)?;
            }
        }
    }
    if rows.starts.is_empty() {
        return Err(FileError::from(Problem::NoRows).at_line(header.line));
    }
    for column in optional {
        rows.optional.extend(column.finish(text, header.separator, &mut marks, notes)?);
    }
    if marks.comma.is_some() {
        notes.push("decimal commas were read as decimal points".to_owned());
    }
    Ok(rows)
}

impl<'a> Optional<'a> {
    fn new(column: &'a Chosen) -> Self {
        Self { column, values: Vec::new(), marks: Marks::default(), refusal: None }
    }

    fn push(&mut self, row: &Row, scratch: &mut String) -> Result<(), FileError> {
        if self.refusal.is_some() {
            return Ok(());
        }
        match row.number(self.column, &mut self.marks, scratch) {
            Ok(number) => self.values.push(number),
            Err(error) => self.refuse(error.at_line(line_of(row.text, row.start)))?,
        }
        Ok(())
    }

    /// Leaves the column out, or refuses the log whose user asked for it.
    fn refuse(&mut self, error: FileError) -> Result<(), FileError> {
        if !self.column.dispensable {
            return Err(error);
        }
        self.values = Vec::new();
        self.refusal = Some(error);
        Ok(())
    }

    /// The column, if its decimal mark is that of the others; else, or if it was refused before, a note.
    fn finish(
        mut self,
        text: &str,
        separator: u8,
        others: &mut Marks,
        notes: &mut Vec<String>,
    ) -> Result<Option<(&'a Chosen, Vec<f64>)>, FileError> {
        if let (None, Some((own, other))) = (&self.refusal, self.marks.against(others)) {
            let cell = first_record(&text[own..], separator).0.into_iter().nth(self.column.index).unwrap_or_default();
            let problem = Problem::DecimalMarks { text: cell, other: line_of(text, other) };
            self.refuse(FileError::from(problem).in_column(&self.column.header).at_line(line_of(text, own)))?;
        }
        if let Some(error) = self.refusal {
            notes.push(left_out(self.column.channel, &error));
            return Ok(None);
        }
        others.take(&self.marks);
        Ok(Some((self.column, self.values)))
    }
}

impl Row<'_> {
    /// The needed numbers; none of a blank row.
    fn numbers(&self, header: &Header, needed: &[Chosen], marks: &mut Marks, scratch: &mut String) -> Result<Option<[f64; 6]>, FileError> {
        let expected = header.names.len();
        let found = self.record.len();
        // More cells than names are trailing separators, as long as they are empty.
        if found < expected || self.record.iter().skip(expected).any(|cell| !trimmed(cell).is_empty()) {
            if self.is_blank() {
                return Ok(None);
            }
            let multiline = self.record.as_slice().contains(&b'\n');
            return Err(Problem::RowLength { found, expected, multiline }.into());
        }
        let mut numbers = [0.0; 6];
        for (slot, column) in numbers.iter_mut().zip(needed) {
            match self.number(column, marks, scratch) {
                Ok(number) => *slot = number,
                Err(_) if self.is_blank() => return Ok(None),
                Err(_) if self.first && self.is_of_units(needed) => {
                    let cells: Vec<_> = self.record.iter().map(|cell| String::from_utf8_lossy(trimmed(cell))).collect();
                    return Err(Problem::UnitsRow { text: cells.join(", ") }.into());
                }
                Err(error) => return Err(error),
            }
        }
        Ok(Some(numbers))
    }

    /// The number of one column, whose decimal mark agrees with `marks`.
    #[inline(always)] // Called for each cell: 4 % of the reader's instructions.
    fn number(&self, column: &Chosen, marks: &mut Marks, scratch: &mut String) -> Result<f64, FileError> {
        let cell = self.cell(column);
        let Some(number) = number(cell, self.separator, scratch) else {
            return Err(FileError::from(refusal(cell, column.channel)).in_column(&column.header));
        };
        if self.separator != b','
            && let Some(other) = marks.disagree(cell, self.start)
        {
            let problem = Problem::DecimalMarks { text: lossy(cell), other: line_of(self.text, other) };
            return Err(FileError::from(problem).in_column(&column.header));
        }
        Ok(number)
    }

    fn cell(&self, column: &Chosen) -> &[u8] {
        trimmed(self.record.get(column.index).unwrap_or_default())
    }

    fn is_blank(&self) -> bool {
        self.record.iter().all(|cell| trimmed(cell).is_empty())
    }

    /// Text in every needed column.
    fn is_of_units(&self, needed: &[Chosen]) -> bool {
        let mut cells = needed.iter().map(|column| self.cell(column));
        cells.all(|cell| !cell.is_empty() && number(cell, self.separator, &mut String::new()).is_none())
    }
}

fn refusal(cell: &[u8], channel: Channel) -> Problem {
    let text = lossy(cell);
    if text.is_empty() {
        Problem::EmptyCell
    } else if channel == Channel::T && text.contains(':') {
        Problem::ClockTime { text }
    } else {
        Problem::NotANumber { text }
    }
}

impl Marks {
    /// Takes note of the cell's decimal mark; the offset of a row with the other mark, if there is one. Without this, the 1,234
    /// of a file with decimal points would be read as 1.234.
    fn disagree(&mut self, cell: &[u8], start: usize) -> Option<usize> {
        // Once points are the rule only a comma matters, and the other way around.
        if self.point.is_none() && cell.contains(&b'.') {
            self.point = Some(start);
        }
        if self.comma.is_none() && cell.contains(&b',') {
            self.comma = Some(start);
        }
        let (point, comma) = (self.point?, self.comma?);
        Some(if cell.contains(&b',') { point } else { comma })
    }

    /// Offsets of a row with a mark, and of a row of `others` with the other one.
    fn against(&self, others: &Self) -> Option<(usize, usize)> {
        self.point.zip(others.comma).or(self.comma.zip(others.point))
    }

    fn take(&mut self, others: &Self) {
        self.point = self.point.or(others.point);
        self.comma = self.comma.or(others.comma);
    }
}

/// The number in a cell. `nan` and `inf` are numbers here: the log refuses them by row and column. A comma is a decimal one if it
/// does not separate.
pub(super) fn number(cell: &[u8], separator: u8, scratch: &mut String) -> Option<f64> {
    let text = str::from_utf8(trimmed(cell)).ok()?;
    if let Ok(number) = text.parse() {
        return Some(number);
    }
    if separator == b',' || text.contains('.') {
        return None;
    }
    let (whole, fraction) = text.split_once(',')?;
    scratch.clear();
    scratch.extend([whole, ".", fraction]);
    // A second comma is still there and spoils it.
    scratch.parse().ok()
}

/// Names, without those of trailing separators, and how many bytes they take with the end of the line.
pub(super) fn first_record(text: &str, separator: u8) -> (Vec<String>, usize) {
    let mut reader = reader(text, separator);
    let mut record = ByteRecord::new();
    if next(&mut reader, &mut record).is_err() {
        return (Vec::new(), text.len());
    }
    let mut names: Vec<String> = record.iter().map(|cell| lossy(trimmed(cell))).collect();
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    (names, bytes(reader.position().byte()))
}

/// The line, from 1, of the record that begins at or after `start`: the reader counts the blank lines above a record to it.
pub(super) fn line_of(text: &str, start: usize) -> u64 {
    let ends = text.as_bytes()[start..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n'));
    line_at(text.as_bytes(), start + ends.count())
}

pub(super) fn reader(text: &str, separator: u8) -> Reader<&[u8]> {
    ReaderBuilder::new().delimiter(separator).has_headers(false).flexible(true).from_reader(text.as_bytes())
}

pub(super) fn next(reader: &mut Reader<&[u8]>, record: &mut ByteRecord) -> Result<bool, FileError> {
    reader.read_byte_record(record).map_err(|error| Problem::Io { action: "reading", reason: error.to_string() }.into())
}

pub(super) fn offset(record: &ByteRecord) -> usize {
    record.position().map_or(0, |position| bytes(position.byte()))
}

/// Offsets into a text in memory fit.
fn bytes(offset: u64) -> usize {
    usize::try_from(offset).unwrap_or(usize::MAX)
}

/// Without spaces around, and without quotes that spaces hid from the reader.
fn trimmed(cell: &[u8]) -> &[u8] {
    let cell = cell.trim_ascii();
    match cell {
        [b'"', inside @ .., b'"'] => inside.trim_ascii(),
        _ => cell,
    }
}

fn lossy(cell: &[u8]) -> String {
    String::from_utf8_lossy(cell).into_owned()
}
