//! Checks the sizes that the pages of a Parquet file state, before the parquet crate allocates memory for them.
//!
//! The header of a page is a structure in Thrift's compact protocol, followed by the page:
//! <https://github.com/apache/parquet-format/blob/master/src/main/thrift/parquet.thrift>, `PageHeader`.

use crate::{
    container::{
        fault::{damaged, unread},
        random_access::RandomAccess,
    },
    problem::Problem,
};
use fluxfit_files::FileError;
use parquet::{
    basic::{Compression, Type},
    file::metadata::ColumnChunkMetaData,
};

/// Name of the format in messages.
pub(super) const FORMAT: &str = "Parquet";

/// Maximum length of the header of a page, bytes: with statistics it has some hundred.
const LONGEST_HEADER: usize = 4096;

/// Maximum size of an uncompressed page, bytes. Writers aim at 1 MB; the largest pages, those of DuckDB, have up to 100 MB.
const LARGEST_PAGE: u64 = 128 << 20;

/// Maximum nesting of structures; the header of a page has two levels.
const DEEPEST: usize = 8;

/// Checks the pages of a column chunk.
///
/// # Errors
/// If a page states a size that is impossible.
pub(super) fn check(source: &RandomAccess, chunk: &ColumnChunkMetaData) -> Result<(), FileError> {
    if let codec @ (Compression::LZO | Compression::BROTLI(_)) = chunk.compression() {
        let codec = codec.to_string();
        return Err(Problem::ParquetCodec { codec: codec.split('(').next().unwrap_or_default().to_owned() }.into());
    }
    let wrong = || damaged(FORMAT, "the size of a page is impossible");
    let start = chunk.dictionary_page_offset().unwrap_or(chunk.data_page_offset());
    let mut at = u64::try_from(start).map_err(|_| wrong())?;
    let length = u64::try_from(chunk.compressed_size()).map_err(|_| wrong())?;
    let end = at.checked_add(length).filter(|end| *end <= source.length()).ok_or_else(wrong)?;
    let mut buffer = vec![0; LONGEST_HEADER];
    while at < end {
        let count = source.read_at(at, &mut buffer).map_err(|error| unread(FORMAT, &error))?;
        let mut header = Compact { bytes: &buffer[..count] };
        let page = header.page_header().ok_or_else(wrong)?;
        let compressed = u64::try_from(page.compressed).map_err(|_| wrong())?;
        let uncompressed = u64::try_from(page.uncompressed).map_err(|_| wrong())?;
        let entries = u64::try_from(page.dictionary_entries).map_err(|_| wrong())?;
        let most = most_uncompressed(chunk.compression(), compressed).min(LARGEST_PAGE);
        if uncompressed > most || entries > most_entries(chunk.column_type(), uncompressed) {
            return Err(wrong());
        }
        at += (count - header.bytes.len()) as u64 + compressed;
    }
    Ok(())
}

/// Maximum size of compressed bytes when decompressed. At best Snappy stores 64 bytes in 3, LZ4 255 bytes in 1, deflate 258 bytes in 2
/// bits. A block of Zstandard may repeat one byte 128 Ki times in 4 bytes, but the numbers of a log do not.
fn most_uncompressed(compression: Compression, compressed: u64) -> u64 {
    let (factor, more) = match compression {
        Compression::UNCOMPRESSED => (1, 0),
        Compression::SNAPPY => (22, 64),
        Compression::LZ4 | Compression::LZ4_RAW => (256, 64),
        _ => (1032, 1 << 20),
    };
    compressed.saturating_mul(factor).saturating_add(more)
}

/// Maximum number of entries of a dictionary of this size.
fn most_entries(kind: Type, uncompressed: u64) -> u64 {
    match kind {
        Type::DOUBLE | Type::INT64 => uncompressed / 8,
        Type::FLOAT | Type::INT32 => uncompressed / 4,
        Type::INT96 => uncompressed / 12,
        _ => uncompressed,
    }
}

