//! A row of the results: one motor, and one window of time where windows are asked for. The rows are the same for every engine that runs
//! them: one machine, Dask, Spark.

use crate::{
    commands::{identify, identify::Identify, input},
    error::CommandError,
    terminal::options,
};
use fluxfit::{Answer, Columns, Log, Parameter, Verdict, identify as identify_log};
use serde_json::{Map, Value, json};
use std::ops::Range;

/// A row: a value for each of [`COLUMNS`], in their order.
pub(crate) type Row = Map<String, Value>;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Text,
    Number,
    Count,
}

/// The columns of the results.
pub(crate) const COLUMNS: [(&str, Kind); 35] = [
    ("motor", Kind::Text),
    ("window_start", Kind::Number),
    ("window_end", Kind::Number),
    ("rows", Kind::Count),
    ("duration_s", Kind::Number),
    ("model", Kind::Text),
    ("rs", Kind::Number),
    ("rs_low", Kind::Number),
    ("rs_high", Kind::Number),
    ("rs_standard_error", Kind::Number),
    ("rs_verdict", Kind::Text),
    ("rs_reason", Kind::Text),
    ("ld", Kind::Number),
    ("ld_low", Kind::Number),
    ("ld_high", Kind::Number),
    ("ld_standard_error", Kind::Number),
    ("ld_verdict", Kind::Text),
    ("ld_reason", Kind::Text),
    ("lq", Kind::Number),
    ("lq_low", Kind::Number),
    ("lq_high", Kind::Number),
    ("lq_standard_error", Kind::Number),
    ("lq_verdict", Kind::Text),
    ("lq_reason", Kind::Text),
    ("psi_f", Kind::Number),
    ("psi_f_low", Kind::Number),
    ("psi_f_high", Kind::Number),
    ("psi_f_standard_error", Kind::Number),
    ("psi_f_verdict", Kind::Text),
    ("psi_f_reason", Kind::Text),
    ("warnings", Kind::Text),
    ("error", Kind::Text),
    ("source", Kind::Text),
    ("seed", Kind::Count),
    ("version", Kind::Text),
];

/// The rows of a motor: what was read, identified whole or in windows of `every` seconds. What fails is a row with its reason.
pub(crate) fn rows(
    motor: &str,
    source: &str,
    read: Result<input::Input, CommandError>,
    arguments: &Identify,
    every: Option<f64>,
) -> Vec<Row> {
    let blank = || blank(motor, source, arguments.log.seed);
    let input = match read.and_then(|input| identify::accepted(arguments, &input).map(|_| input)) {
        Ok(input) => input,
        Err(error) => return vec![failed(blank(), error)],
    };
    let request = match identify::request(arguments, &input) {
        Ok(request) => request,
        Err(error) => return vec![failed(blank(), error)],
    };
    let identified = |log: Result<Log, fluxfit::Error>, mut row: Row| {
        if let Ok(log) = &log {
            row["rows"] = log.rows().into();
            row["duration_s"] = json!(log.duration());
        }
        let answer = log.and_then(|log| Ok(identify_log(&log, &request)?));
        match answer {
            Ok(answer) => filled(row, &answer),
            Err(error) => failed(row, input::of_log(&input.name, error)),
        }
    };
    let Some(every) = every else { return vec![identified(Ok((*input.log).clone()), blank())] };
    let windows = windows(&input.log.columns().t, every);
    let row = |(start, rows): (f64, Range<usize>)| {
        let mut row = blank();
        row["window_start"] = json!(start);
        row["window_end"] = json!(start + every);
        row["rows"] = rows.len().into();
        identified(part(&input.log, rows), row)
    };
    windows.into_iter().map(row).collect()
}

/// A row for a motor that could not be read.
pub(crate) fn unread(motor: &str, source: &str, arguments: &Identify, error: CommandError) -> Row {
    failed(blank(motor, source, arguments.log.seed), error)
}

fn blank(motor: &str, source: &str, seed: u64) -> Row {
    let mut row: Row = COLUMNS.iter().map(|(name, _)| ((*name).to_owned(), Value::Null)).collect();
    row["motor"] = motor.into();
    row["source"] = source.into();
    row["seed"] = seed.into();
    row["version"] = env!("CARGO_PKG_VERSION").into();
    row
}

fn failed(mut row: Row, error: CommandError) -> Row {
    row["error"] = options::with_option(&error.to_string(), error.option()).into();
    for parameter in Parameter::ALL {
        row[&format!("{}_verdict", parameter.key())] = Verdict::NotIdentifiable.key().into();
    }
    row
}

fn filled(mut row: Row, answer: &Answer) -> Row {
    row["model"] = answer.identification.model.model.key().into();
    for parameter in Parameter::ALL {
        let (judgement, key) = (answer.parameter(parameter), parameter.key());
        row[&format!("{key}_verdict")] = judgement.verdict.key().into();
        row[&format!("{key}_reason")] = judgement.reason.as_ref().map(ToString::to_string).into();
        if let (Some(value), Some([low, high])) = (judgement.value(), judgement.interval()) {
            row[key] = json!(value);
            row[&format!("{key}_low")] = json!(low);
            row[&format!("{key}_high")] = json!(high);
            row[&format!("{key}_standard_error")] = json!(judgement.uncertainty.standard_error());
        }
    }
    let warnings: Vec<&str> = answer.warnings().iter().map(fluxfit::Warning::code).collect();
    row["warnings"] = warnings.join(" ").into();
    row
}

/// Windows of `every` seconds that hold rows, counted from the first row: each with its start.
fn windows(t: &[f64], every: f64) -> Vec<(f64, Range<usize>)> {
    let Some(first) = t.first() else { return Vec::new() };
    let number = |row: usize| ((t[row] - first) / every).floor();
    let mut windows: Vec<(f64, Range<usize>)> = Vec::new();
    for row in 0..t.len() {
        let start = first + number(row) * every;
        match windows.last_mut() {
            Some((last, rows)) if *last == start => rows.end = row + 1,
            _ => windows.push((start, row..row + 1)),
        }
    }
    windows
}

/// Some rows of a log.
fn part(log: &Log, rows: Range<usize>) -> Result<Log, fluxfit::Error> {
    let Columns { t, ud, uq, id, iq, omega_e, theta_e, u_dc, temperature } = log.columns();
    let some = |values: &Vec<f64>| values[rows.clone()].to_vec();
    let part = Log::new(Columns {
        t: some(t),
        ud: some(ud),
        uq: some(uq),
        id: some(id),
        iq: some(iq),
        omega_e: some(omega_e),
        theta_e: theta_e.as_ref().map(some),
        u_dc: u_dc.as_ref().map(some),
        temperature: temperature.as_ref().map(some),
    })?;
    Ok(if log.is_interpolated() { part.of_different_instants() } else { part })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_hold_the_rows_of_their_time() {
        let t = [10.0, 10.5, 11.0, 13.0, 13.9];
        assert_eq!(windows(&t, 1.0), [(10.0, 0..2), (11.0, 2..3), (13.0, 3..5)]);
        assert_eq!(windows(&t, 100.0), [(10.0, 0..5)]);
        assert_eq!(windows(&[], 1.0), []);
    }

    #[test]
    fn every_parameter_has_its_columns() {
        let names: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
        for parameter in Parameter::ALL {
            for end in ["", "_low", "_high", "_standard_error", "_verdict", "_reason"] {
                assert!(names.contains(&format!("{}{end}", parameter.key()).as_str()));
            }
        }
    }
}
