//! What every reader promises, whatever the bytes: no panic, a refusal of one line, only finite numbers in what is returned.
//!
//! Two look at it: `tests/regressions.rs` with the files that once broke a promise, and `fuzz/` with files that nobody wrote.

use fluxfit_files::{
    GivenMotor, LogOptions, Mapping, MotorFile, ReadLog, ReadScenario, Truth, parse_bounds, parse_fix, parse_log, parse_map, parse_prior,
    parse_unit, parse_window,
};
use std::{fs, path::Path};

/// The name of the file in messages.
const NAME: &str = "any.file";

/// Holds one reader to its promises.
pub(crate) type Promise = fn(&[u8]);

/// The readers. Targets of fuzzing and folders of regressions have these names.
pub(crate) const READERS: [(&str, Promise); 8] = [
    ("log", log),
    ("motor_file", motor_file),
    ("mapping", mapping),
    ("scenario_file", scenario_file),
    ("flux_map", flux_map),
    ("truth", truth),
    ("given_motor", given_motor),
    ("argument", argument),
];

/// A log, as it is and with what a user may say of it.
pub(crate) fn log(bytes: &[u8]) {
    let map = |text: &str| text.split(',').filter_map(|pair| parse_map(pair).ok()).collect();
    let units = |text: &str| text.split(',').filter_map(|pair| parse_unit(pair).ok()).collect();
    let told = [
        LogOptions::default(),
        LogOptions { pole_pairs: Some(4), units: units("omega=rpm-mech,t=ms,theta=deg"), ..LogOptions::default() },
        LogOptions { mapping: Mapping::parse(NAME, b"sample_period = 0.001").unwrap_or_default(), ..LogOptions::default() },
        LogOptions { map: map("t=time,ud=u_d,uq=u_q,id=i_d,iq=i_q,omega=speed,theta=angle"), pole_pairs: Some(3), ..LogOptions::default() },
    ];
    for options in told {
        if let Some(ReadLog { log, notes, .. }) = one_line(parse_log(NAME, bytes, &options)) {
            let columns = log.columns();
            for (name, values) in columns.named().into_iter().chain(columns.optional()) {
                assert_eq!(values.len(), columns.t.len(), "{name}");
                assert!(values.iter().all(|value| value.is_finite()), "{name}");
            }
            assert!(columns.t.windows(2).all(|pair| pair[0] < pair[1]), "time does not increase");
            notes.iter().for_each(|note| is_one_line(note));
        }
    }
}

/// A motor file.
fn motor_file(bytes: &[u8]) {
    if let Some(file) = one_line(MotorFile::parse(NAME, bytes)) {
        let MotorFile { rs, ld, lq, psi_f, pole_pairs, rating } = file;
        let numbers = [rs, ld, lq, psi_f, rating.current, rating.voltage, rating.speed];
        assert!(numbers.into_iter().flatten().all(|number| number.is_finite() && number > 0.0), "{file:?}");
        assert_ne!(pole_pairs, Some(0));
    }
}

/// A mapping file.
fn mapping(bytes: &[u8]) {
    if let Some(mapping) = one_line(Mapping::parse(NAME, bytes)) {
        assert!(mapping.sample_period.is_none_or(|period| period.is_finite() && period > 0.0));
        assert_ne!(mapping.pole_pairs, Some(0));
    }
}

/// A scenario. Its flux map is looked for in a folder that has none.
fn scenario_file(bytes: &[u8]) {
    // A scenario may name any file of its user's; this one may not wait for a device or for standard input.
    if bytes.windows(8).any(|window| window == b"flux_map") {
        return;
    }
    if let Some(read) = one_line(ReadScenario::parse(NAME, bytes, Path::new("no such folder"))) {
        assert!(read.scenario.duration.is_finite());
        assert!(read.scenario.check().is_ok());
    }
}

/// A flux map, of which only a scenario's reader knows.
fn flux_map(bytes: &[u8]) {
    const SCENARIO: &str = "duration = 0.01\n[motor]\nrs = 0.6\nflux_map = \"map.csv\"\npole_pairs = 2\n\
                            [mechanics]\nkind = \"dyno\"\n[inverter]\nu_dc = 500\n";
    let Ok(folder) = tempfile::tempdir() else { return };
    if fs::write(folder.path().join("map.csv"), bytes).is_ok() {
        one_line(ReadScenario::parse(NAME, SCENARIO.as_bytes(), folder.path()));
    }
}

/// A truth.
fn truth(bytes: &[u8]) {
    if let Some(Truth { motor, pole_pairs }) = one_line(Truth::parse(NAME, bytes)) {
        assert!([motor.rs, motor.ld, motor.lq, motor.psi_f].into_iter().all(|number| number.is_finite() && number >= 0.0), "{motor:?}");
        assert_ne!(pole_pairs, Some(0));
    }
}

/// A motor file, a truth or an identification's document.
fn given_motor(bytes: &[u8]) {
    if let Some(read) = one_line(GivenMotor::parse(NAME, bytes)) {
        let numbers = [read.file.rs, read.file.ld, read.file.lq, read.file.psi_f];
        assert!(numbers.into_iter().flatten().all(|number| number.is_finite() && number >= 0.0), "{:?}", read.file);
    }
}

/// Arguments, of which none is a file.
fn argument(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    one_line(parse_map(&text));
    one_line(parse_unit(&text));
    if let Some((_, value)) = one_line(parse_fix(&text)) {
        assert!(value.is_finite() && value >= 0.0, "{value}");
    }
    if let Some((_, value, error)) = one_line(parse_prior(&text)) {
        assert!(value.is_finite() && error.is_finite() && error > 0.0, "{value} {error}");
    }
    if let Some((_, lower, upper)) = one_line(parse_bounds(&text)) {
        assert!(lower.is_finite() && upper.is_finite() && lower < upper, "{lower} {upper}");
    }
    if let Some((start, end)) = one_line(parse_window(&text)) {
        assert!(start.is_finite() && end.is_finite() && start < end, "{start} {end}");
    }
}

/// What was read; of a refusal, that it is one line.
fn one_line<T>(read: Result<T, impl std::fmt::Display>) -> Option<T> {
    read.map_err(|error| is_one_line(&error.to_string())).ok()
}

fn is_one_line(sentence: &str) {
    assert!(!sentence.is_empty() && !sentence.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')), "{sentence:?}");
}
