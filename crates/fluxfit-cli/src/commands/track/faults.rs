//! The faults of a drive that `fluxfit identify` found.

use crate::{error::CommandError, terminal};
use fluxfit::document::IDENTIFICATION;
use fluxfit_files::{FileError, Problem, input};
use fluxfit_track::DriveFaults;
use serde_json::Value;
use std::path::Path;

const ANSWER: &str = "an answer of fluxfit identify";
const MAKE_ANSWER: &str = "make one with: fluxfit identify LOG --json > answer.json";

const WITH_ANGLE: &str = "an answer whose dead time can be carried to another log: it was found without an electrical angle";
const LOG_ANGLE: &str = "identify a log with theta_e";

/// Reads them from the JSON of an identification. Those that a stream cannot be freed of are named.
pub(super) fn read(path: &Path) -> Result<DriveFaults, CommandError> {
    let bytes = input::read(path)?;
    let refuse = |problem: Problem| FileError::from(problem).in_file(&input::name(path));
    let document: Option<Value> = serde_json::from_slice(&bytes).ok();
    let Some(document) = document.filter(|document| document["schema"] == IDENTIFICATION) else {
        return Err(refuse(Problem::Document { document: ANSWER, remedy: MAKE_ANSWER }).into());
    };
    let mut faults = DriveFaults::default();
    let mut left = Vec::new();
    for (key, entry) in document["nuisance"].as_object().into_iter().flatten().filter(|(key, _)| *key != "voltage_timing") {
        match (faults.number(key), entry["value"].as_f64()) {
            (Some(number), Some(value)) => *number = value,
            _ => left.push(key.as_str()),
        }
    }
    if left.contains(&"dead_time_phase") {
        return Err(refuse(Problem::Document { document: WITH_ANGLE, remedy: LOG_ANGLE }).into());
    }
    if !left.is_empty() {
        terminal::note(&format!("--faults: what a stream is not freed of: {}", left.join(", ")));
    }
    Ok(faults)
}
