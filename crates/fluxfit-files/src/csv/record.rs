//! Records of a table of text: cells, and numbers in them.

use crate::{error::FileError, input::line_at, problem::Problem};
use ::csv::{ByteRecord, Reader, ReaderBuilder};

/// The number in a cell. `nan` and `inf` are numbers here: the log refuses them by row and column. A comma is a decimal one if it
/// does not separate.
#[inline]
pub fn number(cell: &[u8], separator: u8, scratch: &mut String) -> Option<f64> {
    let cell = trimmed(cell);
    if let Ok(number) = fast_float2::parse(cell) {
        return Some(number);
    }
    if separator == b',' || cell.contains(&b'.') {
        return None;
    }
    let (whole, fraction) = str::from_utf8(cell).ok()?.split_once(',')?;
    scratch.clear();
    scratch.extend([whole, ".", fraction]);
    // A second comma is still there and spoils it.
    fast_float2::parse(scratch.as_bytes()).ok()
}

/// Names, without those of trailing separators, and how many bytes they take with the end of the line.
pub fn first_record(text: &str, separator: u8) -> (Vec<String>, usize) {
    let mut reader = reader(text.as_bytes(), separator);
    let mut record = ByteRecord::new();
    if next(&mut reader, &mut record).is_err() {
        return (Vec::new(), text.len());
    }
    let mut names: Vec<String> = record.iter().map(|cell| lossy(trimmed(cell))).collect();
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    (names, place(reader.position().byte()))
}

/// The line, from 1, of the record that begins at or after `start`.
pub fn line_of(text: &str, start: usize) -> u64 {
    line_at(text.as_bytes(), begin(text.as_bytes(), start))
}

/// Where the record begins: the reader counts the blank lines above a record to it.
pub fn begin(bytes: &[u8], start: usize) -> usize {
    let start = start.min(bytes.len());
    start + bytes[start..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count()
}

/// Records of any length, without a header.
pub fn reader(bytes: &[u8], separator: u8) -> Reader<&[u8]> {
    ReaderBuilder::new().delimiter(separator).has_headers(false).flexible(true).from_reader(bytes)
}

/// The next record; whether there was one.
///
/// # Errors
/// If it cannot be read.
pub fn next(reader: &mut Reader<&[u8]>, record: &mut ByteRecord) -> Result<bool, FileError> {
    reader.read_byte_record(record).map_err(|error| Problem::Io { action: "reading", reason: error.to_string() }.into())
}

/// Where a record begins, blank lines above it included.
pub fn offset(record: &ByteRecord) -> usize {
    record.position().map_or(0, |position| place(position.byte()))
}

/// Offsets into bytes in memory fit.
pub fn place(offset: u64) -> usize {
    usize::try_from(offset).unwrap_or(usize::MAX)
}

/// Without spaces around, and without quotes that spaces hid from the reader.
pub fn trimmed(cell: &[u8]) -> &[u8] {
    let cell = cell.trim_ascii();
    match cell {
        [b'"', inside @ .., b'"'] => inside.trim_ascii(),
        _ => cell,
    }
}

/// A cell as text.
pub fn lossy(cell: &[u8]) -> String {
    String::from_utf8_lossy(cell).into_owned()
}
