//! What can stop a command: one sentence each, from whoever found it.

use crate::terminal::{options, told::Told};

/// Why a command stopped.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CommandError {
    /// A file or an argument.
    #[error("{}", crate::terminal::advice::with_options(&.0.to_string(), .0.advice()))]
    File(#[from] fluxfit_files::FileError),
    /// A setting, or a log that holds nothing to work on.
    #[error(transparent)]
    Library(#[from] fluxfit::error::Error),
    /// A search that cannot be made.
    #[error(transparent)]
    Search(#[from] fluxfit::optimizer::Error),
    /// A scenario that cannot be simulated, or whose drive trips.
    #[error(transparent)]
    Drive(#[from] fluxfit_drive::Error),
    /// The same of one log among several.
    #[error("{log}: {error}")]
    Log {
        /// Its name.
        log: String,
        /// What is wrong with it.
        error: fluxfit::error::Error,
    },
    /// A drive that trips, or leaves its flux map.
    #[error("{scenario}: {error}")]
    Simulation {
        /// The scenario's name.
        scenario: String,
        /// What happened.
        error: fluxfit_drive::Error,
    },
    /// Columns that contradict each other, so that an answer would mean nothing.
    #[error("{log}: {}; to identify all the same, state --model; fluxfit --explain {}", .finding.sentence.trim_end_matches(':'), .finding.code)]
    Columns {
        /// Name of the log.
        log: String,
        /// What is wrong, and what mends it.
        finding: Told,
    },
    /// Arguments that do not go together.
    #[error("{0}")]
    Usage(String),
    /// The answer could not be written.
    #[error("the answer could not be written: {0}")]
    Output(#[from] std::io::Error),
}

impl CommandError {
    /// The option that avoids it.
    pub(crate) fn option(&self) -> Option<&'static str> {
        match self {
            Self::Library(error) | Self::Log { error, .. } => options::of_error(error.kind()),
            _ => None,
        }
    }

    /// Lines to paste that mend it.
    pub(crate) fn lines(&self) -> &str {
        match self {
            Self::Columns { finding, .. } => &finding.lines,
            _ => "",
        }
    }

    /// What is wrong with a file, if that is it.
    pub(crate) fn in_file(&self) -> Option<&fluxfit_files::FileError> {
        match self {
            Self::File(error) => Some(error),
            _ => None,
        }
    }
}
