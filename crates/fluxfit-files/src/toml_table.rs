//! TOML files whose keys are all known. Every error names its line and key.
//!
//! A document is first checked against its [`Shape`], in the order of its lines; then each reader takes the keys that it needs.

use crate::{error::FileError, input, problem::Problem};
use fluxfit_units::{Dimension, parse_coefficient, parse_fraction, parse_quantity, wording::nearest};
use serde_json::{Map, Value};
use toml::{
    Spanned,
    de::{DeInteger, DeTable, DeValue},
};

/// The keys and tables that a kind of file can have.
pub struct Shape {
    /// The kind of file, in a sentence.
    pub noun: &'static str,
    /// Keys above all tables.
    pub keys: &'static [&'static str],
    /// Tables and their keys.
    pub tables: &'static [(&'static str, &'static [&'static str])],
}

/// A document whose keys are all known.
pub struct Document<'t> {
    text: &'t str,
    root: Spanned<DeTable<'t>>,
}

/// A table of a document; without keys if the file does not have it.
#[derive(Clone, Copy)]
pub struct Table<'d> {
    text: &'d str,
    name: &'static str,
    start: Option<usize>,
    keys: Option<&'d DeTable<'d>>,
}

/// A key and its value.
#[derive(Clone, Copy)]
pub struct Entry<'d> {
    text: &'d str,
    key: &'d str,
    start: usize,
    value: &'d DeValue<'d>,
}

impl<'t> Document<'t> {
    /// Reads TOML.
    ///
    /// # Errors
    /// If the text is not TOML, or has a key that `shape` does not have.
    pub fn parse(text: &'t str, shape: &Shape) -> Result<Self, FileError> {
        let root = DeTable::parse(text).map_err(|error| {
            let syntax = FileError::from(Problem::Syntax { format: "TOML", message: flat(error.message()) });
            syntax.at_line(input::line_at(text.as_bytes(), error.span().map_or(text.len(), |span| span.start)))
        })?;
        let document = Self { text, root };
        shape.check(&document)?;
        Ok(document)
    }

    /// The keys above all tables.
    pub fn root(&self) -> Table<'_> {
        Table { text: self.text, name: "", start: None, keys: Some(self.root.get_ref()) }
    }

    /// A table of the shape, whether the file has it or not.
    pub fn table(&self, name: &'static str) -> Table<'_> {
        let entry = self.root().get(name);
        Table { text: self.text, name, start: entry.map(|entry| entry.start), keys: entry.and_then(|entry| entry.value.as_table()) }
    }

    /// The entry with the path `table.key`, or `key` if it is above all tables.
    pub fn find(&self, path: &str) -> Option<Entry<'_>> {
        match path.split_once('.') {
            Some((table, key)) => self.root().get(table)?.value.as_table().and_then(|keys| entry(self.text, keys, key)),
            None => self.root().get(path),
        }
    }

    /// The document as JSON: numbers as numbers, quantities with units as text, keys in their order.
    pub fn to_json(&self) -> Value {
        json_of_table(self.text, self.root.get_ref())
    }
}

impl Shape {
    fn check(&self, document: &Document<'_>) -> Result<(), FileError> {
        for entry in in_order(document.text, document.root.get_ref()) {
            let Some((name, known)) = self.tables.iter().find(|(name, _)| *name == entry.key) else {
                if self.keys.contains(&entry.key) {
                    continue;
                }
                return Err(entry.refuse(self.misplaced(entry.key)));
            };
            let DeValue::Table(keys) = entry.value else {
                return Err(entry.refuse(Problem::Value { wanted: format!("a table, as in [{name}]") }));
            };
            if let Some(entry) = in_order(document.text, keys).into_iter().find(|entry| !known.contains(&entry.key)) {
                return Err(entry.refuse(match self.table_of(entry.key) {
                    Some(table) => Problem::OtherTable { table },
                    None if self.keys.contains(&entry.key) => Problem::InsideTable,
                    None => unknown(&format!("[{name}]"), entry.key, known),
                }));
            }
        }
        Ok(())
    }

    fn misplaced(&self, key: &str) -> Problem {
        let all: Vec<&'static str> = self.keys.iter().copied().chain(self.tables.iter().map(|(name, _)| *name)).collect();
        self.table_of(key).map_or_else(|| unknown(self.noun, key, &all), |table| Problem::OutsideTable { table })
    }

