//! Bytes that can be read at any place: a file, or what came from standard input.

use bytes::Bytes;
use fluxfit_files::{FileError, input};
use parquet::{
    errors::{ParquetError, Result as ParquetResult},
    file::reader::{ChunkReader, Length},
};
use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    sync::{Arc, Mutex},
};

/// A file or bytes. Copies share them.
#[derive(Clone)]
pub(crate) struct Source {
    bytes: Place,
    length: u64,
}

#[derive(Clone)]
enum Place {
    /// Behind a lock, because to seek and to read are two steps.
    File(Arc<Mutex<File>>),
    Memory(Bytes),
}

impl Source {
    /// # Errors
    /// If the file cannot tell its length or cannot seek, as a pipe.
    pub(crate) fn file(mut file: File) -> Result<Self, FileError> {
        let length = file.seek(SeekFrom::End(0)).map_err(|error| FileError::from(input::io_problem("reading", &error)))?;
        Ok(Self { bytes: Place::File(Arc::new(Mutex::new(file))), length })
    }

    pub(crate) fn memory(bytes: impl Into<Bytes>) -> Self {
        let bytes = bytes.into();
        Self { length: bytes.len() as u64, bytes: Place::Memory(bytes) }
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// Fills as much of `buffer` as there is from `at` on.
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
                let mut file = file.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                file.seek(SeekFrom::Start(at))?;
                let mut count = 0;
                while count < wanted {
                    match file.read(&mut buffer[count..]) {
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

    /// Exactly `length` bytes from `at` on; nothing is allocated for what is not there.
    pub(super) fn bytes_at(&self, at: u64, length: u64) -> io::Result<Vec<u8>> {
        if at.checked_add(length).is_none_or(|end| end > self.length) {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut bytes = vec![0; usize::try_from(length).map_err(|_| io::ErrorKind::UnexpectedEof)?];
        let count = self.read_at(at, &mut bytes)?;
        if count == bytes.len() { Ok(bytes) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }

    /// The bytes from `at` up to `end`, in their order.
    pub(super) fn range(&self, at: u64, end: u64) -> Range {
        Range { source: self.clone(), at, end: end.min(self.length) }
    }
}

/// A part of a source, read from its begin.
pub(crate) struct Range {
    source: Source,
    at: u64,
    end: u64,
}

impl Range {
    pub(super) fn left(&self) -> u64 {
        self.end.saturating_sub(self.at)
    }

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

impl Length for Source {
    fn len(&self) -> u64 {
        self.length
    }
}

impl ChunkReader for Source {
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
