//! A table that a program holds in memory: its arrays, or columns of Arrow. Values are read where they lie, block by block; of a long
//! table only the selected rows are copied.

use crate::{
    block::{Block, ColumnHead, WantedColumn},
    problem::Problem,
};
use fluxfit_files::FileError;
use fluxfit_units::wording::shorten;
use std::{fmt, ops::Range};

/// Rows of a block.
const ROWS: usize = 1 << 13;

/// Appends the numbers of a range of rows; a missing value is NaN.
pub type ReadRows<'a> = Box<dyn Fn(Range<usize>, &mut Vec<f64>) + Send + Sync + 'a>;

/// A column of numbers.
pub struct MemoryColumn<'a> {
    /// Its name, as a header of a file.
    pub name: String,
    /// Its unit, where whoever holds the values knows it: `s` for instants that were counted in another unit.
    pub unit: Option<&'static str>,
    /// How many values there are.
    pub rows: usize,
    /// Reads some of them.
    pub read: ReadRows<'a>,
}

/// Columns of one length.
///
/// ```
/// use fluxfit_log::{LogOptions, MemoryColumn, MemoryTable, read_table};
///
/// let column = |name: &str, values: &'static [f64]| MemoryColumn {
///     name: name.to_owned(),
///     unit: None,
///     rows: values.len(),
///     read: Box::new(|rows, into| into.extend_from_slice(&values[rows])),
/// };
/// let columns = vec![
///     column("t", &[0.0, 1e-3]),
///     column("ud", &[1.5, 1.5]),
///     column("uq", &[20.0, 20.0]),
///     column("id", &[0.0, 0.0]),
///     column("iq", &[3.0, 3.0]),
///     column("omega_e", &[400.0, 400.0]),
/// ];
/// let read = read_table("data", MemoryTable { columns, unreadable: Vec::new() }, &LogOptions::default())?;
/// assert_eq!(read.log.rows(), 2);
/// # Ok::<(), fluxfit_files::FileError>(())
/// ```
#[derive(Default)]
pub struct MemoryTable<'a> {
    /// The columns of numbers.
    pub columns: Vec<MemoryColumn<'a>>,
    /// Names of columns that hold no numbers, such as texts.
    pub unreadable: Vec<String>,
}

impl MemoryTable<'_> {
    /// The number of rows.
    ///
    /// # Errors
    /// If the columns have different lengths.
    pub fn rows(&self) -> Result<usize, FileError> {
        let rows = self.columns.first().map_or(0, |column| column.rows);
        if self.columns.iter().any(|column| column.rows != rows) {
            let length = |column: &MemoryColumn| format!("'{}' has {} rows", shorten(&column.name), column.rows);
            return Err(Problem::Lengths { lengths: self.columns.iter().map(length).collect() }.into());
        }
        Ok(rows)
    }

    /// Some consecutive rows as a table, whose values stay where they lie.
    pub fn part(&self, rows: Range<usize>) -> MemoryTable<'_> {
        let (start, rows) = (rows.start, rows.len());
        let columns = self.columns.iter().map(|column| MemoryColumn {
            name: column.name.clone(),
            unit: column.unit,
            rows,
            read: Box::new(move |some, into| (column.read)(start + some.start..start + some.end, into)),
        });
        MemoryTable { columns: columns.collect(), unreadable: self.unreadable.clone() }
    }
}

impl fmt::Debug for MemoryTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.columns.iter().map(|column| (&column.name, column.rows))).finish()
    }
}

/// A table in memory with what the reader asks of every table.
pub(crate) struct Held<'a> {
    pub(crate) heads: Vec<ColumnHead>,
    pub(crate) table: MemoryTable<'a>,
}

impl<'a> Held<'a> {
    /// Refuses columns of different lengths.
    pub(crate) fn of(table: MemoryTable<'a>) -> Result<Self, FileError> {
        table.rows()?;
        let head = |column: &MemoryColumn| ColumnHead {
            name: column.name.clone(),
            unit: column.unit.map(str::to_owned),
            rows: column.rows as u64,
            ..ColumnHead::default()
        };
        Ok(Self { heads: table.columns.iter().map(head).collect(), table })
    }

    /// Passes the rows of the wanted columns to `take`.
    pub(crate) fn read(&self, wanted: &[WantedColumn], take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>) -> Result<(), FileError> {
        let rows = wanted.first().map_or(0, |column| self.table.columns[column.index].rows);
        let mut block = Block::of(wanted.len());
        for from in (0..rows).step_by(ROWS) {
            let to = rows.min(from + ROWS);
            block = block.emptied(wanted.len());
            for (values, column) in block.values.iter_mut().zip(wanted) {
                (self.table.columns[column.index].read)(from..to, values);
            }
            block.lines.extend(from as u64 + 1..=to as u64);
            take(&mut block)?;
        }
        if rows == 0 { Err(Problem::NoRows.into()) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_its_rows_and_no_other() {
        let values = [0.0, 1.0, 2.0, 3.0, 4.0];
        let column = |name: &str, values: &'static [f64]| MemoryColumn {
            name: name.to_owned(),
            unit: Some("s"),
            rows: values.len(),
            read: Box::new(|rows, into| into.extend_from_slice(&values[rows])),
        };
        let table = MemoryTable { columns: vec![column("t", &[0.0, 1.0, 2.0, 3.0, 4.0])], unreadable: vec!["motor".to_owned()] };
        let part = table.part(1..4);
        assert_eq!((part.rows().unwrap(), part.unreadable.as_slice()), (3, ["motor".to_owned()].as_slice()));
        let mut read = Vec::new();
        (part.part(1..3).columns[0].read)(0..2, &mut read);
        assert_eq!(read, values[2..4]);
        let uneven = MemoryTable { columns: vec![column("t", &[0.0]), column("iq", &[])], unreadable: Vec::new() };
        assert!(uneven.rows().unwrap_err().to_string().contains("'t' has 1 rows and 'iq' has 0 rows"));
    }
}
