//! `SCENARIO.toml`: a motor in a drive, and what is asked of it. `docs/drive.md` lists the keys; `paper_rig.toml` beside this file
//! shows them.
//!
//! This file and its folder know how a scenario is written; what a drive cannot be is known by [`Scenario::check`] alone, whose
//! refusals are told here with their line.

mod machine;
mod schedule;
mod sensors;
mod supply;

use crate::{
    error::{FileError, Problem},
    input,
    quantity::Dimension,
    toml_table::{Document, Shape},
};
use fluxfit_drive::{Error, Scenario};
use serde_json::Value;
use std::path::Path;

/// A scenario as it is simulated and as it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadScenario {
    /// In SI units, checked.
    pub scenario: Scenario,
    /// The TOML as it was written, as JSON.
    pub document: Value,
}

/// The paper's rig, with a comment for every key: what to start from.
pub const PAPER_RIG: &str = include_str!("scenario_file/paper_rig.toml");

/// Seed of a scenario that names none.
const SEED: u32 = 1;

const SHAPE: Shape = Shape {
    noun: "a scenario",
    keys: &["duration", "seed"],
    tables: &[
        ("motor", &["rs", "ld", "lq", "psi_f", "flux_map", "pole_pairs"]),
        ("mechanics", &["kind", "inertia", "friction"]),
        ("inverter", &["modulation", "u_dc", "ripple", "ripple_frequency", "carrier", "update", "dead_time", "switch_drop", "diode_drop"]),
        ("control", &["current_bandwidth", "speed_bandwidth", "max_current", "trip_current", "field_weakening"]),
        ("schedule", &["id", "iq", "speed", "load"]),
        ("injection", &["axis", "waveform", "frequency", "voltage"]),
        (
            "sensors",
            &[
                "current_sensors",
                "current_noise",
                "current_offset",
                "current_gain",
                "adc_bits",
                "adc_range",
                "angle_offset",
                "encoder_steps",
            ],
        ),
    ],
};

/// Reads a scenario; the path `-` is standard input. A flux map is looked for beside the scenario.
///
/// # Errors
/// If a file cannot be read or is no TOML, a key is unknown, missing or holds no value of its kind, the flux map is none, or
/// [`Scenario::check`] refuses the scenario.
pub fn read_scenario(path: &Path) -> Result<ReadScenario, FileError> {
    let folder = if input::is_standard(path) { None } else { path.parent() };
    ReadScenario::parse(&input::name(path), &input::read(path)?, folder.unwrap_or(Path::new("")))
}

/// The paper's rig.
///
/// # Errors
/// None: a test reads it.
pub fn paper_scenario() -> Result<ReadScenario, FileError> {
    ReadScenario::parse("the built-in scenario", PAPER_RIG.as_bytes(), Path::new(""))
}

impl ReadScenario {
    /// Reads a scenario from memory; `name` is the file's name in messages, `folder` where its flux map is.
    ///
    /// # Errors
    /// As [`read_scenario`].
    pub fn parse(name: &str, bytes: &[u8], folder: &Path) -> Result<Self, FileError> {
        input::text(bytes, "TOML").and_then(|text| parse(text, folder)).map_err(|error| error.in_file(name))
    }
}

fn parse(text: &str, folder: &Path) -> Result<ReadScenario, FileError> {
    let document = Document::parse(text, &SHAPE)?;
    let root = document.root();
    let mechanics = machine::mechanics(&document.table("mechanics"))?;
    let scenario = Scenario {
        duration: root.needed("duration", Dimension::Time)?,
        seed: root.get("seed").map_or(Ok(SEED), |entry| entry.whole(0, "a whole number, zero or more"))?.into(),
        motor: machine::motor(&document.table("motor"), folder)?,
        mechanics,
        inverter: supply::inverter(&document.table("inverter"))?,
        control: supply::control(&document.table("control"), mechanics)?,
        schedule: schedule::schedule(&document.table("schedule"), &document.table("injection"))?,
        sensors: sensors::sensors(&document.table("sensors"))?,
    };
    scenario.check().map_err(|error| located(error, &document))?;
    Ok(ReadScenario { scenario, document: document.to_json() })
}

/// The drive's refusal at its key, in the words of the file where it is about a number that stands there.
fn located(error: Error, document: &Document<'_>) -> FileError {
    let Some(entry) = error.key().and_then(|key| document.find(key)) else { return Problem::Drive(error).into() };
    match error {
        Error::Setting { range, .. } if entry.as_written().is_some() => entry.out_of_range(range),
        // The sentence names the key.
        error => FileError::from(Problem::Drive(error)).at_line(entry.line()),
    }
}
