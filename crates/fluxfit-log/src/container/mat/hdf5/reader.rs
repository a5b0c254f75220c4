//! Access to the structures of an HDF5 file.

use crate::{
    container::{
        fault::{damaged, unread},
        random_access::RandomAccess,
    },
    problem::Problem,
};
use fluxfit_files::FileError;
use std::cell::Cell;

/// The address that means none.
pub(super) const NOWHERE: u64 = u64::MAX;

/// Maximum length of a label or unit, letters.
pub(super) const LONGEST_TEXT: usize = 256;

/// Reads the structures of a file by their address.
pub(crate) struct Reader {
    pub(super) source: RandomAccess,
    pub(super) base: u64,
    pub(super) format: &'static str,
    /// Bytes of structures that may still be read: a limit for files with shared or circular structures.
    pub(super) budget: Cell<u64>,
}

impl Reader {
    pub(super) fn bytes(&self, at: u64, length: u64) -> Result<Vec<u8>, FileError> {
        let left = self
            .budget
            .get()
            .checked_sub(length)
            .ok_or_else(|| self.damaged("its links lead in a circle, or far too many of them to the same objects"))?;
        self.budget.set(left);
        let at = self.base.checked_add(at).ok_or_else(|| self.damaged("an address in it is impossible"))?;
        self.source.bytes_at(at, length).map_err(|error| unread(self.format, &error))
    }

    /// The bytes up to the end of the file.
    pub(super) fn bytes_up_to(&self, at: u64, length: u64) -> Result<Vec<u8>, FileError> {
        let left = self.source.length().saturating_sub(self.base).saturating_sub(at);
        self.bytes(at, length.min(left))
    }

    pub(super) fn damaged(&self, fault: &'static str) -> FileError {
        damaged(self.format, fault)
    }

    pub(super) fn newer(&self, what: &'static str) -> FileError {
        Problem::NewerHdf5 { what }.into()
    }
}

/// Reads little-endian integers from a structure.
pub(super) struct Cursor<'a>(pub(super) &'a [u8]);

impl<'a> Cursor<'a> {
    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    pub(super) fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.first_chunk().copied()
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }
}
