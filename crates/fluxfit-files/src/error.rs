//! The error of everything that reads or writes files: one sentence on one line that says where, what, and what to do.
//!
//! `drive.csv, line 17, column 'uq': "abc" is not a number; correct it or remove the row`
//!
//! The place is added by [`FileError`]; the sentence comes from the problem, an enum of the crate that found it.

use crate::advice::Advice;
use fluxfit_units::{
    ValueError,
    wording::{one_line, shorten},
};
use std::fmt;

/// What kind of thing is wrong with a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FileErrorKind {
    /// The file could not be opened, read or written.
    Access,
    /// The content is damaged, or not of the format that it should be.
    Format,
    /// The format, or a part of it, is not supported.
    Unsupported,
    /// A column is missing or ambiguous.
    Columns,
    /// A unit or the number of pole pairs has to be stated.
    Unit,
    /// A value is missing, not a number or out of range.
    Value,
    /// The values are readable but cannot be those of a drive, or not at one instant.
    Data,
    /// A key of a file with keys is unknown, missing or in the wrong place.
    Key,
    /// A request that does not make sense for any file: an unknown channel, the same channel twice.
    Request,
}

/// What could not be read, written or understood, and where. Its `Display` is one line and names no option of any interface;
/// [`advice`](Self::advice) has the facts from which an interface adds its own.
#[derive(Debug, Clone, PartialEq)]
pub struct FileError(Box<Located>);

#[derive(Debug, Clone, PartialEq)]
struct Located {
    file: Option<String>,
    line: Option<u64>,
    row: Option<u64>,
    field: Option<Field>,
    kind: FileErrorKind,
    sentence: String,
    advice: Vec<Advice>,
}

#[derive(Debug, Clone, PartialEq)]
enum Field {
    Column(String),
    Key(String),
}

impl FileError {
    /// An error without a place.
    pub fn new(kind: FileErrorKind, sentence: impl fmt::Display) -> Self {
        let sentence = sentence.to_string();
        Self(Box::new(Located { file: None, line: None, row: None, field: None, kind, sentence, advice: Vec::new() }))
    }

    /// The same error, with statements of the user that would resolve it.
    #[must_use]
    pub fn with_advice(mut self, advice: Vec<Advice>) -> Self {
        self.0.advice = advice;
        self
    }

    /// What kind of thing is wrong.
    pub fn kind(&self) -> FileErrorKind {
        self.0.kind
    }

    /// Statements of the user that would resolve it, the most likely one first; empty where the file itself has to change.
    pub fn advice(&self) -> &[Advice] {
        &self.0.advice
    }

    /// The file as it was named, or `standard input`; none for an argument.
    pub fn file(&self) -> Option<&str> {
        self.0.file.as_deref()
    }

    /// The line of the file, from 1, counted as an editor counts.
    pub fn line(&self) -> Option<u64> {
        self.0.line
    }

    /// The column's name in the file's header, or the key of a motor or truth file.
    pub fn column(&self) -> Option<&str> {
        self.0.field.as_ref().map(|(Field::Column(name) | Field::Key(name))| name.as_str())
    }

    /// In this file, unless it has one already.
    #[must_use]
    pub fn in_file(mut self, name: &str) -> Self {
        self.0.file.get_or_insert_with(|| name.to_owned());
        self
    }

    /// At this line, from 1, unless it has one already.
    #[must_use]
    pub fn at_line(mut self, line: u64) -> Self {
        self.0.line.get_or_insert(line);
        self
    }

    /// At this row, from 1, of a container, which has no lines.
    #[must_use]
    pub fn at_row(mut self, row: u64) -> Self {
        self.0.row.get_or_insert(row);
        self
    }

    /// In the column with this header, unless it has a column or key already.
    #[must_use]
    pub fn in_column(mut self, header: &str) -> Self {
        self.0.field.get_or_insert_with(|| Field::Column(header.to_owned()));
        self
    }

    /// At this key, unless it has a column or key already.
    #[must_use]
    pub fn in_key(mut self, key: &str) -> Self {
        self.0.field.get_or_insert_with(|| Field::Key(key.to_owned()));
        self
    }
}

impl From<ValueError> for FileError {
    fn from(error: ValueError) -> Self {
        Self::new(FileErrorKind::Value, error)
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Located { file, line, row, field, sentence, .. } = &*self.0;
        let place: Vec<String> = [
            file.clone(),
            line.map(|line| format!("line {line}")),
            row.map(|row| format!("row {row}")),
            field.as_ref().map(|field| match field {
                Field::Column(header) => format!("column '{}'", shorten(header)),
                Field::Key(key) => format!("key '{}'", shorten(key)),
            }),
        ]
        .into_iter()
        .flatten()
        .collect();
        let sentence = if place.is_empty() { sentence.clone() } else { format!("{}: {sentence}", place.join(", ")) };
        // Names come from files and may hold anything.
        f.write_str(&one_line(&sentence))
    }
}

impl std::error::Error for FileError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_comes_first_and_only_where_there_is_one() {
        let error = || FileError::new(FileErrorKind::Value, "\"abc\" is not a number; correct it or remove the row");
        assert_eq!(error().to_string(), "\"abc\" is not a number; correct it or remove the row");
        let placed = error().in_file("drive.csv").at_line(17).in_column("uq");
        assert_eq!(placed.to_string(), "drive.csv, line 17, column 'uq': \"abc\" is not a number; correct it or remove the row");
        assert_eq!((placed.file(), placed.line(), placed.column()), (Some("drive.csv"), Some(17), Some("uq")));
        assert_eq!((placed.kind(), placed.advice()), (FileErrorKind::Value, &[][..]));
    }

    #[test]
    fn the_innermost_place_stays() {
        let error = FileError::new(FileErrorKind::Format, "empty").at_line(3).at_line(1).in_file("a").in_file("b");
        assert_eq!(error.to_string(), "a, line 3: empty");
    }
}
