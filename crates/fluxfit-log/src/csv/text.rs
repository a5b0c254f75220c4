//! Text as it comes: unpacked, decoded to UTF-8, a block of whole lines at a time.

use crate::problem::Problem;
use encoding_rs::WINDOWS_1252;
use encoding_rs_io::DecodeReaderBytesBuilder;
use flate2::read::MultiGzDecoder;
use fluxfit_files::{
    FileError, Problem as FileProblem,
    input::{io_problem, line_at},
};
use std::io::{Cursor, Read};

/// Bytes of the first block, in which the header has to be.
const HEAD: usize = 1 << 20;

/// Bytes of the others: enough that their ends cost nothing.
const BLOCK: usize = 1 << 20;

/// A quotation over more bytes than this is no quotation, but a mark that was never closed.
const LONGEST_QUOTATION: usize = 1 << 22;

/// A line of more bytes is cut, and what comes out refused: no table has it.
const LONGEST_LINE: usize = 1 << 24;

/// The first bytes of what `gzip` packs (RFC 1952).
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Documents that are taken for tables, by their first bytes.
const DOCUMENTS: [(&[u8], &str); 4] = [
    (b"PK\x03\x04", "an Excel workbook, or another zip archive"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook"),
    (b"%PDF", "a PDF"),
    (b"{\\rtf", "a text with formats"),
];

/// Unpacked, decoded text.
pub(crate) struct Text {
    /// Its beginning; all of it, if it is short.
    pub(super) head: String,
    rest: Box<dyn Read>,
    is_packed: bool,
    /// What had to be inferred.
    pub(super) notes: Vec<String>,
}

impl Text {
    /// Unpacks gzip, decodes UTF-16 and UTF-8 by their byte order marks, and what is no UTF-8 as Windows-1252, which every byte is.
    ///
    /// # Errors
    /// If it cannot be read, is empty, or is binary.
    pub(crate) fn open(mut raw: Box<dyn Read>) -> Result<Self, FileError> {
        let mut notes = Vec::new();
        let magic = read_up_to(&mut *raw, GZIP.len(), false)?;
        let is_packed = magic == GZIP;
        let raw: Box<dyn Read> = Box::new(Cursor::new(magic).chain(raw));
        let raw: Box<dyn Read> = if is_packed { Box::new(MultiGzDecoder::new(raw)) } else { raw };
        let mut decoded = DecodeReaderBytesBuilder::new().utf8_passthru(true).strip_bom(true).build(raw);
        let head = read_up_to(&mut decoded, HEAD, is_packed)?;
        if let Some((_, what)) = DOCUMENTS.iter().find(|(start, _)| head.starts_with(start)) {
            return Err(Problem::Document { what }.into());
        }
        if let Some(at) = head.iter().position(|byte| *byte == 0) {
            return Err(FileError::from(FileProblem::NotText { wanted: "CSV text" }).at_line(line_at(&head, at)));
        }
        if head.trim_ascii().is_empty() {
            return Err(FileProblem::Empty.into());
        }
        let mut text = Self { head: String::new(), rest: Box::new(decoded), is_packed, notes: Vec::new() };
        text.head = match String::from_utf8(head) {
            Ok(head) => head,
            // The block may end within a character.
            Err(error) if error.utf8_error().error_len().is_none() => {
                let (end, mut bytes) = (error.utf8_error().valid_up_to(), error.into_bytes());
                let cut = bytes.split_off(end);
                text.rest = Box::new(Cursor::new(cut).chain(text.rest));
                String::from_utf8_lossy(&bytes).into_owned()
            }
            Err(error) => {
                notes.push("the file is no UTF-8; it was read as Windows-1252".to_owned());
                let (head, _, _) = WINDOWS_1252.decode(error.as_bytes());
                text.rest = Box::new(DecodeReaderBytesBuilder::new().encoding(Some(WINDOWS_1252)).bom_sniffing(false).build(text.rest));
                head.into_owned()
            }
        };
        text.notes = notes;
        Ok(text)
    }

    /// The rest of it from an offset in the head, in blocks of whole lines; each with the number of its first line, and whether it
    /// is the last one.
    pub(super) fn blocks(
        self,
        from: usize,
        first_line: u64,
        mut take: impl FnMut(&[u8], u64, bool) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let Self { head, mut rest, is_packed, .. } = self;
        let mut bytes = head.into_bytes();
        bytes.drain(..from);
        let mut line = first_line;
        loop {
            let more = read_up_to(&mut *rest, BLOCK, is_packed)?;
            let ended = more.is_empty();
            // What was held back before has no end in it: only what is new is searched, unless it is all there is.
            bytes.extend(more);
            let end = if ended { bytes.len() } else { end_of_lines(&bytes) };
            if end > 0 {
                take(&bytes[..end], line, ended)?;
                line += lines(&bytes[..end]);
                bytes.drain(..end);
            }
            if ended {
                return Ok(());
            }
        }
    }
}

/// Where the last whole record ends: behind a line's end outside of quotes.
fn end_of_lines(bytes: &[u8]) -> usize {
    let last_end = |bytes: &[u8]| memchr::memrchr(b'\n', bytes).or_else(|| lone_return(bytes)).map_or(0, |at| at + 1);
    let mut end = last_end(bytes);
    if end == 0 && bytes.len() > LONGEST_LINE {
        return bytes.len();
    }
    let marks = memchr::memchr_iter(b'"', &bytes[..end]).count();
    if marks.is_multiple_of(2) || bytes.len() > LONGEST_QUOTATION {
        return end;
    }
    // Back over the open quotation to a line's end before it.
    if let Some(open) = memchr::memrchr(b'"', &bytes[..end]) {
        end = last_end(&bytes[..open]);
        if !memchr::memchr_iter(b'"', &bytes[..end]).count().is_multiple_of(2) {
            end = 0;
        }
    }
    end
}

/// The last `\r` with something behind it: in the last place a `\n` may follow.
fn lone_return(bytes: &[u8]) -> Option<usize> {
    memchr::memrchr(b'\r', bytes.split_last()?.1)
}

/// Line ends: `\n`, `\r\n` or `\r`.
fn lines(bytes: &[u8]) -> u64 {
    line_at(bytes, bytes.len()) - 1
}

/// The next `most` bytes, fewer only at the end.
fn read_up_to(reader: &mut dyn Read, most: usize, is_packed: bool) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    match reader.take(most as u64).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) if is_packed => Err(Problem::Packed { reason: error.to_string() }.into()),
        Err(error) => Err(io_problem("reading", &error).into()),
    }
}