#[derive(Default)]
struct PageHeader {
    uncompressed: i64,
    compressed: i64,
    dictionary_entries: i64,
}

/// The unread part of a structure in Thrift's compact protocol.
struct Compact<'a> {
    bytes: &'a [u8],
}

/// Types of fields in the compact protocol.
mod field {
    pub(super) const STOP: u8 = 0;
    pub(super) const TRUE: u8 = 1;
    pub(super) const FALSE: u8 = 2;
    pub(super) const BYTE: u8 = 3;
    pub(super) const I16: u8 = 4;
    pub(super) const I32: u8 = 5;
    pub(super) const I64: u8 = 6;
    pub(super) const DOUBLE: u8 = 7;
    pub(super) const BINARY: u8 = 8;
    pub(super) const LIST: u8 = 9;
    pub(super) const SET: u8 = 10;
    pub(super) const STRUCT: u8 = 12;
}

impl Compact<'_> {
    fn page_header(&mut self) -> Option<PageHeader> {
        let mut header = PageHeader::default();
        let mut id = 0;
        while let Some(kind) = self.field(&mut id)? {
            match (id, kind) {
                (2, field::I32) => header.uncompressed = self.integer()?,
                (3, field::I32) => header.compressed = self.integer()?,
                (7, field::STRUCT) => header.dictionary_entries = self.dictionary_header()?,
                _ => self.skip(kind, DEEPEST)?,
            }
        }
        Some(header)
    }

    /// The number of entries.
    fn dictionary_header(&mut self) -> Option<i64> {
        let (mut entries, mut id) = (0, 0);
        while let Some(kind) = self.field(&mut id)? {
            match (id, kind) {
                (1, field::I32) => entries = self.integer()?,
                _ => self.skip(kind, DEEPEST)?,
            }
        }
        Some(entries)
    }

    /// The type of the next field, whose number is stored in `id`; `Some(None)` at the end of the structure.
    fn field(&mut self, id: &mut i64) -> Option<Option<u8>> {
        let byte = self.byte()?;
        let kind = byte & 0x0f;
        if kind == field::STOP {
            return Some(None);
        }
        match byte >> 4 {
            0 => *id = self.integer()?,
            step => *id = id.checked_add(i64::from(step))?,
        }
        Some(Some(kind))
    }

    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.bytes.split_first()?;
        self.bytes = rest;
        Some(*first)
    }

    /// An unsigned integer: seven bits per byte, the lowest first.
    fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    /// A signed integer in zigzag encoding.
    fn integer(&mut self) -> Option<i64> {
        self.varint().map(|value| (value >> 1).cast_signed() ^ -(value & 1).cast_signed())
    }

    fn advance(&mut self, count: u64) -> Option<()> {
        self.bytes = self.bytes.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        let depth = depth.checked_sub(1)?;
        match kind {
            field::TRUE | field::FALSE => Some(()),
            field::BYTE => self.advance(1),
            field::I16 | field::I32 | field::I64 => self.varint().map(drop),
            field::DOUBLE => self.advance(8),
            field::BINARY => {
                let length = self.varint()?;
                self.advance(length)
            }
            field::LIST | field::SET => {
                let byte = self.byte()?;
                let length = if byte >> 4 == 15 { self.varint()? } else { u64::from(byte >> 4) };
                // Every element takes at least one byte, in a list also a boolean.
                if length > self.bytes.len() as u64 {
                    return None;
                }
                (0..length).try_for_each(|_| match byte & 0x0f {
                    field::TRUE | field::FALSE => self.advance(1),
                    kind => self.skip(kind, depth),
                })
            }
            field::STRUCT => {
                let mut id = 0;
                while let Some(kind) = self.field(&mut id)? {
                    self.skip(kind, depth)?;
                }
                Some(())
            }
            _ => None,
        }
    }
}
