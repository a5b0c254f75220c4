//! The sizes that the pages of a Parquet file state, checked before the parquet crate allocates what they say.
//!
//! A page's header is a structure in Thrift's compact protocol, followed by the page:
//! <https://github.com/apache/parquet-format/blob/master/src/main/thrift/parquet.thrift>, `PageHeader`.

use super::{FORMAT, Source};
use crate::{
    container::{damaged, unread},
    problem::Problem,
};
use fluxfit_files::FileError;
use parquet::{
    basic::{Compression, Type},
    file::metadata::ColumnChunkMetaData,
};

/// Bytes of a page's header at most: statistics of numbers make it some hundred.
const LONGEST_HEADER: usize = 4096;

/// Bytes of an unpacked page at most. Writers aim at 1 MB; DuckDB, with the largest, ends at 100 MB.
const LARGEST_PAGE: u64 = 128 << 20;

/// Structures inside of structures at most; a page's header has two levels.
const DEEPEST: usize = 8;

/// Walks along the pages of a column chunk.
///
/// # Errors
/// If a page states that it is larger than it can be.
pub(super) fn check(source: &Source, chunk: &ColumnChunkMetaData) -> Result<(), FileError> {
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
        let packed = u64::try_from(page.packed).map_err(|_| wrong())?;
        let unpacked = u64::try_from(page.unpacked).map_err(|_| wrong())?;
        let entries = u64::try_from(page.dictionary_entries).map_err(|_| wrong())?;
        let most = most_unpacked(chunk.compression(), packed).min(LARGEST_PAGE);
        if unpacked > most || entries > most_entries(chunk.column_type(), unpacked) {
            return Err(wrong());
        }
        at += (count - header.bytes.len()) as u64 + packed;
    }
    Ok(())
}

/// What `packed` bytes can hold. Snappy copies 64 bytes by 3 at best, LZ4 255 by 1, deflate 258 by 2 bits; a block of Zstandard's may
/// repeat one byte 128 Ki times by 4, but no numbers of a log worth packing do.
fn most_unpacked(compression: Compression, packed: u64) -> u64 {
    let (factor, more) = match compression {
        Compression::UNCOMPRESSED => (1, 0),
        Compression::SNAPPY => (22, 64),
        Compression::LZ4 | Compression::LZ4_RAW => (256, 64),
        _ => (1032, 1 << 20),
    };
    packed.saturating_mul(factor).saturating_add(more)
}

/// A dictionary's entries lie one after the other.
fn most_entries(kind: Type, unpacked: u64) -> u64 {
    match kind {
        Type::DOUBLE | Type::INT64 => unpacked / 8,
        Type::FLOAT | Type::INT32 => unpacked / 4,
        Type::INT96 => unpacked / 12,
        _ => unpacked,
    }
}

#[derive(Default)]
struct PageHeader {
    unpacked: i64,
    packed: i64,
    dictionary_entries: i64,
}

/// What is left of a structure in Thrift's compact protocol.
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
                (2, field::I32) => header.unpacked = self.integer()?,
                (3, field::I32) => header.packed = self.integer()?,
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

    /// The type of the next field, whose number comes into `id`; `Some(None)` at the structure's end.
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

    /// Seven bits a byte, the lowest first.
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

    /// Signs alternate.
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
                // Every element takes a byte at least, truth values too when they are in a list.
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
