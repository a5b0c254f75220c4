//! Bytes that can be read at any offset: a file, or bytes in memory.

use bytes::Bytes;
use fluxfit_files::{FileError, input};
use parquet::{
    errors::{ParquetError, Result as ParquetResult},
    file::reader::{ChunkReader, Length},
};
use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    sync::Arc,
};

/// A file or bytes in memory; clones share them.
#[derive(Clone)]
pub(crate) struct RandomAccess {
    bytes: Place,
    length: u64,
}

#[derive(Clone)]
enum Place {
    File(Arc<File>),
    Memory(Bytes),
}

impl RandomAccess {
    /// Of a file.
    ///
    /// # Errors
    /// If the file cannot be positioned, as a pipe.
    pub(crate) fn file(mut file: File) -> Result<Self, FileError> {
        let length = file.seek(SeekFrom::End(0)).map_err(|error| FileError::from(input::io_problem("reading", &error)))?;
        Ok(Self { bytes: Place::File(Arc::new(file)), length })
    }

    /// Of bytes in memory.
    pub(crate) fn memory(bytes: impl Into<Bytes>) -> Self {
        let bytes = bytes.into();
        Self { length: bytes.len() as u64, bytes: Place::Memory(bytes) }
    }

    /// The length in bytes.
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// Fills `buffer` from the offset `at`, up to the end of the bytes.
    pub(super) fn read_at(&self, at: u64, buffer: &mut [u8]) -> io::Result<usize> {
        let left = usize::try_from(self.length.saturating_sub(at)).unwrap_or(usize::MAX);
        let wanted = left.min(buffer.len());
        let buffer = &mut buffer[..wanted];
        match &self.bytes {
            Place::Memory(bytes) => {
                let start = usize::try_from(at).unwrap_or(usize::MAX).min(bytes.len());
                let from = &bytes[start..];
                let count = from.len().min(wanted);
                buffer[..count].copy_from_slice(&from[..count]);
                Ok(count)
            }
            Place::File(file) => {
                let mut count = 0;
                while count < wanted {
                    match read_file(file, &mut buffer[count..], at + count as u64) {
                        Ok(0) => break,
                        Ok(read) => count += read,
                        Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                        Err(error) => return Err(error),
                    }
                }
                Ok(count)
            }
        }
    }

    /// Exactly `length` bytes from the offset `at`; nothing is allocated if they do not exist.
    pub(super) fn bytes_at(&self, at: u64, length: u64) -> io::Result<Vec<u8>> {
        if at.checked_add(length).is_none_or(|end| end > self.length) {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut bytes = vec![0; usize::try_from(length).map_err(|_| io::ErrorKind::UnexpectedEof)?];
        let count = self.read_at(at, &mut bytes)?;
        if count == bytes.len() { Ok(bytes) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }

    /// The bytes from `at` up to `end`, as a reader.
    pub(crate) fn range(&self, at: u64, end: u64) -> Range {
        Range { source: self.clone(), at, end: end.min(self.length) }
    }
}

/// Reads from a file at an offset, whatever other threads read at the same time.
#[cfg(unix)]
fn read_file(file: &File, buffer: &mut [u8], at: u64) -> io::Result<usize> {
    std::os::unix::fs::FileExt::read_at(file, buffer, at)
}

/// Reads from a file at an offset, whatever other threads read at the same time.
#[cfg(windows)]
fn read_file(file: &File, buffer: &mut [u8], at: u64) -> io::Result<usize> {
    std::os::windows::fs::FileExt::seek_read(file, buffer, at)
}

/// A part of the bytes, read from its beginning.
pub(crate) struct Range {
    source: RandomAccess,
    at: u64,
    end: u64,
}

impl Range {
    /// Bytes that are not read yet.
    pub(super) fn left(&self) -> u64 {
        self.end.saturating_sub(self.at)
    }

    /// Skips bytes.
    pub(super) fn skip(&mut self, count: u64) {
        self.at = self.at.saturating_add(count);
    }
}

impl Read for Range {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let wanted = usize::try_from(self.left()).unwrap_or(usize::MAX).min(buffer.len());
        let count = self.source.read_at(self.at, &mut buffer[..wanted])?;
        self.at += count as u64;
        Ok(count)
    }
}

impl Length for RandomAccess {
    fn len(&self) -> u64 {
        self.length
    }
}

impl ChunkReader for RandomAccess {
    type T = BufReader<Range>;

    fn get_read(&self, start: u64) -> ParquetResult<Self::T> {
        Ok(BufReader::new(self.range(start, self.length)))
    }

    fn get_bytes(&self, start: u64, length: usize) -> ParquetResult<Bytes> {
        if let Place::Memory(bytes) = &self.bytes {
            let start = usize::try_from(start).unwrap_or(usize::MAX);
            let end = start.checked_add(length).filter(|end| *end <= bytes.len());
            return end.map(|end| bytes.slice(start..end)).ok_or_else(|| ParquetError::EOF("the file ends too early".to_owned()));
        }
        Ok(self.bytes_at(start, length as u64)?.into())
    }
}
