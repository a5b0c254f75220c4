//! The results as a file: Parquet or CSV, by the ending of its name.

use super::row::{COLUMNS, Kind, Row};
use crate::error::CommandError;
use fluxfit_files::{Output, write_atomically};
use parquet::{
    basic::Compression,
    data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type},
    errors::ParquetError,
    file::{properties::WriterProperties, writer::SerializedFileWriter},
    schema::parser::parse_message_type,
};
use serde_json::Value;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// Formats of the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Csv,
    Parquet,
}

impl Format {
    /// By the ending of the name.
    ///
    /// # Errors
    /// If it is neither.
    pub(crate) fn of(path: &Path) -> Result<Self, CommandError> {
        match path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("parquet") => Ok(Self::Parquet),
            _ => Err(CommandError::Usage(format!("-o {}: the results are CSV or Parquet; name them .csv or .parquet", path.display()))),
        }
    }
}

/// Rows of a row group of Parquet, and of a part of a text: so many are in memory with the names of their columns.
const TOGETHER: usize = 1 << 12;

/// Results that are being written, row by row; they are there as a whole, or not at all.
pub(crate) struct ResultsFile {
    path: PathBuf,
    rows: Vec<Row>,
    file: Growing,
}

enum Growing {
    Csv(Output),
    /// In memory, where its compressed columns are small.
    Parquet(SerializedFileWriter<Vec<u8>>),
}

impl ResultsFile {
    /// Begins a file.
    ///
    /// # Errors
    /// If its name has another ending, or it cannot be written.
    pub(crate) fn begin(path: &Path) -> Result<Self, CommandError> {
        let file = match Format::of(path)? {
            Format::Csv => {
                let mut output = Output::open(path)?;
                output.fill(|file| file.write_all((COLUMNS.map(|(name, _)| name).join(",") + "\n").as_bytes()))?;
                Growing::Csv(output)
            }
            Format::Parquet => Growing::Parquet(parquet().map_err(|error| refusal(path, &error))?),
        };
        Ok(Self { path: path.to_owned(), rows: Vec::new(), file })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn add(&mut self, row: &Row) -> Result<(), CommandError> {
        self.rows.push(row.clone());
        if self.rows.len() < TOGETHER { Ok(()) } else { self.flush() }
    }

    fn flush(&mut self) -> Result<(), CommandError> {
        match &mut self.file {
            Growing::Csv(output) => output.fill(|file| file.write_all(csv(&self.rows).as_bytes()))?,
            Growing::Parquet(file) => group(file, &self.rows).map_err(|error| refusal(&self.path, &error))?,
        }
        self.rows.clear();
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn end(mut self) -> Result<(), CommandError> {
        if !self.rows.is_empty() {
            self.flush()?;
        }
        match self.file {
            Growing::Csv(output) => output.commit()?,
            Growing::Parquet(file) => {
                let bytes = file.into_inner().map_err(|error| refusal(&self.path, &error))?;
                write_atomically(&self.path, &bytes)?;
            }
        }
        Ok(())
    }
}

/// Writes results whose rows are in memory.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(path: &Path, rows: &[Row]) -> Result<(), CommandError> {
    let mut results = ResultsFile::begin(path)?;
    rows.iter().try_for_each(|row| results.add(row))?;
    results.end()
}

fn refusal(path: &Path, error: &ParquetError) -> CommandError {
    CommandError::Usage(format!("-o {}: {error}", path.display()))
}

/// The rows as CSV, with numbers in as many digits as tell them apart.
fn csv(rows: &[Row]) -> String {
    let mut text = String::new();
    for row in rows {
        let cells: Vec<String> = COLUMNS.iter().map(|(name, _)| cell(row.get(*name))).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

fn cell(value: Option<&Value>) -> String {
    match value {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(text)) if text.contains([',', '"', '\n', '\r']) => format!("\"{}\"", text.replace('"', "\"\"")),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    }
}

/// A Parquet file without rows.
fn parquet() -> Result<SerializedFileWriter<Vec<u8>>, ParquetError> {
    let field = |(name, kind): &(&str, Kind)| match kind {
        Kind::Text => format!("optional binary {name} (STRING);"),
        Kind::Number => format!("optional double {name};"),
        Kind::Count => format!("optional int64 {name};"),
    };
    let message = format!("message fleet {{ {} }}", COLUMNS.iter().map(field).collect::<Vec<_>>().join(" "));
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    SerializedFileWriter::new(Vec::new(), Arc::new(parse_message_type(&message)?), Arc::new(properties))
}

/// Adds a row group.
fn group(file: &mut SerializedFileWriter<Vec<u8>>, rows: &[Row]) -> Result<(), ParquetError> {
    let mut group = file.next_row_group()?;
    for (name, kind) in COLUMNS {
        let Some(mut column) = group.next_column()? else { break };
        let values = || rows.iter().filter_map(|row| row.get(name).filter(|value| !value.is_null()));
        let levels: Vec<i16> = rows.iter().map(|row| i16::from(row.get(name).is_some_and(|value| !value.is_null()))).collect();
        match kind {
            Kind::Text => {
                let values: Vec<ByteArray> = values().map(|value| ByteArray::from(value.as_str().unwrap_or_default())).collect();
                column.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?;
            }
            Kind::Number => {
                let values: Vec<f64> = values().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect();
                column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
            }
            Kind::Count => {
                let values: Vec<i64> = values().map(|value| value.as_i64().unwrap_or_default()).collect();
                column.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
            }
        }
        column.close()?;
    }
    group.close().map(drop)
}
