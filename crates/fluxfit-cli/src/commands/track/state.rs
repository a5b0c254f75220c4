//! The state of a tracker as a file.

use crate::error::CommandError;
use fluxfit_files::{FileError, Problem, input};
use fluxfit_track::Tracker;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name and version of the file.
const STATE: &str = "fluxfit.track-state/1";

#[derive(Deserialize)]
struct State {
    schema: String,
    tracker: Tracker,
}

#[derive(Serialize)]
struct StateOf<'a> {
    schema: &'a str,
    tracker: &'a Tracker,
}

/// Reads a state.
pub(super) fn read(path: &Path) -> Result<Tracker, CommandError> {
    let bytes = input::read(path)?;
    let refuse = |reason: String| {
        FileError::from(Problem::Syntax { format: "a state that fluxfit track has saved", message: reason }).in_file(&input::name(path))
    };
    let state: State = serde_json::from_slice(&bytes).map_err(|error| refuse(error.to_string()))?;
    if state.schema != STATE {
        return Err(refuse(format!("its schema is {:?}", state.schema)).into());
    }
    Ok(state.tracker)
}

/// Writes a state, whole or not at all.
pub(super) fn write(path: &Path, tracker: &Tracker) -> Result<(), CommandError> {
    let text = serde_json::to_string(&StateOf { schema: STATE, tracker }).map_err(std::io::Error::from)?;
    Ok(fluxfit_files::write_atomically(path, text.as_bytes())?)
}
