//! Errors of damaged containers.

use crate::problem::Problem;
use fluxfit_files::{FileError, input::io_problem};
use std::io;

/// The error for a container with damaged content.
pub(super) fn damaged(format: &'static str, fault: impl ToString) -> FileError {
    Problem::Container { format, fault: format!("{}; export it again", fault.to_string().trim_end_matches(['.', ';', '\n'])) }.into()
}

/// The error for a container that cannot be read to its end.
pub(super) fn unread(format: &'static str, error: &io::Error) -> FileError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged(format, "it ends too early"),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => damaged(format, "its compressed data are damaged"),
        _ => io_problem("reading", error).into(),
    }
}
