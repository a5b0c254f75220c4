//! One file per verb. Each takes its arguments and returns the exit status.

pub(crate) mod compare;
pub(crate) mod demo;
mod export;
pub(crate) mod formats;
pub(crate) mod identify;
mod input;
pub(crate) mod inspect;
pub(crate) mod manual;
mod report;
pub(crate) mod simulate;
pub(crate) mod validate;

use std::process::ExitCode;

/// How a command ended, errors apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    /// Everything asked for was identified.
    Complete,
    /// The log cannot carry some parameter.
    Incomplete,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        match status {
            Status::Complete => Self::SUCCESS,
            Status::Incomplete => Self::from(1),
        }
    }
}
