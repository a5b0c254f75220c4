//! How a verb ended.

use std::process::ExitCode;

/// How a command ended, errors apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    /// Everything asked for was identified.
    Complete,
    /// The log cannot carry some parameter.
    Incomplete,
    /// A parameter left the band that was asked for.
    Alarm,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        match status {
            Status::Complete => Self::SUCCESS,
            Status::Incomplete => Self::from(1),
            Status::Alarm => Self::from(3),
        }
    }
}
