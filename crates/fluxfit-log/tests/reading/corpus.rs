//! The corpus: small logs of every format, dialect and pitfall, from independent writers, and the expected reading of each.
//! `corpus/make.py` writes them and explains the keys of `expected.toml`.

use fluxfit::log::Columns;
use fluxfit_log::{LogOptions, ReadLog, parse_map, parse_unit, read_log, read_mapping};
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};
use toml::{Table, Value};

/// Maximum size of a file, bytes: the corpus is part of every copy of the project.
const LARGEST: u64 = 40_000;

/// Rows of two logs are of the same instant if they differ by no more than this, s.
const SAME_INSTANT: f64 = 1e-9;

/// Minimum share of the rows of a log whose instants its reference log has.
const HELD: f64 = 0.9;

#[test]
fn every_log_is_read_or_refused_as_expected() {
    let cases = cases();
    let (available, left): (Vec<_>, Vec<_>) = cases.iter().partition(|case| is_built(case));
    left.iter().for_each(|case| println!("left out: {} needs the feature {}", text(case, "file"), text(case, "needs")));
    let failures: Vec<String> = available
        .iter()
        .filter_map(|case| check(case).err().map(|why| format!("{} ({})\n    {why}", text(case, "file"), text(case, "says"))))
        .collect();
    let held = available.len() - failures.len();
    println!("{held} of {} cases hold", available.len());
    assert!(failures.is_empty(), "{held} of {} cases hold; the others:\n{}", available.len(), failures.join("\n"));
}

