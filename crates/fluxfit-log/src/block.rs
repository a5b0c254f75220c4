//! Columns of a table, whatever they mean, and their values in blocks of rows.

use crate::instant::Instants;
use fluxfit_files::FileError;

/// Name, unit and length of a column, as the file states them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct ColumnHead {
    /// Fields of structures are joined by dots, and `(:,2)` is the second column of a matrix.
    pub(crate) name: String,
    /// The unit, as the file spells it.
    pub(crate) unit: Option<String>,
    /// Number of rows; 0 of a table of text, where it is not known.
    pub(crate) rows: u64,
    /// Columns of one group were sampled at the same instants.
    pub(crate) group: usize,
    /// This column is the time of its group: the master channel of an MDF file, or the field `time` or `Time` of a structure.
    pub(crate) is_time: bool,
    /// Its cells are instants, by the first rows of a text.
    pub(crate) instants: Option<Instants>,
}

/// A column whose values are to be read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WantedColumn {
    pub(crate) index: usize,
    pub(crate) header: String,
    pub(crate) is_time: bool,
    /// Cells that are not numbers do not refuse the table.
    pub(crate) is_optional: bool,
    /// Its cells are to be read as instants, in s.
    pub(crate) instants: Option<Instants>,
}

/// Rows of the wanted columns.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// The values of each wanted column; a missing value is NaN.
    pub(crate) values: Vec<Vec<f64>>,
    /// The line of each row in a file of text, from 1; the number of the row in other formats.
    pub(crate) lines: Vec<u64>,
    /// For each wanted column, why it cannot be read, if it is optional and cannot.
    pub(crate) refused: Vec<Option<FileError>>,
}

impl Block {
    /// An empty block.
    pub(crate) fn of(columns: usize) -> Self {
        Self { values: vec![Vec::new(); columns], lines: Vec::new(), refused: vec![None; columns] }
    }

    /// An empty block of as many columns in the memory of this one.
    pub(crate) fn emptied(mut self, columns: usize) -> Self {
        self.values.resize_with(columns, Vec::new);
        self.values.iter_mut().for_each(Vec::clear);
        self.lines.clear();
        self.refused.clear();
        self.refused.resize(columns, None);
        self
    }

    /// Records why a wanted column cannot be read; the first reason stays.
    pub(crate) fn refuse(&mut self, column: usize, error: FileError) {
        self.refused[column].get_or_insert(error);
    }
}
