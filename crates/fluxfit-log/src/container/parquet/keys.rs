//! A column of names, as runs of equal ones: the motor of each row of a table.

use super::{FORMAT, Parquet, fault};
use crate::{container::guard::guarded, problem::Problem};
use fluxfit_files::FileError;
use parquet::{
    column::reader::{ColumnReader, ColumnReaderImpl},
    data_type::DataType,
    file::reader::FileReader,
};

/// A name, or none, and how many rows have it one after the other.
pub(crate) type Run = (Option<String>, u64);

/// Rows that are read at a time.
const ROWS: usize = 1 << 13;

impl Parquet {
    /// Names of all columns, those of texts too.
    pub(crate) fn names(&self) -> Vec<String> {
        let schema = self.file.metadata().file_metadata().schema_descr_ptr();
        schema.columns().iter().map(|column| column.path().parts().join(".")).collect()
    }

    /// The values of a column of texts or whole numbers as runs: each with its number of rows; `None` of rows without one. `None` if there
    /// is no such column.
    ///
    /// # Errors
    /// If the file is damaged, or the column holds something else.
    pub(crate) fn runs(&self, name: &str) -> Result<Option<Vec<Run>>, FileError> {
        let Some(leaf) = self.names().iter().position(|other| other == name) else { return Ok(None) };
        let mut runs: Vec<Run> = Vec::new();
        for group in 0..self.file.num_row_groups() {
            let reader = guarded(FORMAT, || self.file.get_row_group(group).and_then(|group| group.get_column_reader(leaf)).map_err(fault))?;
            match reader {
                ColumnReader::ByteArrayColumnReader(reader) => {
                    read(reader, |text| String::from_utf8_lossy(text.data()).into_owned(), &mut runs)?;
                }
                ColumnReader::Int32ColumnReader(reader) => read(reader, ToString::to_string, &mut runs)?,
                ColumnReader::Int64ColumnReader(reader) => read(reader, ToString::to_string, &mut runs)?,
                _ => return Err(FileError::from(Problem::MotorNames).in_column(name)),
            }
        }
        Ok(Some(runs))
    }
}

/// Adds the values of a part of the column.
fn read<T: DataType>(mut reader: ColumnReaderImpl<T>, name: impl Fn(&T::T) -> String, runs: &mut Vec<Run>) -> Result<(), FileError>
where
    T::T: PartialEq,
{
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    loop {
        levels.clear();
        values.clear();
        let (rows, _, _) = guarded(FORMAT, || reader.read_records(ROWS, Some(&mut levels), None, &mut values).map_err(fault))?;
        if rows == 0 {
            return Ok(());
        }
        // The value of the run that is open in this block: equal ones are not made a text again.
        let (mut open, mut next): (Option<&T::T>, usize) = (None, 0);
        for row in 0..rows {
            let has_value = levels.get(row).is_none_or(|level| *level > 0);
            let value = if has_value { values.get(next) } else { None };
            next += usize::from(has_value);
            if row > 0 && open == value {
                if let Some((_, rows)) = runs.last_mut() {
                    *rows += 1;
                }
                continue;
            }
            open = value;
            let text = value.map(&name);
            match runs.last_mut() {
                Some((last, rows)) if *last == text => *rows += 1,
                _ => runs.push((text, 1)),
            }
        }
    }
}
