//! Finished results, read again for their page: Parquet or CSV, as one machine, Dask or Spark wrote them.

use super::row::{COLUMNS, Kind, Row};
use crate::error::CommandError;
use fluxfit::{Parameter, Verdict};
use fluxfit_files::{
    FileError, FileErrorKind, Problem,
    csv::record,
    input::{name, read as read_bytes, text},
};
use fluxfit_log::guarded;
use parquet::{
    errors::ParquetError,
    file::{reader::FileReader, serialized_reader::SerializedFileReader},
    record::Field,
};
use serde_json::{Map, Value, json};
use std::{
    fs::File,
    path::{Path, PathBuf},
};

/// What a Parquet file begins with.
const SIGNATURE: &[u8] = b"PAR1";

/// The rows of finished results, one file after the other.
///
/// # Errors
/// If a file cannot be read, or holds no results.
pub(super) fn read(paths: &[PathBuf]) -> Result<Vec<Row>, CommandError> {
    let mut rows = Vec::new();
    for path in paths {
        let bytes = read_bytes(path)?;
        let read = if bytes.starts_with(SIGNATURE) { of_parquet(path, &mut rows) } else { of_csv(&bytes, &mut rows) };
        read.map_err(|error| error.in_file(&name(path)))?;
    }
    Ok(rows)
}

/// The columns without which a table holds no results of a fleet.
fn needed() -> impl Iterator<Item = String> {
    let of_parameter = |parameter: Parameter| ["", "_low", "_high", "_verdict"].map(|end| format!("{}{end}", parameter.key()));
    ["motor", "error"].map(str::to_owned).into_iter().chain(Parameter::ALL.into_iter().flat_map(of_parameter))
}

/// Refuses a table that holds something else.
fn check(names: &[String]) -> Result<(), FileError> {
    needed().find(|needed| !names.contains(needed)).map_or(Ok(()), |missing| {
        let sentence =
            format!("these are no results of a fleet: there is no column {missing}; to identify motors, name the results with -o");
        Err(FileError::new(FileErrorKind::Columns, sentence))
    })
}

fn of_csv(bytes: &[u8], rows: &mut Vec<Row>) -> Result<(), FileError> {
    let text = text(bytes, "CSV")?;
    let (names, body) = record::first_record(text, b',');
    check(&names)?;
    let rest = &text.as_bytes()[body..];
    let mut reader = record::reader(rest, b',');
    let mut cells = Default::default();
    while record::next(&mut reader, &mut cells)? {
        let line = || record::line_of(text, body + record::offset(&cells));
        if cells.len() != names.len() {
            let problem = Problem::RowLength { found: cells.len(), expected: names.len(), multiline: false };
            return Err(FileError::from(problem).at_line(line()));
        }
        let cells_by_name = names.iter().zip(&cells).map(|(name, cell)| (name.as_str(), Value::String(record::text_of(cell))));
        rows.push(row(cells_by_name).map_err(|error| error.at_line(line()))?);
    }
    Ok(())
}

fn of_parquet(path: &Path, rows: &mut Vec<Row>) -> Result<(), FileError> {
    const FORMAT: &str = "Parquet";
    let fault = |error: ParquetError| FileError::from(Problem::Syntax { format: FORMAT, message: error.to_string() });
    let io = |error: std::io::Error| FileError::from(Problem::Io { action: "reading", reason: error.to_string() });
    let file = File::open(path).map_err(io)?;
    let file = guarded(FORMAT, || SerializedFileReader::new(file).map_err(fault))?;
    let columns = file.metadata().file_metadata().schema_descr().columns();
    check(&columns.iter().map(|column| column.name().to_owned()).collect::<Vec<_>>())?;
    let mut records = guarded(FORMAT, || file.get_row_iter(None).map_err(fault))?;
    while let Some(record) = guarded(FORMAT, || records.next().transpose().map_err(fault))? {
        let at_row = rows.len() as u64 + 1;
        let cells = record.get_column_iter().map(|(name, field)| (name.as_str(), value_of(field)));
        rows.push(row(cells).map_err(|error| error.at_row(at_row))?);
    }
    Ok(())
}

fn value_of(field: &Field) -> Value {
    match field {
        Field::Str(text) => Value::String(text.clone()),
        Field::Bytes(bytes) => Value::String(String::from_utf8_lossy(bytes.data()).into_owned()),
        Field::Double(number) => json!(number),
        Field::Float(number) => json!(number),
        Field::Long(count) => json!(count),
        Field::Int(count) => json!(count),
        _ => Value::Null,
    }
}

/// A row of the results from its cells; columns that are no results are left out.
fn row<'a>(cells: impl Iterator<Item = (&'a str, Value)>) -> Result<Row, FileError> {
    let mut row: Row = COLUMNS.iter().map(|(name, _)| ((*name).to_owned(), Value::Null)).collect::<Map<_, _>>();
    for (name, value) in cells {
        let Some((_, kind)) = COLUMNS.iter().find(|(known, _)| *known == name) else { continue };
        let value = cell(*kind, value).map_err(|text| FileError::from(Problem::NotANumber { text }).in_column(name))?;
        if name.ends_with("_verdict") {
            check_verdict(&value).map_err(|error| error.in_column(name))?;
        }
        row[name] = value;
    }
    // Rows without a name are those of the motor without a name.
    if row["motor"].is_null() {
        row["motor"] = "".into();
    }
    Ok(row)
}

/// The value of a cell; the text that should be a number.
fn cell(kind: Kind, value: Value) -> Result<Value, String> {
    match (kind, value) {
        (Kind::Text, Value::String(text)) if text.is_empty() => Ok(Value::Null),
        (Kind::Text, Value::Number(number)) => Ok(Value::String(number.to_string())),
        (Kind::Text, value) => Ok(value),
        (_, Value::String(text)) if text.trim().is_empty() => Ok(Value::Null),
        (_, Value::String(text)) => text.trim().parse::<f64>().map(|number| json!(number)).map_err(|_| text),
        (_, value) => Ok(value),
    }
}

fn check_verdict(value: &Value) -> Result<(), FileError> {
    let Some(text) = value.as_str().filter(|text| Verdict::of_key(text).is_none()) else { return Ok(()) };
    let known = vec![Verdict::Identified.key(), Verdict::Weak.key(), Verdict::NotIdentifiable.key()];
    Err(Problem::Word { text: text.to_owned(), known, nearest: None }.into())
}
