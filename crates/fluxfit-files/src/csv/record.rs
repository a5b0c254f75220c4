//! Records of a table of text: cells, and numbers in them.

use crate::{error::FileError, input::line_at, problem::Problem};
use ::csv::{ByteRecord, Reader, ReaderBuilder};

/// The number in a cell, if it is one. `nan` and `inf` count as numbers here: the log refuses them by row and column. A comma is a
/// decimal comma, unless the cells were split at commas without regard to quotation marks.
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
    // A second comma is still there, and makes it not a number.
    fast_float2::parse(scratch.as_bytes()).ok()
}

/// The number with which a text begins, and its length in bytes; of a cell that is nothing but a number, the same as [`number`].
#[inline]
pub fn leading_number(text: &[u8]) -> Option<(f64, usize)> {
    fast_float2::parse_partial(text).ok()
}

/// The cells of the first record, without empty ones at its end, and its length in bytes including the end of the line.
pub fn first_record(text: &str, separator: u8) -> (Vec<String>, usize) {
    let (bytes, start) = (text.as_bytes(), begin(text.as_bytes(), 0));
    let end = memchr::memchr2(b'\r', b'\n', &bytes[start..]).map_or(bytes.len(), |at| start + at);
    let mut names: Vec<String>;
    let length;
    // A line without quotation marks is a record as it is. Setting up a reader would cost more than reading it.
    if memchr::memchr(b'"', &bytes[start..end]).is_none() {
        names = bytes[start..end].split(|byte| *byte == separator).map(|cell| text_of(trimmed(cell))).collect();
        length = if bytes[end..].starts_with(b"\r\n") { end + 2 } else { bytes.len().min(end + 1) };
    } else {
        (names, length) = first_of_any(text, separator);
    }
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    (names, length)
}

fn first_of_any(text: &str, separator: u8) -> (Vec<String>, usize) {
    let mut reader = reader(text.as_bytes(), separator);
    let mut record = ByteRecord::new();
    if next(&mut reader, &mut record).is_err() {
        return (Vec::new(), text.len());
    }
    (record.iter().map(|cell| text_of(trimmed(cell))).collect(), in_memory(reader.position().byte()))
}

/// Lines with their offsets; they end with `\n`, `\r\n` or `\r`.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut offset = 0;
    std::iter::from_fn(move || {
        let rest = text.get(offset..).filter(|rest| !rest.is_empty())?;
        let length = rest.find(['\n', '\r']).map_or(rest.len(), |at| if rest[at..].starts_with("\r\n") { at + 2 } else { at + 1 });
        let line = (offset, &rest[..length]);
        offset += length;
        Some(line)
    })
}

/// The line, from 1, of the record that begins at or after `start`.
pub fn line_of(text: &str, start: usize) -> u64 {
    line_at(text.as_bytes(), begin(text.as_bytes(), start))
}

/// The offset of the record that begins at or after `start`: the reader counts blank lines above a record as part of it.
pub fn begin(bytes: &[u8], start: usize) -> usize {
    let start = start.min(bytes.len());
    start + bytes[start..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count()
}

/// A reader of records of any length, without a header.
pub fn reader(bytes: &[u8], separator: u8) -> Reader<&[u8]> {
    ReaderBuilder::new().delimiter(separator).has_headers(false).flexible(true).from_reader(bytes)
}

/// Reads the next record; false at the end.
///
/// # Errors
/// If it cannot be read.
pub fn next(reader: &mut Reader<&[u8]>, record: &mut ByteRecord) -> Result<bool, FileError> {
    reader.read_byte_record(record).map_err(|error| Problem::Io { action: "reading", reason: error.to_string() }.into())
}

/// Where a record begins, blank lines above it included.
pub fn offset(record: &ByteRecord) -> usize {
    record.position().map_or(0, |position| in_memory(position.byte()))
}

/// An offset into bytes in memory, which always fits.
pub fn in_memory(offset: u64) -> usize {
    usize::try_from(offset).unwrap_or(usize::MAX)
}

/// The cell without spaces around it, and without quotes that the reader did not recognize because of those spaces.
pub fn trimmed(cell: &[u8]) -> &[u8] {
    let cell = cell.trim_ascii();
    match cell {
        [b'"', inside @ .., b'"'] => inside.trim_ascii(),
        _ => cell,
    }
}

/// A cell as text; invalid bytes are replaced.
pub fn text_of(cell: &[u8]) -> String {
    String::from_utf8_lossy(cell).into_owned()
}
