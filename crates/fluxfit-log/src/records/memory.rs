//! A table that is held in memory.

use crate::{
    block::{Block, ColumnHead, WantedColumn},
    problem::Problem,
};
use fluxfit_files::FileError;

/// Rows of a block.
const ROWS: usize = 1 << 13;

/// Columns of numbers, in groups of one length.
#[derive(Debug, Default)]
pub(crate) struct Table {
    pub(super) heads: Vec<ColumnHead>,
    pub(super) values: Vec<Vec<f64>>,
    /// The line of each row, where all columns have the same rows.
    pub(super) lines: Vec<u64>,
    pub(super) unreadable: Vec<String>,
    pub(super) notes: Vec<String>,
}

impl Table {
    /// Adds a column.
    pub(super) fn push(&mut self, head: ColumnHead, values: Vec<f64>) {
        self.heads.push(ColumnHead { rows: values.len() as u64, ..head });
        self.values.push(values);
    }

    /// Passes the rows of columns of one group to `take`.
    pub(super) fn read(&self, wanted: &[WantedColumn], take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>) -> Result<(), FileError> {
        let rows = wanted.first().map_or(0, |column| self.values[column.index].len());
        if wanted.iter().any(|column| self.values[column.index].len() != rows) {
            return Err(Problem::SeveralGroups.into());
        }
        for from in (0..rows).step_by(ROWS) {
            let to = rows.min(from + ROWS);
            let line = |row: usize| self.lines.get(row).copied().unwrap_or(row as u64 + 1);
            take(&mut Block {
                values: wanted.iter().map(|column| self.values[column.index][from..to].to_vec()).collect(),
                lines: (from..to).map(line).collect(),
                refused: vec![None; wanted.len()],
            })?;
        }
        if rows == 0 { Err(Problem::NoRows.into()) } else { Ok(()) }
    }
}
