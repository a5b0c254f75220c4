//! Text: decompressed, decoded to UTF-8, in blocks of whole lines.

use crate::problem::Problem;
use encoding_rs::WINDOWS_1252;
use encoding_rs_io::DecodeReaderBytesBuilder;
use flate2::read::MultiGzDecoder;
use fluxfit_files::{
    FileError, Problem as FileProblem,
    input::{io_problem, line_at},
};
use std::io::{Cursor, Read};

/// Bytes of the first block, which must contain the header.
const HEAD: usize = 1 << 20;

/// Bytes of the other blocks: so many that handling their ends takes no time.
const BLOCK: usize = 1 << 20;

/// A quotation of more bytes is a quotation mark that was never closed.
const LONGEST_QUOTATION: usize = 1 << 22;

/// A longer line is cut into pieces, which are then refused: no table has such lines.
const LONGEST_LINE: usize = 1 << 24;

/// The first bytes of a gzip file (RFC 1952).
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// The first bytes of documents that users mistake for tables of text.
const DOCUMENTS: [(&[u8], &str); 4] = [
    (b"PK\x03\x04", "an Excel workbook, or another zip archive"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook"),
    (b"%PDF", "a PDF"),
    (b"{\\rtf", "a text with formats"),
];

/// Decompressed, decoded text.
pub(crate) struct Text {
    /// The beginning; all of a short text.
    pub(super) head: String,
    rest: Box<dyn Read>,
    is_gzip: bool,
    /// What was inferred.
    pub(super) notes: Vec<String>,
}

impl Text {
    /// Decompresses gzip, and decodes UTF-16 and UTF-8 by their byte order marks. Text that is not UTF-8 is decoded as Windows-1252, in
    /// which every byte is valid.
    ///
    /// # Errors
    /// If the bytes cannot be read, are empty, or are not text.
    pub(crate) fn open(mut raw: Box<dyn Read>) -> Result<Self, FileError> {
        let mut notes = Vec::new();
        let magic = read_up_to(&mut *raw, GZIP.len(), false)?;
        let is_gzip = magic == GZIP;
        let raw: Box<dyn Read> = Box::new(Cursor::new(magic).chain(raw));
        let raw: Box<dyn Read> = if is_gzip { Box::new(MultiGzDecoder::new(raw)) } else { raw };
        let mut decoded = DecodeReaderBytesBuilder::new().utf8_passthru(true).strip_bom(true).build(raw);
        let head = read_up_to(&mut decoded, HEAD, is_gzip)?;
        if let Some((_, what)) = DOCUMENTS.iter().find(|(start, _)| head.starts_with(start)) {
            return Err(Problem::Document { what }.into());
        }
        if let Some(at) = head.iter().position(|byte| *byte == 0) {
            return Err(FileError::from(FileProblem::NotText { wanted: "CSV text" }).at_line(line_at(&head, at)));
        }
        if head.trim_ascii().is_empty() {
            return Err(FileProblem::Empty.into());
        }
        let mut text = Self { head: String::new(), rest: Box::new(decoded), is_gzip, notes: Vec::new() };
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
                notes.push("the file is not UTF-8 and was read as Windows-1252".to_owned());
                let (head, _, _) = WINDOWS_1252.decode(error.as_bytes());
                text.rest = Box::new(DecodeReaderBytesBuilder::new().encoding(Some(WINDOWS_1252)).bom_sniffing(false).build(text.rest));
                head.into_owned()
            }
        };
        text.notes = notes;
        Ok(text)
    }

    /// Passes the text from an offset in the head on to `take`, in blocks of whole lines, each with the number of its first line and
    /// whether it is the last block.
    pub(super) fn blocks(
        self,
        from: usize,
        first_line: u64,
        mut take: impl FnMut(&[u8], u64, bool) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let Self { head, mut rest, is_gzip, .. } = self;
        let mut bytes = head.into_bytes();
        bytes.drain(..from);
        let mut line = first_line;
        loop {
            let more = read_up_to(&mut *rest, BLOCK, is_gzip)?;
            let ended = more.is_empty();
            // Bytes carried over from the block before contain no line end.
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

/// The end of the last complete record: after a line end outside of quotes.
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
    // Back to the last line end before the open quotation.
    if let Some(open) = memchr::memrchr(b'"', &bytes[..end]) {
        end = last_end(&bytes[..open]);
        if !memchr::memchr_iter(b'"', &bytes[..end]).count().is_multiple_of(2) {
            end = 0;
        }
    }
    end
}

/// The last `\r` that is not the last byte, after which a `\n` may still follow.
fn lone_return(bytes: &[u8]) -> Option<usize> {
    memchr::memrchr(b'\r', bytes.split_last()?.1)
}

/// The number of line ends: `\n`, `\r\n` or `\r`.
fn lines(bytes: &[u8]) -> u64 {
    line_at(bytes, bytes.len()) - 1
}

/// The next `most` bytes, fewer only at the end.
fn read_up_to(reader: &mut dyn Read, most: usize, is_gzip: bool) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    match reader.take(most as u64).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) if is_gzip => Err(Problem::Gzip { reason: error.to_string() }.into()),
        Err(error) => Err(io_problem("reading", &error).into()),
    }
}
