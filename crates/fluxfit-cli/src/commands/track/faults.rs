//! The faults of a drive that `fluxfit identify` found.

use crate::{error::CommandError, terminal};
use fluxfit::document::IDENTIFICATION;
use fluxfit_files::{FileError, Problem, input};
use fluxfit_track::DriveFaults;
use serde_json::Value;
use std::path::Path;

/// Reads them from the JSON of an identification. Those that a stream cannot be freed of are named.
pub(super) fn read(path: &Path) -> Result<DriveFaults, CommandError> {
    let bytes = input::read(path)?;
    let refuse =
        |message: String| FileError::from(Problem::Syntax { format: "the JSON of fluxfit identify", message }).in_file(&input::name(path));
    let document: Value = serde_json::from_slice(&bytes).map_err(|error| refuse(error.to_string()))?;
    if document["schema"] != IDENTIFICATION {
        return Err(refuse(format!("its schema is {}", document["schema"])).into());
    }
    let mut faults = DriveFaults::default();
    let mut left = Vec::new();
    for (key, entry) in document["nuisance"].as_object().into_iter().flatten().filter(|(key, _)| *key != "voltage_timing") {
        match (faults.number(key), entry["value"].as_f64()) {
            (Some(number), Some(value)) => *number = value,
            _ => left.push(key.as_str()),
        }
    }
    if left.contains(&"dead_time_phase") {
        let message = "its dead time was found without an electrical angle, and cannot be carried to another log";
        return Err(refuse(message.to_owned()).into());
    }
    if !left.is_empty() {
        terminal::note(&format!("--faults: what a stream is not freed of: {}", left.join(", ")));
    }
    Ok(faults)
}
