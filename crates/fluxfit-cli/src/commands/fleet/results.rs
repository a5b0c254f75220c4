//! Finished results, read again for their page: Parquet or CSV, as one machine, Dask or Spark wrote them. One row is in memory at a time,
//! and of a CSV file one block.

use super::row::{COLUMNS, Kind, Row};
use crate::error::CommandError;
use fluxfit::{Parameter, Verdict};
use fluxfit_files::{
    FileError, FileErrorKind, Problem,
    csv::record,
    input::{Bytes, io_problem, line_at, name, open, text},
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
    io::{BufRead, BufReader, Read},
    path::{Path, PathBuf},
};

/// What a Parquet file begins with.
const SIGNATURE: &[u8] = b"PAR1";

/// Bytes of text in memory at a time: some thousand rows.
const BLOCK: usize = 1 << 20;

/// Passes on the rows of finished results, one file after the other.
///
/// # Errors
/// If a file cannot be read, or holds no results.
pub(super) fn read(paths: &[PathBuf], take: &mut dyn FnMut(&Row)) -> Result<(), CommandError> {
    for path in paths {
        read_one(path, take).map_err(|error| error.in_file(&name(path)))?;
    }
    Ok(())
}

fn read_one(path: &Path, take: &mut dyn FnMut(&Row)) -> Result<(), FileError> {
    let mut bytes: Box<dyn Read> = match open(path)? {
        Bytes::File(file, _) => Box::new(file),
        Bytes::Stream(stream) => stream,
    };
    let mut start = Vec::new();
    bytes.by_ref().take(SIGNATURE.len() as u64).read_to_end(&mut start).map_err(|error| io_problem("reading", &error))?;
    if start == SIGNATURE { of_parquet(path, take) } else { of_csv(start.chain(bytes), take) }
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

fn of_csv(bytes: impl Read, take: &mut dyn FnMut(&Row)) -> Result<(), FileError> {
    let mut lines = BufReader::new(bytes);
    let (mut names, mut block, mut above) = (None, Vec::new(), 0);
    while next_block(&mut lines, &mut block).map_err(|error| io_problem("reading", &error))? {
        // Blank lines at the end of a file may be a block.
        if names.is_none() || !block.trim_ascii().is_empty() {
            rows_of(&block, &mut names, above, take)?;
        }
        above += line_at(&block, block.len()) - 1;
    }
    // Of a file without a byte, the refusal.
    if names.is_none() { text(b"", "CSV").map(drop) } else { Ok(()) }
}

/// The next records of a text that are whole, some [`BLOCK`] of them; false at the end. A record does not end inside of quotes, where a
/// line may.
fn next_block(lines: &mut impl BufRead, block: &mut Vec<u8>) -> std::io::Result<bool> {
    block.clear();
    let (mut from, mut is_quoted) = (0, false);
    while (block.len() < BLOCK || is_quoted) && lines.read_until(b'\n', block)? > 0 {
        is_quoted ^= block[from..].iter().filter(|byte| **byte == b'"').count() % 2 == 1;
        from = block.len();
    }
    Ok(!block.is_empty())
}

/// The text of a block above which are so many lines.
fn text_below(block: &[u8], above: u64) -> Result<&str, FileError> {
    let zero = block.iter().position(|byte| *byte == 0);
    match (str::from_utf8(block), zero) {
        _ if above == 0 => text(block, "CSV"),
        (Ok(text), None) => Ok(text),
        (found, zero) => {
            let at = found.err().map(|error| error.valid_up_to()).or(zero).unwrap_or(0);
            Err(FileError::from(Problem::NotText { wanted: "CSV" }).at_line(above + line_at(block, at)))
        }
    }
}

/// Passes on the rows of a block, above which are so many lines. The first record of the file has the names.
fn rows_of(block: &[u8], names: &mut Option<Vec<String>>, above: u64, take: &mut dyn FnMut(&Row)) -> Result<(), FileError> {
    let below = |error: FileError, line: u64| error.at_line(above + line);
    let text = text_below(block, above)?;
    let (names, body) = match names {
        Some(names) => (names, 0),
        None => {
            let (found, body) = record::first_record(text, b',');
            check(&found)?;
            (names.insert(found), body)
        }
    };
    let mut reader = record::reader(&text.as_bytes()[body..], b',');
    let mut cells = Default::default();
    while record::next(&mut reader, &mut cells)? {
        let line = || record::line_of(text, body + record::offset(&cells));
        if cells.len() != names.len() {
            let problem = Problem::RowLength { found: cells.len(), expected: names.len(), multiline: false };
            return Err(below(problem.into(), line()));
        }
        let cells_by_name = names.iter().zip(&cells).map(|(name, cell)| (name.as_str(), Value::String(record::text_of(cell))));
        take(&row(cells_by_name).map_err(|error| below(error, line()))?);
    }
    Ok(())
}

fn of_parquet(path: &Path, take: &mut dyn FnMut(&Row)) -> Result<(), FileError> {
    const FORMAT: &str = "Parquet";
    let fault = |error: ParquetError| FileError::from(Problem::Syntax { format: FORMAT, message: error.to_string() });
    let io = |error: std::io::Error| FileError::from(Problem::Io { action: "reading", reason: error.to_string() });
    let file = File::open(path).map_err(io)?;
    let file = guarded(FORMAT, || SerializedFileReader::new(file).map_err(fault))?;
    let columns = file.metadata().file_metadata().schema_descr().columns();
    check(&columns.iter().map(|column| column.name().to_owned()).collect::<Vec<_>>())?;
    let mut records = guarded(FORMAT, || file.get_row_iter(None).map_err(fault))?;
    let mut at_row = 0;
    while let Some(record) = guarded(FORMAT, || records.next().transpose().map_err(fault))? {
        at_row += 1;
        let cells = record.get_column_iter().map(|(name, field)| (name.as_str(), value_of(field)));
        take(&row(cells).map_err(|error| error.at_row(at_row))?);
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
