//! `MOTOR.toml`: what is known of a motor before anything is identified.
//!
//! ```toml
//! [motor]
//! rs = "0.958 ohm"      # numbers with units; a bare number is SI; every key may be missing
//! ld = "5.25 mH"
//! lq = "12 mH"
//! psi_f = "0.1827 Wb"
//! pole_pairs = 4
//! [rating]
//! current = "20 A"      # phase peak
//! voltage = "180 V"     # phase peak
//! speed = "3000 rpm"    # mechanical
//! ```

use crate::{
    error::{FileError, Problem},
    input,
    quantity::{Dimension, parse_quantity},
    wording::nearest,
};
use std::path::Path;
use toml::{
    Spanned,
    de::{DeInteger, DeTable, DeValue},
};

/// What is known of a motor; every number above zero.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MotorFile {
    /// Stator resistance, ohm.
    pub rs: Option<f64>,
    /// Inductance along d, H.
    pub ld: Option<f64>,
    /// Inductance along q, H.
    pub lq: Option<f64>,
    /// Magnet flux linkage, Wb, peak per phase.
    pub psi_f: Option<f64>,
    /// Pole pairs.
    pub pole_pairs: Option<u32>,
    /// What the motor is made for.
    pub rating: Rating,
}

/// What a motor is made for; every number above zero.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rating {
    /// A, phase peak.
    pub current: Option<f64>,
    /// V, phase peak.
    pub voltage: Option<f64>,
    /// **Mechanical** rad/s.
    pub speed: Option<f64>,
}

const MOTOR: &str = "motor";
const RATING: &str = "rating";
const MOTOR_KEYS: [&str; 5] = ["rs", "ld", "lq", "psi_f", "pole_pairs"];
const RATING_KEYS: [&str; 3] = ["current", "voltage", "speed"];

const ABOVE_ZERO: &str = "a finite number above zero";

/// Reads a motor file; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, is no TOML, has a key that is not known, or a value that is no quantity of its dimension or not above zero.
pub fn read_motor(path: &Path) -> Result<MotorFile, FileError> {
    MotorFile::parse(&input::name(path), &input::read(path)?)
}

impl MotorFile {
    /// Reads a motor file from memory; `name` is the file's name in messages. An empty file is a motor of which nothing is known.
    ///
    /// # Errors
    /// As [`read_motor`].
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, FileError> {
        let parsed = match input::text(bytes, "TOML") {
            Ok(text) => parse(text),
            Err(_) if bytes.trim_ascii().is_empty() => Ok(Self::default()),
            Err(error) => Err(error),
        };
        parsed.map_err(|error| error.in_file(name))
    }
}

fn parse(text: &str) -> Result<MotorFile, FileError> {
    let line = |at: usize| input::line_at(text.as_bytes(), at);
    let document = DeTable::parse(text).map_err(|error| {
        let syntax = FileError::from(Problem::Syntax { format: "TOML", message: flat(error.message()) });
        syntax.at_line(line(error.span().map_or(text.len(), |span| span.start)))
    })?;
    let mut motor = MotorFile::default();
    for (start, table, value) in in_order(document.get_ref()) {
        let outside = |error: FileError| error.at_line(line(start)).in_key(table);
        let keys = match (table, value) {
            (MOTOR | RATING, DeValue::Table(keys)) => keys,
            (MOTOR, _) => return Err(outside(Problem::Value { wanted: "a table, as in [motor]" }.into())),
            (RATING, _) => return Err(outside(Problem::Value { wanted: "a table, as in [rating]" }.into())),
            _ => return Err(outside(misplaced(table))),
        };
        for (start, key, value) in in_order(keys) {
            motor.take(table, key, value).map_err(|error| error.at_line(line(start)).in_key(key))?;
        }
    }
    Ok(motor)
}

/// Entries by their place in the file, so that the first fault is the one told.
fn in_order<'a>(table: &'a DeTable<'_>) -> Vec<(usize, &'a str, &'a DeValue<'a>)> {
    let entry =
        |(key, value): (&'a Spanned<_>, &'a Spanned<DeValue<'a>>)| (key.span().start, AsRef::<str>::as_ref(key.get_ref()), value.get_ref());
    let mut entries: Vec<_> = table.iter().map(entry).collect();
    entries.sort_by_key(|(start, _, _)| *start);
    entries
}

fn misplaced(key: &str) -> FileError {
    let table = if MOTOR_KEYS.contains(&key) { Some(MOTOR) } else { RATING_KEYS.contains(&key).then_some(RATING) };
    match table {
        Some(table) => Problem::OutsideTable { table }.into(),
        None => unknown("a motor file", key, &[MOTOR, RATING]),
    }
}

fn unknown(table: &'static str, key: &str, known: &[&'static str]) -> FileError {
    Problem::Key { table, known: known.to_vec(), nearest: nearest(key, known.iter().copied()) }.into()
}

