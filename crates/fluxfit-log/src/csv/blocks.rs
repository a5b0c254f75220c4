//! A text in blocks of whole records, each with the number of its first line.

use super::text::{Text, read_up_to};
use fluxfit_files::FileError;
use std::io::{Cursor, Read};

/// Bytes of a block: so many that handing it to a thread takes no time beside a tenth of a millisecond of work, so few that it stays
/// in the cache of a core.
pub(super) const BLOCK: usize = 1 << 16;

/// A quotation of more bytes is a quotation mark that was never closed.
const LONGEST_QUOTATION: usize = 1 << 22;

/// A longer line is cut into pieces, which are then refused: no table has such lines.
const LONGEST_LINE: usize = 1 << 24;

/// Records, from the beginning of the first to the end of the last.
pub(super) struct TextBlock {
    pub(super) bytes: Vec<u8>,
    /// The number of its first line, from 1.
    pub(super) line: u64,
    /// Number of ends of lines.
    pub(super) lines: u64,
    /// The text ends with this block.
    pub(super) is_last: bool,
}

/// Cuts a text into blocks.
pub(super) struct Blocks {
    rest: Box<dyn Read>,
    is_gzip: bool,
    separator: u8,
    size: usize,
    /// Bytes after the last whole record of the block before.
    carried: Vec<u8>,
    line: u64,
    ended: bool,
}

impl Blocks {
    /// The text from an offset in its head on, which is the beginning of a line.
    pub(super) fn new(text: Text, from: usize, line: u64, separator: u8, size: usize) -> Self {
        let Text { head, rest, is_gzip, .. } = text;
        let mut head = Cursor::new(head.into_bytes());
        head.set_position(from as u64);
        Self { rest: Box::new(head.chain(rest)), is_gzip, separator, size, carried: Vec::new(), line, ended: false }
    }

    /// The next block, in the memory of `bytes`; none at the end.
    ///
    /// # Errors
    /// If reading fails.
    pub(super) fn next(&mut self, mut bytes: Vec<u8>) -> Result<Option<TextBlock>, FileError> {
        bytes.clear();
        bytes.append(&mut self.carried);
        while !self.ended {
            self.ended = read_up_to(&mut *self.rest, self.size, self.is_gzip, &mut bytes)? == 0;
            let end = if self.ended { bytes.len() } else { end_of_records(&bytes, self.separator) };
            if end > 0 {
                self.carried.extend_from_slice(&bytes[end..]);
                bytes.truncate(end);
                let (line, lines) = (self.line, ends_of_lines(&bytes));
                self.line += lines;
                return Ok(Some(TextBlock { bytes, line, lines, is_last: self.ended }));
            }
        }
        Ok(None)
    }
}

/// The end of the last complete record: after an end of line outside of quotations. 0 if there is none.
fn end_of_records(bytes: &[u8], separator: u8) -> usize {
    // As the reader of records sees it: a quotation begins with a mark at the beginning of a cell, and two marks in it are one of the
    // text.
    let begins_cell = |mark: usize| mark == 0 || [separator, b'\n', b'\r'].contains(&bytes[mark - 1]);
    let mut marks = memchr::memchr_iter(b'"', bytes).peekable();
    let (mut end, mut outside) = (0, 0);
    while let Some(mark) = marks.next() {
        if !begins_cell(mark) {
            continue;
        }
        end = last_end(bytes, outside, mark).unwrap_or(end);
        let closing = loop {
            let Some(closing) = marks.next() else { return before_quotation(bytes, end) };
            if marks.next_if_eq(&(closing + 1)).is_none() {
                break closing;
            }
        };
        outside = closing + 1;
    }
    end = last_end(bytes, outside, bytes.len()).unwrap_or(end);
    if end == 0 && bytes.len() > LONGEST_LINE { bytes.len() } else { end }
}

/// The end of the last record before a quotation that is open at the end, or within it if it is too long to be one.
fn before_quotation(bytes: &[u8], end: usize) -> usize {
    match bytes.len() {
        length if end == 0 && length > LONGEST_LINE => last_end(bytes, 0, length).unwrap_or(length),
        length if end == 0 && length > LONGEST_QUOTATION => last_end(bytes, 0, length).unwrap_or(0),
        _ => end,
    }
}

/// The last end of a line in a part. A `\r` counts only if the byte after it is known, and not if it is half of a `\r\n`.
fn last_end(bytes: &[u8], from: usize, to: usize) -> Option<usize> {
    let known = to.min(bytes.len().saturating_sub(1)).max(from);
    let newline = memchr::memrchr(b'\n', &bytes[from..to]);
    newline.or_else(|| memchr::memrchr(b'\r', &bytes[from..known])).map(|at| from + at + 1)
}

/// The number of ends of lines: `\n`, `\r\n` or `\r`.
fn ends_of_lines(bytes: &[u8]) -> u64 {
    let mut count = memchr::memchr_iter(b'\n', bytes).count();
    if let Some(first) = memchr::memchr(b'\r', bytes) {
        let rest = &bytes[first..];
        count += rest.iter().filter(|byte| **byte == b'\r').count() - rest.windows(2).filter(|pair| *pair == b"\r\n").count();
    }
    count as u64
}
