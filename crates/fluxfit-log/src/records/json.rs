//! JSON: an object for each row, one below the other or in an array; or an object with a list for each column.
//!
//! Objects within an object are joined by dots: `{"motor": {"id": 1}}` is the column `motor.id`. Records are read one by one, whatever the
//! length of the file.

use super::memory::Table;
use crate::{
    block::{Block, ColumnHead, WantedColumn},
    container::MOST_COLUMNS,
    csv::Text,
    instant::Instants,
    problem::Problem,
};
use fluxfit_files::{FileError, Problem as FileProblem, csv::record::number, input::io_problem, json_fault};
use fluxfit_units::wording::shorten;
use serde_json::{Map, Value};
use std::{
    collections::HashMap,
    io::{Cursor, ErrorKind, Read},
};

/// Bytes of the longest record, or object of columns.
const LONGEST: usize = 1 << 24;

/// Records whose keys are the columns; keys that come later are not read.
const FIRST_RECORDS: usize = 1000;

/// Rows of a block.
const ROWS: usize = 1 << 12;

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

pub(crate) struct Json {
    pub(super) heads: Vec<ColumnHead>,
    pub(super) unreadable: Vec<String>,
    records: Splitter,
}

/// JSON whose columns are known.
pub(super) enum Opened {
    /// A record for each row.
    Records(Box<Json>),
    /// A list for each column.
    Columns(Table),
}

/// Whether a text is JSON: it begins with an object, or with an array of something that JSON has.
pub(super) fn is_json(head: &str) -> bool {
    let start = head.trim_start();
    let inner = || start[1..].trim_start().starts_with(|c: char| matches!(c, '{' | '[' | ']' | '"' | '-') || c.is_ascii_digit());
    start.starts_with('{') || start.starts_with('[') && inner()
}

/// Reads the columns.
pub(super) fn open(text: Text) -> Result<Opened, FileError> {
    let mut first = Splitter::new(Box::new(Cursor::new(text.head.clone().into_bytes())), text.has_rest());
    let mut keys: Vec<String> = Vec::new();
    let mut texts: HashMap<String, Vec<String>> = HashMap::new();
    let mut count = 0;
    let records = Splitter::new(Box::new(Cursor::new(text.head.into_bytes()).chain(text.rest)), false);
    while count < FIRST_RECORDS {
        let Some((line, bytes)) = first.next()? else { break };
        let record = parse(&bytes).map_err(|error| error.at_line(line))?;
        count += 1;
        for (key, value) in flat(&record) {
            let known = texts.entry(key.clone()).or_insert_with(|| {
                keys.push(key);
                Vec::new()
            });
            if let Some(cell) = cell(value) {
                known.push(cell);
            }
        }
        if keys.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
    }
    if count < 2 {
        return of_columns(records);
    }
    let (mut heads, mut unreadable) = (Vec::new(), Vec::new());
    for name in keys {
        let cells = texts.remove(&name).unwrap_or_default();
        let cells: Vec<&str> = cells.iter().map(String::as_str).collect();
        let instants = Instants::of(&cells);
        if instants.is_none() && cells.iter().any(|cell| text_number(cell).is_none()) {
            unreadable.push(name.clone());
        }
        heads.push(ColumnHead { name, instants, ..ColumnHead::default() });
    }
    // A column of texts can still be named, and is then refused where its first text is.
    Ok(Opened::Records(Box::new(Json { heads, unreadable, records })))
}

impl Json {
    pub(super) fn read(
        &mut self,
        wanted: &[WantedColumn],
        take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        let names: Vec<String> = wanted.iter().map(|column| self.heads[column.index].name.clone()).collect();
        let mut block = Block::of(wanted.len());
        let mut any = false;
        while let Some((line, bytes)) = self.records.next()? {
            let record = parse(&bytes).map_err(|error| error.at_line(line))?;
            let mut is_empty = true;
            for (place, (column, name)) in wanted.iter().zip(&names).enumerate() {
                let found = lookup(&record, name);
                let value = value_of(found, column).or_else(|error| {
                    let error = error.in_column(name).at_line(line);
                    if column.is_optional {
                        block.refuse(place, error);
                        return Ok(f64::NAN);
                    }
                    Err(error)
                })?;
                is_empty &= value.is_nan();
                block.values[place].push(value);
            }
            if is_empty {
                // A record of something else, such as a heading.
                block.values.iter_mut().for_each(|values| _ = values.pop());
                continue;
            }
            any = true;
            block.lines.push(line);
            if block.lines.len() == ROWS {
                take(&mut block)?;
                block = block.emptied(wanted.len());
            }
        }
        if !any {
            return Err(Problem::NoRows.into());
        }
        take(&mut block)?;
        Ok(Vec::new())
    }
}

