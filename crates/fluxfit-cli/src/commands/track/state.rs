//! The state of a tracker as a file.

use crate::error::CommandError;
use fluxfit_files::{FileError, Problem, input};
use fluxfit_track::Tracker;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name and version of the file.
const STATE: &str = "fluxfit.track-state/1";

const SAVED: &str = "a state that this version of fluxfit track has saved";
const SAVE: &str = "save one with: fluxfit track LOG --save-state state.json";

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
    let state: Option<State> = serde_json::from_slice(&bytes).ok();
    let refusal = || FileError::from(Problem::Document { document: SAVED, remedy: SAVE }).in_file(&input::name(path));
    Ok(state.filter(|state| state.schema == STATE).ok_or_else(refusal)?.tracker)
}

/// Writes a state, whole or not at all.
pub(crate) fn write(path: &Path, tracker: &Tracker) -> Result<(), CommandError> {
    let text = serde_json::to_string(&StateOf { schema: STATE, tracker }).map_err(std::io::Error::from)?;
    Ok(fluxfit_files::write_atomically(path, text.as_bytes())?)
}