#[test]
fn every_file_has_one_case_and_is_small() {
    let cases = cases();
    let named: Vec<&str> = cases.iter().map(|case| text(case, "file")).collect();
    let files = |folder: &str| fs::read_dir(home().join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<PathBuf>>();
    let found: BTreeSet<String> = files("logs").iter().map(|path| path.file_name().unwrap().to_str().unwrap().to_owned()).collect();
    assert_eq!(found, named.iter().map(|name| (*name).to_owned()).collect());
    assert_eq!(found.len(), named.len(), "a file has two cases");
    for path in files("logs") {
        assert!(fs::metadata(&path).unwrap().len() <= LARGEST, "{}", path.display());
    }
}

/// The options of a case.
fn options(case: &Table) -> LogOptions {
    let pairs = |key: &str| list(case, key).into_iter();
    LogOptions {
        map: pairs("map").map(|pair| parse_map(pair).unwrap()).collect(),
        units: pairs("units").map(|pair| parse_unit(pair).unwrap()).collect(),
        pole_pairs: case.get("pole_pairs").map(|number| u32::try_from(number.as_integer().unwrap()).unwrap()),
        dbc: case.get("dbc").map(|path| fs::read_to_string(home().join(path.as_str().unwrap())).unwrap()),
        mapping: case.get("mapping").map(|path| read_mapping(&home().join(path.as_str().unwrap())).unwrap()).unwrap_or_default(),
        ..LogOptions::default()
    }
}

/// Whether the reader that a case needs is part of this build.
fn is_built(case: &Table) -> bool {
    match case.get("needs").map(|needs| needs.as_str().unwrap()) {
        None => true,
        Some("mdf4") => cfg!(feature = "mdf4"),
        Some(other) => panic!("{other} is not a feature"),
    }
}

fn check(case: &Table) -> Result<(), String> {
    let read = read_log(&home().join("logs").join(text(case, "file")), &options(case));
    match (case.contains_key("refused"), read) {
        (true, Ok(read)) => Err(format!("read, with {:?}, where a refusal is expected", read.notes)),
        (false, Err(error)) => Err(format!("refused: {error}")),
        (true, Err(error)) => {
            // The name of the file may contain the word.
            let sentence = error.to_string().replace(error.file().unwrap_or_default(), "FILE");
            ensure(!sentence.contains('\n'), || format!("more than one line: {sentence}"))?;
            let line = case.get("line").map(|line| u64::try_from(line.as_integer().unwrap()).unwrap());
            ensure(line.is_none() || error.line() == line, || format!("line {:?} in place of {line:?}: {sentence}", error.line()))?;
            list(case, "refused").into_iter().try_for_each(|words| contains(words, &sentence))
        }
        (false, Ok(read)) => check_reading(case, &read),
    }
}

fn check_reading(case: &Table, read: &ReadLog) -> Result<(), String> {
    let log = &read.log;
    let columns = log.columns();
    let notes = log.source().notes.join("\n");
    let found = read.layout.map_or("none", |layout| layout.name);
    ensure(found == text(case, "layout"), || format!("layout {found} in place of {}", text(case, "layout")))?;
    if let Some(rows) = case.get("rows") {
        let allowed: Vec<&Value> = rows.as_array().map_or_else(|| vec![rows], |several| several.iter().collect());
        let found = i64::try_from(log.rows()).unwrap();
        ensure(allowed.iter().any(|rows| rows.as_integer() == Some(found)), || format!("{found} rows in place of {rows}"))?;
    }
    if let Some(segments) = case.get("segments").and_then(Value::as_integer) {
        let found = log.segments().len();
        ensure(i64::try_from(found) == Ok(segments), || format!("{found} segments in place of {segments}"))?;
    }
    if let Some(period) = case.get("sample_period").and_then(Value::as_float) {
        let found = log.segments()[0].sample_period;
        ensure((found - period).abs() < SAME_INSTANT, || format!("a period of {found} s in place of {period}"))?;
    }
    list(case, "notes").into_iter().try_for_each(|words| contains(words, &notes))?;
    for (name, expected) in table(case, "columns") {
        let values = column(columns, name).ok_or_else(|| format!("no column {name}"))?;
        check_column(values, expected.as_table().unwrap()).map_err(|why| format!("{name}: {why}"))?;
    }
    if let Some(reference) = case.get("same_as") {
        let other = reading_of(reference.as_str().unwrap());
        for ((name, found), (_, expected)) in columns.named().into_iter().zip(other.log.columns().named()) {
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            ensure(bits(found) == bits(expected), || format!("{name} has not the bits of {reference}"))?;
        }
    }
    for (name, expected) in table(case, "within") {
        check_within(columns, name, expected.as_table().unwrap()).map_err(|why| format!("{name}: {why}"))?;
    }
    Ok(())
}

/// Checks first value, last value and sum; with a tolerance of zero, to the bit.
fn check_column(values: &[f64], expected: &Table) -> Result<(), String> {
    let tolerance = number(expected, "tolerance").unwrap();
    let found = [
        ("first", values[0], tolerance),
        ("last", values[values.len() - 1], tolerance),
        ("sum", values.iter().sum::<f64>(), tolerance * values.len() as f64),
    ];
    for (key, found, tolerance) in found {
        let Some(expected) = number(expected, key) else { continue };
        ensure((found - expected).abs() <= tolerance, || format!("{key} {found} in place of {expected} ± {tolerance}"))?;
    }
    Ok(())
}

/// Checks that each value is near that of another log at the same instant.
fn check_within(columns: &Columns, name: &str, expected: &Table) -> Result<(), String> {
    let reference = reading_of(expected["reference"].as_str().unwrap());
    let tolerance = number(expected, "tolerance").unwrap();
    let (instants, values) = (&reference.log.columns().t, column(reference.log.columns(), name).unwrap());
    let mut held = 0;
    for (t, found) in columns.t.iter().zip(column(columns, name).unwrap()) {
        let after = instants.partition_point(|instant| *instant < t - SAME_INSTANT);
        if instants.get(after).is_some_and(|instant| (instant - t).abs() <= SAME_INSTANT) {
            held += 1;
            ensure((found - values[after]).abs() <= tolerance, || {
                format!("{found} at {t} s, in place of {} ± {tolerance}", values[after])
            })?;
        }
    }
    ensure(f64::from(held) >= HELD * columns.t.len() as f64, || {
        format!("only {held} of {} rows have an instant of the reference", columns.t.len())
    })
}

/// Whether one of the alternatives of `words`, separated by `|`, occurs. Case does not matter.
fn contains(words: &str, sentence: &str) -> Result<(), String> {
    let lower = sentence.to_lowercase();
    ensure(words.split('|').any(|word| lower.contains(&word.to_lowercase())), || format!("\"{words}\" is not in: {sentence}"))
}

fn ensure(holds: bool, why: impl Fn() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(why()) }
}

fn column<'a>(columns: &'a Columns, name: &str) -> Option<&'a Vec<f64>> {
    columns.named().into_iter().chain(columns.optional()).find(|(known, _)| *known == name).map(|(_, values)| values)
}

/// A file of the corpus, read without options.
fn reading_of(file: &str) -> ReadLog {
    read_log(&home().join("logs").join(file), &LogOptions::default()).unwrap()
}

fn home() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

fn cases() -> Vec<Table> {
    let document: Table = fs::read_to_string(home().join("expected.toml")).unwrap().parse().unwrap();
    document["case"].as_array().unwrap().iter().map(|case| case.as_table().unwrap().clone()).collect()
}

fn text<'a>(case: &'a Table, key: &str) -> &'a str {
    case[key].as_str().unwrap()
}

fn number(table: &Table, key: &str) -> Option<f64> {
    table.get(key).map(|value| value.as_float().unwrap())
}

fn list<'a>(case: &'a Table, key: &str) -> Vec<&'a str> {
    case.get(key).map_or_else(Vec::new, |list| list.as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect())
}

fn table<'a>(case: &'a Table, key: &str) -> impl Iterator<Item = (&'a String, &'a Value)> {
    case.get(key).and_then(Value::as_table).into_iter().flatten()
}