/// The number of a value; NaN of none.
fn value_of(value: Option<&Value>, column: &WantedColumn) -> Result<f64, FileError> {
    let Some(text) = value.and_then(cell) else { return Ok(f64::NAN) };
    let found = match (&column.instants, value) {
        (Some(instants), _) => instants.seconds(text.as_bytes()),
        (None, Some(Value::Number(number))) => number.as_f64(),
        _ => text_number(&text),
    };
    found.ok_or_else(|| if column.instants.is_some() { Problem::Instant { text }.into() } else { FileProblem::NotANumber { text }.into() })
}

/// A value as text; none of null and of an empty text.
fn cell(value: &Value) -> Option<String> {
    match value {
        Value::Null => None,
        Value::String(text) => (!text.trim().is_empty()).then(|| text.trim().to_owned()),
        other => Some(other.to_string()),
    }
}

fn text_number(text: &str) -> Option<f64> {
    number(text.as_bytes(), b',', &mut String::new())
}

/// The value with this name, in objects within objects.
fn lookup<'a>(record: &'a Map<String, Value>, name: &str) -> Option<&'a Value> {
    if let Some(value) = record.get(name) {
        return Some(value);
    }
    name.match_indices('.').find_map(|(at, _)| match record.get(&name[..at])? {
        Value::Object(inner) => lookup(inner, &name[at + 1..]),
        _ => None,
    })
}

/// The names and values of a record.
fn flat(record: &Map<String, Value>) -> Vec<(String, &Value)> {
    let mut found = Vec::new();
    for (key, value) in record {
        match value {
            Value::Object(inner) => found.extend(flat(inner).into_iter().map(|(name, value)| (format!("{key}.{name}"), value))),
            Value::Array(_) => {}
            _ => found.push((key.clone(), value)),
        }
    }
    found
}

fn parse(bytes: &[u8]) -> Result<Map<String, Value>, FileError> {
    let refuse = |error: &serde_json::Error| Problem::Json { reason: json_fault(error) };
    serde_json::from_slice(bytes).or_else(|error| match without_nan(bytes) {
        Some(bytes) => serde_json::from_slice(&bytes).map_err(|error| refuse(&error).into()),
        None => Err(refuse(&error).into()),
    })
}

/// NaN and Infinity, which Python writes and JSON does not have, as null; none if the text has none of them.
fn without_nan(bytes: &[u8]) -> Option<Vec<u8>> {
    let (mut changed, mut at, mut is_text, mut any) = (Vec::with_capacity(bytes.len()), 0, false, false);
    while let Some(byte) = bytes.get(at) {
        let word = [&b"-Infinity"[..], b"Infinity", b"NaN"].into_iter().find(|word| !is_text && bytes[at..].starts_with(word));
        if let Some(word) = word {
            changed.extend_from_slice(b"null");
            at += word.len();
            any = true;
            continue;
        }
        is_text ^= *byte == b'"' && (at == 0 || bytes[at - 1] != b'\\');
        changed.push(*byte);
        at += 1;
    }
    any.then_some(changed)
}

/// An object with a list for each column, as pandas writes them.
fn of_columns(mut records: Splitter) -> Result<Opened, FileError> {
    let none = |reason: String| FileError::from(Problem::Json { reason });
    let nothing = || "it has no records".to_owned();
    let (_, bytes) = records.next()?.ok_or_else(|| none(nothing()))?;
    let mut held = Held::default();
    held.gather(parse(&bytes)?, &mut Vec::new());
    let longest = held.columns.iter().map(|(_, values)| values.len()).max().unwrap_or_default();
    // A few records beside longer columns are events.
    if let Some(records) = held.records.into_iter().max_by_key(Vec::len).filter(|records| records.len() >= longest) {
        let bytes = Value::Array(records).to_string().into_bytes();
        return open(Text::of(String::from_utf8_lossy(&bytes).into_owned()));
    }
    let columns = named(held.columns);
    let mut table = Table::default();
    for (name, values) in columns {
        let cells: Vec<Option<String>> = values.iter().map(cell).collect();
        let present: Vec<&str> = cells.iter().flatten().take(FIRST_RECORDS).map(String::as_str).collect();
        let instants = Instants::of(&present);
        let number = |cell: &Option<String>| match (cell, &instants) {
            (None, _) => Some(f64::NAN),
            (Some(cell), Some(instants)) => instants.seconds(cell.as_bytes()),
            (Some(cell), None) => text_number(cell),
        };
        let numbers: Option<Vec<f64>> = cells.iter().map(number).collect();
        let Some(numbers) = numbers.filter(|numbers| numbers.len() > 1) else {
            table.unreadable.push(name);
            continue;
        };
        let unit = instants.as_ref().map(|_| "s".to_owned());
        if let Some(instants) = &instants {
            table.notes.push(format!("column '{}' read as {}", shorten(&name), instants.describe()));
        }
        let group = numbers.len();
        table.push(ColumnHead { name, unit, group, ..ColumnHead::default() }, numbers);
        if table.heads.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
    }
    if table.heads.is_empty() { Err(none(nothing())) } else { Ok(Opened::Columns(table)) }
}

/// A list and the keys that lead to it.
type Column = (Vec<String>, Vec<Value>);