impl MotorFile {
    fn take(&mut self, table: &str, key: &str, value: &DeValue<'_>) -> Result<(), FileError> {
        let (slot, dimension) = match (table, key) {
            (MOTOR, "rs") => (&mut self.rs, Dimension::Resistance),
            (MOTOR, "ld") => (&mut self.ld, Dimension::Inductance),
            (MOTOR, "lq") => (&mut self.lq, Dimension::Inductance),
            (MOTOR, "psi_f") => (&mut self.psi_f, Dimension::FluxLinkage),
            (MOTOR, "pole_pairs") => {
                self.pole_pairs = Some(pole_pairs(value)?);
                return Ok(());
            }
            (RATING, "current") => (&mut self.rating.current, Dimension::Current),
            (RATING, "voltage") => (&mut self.rating.voltage, Dimension::Voltage),
            (RATING, "speed") => (&mut self.rating.speed, Dimension::Speed),
            (MOTOR, _) => return Err(unknown("[motor]", key, &MOTOR_KEYS)),
            _ => return Err(unknown("[rating]", key, &RATING_KEYS)),
        };
        let text = match value {
            DeValue::String(text) => text.as_ref(),
            DeValue::Float(number) => number.as_str(),
            DeValue::Integer(number) => &whole(number).map(|number| number.to_string()).unwrap_or_default(),
            _ => return Err(Problem::Value { wanted: "a number, or one with its unit in quotes" }.into()),
        };
        let number = parse_quantity(text, dimension)?;
        if number <= 0.0 {
            return Err(Problem::Range { text: text.to_owned(), range: ABOVE_ZERO }.into());
        }
        *slot = Some(number);
        Ok(())
    }
}

fn pole_pairs(value: &DeValue<'_>) -> Result<u32, FileError> {
    let DeValue::Integer(number) = value else { return Err(Problem::Value { wanted: "a whole number, as in pole_pairs = 4" }.into()) };
    let found = whole(number).and_then(|number| u32::try_from(number).ok()).filter(|pole_pairs| *pole_pairs > 0);
    found.ok_or_else(|| Problem::Range { text: number.to_string(), range: "a whole number above zero" }.into())
}

fn whole(number: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// A message of several lines as one.
fn flat(message: &str) -> String {
    message.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn read(text: &str) -> Result<MotorFile, String> {
        MotorFile::parse("motor.toml", text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_papers_motor() {
        let text = "[motor]\nrs = \"0.958 ohm\"\nld = \"5.25 mH\"\nlq = 12e-3\npsi_f = \"0.1827 Wb\"\npole_pairs = 4\n\
                    [rating]\ncurrent = 20\nvoltage = \"180 V\"\nspeed = \"3000 rpm\"\n";
        let expected = MotorFile {
            rs: Some(0.958),
            ld: Some(5.25e-3),
            lq: Some(12e-3),
            psi_f: Some(0.1827),
            pole_pairs: Some(4),
            rating: Rating { current: Some(20.0), voltage: Some(180.0), speed: Some(3000.0 * (TAU / 60.0)) },
        };
        assert_eq!(read(text), Ok(expected));
        assert_eq!(read(""), Ok(MotorFile::default()));
        assert_eq!(read("motor.ld = \"5.25mH\"").map(|motor| motor.ld), Ok(Some(5.25e-3)));
    }

    #[test]
    fn refusals_name_line_and_key() {
        let cases = [
            (
                "[motor]\n\nl_d = 1",
                "line 3, key 'l_d': this key is not known; [motor] can hold rs, ld, lq, psi_f and pole_pairs; did you mean ld?",
            ),
            ("rs = 1", "line 1, key 'rs': this key stands outside of a table; put it below a line [motor]"),
            ("[ratings]", "line 1, key 'ratings': this key is not known; a motor file can hold motor and rating; did you mean rating?"),
            ("motor = 1", "line 1, key 'motor': this is not a table, as in [motor]; correct it"),
            (
                "[motor]\nrs = \"1 H\"",
                "line 2, key 'rs': \"1 H\" is not a resistance; write a number, in ohm or with its unit, as in \"0.958 ohm\"",
            ),
            ("[motor]\nrs = 0", "line 2, key 'rs': \"0\" is out of range; it must be a finite number above zero"),
            ("[motor]\nld = -1e-3", "line 2, key 'ld': \"-1e-3\" is out of range; it must be a finite number above zero"),
            (
                "[motor]\nrs = nan",
                "line 2, key 'rs': \"nan\" is not a resistance; write a number, in ohm or with its unit, as in \"0.958 ohm\"",
            ),
            ("[motor]\nrs = [1]", "line 2, key 'rs': this is not a number, or one with its unit in quotes; correct it"),
            ("[motor]\npole_pairs = 0", "line 2, key 'pole_pairs': \"0\" is out of range; it must be a whole number above zero"),
            ("[motor]\npole_pairs = 4.0", "line 2, key 'pole_pairs': this is not a whole number, as in pole_pairs = 4; correct it"),
            ("[motor]\nrs = 1\nrs = 2", "line 3: this is not TOML: duplicate key; correct it"),
            ("[motor]\nrs = 0.958 ohm", "line 2: this is not TOML: string values must be quoted, expected literal string; correct it"),
        ];
        for (text, sentence) in cases {
            assert_eq!(read(text), Err(format!("motor.toml, {sentence}")), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(text in "\\PC*|(\\[motor\\]\n|rs = |ld=|[0-9.\"'\\[\\]{}= \n]){0,20}") {
            if let Err(sentence) = read(&text) {
                prop_assert_eq!(sentence.lines().count(), 1);
            }
        }
    }
}
