//! The results as a file: Parquet or CSV, by the ending of its name.

use super::row::{COLUMNS, Kind, Row};
use crate::error::CommandError;
use fluxfit_files::write_atomically;
use parquet::{
    basic::Compression,
    data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type},
    errors::ParquetError,
    file::{properties::WriterProperties, writer::SerializedFileWriter},
    schema::parser::parse_message_type,
};
use serde_json::Value;
use std::{path::Path, sync::Arc};

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

/// Writes the results, whole or not at all.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write<'a>(path: &Path, rows: impl Iterator<Item = &'a Row>) -> Result<(), CommandError> {
    let rows: Vec<&Row> = rows.collect();
    let bytes = match Format::of(path)? {
        Format::Csv => csv(&rows).into_bytes(),
        Format::Parquet => parquet(&rows).map_err(|error| CommandError::Usage(format!("-o {}: {error}", path.display())))?,
    };
    Ok(write_atomically(path, &bytes)?)
}

/// The rows as CSV, with numbers in as many digits as tell them apart.
fn csv(rows: &[&Row]) -> String {
    let mut text = COLUMNS.map(|(name, _)| name).join(",") + "\n";
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

fn parquet(rows: &[&Row]) -> Result<Vec<u8>, ParquetError> {
    let field = |(name, kind): &(&str, Kind)| match kind {
        Kind::Text => format!("optional binary {name} (STRING);"),
        Kind::Number => format!("optional double {name};"),
        Kind::Count => format!("optional int64 {name};"),
    };
    let message = format!("message fleet {{ {} }}", COLUMNS.iter().map(field).collect::<Vec<_>>().join(" "));
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, Arc::new(parse_message_type(&message)?), Arc::new(properties))?;
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
    group.close()?;
    file.close()?;
    Ok(bytes)
}