/// What an object holds at any depth.
#[derive(Default)]
struct Held {
    columns: Vec<Column>,
    /// Lists of objects.
    records: Vec<Vec<Value>>,
}

impl Held {
    fn gather(&mut self, object: Map<String, Value>, path: &mut Vec<String>) {
        let rows_of = ["data", "values"].into_iter().find(|key| object.get(*key).is_some_and(Value::is_array));
        if let (Some(Value::Array(names)), Some(rows)) = (object.get("columns"), rows_of) {
            let rows = object[rows].as_array().into_iter().flatten();
            for (place, name) in names.iter().enumerate() {
                let value = |row: &Value| row.get(place).cloned().unwrap_or(Value::Null);
                let name = name.as_str().unwrap_or_default().to_owned();
                self.columns.push((beneath(path, name), rows.clone().map(value).collect()));
            }
            return;
        }
        for (name, value) in object {
            match value {
                Value::Array(mut values) if values.len() == 1 && values[0].is_object() => {
                    if let Some(Value::Object(inner)) = values.pop() {
                        self.within(inner, path, name);
                    }
                }
                Value::Array(values) if values.first().is_some_and(Value::is_object) => self.records.push(values),
                Value::Array(values) => self.columns.push((beneath(path, name), values)),
                Value::Object(inner) => self.within(inner, path, name),
                _ => {}
            }
        }
    }

    fn within(&mut self, inner: Map<String, Value>, path: &mut Vec<String>, name: String) {
        // As pandas writes a column: with the number or the instant of each row.
        let is_column = inner.keys().all(|key| key.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
        if is_column && !inner.values().any(|value| value.is_object() || value.is_array()) {
            self.columns.push((beneath(path, name), inner.into_iter().map(|(_, value)| value).collect()));
            return;
        }
        path.push(name);
        self.gather(inner, path);
        path.pop();
    }
}

fn beneath(path: &[String], name: String) -> Vec<String> {
    path.iter().cloned().chain([name]).collect()
}

/// The columns by their keys joined by dots, without those that all of them share.
fn named(columns: Vec<Column>) -> Vec<(String, Vec<Value>)> {
    let first = columns.first().map_or(Vec::new(), |(path, _)| path.clone());
    let is_shared = |key: &usize| columns.iter().all(|(path, _)| path.len() > key + 1 && path[*key] == first[*key]);
    let shared = (0..first.len()).take_while(is_shared).count();
    columns.into_iter().map(|(path, values)| (path[shared..].join("."), values)).collect()
}

/// Cuts a text into its outermost objects.
struct Splitter {
    rest: Box<dyn Read>,
    bytes: Vec<u8>,
    at: usize,
    line: u64,
    /// The text goes on after its end.
    is_cut: bool,
}

impl Splitter {
    fn new(rest: Box<dyn Read>, is_cut: bool) -> Self {
        Self { rest, bytes: Vec::new(), at: 0, line: 1, is_cut }
    }

    /// The next object and its line; none at the end.
    fn next(&mut self) -> Result<Option<(u64, Vec<u8>)>, FileError> {
        let wrong = |reason: &str, line: u64| FileError::from(Problem::Json { reason: reason.to_owned() }).at_line(line);
        loop {
            match self.byte()? {
                None => return Ok(None),
                Some(b'{') => break,
                Some(b'\n') => self.line += 1,
                Some(b' ' | b'\t' | b'\r' | b',' | b'[' | b']' | 0x1e) => {}
                Some(_) => return Err(wrong("between its records is something else", self.line)),
            }
        }
        let line = self.line;
        let mut record = vec![b'{'];
        let (mut depth, mut is_text, mut is_escaped) = (1_u32, false, false);
        while depth > 0 {
            let Some(byte) = self.byte()? else {
                return if self.is_cut { Ok(None) } else { Err(wrong("it ends within a record", line)) };
            };
            record.push(byte);
            self.line += u64::from(byte == b'\n');
            match byte {
                _ if is_escaped => is_escaped = false,
                b'\\' if is_text => is_escaped = true,
                b'"' => is_text = !is_text,
                b'{' | b'[' if !is_text => depth += 1,
                b'}' | b']' if !is_text => depth -= 1,
                _ => {}
            }
            if record.len() > LONGEST {
                return if self.is_cut { Ok(None) } else { Err(Problem::LongRecord { most: LONGEST >> 20 }.into()) };
            }
        }
        Ok(Some((line, record)))
    }

    fn byte(&mut self) -> Result<Option<u8>, FileError> {
        if self.at == self.bytes.len() {
            self.at = 0;
            self.bytes.resize(PIECE, 0);
            let count = loop {
                match self.rest.read(&mut self.bytes) {
                    Err(error) if error.kind() == ErrorKind::Interrupted => {}
                    read => break read.map_err(|error| FileError::from(io_problem("reading", &error)))?,
                }
            };
            self.bytes.truncate(count);
        }
        let byte = self.bytes.get(self.at).copied();
        self.at += 1;
        self.at = self.at.min(self.bytes.len());
        Ok(byte)
    }
}