    /// The table to which a key belongs.
    fn table_of(&self, key: &str) -> Option<&'static str> {
        self.tables.iter().find(|(_, keys)| keys.contains(&key)).map(|(table, _)| *table)
    }
}

impl<'d> Table<'d> {
    /// The entry with this key, if the file has it.
    pub fn get(&self, key: &str) -> Option<Entry<'d>> {
        entry(self.text, self.keys?, key)
    }

    /// Whether the file has the table.
    pub fn is_present(&self) -> bool {
        self.keys.is_some()
    }

    /// A quantity in SI units, if the file has it.
    ///
    /// # Errors
    /// If the value is not a quantity of this dimension.
    pub fn quantity(&self, key: &str, dimension: Dimension) -> Result<Option<f64>, FileError> {
        self.get(key).map(|entry| entry.quantity(dimension)).transpose()
    }

    /// A quantity in SI units that the file must have.
    ///
    /// # Errors
    /// If the key is missing, or the value is not a quantity of this dimension.
    pub fn needed(&self, key: &str, dimension: Dimension) -> Result<f64, FileError> {
        self.quantity(key, dimension)?.ok_or_else(|| self.missing(key, dimension.example()))
    }

    /// The error for a missing key, at the line of the table if there is one.
    pub fn missing(&self, key: &str, example: &str) -> FileError {
        let place = if self.name.is_empty() { String::new() } else { format!(" below [{}]", self.name) };
        let missing = FileError::from(Problem::MissingKey { key: key.to_owned(), remedy: format!("{key} = {example}{place}") });
        match self.start {
            Some(start) => missing.at_line(input::line_at(self.text.as_bytes(), start)),
            None => missing,
        }
    }
}

impl<'d> Entry<'d> {
    /// Its line, from 1.
    pub fn line(&self) -> u64 {
        input::line_at(self.text.as_bytes(), self.start)
    }

    /// An error at this entry.
    pub fn refuse(&self, problem: impl Into<FileError>) -> FileError {
        problem.into().at_line(self.line()).in_key(self.key)
    }

    /// A number or a text as it is written; none for other values.
    pub fn as_written(&self) -> Option<String> {
        match self.value {
            DeValue::String(text) => Some(text.to_string()),
            DeValue::Float(number) => Some(number.as_str().to_owned()),
            DeValue::Integer(number) => Some(decimal(number).map_or_else(|| number.to_string(), |number| number.to_string())),
            _ => None,
        }
    }

    /// The error for a number out of range.
    pub fn out_of_range(&self, range: &'static str) -> FileError {
        self.refuse(Problem::Range { text: self.as_written().unwrap_or_default(), range })
    }

    /// A quantity in SI units.
    ///
    /// # Errors
    /// If the value is not a quantity of this dimension.
    pub fn quantity(&self, dimension: Dimension) -> Result<f64, FileError> {
        let wanted = || self.refuse(Problem::Value { wanted: "a number, or one with its unit in quotes".to_owned() });
        parse_quantity(&self.as_written().ok_or_else(wanted)?, dimension).map_err(|error| self.refuse(error))
    }

    /// A fraction: a number, or a percentage in quotes.
    ///
    /// # Errors
    /// If the value is neither, or it is negative.
    pub fn fraction(&self) -> Result<f64, FileError> {
        let wanted = || self.refuse(Problem::Value { wanted: "a number, or a percentage in quotes".to_owned() });
        parse_fraction(&self.as_written().ok_or_else(wanted)?).map_err(|error| self.refuse(error))
    }

    /// A part per kelvin: a number, or text such as `-0.12 %/K`.
    ///
    /// # Errors
    /// If the value is neither.
    pub fn coefficient(&self) -> Result<f64, FileError> {
        let wanted = || self.refuse(Problem::Value { wanted: "a part per kelvin, as in \"-0.12 %/K\"".to_owned() });
        parse_coefficient(&self.as_written().ok_or_else(wanted)?).map_err(|error| self.refuse(error))
    }

    /// A whole number of at least `least`.
    ///
    /// # Errors
    /// If the value is not such a number.
    pub fn whole<T: TryFrom<i64> + PartialOrd>(&self, least: T, range: &'static str) -> Result<T, FileError> {
        let wanted = || self.refuse(Problem::Value { wanted: format!("a whole number, as in {} = 4", self.key) });
        let DeValue::Integer(number) = self.value else { return Err(wanted()) };
        let found = decimal(number).and_then(|number| T::try_from(number).ok()).filter(|number| *number >= least);
        found.ok_or_else(|| self.refuse(Problem::Range { text: number.to_string(), range }))
    }

