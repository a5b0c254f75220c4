//! What is wrong with a file of text, a table, or a value in it: sentences that several readers share.

use crate::error::FileError;
use fluxfit_units::{
    ValueError,
    wording::{choice, did_you_mean, list, quote},
};

/// The sentences. Texts taken from files are quoted here, never before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence of each says what it is")]
pub enum Problem {
    #[error("this is a directory; name a file in it")]
    Directory,
    #[error("there is no such file; check the path")]
    NotFound,
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
    #[error("there are only comments; a header line with the names of the columns and rows of numbers are needed")]
    NoHeader,
    #[error("{} are numbers where the header should be; put a line with the names of the columns above them", quote(.text))]
    NumbersForHeader { text: String },
    #[error("{} is only one column; separate the names, and the values, by comma, semicolon or tab", quote(.text))]
    OneColumn { text: String },
    #[error("the row has {} where the header has {expected}; {}", cells(*.found), row_remedy(*.found > *.expected, *.multiline))]
    RowLength { found: usize, expected: usize, multiline: bool },
    #[error("{} is not a number; correct it or remove the row", quote(.text))]
    NotANumber { text: String },
    #[error("this is not {format}: {message}; correct it")]
    Syntax { format: &'static str, message: String },
    #[error("this key is not known; {table} can hold {}{}", list(.known), did_you_mean(*.nearest))]
    Key { table: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("this key stands outside of a table; put it below a line [{table}]")]
    OutsideTable { table: &'static str },
    #[error("this key belongs to [{table}]; move it there")]
    OtherTable { table: &'static str },
    #[error("this key stands above all tables; move it to the top of the file")]
    InsideTable,
    #[error("this is not {wanted}; correct it")]
    Value { wanted: String },
    #[error("{} is not known here; it can be {}{}", quote(.text), choice(.known), did_you_mean(*.nearest))]
    Word { text: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("the key {key} is missing; write {remedy}")]
    MissingKey { key: String, remedy: String },
    #[error("{} is out of range; it must be {range}", quote(.text))]
    Range { text: String, range: &'static str },
}

impl From<Problem> for FileError {
    fn from(problem: Problem) -> Self {
        Self::new(&problem)
    }
}

impl From<ValueError> for FileError {
    fn from(error: ValueError) -> Self {
        Self::new(&error)
    }
}

fn cells(count: usize) -> String {
    if count == 1 { "1 cell".to_owned() } else { format!("{count} cells") }
}

fn row_remedy(too_many: bool, multiline: bool) -> &'static str {
    match (multiline, too_many) {
        (true, _) => "a quotation mark in this line opens a cell that runs over several lines: close it",
        (false, true) => "remove the cells that are too many, or the row",
        (false, false) => "complete the row or remove it",
    }
}
