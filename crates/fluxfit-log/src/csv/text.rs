//! Text: decompressed, decoded to UTF-8.

use super::padding::Unpadded;
use crate::problem::Problem;
use encoding_rs::{BIG5, EUC_JP, EUC_KR, Encoding, GBK, SHIFT_JIS, WINDOWS_1252};
use encoding_rs_io::DecodeReaderBytesBuilder;
use flate2::read::MultiGzDecoder;
use fluxfit_files::{
    FileError, Problem as FileProblem,
    csv::tidy::{RowStyle, Tidied},
    input::{io_problem, line_at},
};
use std::io::{Cursor, Read};

/// Bytes of the head, which must contain the header.
const HEAD: usize = 1 << 20;

/// Bytes of the longest character, which the head may lack at its end.
const LONGEST_CHARACTER: usize = 4;

/// The first bytes of a gzip file (RFC 1952).
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// The first bytes of documents that users mistake for tables of text.
const DOCUMENTS: [(&[u8], &str); 19] = [
    (b"PK\x03\x04", "an Excel workbook, or another zip archive"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook"),
    (b"%PDF", "a PDF"),
    (b"{\\rtf", "a text with formats"),
    (b"TDSm", "a TDMS file of LabVIEW"),
    (b"LOGG", "a BLF log of Vector's tools"),
    (b"SQLite format 3", "a database of SQLite"),
    (b"#ROSBAG", "a bag of ROS"),
    (b"\x93NUMPY", "an array of numpy"),
    (b"ARROW1", "an Arrow file (Feather)"),
    (b"\x80\x04\x95", "a pickle of Python"),
    (b"\x80\x05\x95", "a pickle of Python"),
    (b"BZh", "compressed by bzip2"),
    (b"\xfd7zXZ", "compressed by xz"),
    (b"\x28\xb5\x2f\xfd", "compressed by zstd"),
    (b"7z\xbc\xaf\x27\x1c", "an archive of 7-Zip"),
    (b"ULog\x01\x12\x35", "a ULog of PX4"),
    (b"\xa3\x95\x80\x80", "a flash log of ArduPilot"),
    (b"\x89MCAP0\r\n", "an MCAP recording"),
];

/// Whether bytes begin an archive of numpy's arrays: a zip archive whose first file is one. The name of it stands behind 30 bytes.
fn is_npz(head: &[u8]) -> bool {
    let length = || Some(usize::from(u16::from_le_bytes([*head.get(26)?, *head.get(27)?])));
    let name = || head.get(30..30 + length()?);
    head.starts_with(b"PK\x03\x04") && name().is_some_and(|name| name.ends_with(b".npy"))
}

/// Encodings of East Asian systems, each with words that stand in the header of a log: time, voltage, current, speed, angle. The bytes of
/// one are often valid in another, so that only such a word decides. The first two as WHATWG Encoding calls them: GBK, Shift_JIS.
static EAST_ASIAN: [(&Encoding, &[&str]); 5] = [
    (GBK, &["时间", "电压", "电流", "转速", "速度", "角度"]),
    (SHIFT_JIS, &["時間", "時刻", "電圧", "電流", "回転", "速度", "角度"]),
    (EUC_JP, &["時間", "時刻", "電圧", "電流", "回転", "速度", "角度"]),
    (BIG5, &["時間", "電壓", "電流", "轉速", "速度", "角度"]),
    (EUC_KR, &["시간", "전압", "전류", "속도", "회전"]),
];

/// Decompressed, decoded text.
pub(crate) struct Text {
    /// The beginning; all of a short text.
    pub(crate) head: String,
    pub(crate) rest: Box<dyn Read>,
    pub(super) is_gzip: bool,
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
        let mut magic = Vec::new();
        read_up_to(&mut *raw, GZIP.len(), false, &mut magic)?;
        let is_gzip = magic == GZIP;
        let raw: Box<dyn Read> = Box::new(Cursor::new(magic).chain(raw));
        let raw: Box<dyn Read> = if is_gzip { Box::new(MultiGzDecoder::new(raw)) } else { raw };
        let mut decoded = Unpadded::new(DecodeReaderBytesBuilder::new().utf8_passthru(true).strip_bom(true).build(raw));
        let mut head = Vec::new();
        read_up_to(&mut decoded, HEAD, is_gzip, &mut head)?;
        if is_npz(&head) {
            return Err(Problem::Npz.into());
        }
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
            // The head may end within a character.
            Err(error) if error.utf8_error().error_len().is_none() => {
                let (end, mut bytes) = (error.utf8_error().valid_up_to(), error.into_bytes());
                let cut = bytes.split_off(end);
                text.rest = Box::new(Cursor::new(cut).chain(text.rest));
                String::from_utf8_lossy(&bytes).into_owned()
            }
            Err(error) => {
                let mut bytes = error.into_bytes();
                // A character of two bytes may be cut at the end of the head, but no second byte is the end of a line.
                let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(bytes.len(), |at| at + 1);
                let cut = bytes.split_off(whole);
                let encoding = encoding(&bytes);
                notes.push(format!("the file is not UTF-8 and was read as {}", name_of(encoding)));
                let (head, _) = encoding.decode_without_bom_handling(&bytes);
                let rest = Cursor::new(cut).chain(text.rest);
                text.rest = Box::new(DecodeReaderBytesBuilder::new().encoding(Some(encoding)).bom_sniffing(false).build(rest));
                head.into_owned()
            }
        };
        text.notes = notes;
        Ok(text)
    }
}