    /// True or false.
    ///
    /// # Errors
    /// If the value is neither.
    pub fn boolean(&self) -> Result<bool, FileError> {
        self.value.as_bool().ok_or_else(|| self.refuse(Problem::Value { wanted: "true or false, without quotes".to_owned() }))
    }

    /// A text.
    ///
    /// # Errors
    /// If the value is not a text.
    pub fn text(&self) -> Result<&'d str, FileError> {
        self.value.as_str().ok_or_else(|| self.refuse(Problem::Value { wanted: "a text in quotes".to_owned() }))
    }

    /// The meaning of one of these words.
    ///
    /// # Errors
    /// If the value is none of them.
    pub fn word<T: Copy>(&self, words: &[(&'static str, T)]) -> Result<T, FileError> {
        let known: Vec<&'static str> = words.iter().map(|(word, _)| *word).collect();
        let text = self.as_written().unwrap_or_default();
        let found = words.iter().find(|(word, _)| *word == text).map(|(_, meaning)| *meaning);
        found.ok_or_else(|| self.refuse(Problem::Word { nearest: nearest(&text, known.iter().copied()), text, known }))
    }

    /// The items of a list, in order, with the key of the list; none if the value is not a list.
    pub fn items(&self) -> Option<Vec<Entry<'d>>> {
        let items = self.value.as_array()?;
        Some(items.iter().map(|item| Entry { start: item.span().start, value: item.get_ref(), ..*self }).collect())
    }

    /// An inline table with these keys; `noun` names it in messages.
    ///
    /// # Errors
    /// If the value is not a table, or has another key.
    pub fn table(&self, known: &[&'static str], noun: &str, example: &str) -> Result<Table<'d>, FileError> {
        let wanted = || self.refuse(Problem::Value { wanted: format!("{noun}, as in {example}") });
        let DeValue::Table(keys) = self.value else { return Err(wanted()) };
        if let Some(entry) = in_order(self.text, keys).into_iter().find(|entry| !known.contains(&entry.key)) {
            return Err(entry.refuse(unknown(noun, entry.key, known)));
        }
        Ok(Table { text: self.text, name: "", start: Some(self.start), keys: Some(keys) })
    }
}

fn unknown(table: &str, key: &str, known: &[&'static str]) -> Problem {
    Problem::Key { table: table.to_owned(), known: known.to_vec(), nearest: nearest(key, known.iter().copied()) }
}

fn entry<'d>(text: &'d str, keys: &'d DeTable<'_>, key: &str) -> Option<Entry<'d>> {
    let (key, value) = keys.get_key_value(key)?;
    Some(Entry { text, key: key.get_ref(), start: key.span().start, value: value.get_ref() })
}

/// Entries in the order of the file, so that the first error is the one reported.
fn in_order<'d>(text: &'d str, keys: &'d DeTable<'_>) -> Vec<Entry<'d>> {
    let entry = |(key, value): (&'d Spanned<_>, &'d Spanned<DeValue<'d>>)| Entry {
        text,
        key: AsRef::<str>::as_ref(key.get_ref()),
        start: key.span().start,
        value: value.get_ref(),
    };
    let mut entries: Vec<_> = keys.iter().map(entry).collect();
    entries.sort_by_key(|entry| entry.start);
    entries
}

fn json_of_table(text: &str, keys: &DeTable<'_>) -> Value {
    let pairs = in_order(text, keys).into_iter().map(|entry| (entry.key.to_owned(), json_of(text, entry.value)));
    Value::Object(pairs.collect::<Map<_, _>>())
}

fn json_of(text: &str, value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(written) => written.as_ref().into(),
        DeValue::Integer(number) => decimal(number).map_or(Value::Null, Value::from),
        DeValue::Float(number) => number.as_str().parse::<f64>().map_or(Value::Null, Value::from),
        DeValue::Boolean(truth) => (*truth).into(),
        DeValue::Array(items) => items.iter().map(|item| json_of(text, item.get_ref())).collect(),
        DeValue::Table(keys) => json_of_table(text, keys),
        DeValue::Datetime(time) => time.to_string().into(),
    }
}

fn decimal(number: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// A message of several lines on one line.
fn flat(message: &str) -> String {
    message.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(", ")
}
