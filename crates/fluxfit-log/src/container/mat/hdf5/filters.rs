//! The filters of chunks: deflate, shuffle and checksum.

use super::reader::{Cursor, Reader};
use crate::{
    container::{
        fault::{damaged, unread},
        random_access::RandomAccess,
    },
    problem::Problem,
};
use flate2::read::ZlibDecoder;
use fluxfit_files::FileError;
use std::io::Read;

/// A filter of the chunks of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Filter {
    Deflate,
    Shuffle,
    Checksum,
}

/// A chunk in the file.
pub(super) struct Stored {
    pub(super) at: u64,
    pub(super) length: u64,
    /// A bit for each filter that was not applied.
    pub(super) unfiltered: u32,
}

/// The filters in a filter pipeline message, in the order in which they were applied.
pub(super) fn in_message(reader: &Reader, bytes: &[u8]) -> Result<Vec<Filter>, FileError> {
    let mut cursor = Cursor(bytes);
    let mut parse = || {
        let (version, count) = (cursor.u8()?, cursor.u8()?);
        cursor.take(if version == 1 { 6 } else { 0 })?;
        let mut identifiers = Vec::new();
        for _ in 0..count {
            let identifier = cursor.u16()?;
            let name = if version == 1 || identifier >= 256 { cursor.u16()?.into() } else { 0 };
            let (_flags, parameters) = (cursor.u16()?, usize::from(cursor.u16()?));
            cursor.take(if version == 1 { usize::next_multiple_of(name, 8) } else { name })?;
            cursor.take(4 * parameters)?;
            cursor.take(if version == 1 && parameters % 2 == 1 { 4 } else { 0 })?;
            identifiers.push(identifier);
        }
        Some(identifiers)
    };
    let identifiers = parse().ok_or_else(|| reader.damaged("the filters of an array are impossible"))?;
    let known = identifiers.into_iter().map(|identifier| match identifier {
        1 => Ok(Filter::Deflate),
        2 => Ok(Filter::Shuffle),
        3 => Ok(Filter::Checksum),
        other => Err(Problem::Hdf5Filter { identifier: other }.into()),
    });
    known.collect()
}

/// Reads a chunk and reverts its filters; `length` is its size without them.
pub(super) fn decode(
    source: &RandomAccess,
    stored: &Stored,
    filters: &[Filter],
    length: u64,
    width: usize,
    format: &'static str,
) -> Result<Vec<u8>, FileError> {
    let wrong = || damaged(format, "a chunk of an array has another size than it states");
    let mut bytes = source.bytes_at(stored.at, stored.length).map_err(|error| unread(format, &error))?;
    for (at, filter) in filters.iter().enumerate().rev() {
        if stored.unfiltered.checked_shr(at as u32).is_some_and(|rest| rest & 1 != 0) {
            continue;
        }
        bytes = match filter {
            Filter::Checksum => {
                bytes.truncate(bytes.len().checked_sub(4).ok_or_else(wrong)?);
                bytes
            }
            Filter::Deflate => {
                let mut inflated = Vec::new();
                // A checksum may follow.
                let most = length.saturating_add(4);
                ZlibDecoder::new(&bytes[..]).take(most).read_to_end(&mut inflated).map_err(|error| unread(format, &error))?;
                inflated
            }
            Filter::Shuffle => unshuffle(&bytes, width),
        };
    }
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(wrong()) }
}

/// Reverts the shuffle filter, which stores the first bytes of all numbers, then their second bytes, and so on.
fn unshuffle(bytes: &[u8], width: usize) -> Vec<u8> {
    let count = bytes.len() / width;
    let mut whole = vec![0; bytes.len()];
    for (byte, plane) in bytes[..count * width].chunks_exact(count.max(1)).enumerate() {
        for (number, value) in plane.iter().enumerate() {
            whole[number * width + byte] = *value;
        }
    }
    whole[count * width..].copy_from_slice(&bytes[count * width..]);
    whole
}
