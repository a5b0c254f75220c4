//! What must hold for every reader and any bytes: no panic, errors of one line, only finite numbers in what is returned.
//!
//! Checked by `tests/files.rs` with the files of the examples, whole and damaged, and by `fuzz/` with random files.

use fluxfit_setup::{GivenMotor, MotorFile, ReadScenario, Truth};
use std::{fs, path::Path};

/// The name of the file in messages.
const NAME: &str = "any.file";

/// Checks one reader.
pub(crate) type Promise = fn(&[u8]);

/// The readers; targets of fuzzing have these names.
pub(crate) const READERS: [(&str, Promise); 5] =
    [("motor_file", motor_file), ("scenario_file", scenario_file), ("flux_map", flux_map), ("truth", truth), ("given_motor", given_motor)];

/// A motor file.
fn motor_file(bytes: &[u8]) {
    if let Some(file) = one_line(MotorFile::parse(NAME, bytes)) {
        let MotorFile { rs, ld, lq, psi_f, pole_pairs, magnet_coefficient, rating, sensors } = file;
        let numbers = [rs, ld, lq, psi_f, rating.current, rating.voltage, rating.speed];
        assert!(numbers.into_iter().flatten().all(|number| number.is_finite() && number > 0.0), "{file:?}");
        assert_ne!(pole_pairs, Some(0));
        assert!(magnet_coefficient.is_none_or(f64::is_finite));
        assert!([sensors.current, sensors.bus].into_iter().flatten().all(|fraction| (0.0..1.0).contains(&fraction)), "{file:?}");
    }
}

/// A scenario, whose flux map would be in a folder that does not exist.
fn scenario_file(bytes: &[u8]) {
    // A scenario may name any file, but the test must not wait for a device or for standard input.
    if bytes.windows(8).any(|window| window == b"flux_map") {
        return;
    }
    if let Some(read) = one_line(ReadScenario::parse(NAME, bytes, Path::new("no such folder"))) {
        assert!(read.scenario.duration.is_finite());
        assert!(read.scenario.check().is_ok());
    }
}

/// A flux map, which is read through a scenario.
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

/// What was read; an error must be one line.
fn one_line<T>(read: Result<T, impl std::fmt::Display>) -> Option<T> {
    read.map_err(|error| is_one_line(&error.to_string())).ok()
}

fn is_one_line(sentence: &str) {
    assert!(!sentence.is_empty() && !sentence.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')), "{sentence:?}");
}
