//! The error of everything that reads or writes files: one sentence on one line that says where, what, and what to do.
//!
//! `drive.csv, line 17, column 'uq': "abc" is not a number; correct it or remove the row`
//!
//! The place is stated once, by [`FileError`]; the sentence once, by the problem of the crate that found it.

use fluxfit_units::wording::{one_line, shorten};
use std::fmt;

/// What could not be read, written or understood, and where. Its `Display` is one line.
#[derive(Debug, Clone, PartialEq)]
pub struct FileError(Box<Located>);

#[derive(Debug, Clone, PartialEq)]
struct Located {
    file: Option<String>,
    line: Option<u64>,
    row: Option<u64>,
    field: Option<Field>,
    sentence: String,
}

#[derive(Debug, Clone, PartialEq)]
enum Field {
    Column(String),
    Key(String),
}

impl FileError {
    /// An error that has no place yet.
    pub fn new(problem: &impl fmt::Display) -> Self {
        Self(Box::new(Located { file: None, line: None, row: None, field: None, sentence: problem.to_string() }))
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

    /// At this line, unless it has one already.
    #[must_use]
    pub fn at_line(mut self, line: u64) -> Self {
        self.0.line.get_or_insert(line);
        self
    }

    /// At this row of a container, which has no lines; rows count from 1.
    #[must_use]
    pub fn at_row(mut self, row: u64) -> Self {
        self.0.row.get_or_insert(row);
        self
    }

    /// In the column with this header.
    #[must_use]
    pub fn in_column(mut self, header: &str) -> Self {
        self.0.field.get_or_insert_with(|| Field::Column(header.to_owned()));
        self
    }

    /// At this key.
    #[must_use]
    pub fn in_key(mut self, key: &str) -> Self {
        self.0.field.get_or_insert_with(|| Field::Key(key.to_owned()));
        self
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Located { file, line, row, field, sentence } = &*self.0;
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
    use crate::problem::Problem;

    #[test]
    fn the_place_comes_first_and_only_where_there_is_one() {
        let problem = || FileError::from(Problem::NotANumber { text: "abc".into() });
        assert_eq!(problem().to_string(), "\"abc\" is not a number; correct it or remove the row");
        let placed = problem().in_file("drive.csv").at_line(17).in_column("uq");
        assert_eq!(placed.to_string(), "drive.csv, line 17, column 'uq': \"abc\" is not a number; correct it or remove the row");
        assert_eq!((placed.file(), placed.line(), placed.column()), (Some("drive.csv"), Some(17), Some("uq")));
    }

    #[test]
    fn the_innermost_place_stays() {
        let error = FileError::from(Problem::Empty).at_line(3).at_line(1).in_file("a").in_file("b");
        assert_eq!(error.to_string(), "a, line 3: the file is empty; export it again");
    }
}
