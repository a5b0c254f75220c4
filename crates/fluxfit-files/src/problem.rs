//! What can be wrong with a file of text, a table or a value in it: the problems that several readers share.

use crate::error::{FileError, FileErrorKind};
use fluxfit_units::wording::{choice, did_you_mean, list, one_line, quote};

/// The problems and their sentences. Texts taken from files are quoted and shortened here and nowhere else.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence of each says what it is")]
pub enum Problem {
    #[error("this is a directory; name a file in it")]
    Directory,
    #[error("there is no such file; {}", nearest.as_ref().map_or_else(|| "check the path".to_owned(), |name| format!("did you mean {}?", one_line(name))))]
    NotFound { nearest: Option<String> },
    #[error("permission is denied; change the permissions, or name another file")]
    NotPermitted,
    #[error("{action} failed: {reason}; try again, or name another file")]
    Io { action: &'static str, reason: String },
    #[error("the directory {} does not exist; create it, or name another file", quote(.directory))]
    NoDirectory { directory: String },
    #[error("this is not text in UTF-8; export it as {wanted} in UTF-8")]
    NotText { wanted: &'static str },
    #[error("the file is empty; export it again")]
    Empty,
    #[error("the file has only comments; a header line with the names of the columns and rows of numbers are needed")]
    NoHeader,
    #[error("{} are numbers in place of a header; put a line with the names of the columns above them", quote(.text))]
    NumbersForHeader { text: String },
    #[error("{} is a single column; separate names and values by comma, semicolon or tab", quote(.text))]
    OneColumn { text: String },
    #[error("this export of TwinCAT Scope has channels with the sample times {} ms, so the values of a row are not simultaneous; export the channels of the log with one sample time", list(.times))]
    SampleTimes { times: Vec<String> },
    #[error("the row has {} where the header has {expected}; {}", cells(*.found), row_remedy(*.found > *.expected, *.multiline))]
    RowLength { found: usize, expected: usize, multiline: bool },
    #[error("{} is not a number; correct it or remove the row", quote(.text))]
    NotANumber { text: String },
    #[error("this is not {format}: {message}; correct it")]
    Syntax { format: &'static str, message: String },
    #[error("this is not {document}; {remedy}")]
    Document { document: &'static str, remedy: &'static str },
    #[error("this key is not known; {table} can hold {}{}", list(.known), did_you_mean(*.nearest))]
    Key { table: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("this key is outside of its table; put it below a line [{table}]")]
    OutsideTable { table: &'static str },
    #[error("this key belongs to [{table}]; move it there")]
    OtherTable { table: &'static str },
    #[error("this key belongs above all tables; move it to the top of the file")]
    InsideTable,
    #[error("this is not {wanted}; correct it")]
    Value { wanted: String },
    #[error("{} is not one of the values; it can be {}{}", quote(.text), choice(.known), did_you_mean(*.nearest))]
    Word { text: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("the key {key} is missing; write {remedy}")]
    MissingKey { key: String, remedy: String },
    #[error("{} is out of range; it must be {range}", quote(.text))]
    Range { text: String, range: &'static str },
}

impl Problem {
    fn kind(&self) -> FileErrorKind {
        match self {
            Self::Directory | Self::NotFound { .. } | Self::NotPermitted | Self::Io { .. } | Self::NoDirectory { .. } => {
                FileErrorKind::Access
            }
            Self::NotText { .. }
            | Self::Empty
            | Self::Syntax { .. }
            | Self::Document { .. }
            | Self::NoHeader
            | Self::NumbersForHeader { .. } => FileErrorKind::Format,
            Self::OneColumn { .. } | Self::RowLength { .. } | Self::SampleTimes { .. } => FileErrorKind::Format,
            Self::NotANumber { .. } | Self::Value { .. } | Self::Word { .. } | Self::Range { .. } => FileErrorKind::Value,
            Self::Key { .. } | Self::OutsideTable { .. } | Self::OtherTable { .. } | Self::InsideTable | Self::MissingKey { .. } => {
                FileErrorKind::Key
            }
        }
    }
}

impl From<Problem> for FileError {
    fn from(problem: Problem) -> Self {
        Self::new(problem.kind(), problem)
    }
}

fn cells(count: usize) -> String {
    if count == 1 { "1 cell".to_owned() } else { format!("{count} cells") }
}

fn row_remedy(too_many: bool, multiline: bool) -> &'static str {
    match (multiline, too_many) {
        (true, _) => "a quotation mark in this line opens a cell that continues over several lines: close it",
        (false, true) => "remove the extra cells or the row",
        (false, false) => "complete the row or remove it",
    }
}
