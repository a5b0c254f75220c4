//! Columns of a table before anything is known of what they mean, and their values in blocks of rows.

use fluxfit_files::FileError;

/// A column of a container as it is found there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Head {
    /// Fields of structures are joined by dots, and `(:,2)` is the second column of a matrix.
    pub(crate) name: String,
    /// As the file spells it.
    pub(crate) unit: Option<String>,
    pub(crate) rows: u64,
    /// Columns with the same number share their rows' instants; others were sampled at others.
    pub(crate) group: usize,
    /// This column is the time of its group: the master channel of an MDF file, or the field `time` or `Time` of a structure.
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

impl Block {
    pub(crate) fn of(columns: usize) -> Self {
        Self { values: vec![Vec::new(); columns], lines: Vec::new(), refused: vec![None; columns] }
    }

    /// Why the column of this place cannot be read: the first reason stays.
    pub(crate) fn refuse(&mut self, place: usize, error: FileError) {
        self.refused[place].get_or_insert(error);
    }
}
