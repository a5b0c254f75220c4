//! A table, whatever it came in: named columns, and their values in blocks of rows.

use crate::{csv::TextTable, error::FileError};
use std::io::Read;

/// A column as the file has it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Head {
    pub(crate) name: String,
    /// As the file spells it, apart from the name.
    pub(crate) unit: Option<String>,
    pub(crate) rows: u64,
    /// Columns with the same number share their rows' instants; others were sampled at others.
    pub(crate) group: usize,
    /// This column is the time of its group.
    pub(crate) is_time: bool,
}

/// A column whose values are wanted.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wanted {
    pub(crate) index: usize,
    pub(crate) header: String,
    pub(crate) is_time: bool,
    /// Nobody asked for it: if its cells are no numbers it is left out, and the log is read.
    pub(crate) dispensable: bool,
}

/// Rows of the wanted columns.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// One for each wanted column; a missing value is NaN.
    pub(crate) values: Vec<Vec<f64>>,
    /// The line of each row in a file of text; elsewhere the row, from 1.
    pub(crate) lines: Vec<u64>,
    /// Why a dispensable column cannot be read, where it cannot.
    pub(crate) refused: Vec<Option<FileError>>,
}

/// What a table came in.
pub(crate) enum Table {
    Text(TextTable),
}

impl Block {
    pub(crate) fn of(columns: usize) -> Self {
        Self { values: vec![Vec::new(); columns], lines: Vec::new(), refused: vec![None; columns] }
    }

    /// Why the column of this place cannot be read: the first reason stays.
    pub(crate) fn refuse(&mut self, place: usize, error: FileError) {
        self.refused[place].get_or_insert(error);
    }
}

impl Table {
    /// Reads as far as the names of the columns.
    ///
    /// # Errors
    /// If it cannot be read, or has none.
    pub(crate) fn open(raw: Box<dyn Read>) -> Result<Self, FileError> {
        TextTable::open(raw).map(Self::Text)
    }

    pub(crate) fn heads(&self) -> &[Head] {
        match self {
            Self::Text(table) => &table.heads,
        }
    }

    /// What had to be inferred so far.
    pub(crate) fn notes(&self) -> &[String] {
        match self {
            Self::Text(table) => &table.notes,
        }
    }

    /// The line with the names, in a file of text.
    pub(crate) fn line(&self) -> Option<u64> {
        match self {
            Self::Text(table) => Some(table.line()),
        }
    }

    /// What it is, in a few words.
    pub(crate) fn kind(&self) -> String {
        match self {
            Self::Text(table) => format!("text, separated by {}", table.separator()),
        }
    }

    /// Values of columns of one group; what had to be inferred.
    ///
    /// # Errors
    /// Those of reading, and of `take`.
    pub(crate) fn read(
        &mut self,
        wanted: &[Wanted],
        take: &mut dyn FnMut(Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        match self {
            Self::Text(table) => table.read(wanted, take),
        }
    }
}