/// The encoding of a text that is not UTF-8: one of East Asia if a word of a log's header says so, else Windows-1252.
fn encoding(bytes: &[u8]) -> &'static Encoding {
    let fits = |(encoding, words): &&(&'static Encoding, &[&str])| {
        let (text, is_wrong) = encoding.decode_without_bom_handling(bytes);
        !is_wrong && words.iter().any(|word| text.contains(word))
    };
    EAST_ASIAN.iter().find(fits).map_or(WINDOWS_1252, |(encoding, _)| encoding)
}

/// The name of an encoding as it is usually written.
fn name_of(encoding: &'static Encoding) -> &'static str {
    if encoding == WINDOWS_1252 { "Windows-1252" } else { encoding.name() }
}

impl Text {
    /// A text in memory.
    pub(crate) fn of(head: String) -> Self {
        Self { head, rest: Box::new(std::io::empty()), is_gzip: false, notes: Vec::new() }
    }

    /// Whether the head may not be all of it.
    pub(crate) fn has_rest(&self) -> bool {
        self.head.len() + LONGEST_CHARACTER > HEAD
    }

    /// The text with its rows, from `body` on, as records.
    pub(super) fn with_rows(self, style: RowStyle, body: usize) -> Self {
        self.changed(body, |rows| Box::new(Tidied::new(rows, style)))
    }

    /// The text changed from `body` on.
    pub(super) fn changed(mut self, body: usize, change: impl FnOnce(Box<dyn Read>) -> Box<dyn Read>) -> Self {
        let rows = self.head.split_off(body).into_bytes();
        let mut changed = change(Box::new(Cursor::new(rows).chain(self.rest)));
        // So much that the first rows can be looked at.
        let mut first = Vec::new();
        // An error comes again where the rest is read.
        let _ = (&mut changed).take(HEAD as u64).read_to_end(&mut first);
        let whole = first.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let cut = first.split_off(whole);
        self.head.push_str(&String::from_utf8_lossy(&first));
        self.rest = Box::new(Cursor::new(cut).chain(changed));
        self
    }
}

/// Appends the next `most` bytes, fewer only at the end, and returns their number.
pub(super) fn read_up_to(reader: &mut dyn Read, most: usize, is_gzip: bool, bytes: &mut Vec<u8>) -> Result<usize, FileError> {
    match reader.take(most as u64).read_to_end(bytes) {
        Ok(count) => Ok(count),
        Err(error) if is_gzip => Err(Problem::Gzip { reason: error.to_string() }.into()),
        Err(error) => Err(io_problem("reading", &error).into()),
    }
}
