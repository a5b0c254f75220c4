//! A file that is named as a log and is another one of fluxfit's own files: what it is, and where it belongs.

use crate::{error::CommandError, shell};
use fluxfit_files::{FileError, input};
use fluxfit_log::{Mapping, read_mapping};
use fluxfit_setup::{MotorFile, read_motor, read_scenario};
use std::{fs, path::Path};

/// Largest of such files, bytes: a longer one is read as a log alone.
const LARGEST: u64 = 1 << 20;

/// The table that only a scenario has.
const OF_SCENARIO: &str = "[schedule]";

/// What was read of a log, with an error that says what the file is where it is no log.
pub(crate) fn or_what_it_is<T>(read: Result<T, FileError>, path: &Path) -> Result<T, CommandError> {
    read.map_err(|error| what_it_is(path).map_or_else(|| error.into(), CommandError::Usage))
}

/// What a file of fluxfit's own is, and what to do with it; nothing of any other file.
fn what_it_is(path: &Path) -> Option<String> {
    if !fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() <= LARGEST) {
        return None;
    }
    let (name, file) = (input::name(path), shell::word(path.as_os_str()));
    // A scenario with a mistake is one all the same: to simulate it says what is wrong.
    let has_schedule = || fs::read_to_string(path).is_ok_and(|text| text.lines().any(|line| line.trim() == OF_SCENARIO));
    if read_scenario(path).is_ok() || has_schedule() {
        let log = shell::word(path.with_extension("csv").as_os_str());
        return Some(format!("{name} is a scenario, not a log; simulate it first (fluxfit simulate {file} -o {log}), and name {log} here"));
    }
    // An empty file is any of them.
    if read_motor(path).is_ok_and(|motor| motor != MotorFile::default()) {
        return Some(format!("{name} is a motor file, not a log; name it beside the log: --motor {file}"));
    }
    let is_mapping = read_mapping(path).is_ok_and(|mapping| mapping != Mapping::default());
    is_mapping.then(|| format!("{name} is a mapping file, not a log; name it beside the log: --mapping {file}"))
}
