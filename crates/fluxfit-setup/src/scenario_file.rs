//! `SCENARIO.toml`: a motor in a drive, and its schedule. `docs/drive.md` lists the keys; `scenario_file/paper_rig.toml` is an example
//! with all of them.
//!
//! This file and its folder read the format. Whether the values make a valid drive is decided by [`Scenario::check`] alone; its errors
//! get their line here.

mod log;
mod machine;
mod schedule;
mod sensors;
mod supply;

use crate::problem::Problem;
use fluxfit_drive::{Error, Scenario};
use fluxfit_files::{
    FileError, input,
    toml_table::{Document, Shape},
};
use fluxfit_units::Dimension;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A scenario as it is simulated, and as it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadScenario {
    /// In SI units, checked.
    pub scenario: Scenario,
    /// The content of the file, as JSON.
    pub document: Value,
    /// The path of the flux map, if there is one.
    pub flux_map: Option<PathBuf>,
}

/// The paper's rig with a comment for every key: a template.
pub const PAPER_RIG: &str = include_str!("scenario_file/paper_rig.toml");

/// Seed of a scenario without one.
const SEED: u64 = 1;

const SHAPE: Shape = Shape {
    noun: "a scenario",
    keys: &["duration", "seed"],
    tables: &[
        ("motor", machine::MOTOR_KEYS),
        ("changes", schedule::CHANGES_KEYS),
        ("mechanics", machine::MECHANICS_KEYS),
        ("inverter", supply::INVERTER_KEYS),
        ("control", supply::CONTROL_KEYS),
        ("schedule", schedule::SCHEDULE_KEYS),
        ("injection", schedule::INJECTION_KEYS),
        ("sensors", sensors::KEYS),
        ("log", log::KEYS),
    ],
};

/// Reads a scenario; the path `-` is standard input. The path of a flux map is relative to the folder of the scenario.
///
/// # Errors
/// If a file cannot be read or is not TOML, a key is unknown or missing or has a value of the wrong kind, the flux map cannot be read,
/// or [`Scenario::check`] refuses the scenario.
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
    /// Reads a scenario from memory; `name` is the file's name in messages, `folder` the folder of its flux map.
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
    let duration = root.needed("duration", Dimension::Time)?;
    let seed = root.get("seed").map_or(Ok(SEED), |entry| entry.whole(0, "a whole number, zero or more"))?;
    let changes = schedule::changes(&document.table("changes"))?;
    let motor = machine::motor(&document.table("motor"), changes, folder)?;
    let mechanics = machine::mechanics(&document.table("mechanics"))?;
    let scenario = Scenario {
        duration,
        seed,
        motor,
        mechanics,
        inverter: supply::inverter(&document.table("inverter"))?,
        control: supply::control(&document.table("control"), mechanics)?,
        schedule: schedule::schedule(&document.table("schedule"), &document.table("injection"))?,
        sensors: sensors::sensors(&document.table("sensors"))?,
        logging: log::log(&document.table("log"))?,
    };
    scenario.check().map_err(|error| located(error, &document))?;
    let flux_map = document.table("motor").get("flux_map").and_then(|entry| entry.text().ok()).map(|name| folder.join(name));
    Ok(ReadScenario { scenario, document: document.to_json(), flux_map })
}

/// The error of the drive at its key; an error about a number quotes the number as it is written.
fn located(error: Error, document: &Document<'_>) -> FileError {
    let Some(entry) = error.key().and_then(|key| document.find(key)) else { return Problem::Drive(error).into() };
    match error {
        Error::Setting { range, .. } if entry.as_written().is_some() => entry.out_of_range(range),
        // The sentence names the key already.
        error => FileError::from(Problem::Drive(error)).at_line(entry.line()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit_drive::{
        scenario::{
            Adc, Axis, CurrentSensors, FilterFrame, Harmonics, Injection, LoggedRows, Logging, Mechanics, Modulation, Sensors, Update,
            Waveform,
        },
        schedule::{Profile, Ramp},
    };
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    fn read(text: &str) -> Result<ReadScenario, String> {
        ReadScenario::parse("rig.toml", text.as_bytes(), Path::new("")).map_err(|error| error.to_string())
    }

    #[test]
    fn the_built_in_scenario_is_the_papers_rig() {
        let read = paper_scenario().unwrap();
        assert_eq!(read.scenario, Scenario::paper());
        assert_eq!(read.document["motor"]["ld"], "5.25 mH");
        assert_eq!(read.document["seed"], 1);
        assert_eq!(read.document.as_object().unwrap().keys().next().unwrap(), "duration");
    }

    /// The keys that are comments in the template are valid too.
    #[test]
    fn every_key_is_read() {
        let keys = ["# modulation", "# ripple", "# update", "# dead_time", "# switch_drop", "# diode_drop", "# trip_current"];
        let keys = keys.iter().chain(&["# field_weakening", "# current_", "# adc_", "# angle_", "# encoder_", "# [injection]"]);
        let keys = keys.chain(&["# axis", "# waveform", "# frequency", "# voltage"]);
        let keys = keys.chain(&[
            "# [changes]",
            "# rs = [",
            "# psi_f = [",
            "# rs_drift",
            "# flux_harmonics",
            "# u_dc_gain",
            "# [log]",
            "# speed_filter",
            "# every",
            "# rows",
            "# theta_e",
            "# filter_frame",
            "# u_dc",
        ]);
        let text = keys.fold(PAPER_RIG.to_owned(), |text, key| text.replace(key, &key[2..]));
        let mut expected = Scenario::paper();
        expected.inverter.modulation = Modulation::Averaged;
        expected.inverter.update = Update::Single;
        (expected.inverter.ripple, expected.inverter.ripple_frequency) = (5.0, 300.0);
        (expected.inverter.dead_time, expected.inverter.switch_drop, expected.inverter.diode_drop) = (2e-6, 1.0, 1.0);
        expected.control.field_weakening = true;
        let voltage = Profile::new(vec![Ramp { at: 0.3, to: 5.0, over: 0.0 }]);
        expected.schedule.injection = Some(Injection { axis: Axis::D, waveform: Waveform::Square, frequency: 500.0, voltage });
        expected.sensors = Sensors {
            current_sensors: CurrentSensors::Two,
            current_noise: 0.05,
            current_offset: [0.0, 0.1, 0.0],
            current_gain: [1.0, 1.0, 1.02],
            adc: Some(Adc { bits: 12, range: 30.0 }),
            angle_offset: 3.0 * (PI / 180.0),
            angle_delay: 40e-6,
            encoder_steps: Some(4096),
            u_dc_gain: 1.02,
        };
        expected.motor.rs_drift = 0.2;
        expected.motor.changes[0] = Profile::new(vec![Ramp { at: 0.0, to: 0.3, over: 0.9 }]);
        expected.motor.changes[3] = Profile::new(vec![Ramp { at: 0.5, to: -0.05, over: 0.0 }]);
        expected.motor.harmonics = Harmonics { fifth: 0.006, seventh: 0.003 };
        expected.logging = Logging {
            filter_frame: FilterFrame::Dq,
            current_filter: Some(1000.0),
            voltage_filter: Some(1000.0),
            speed_filter: Some(20.0),
            every: 10,
            rows: LoggedRows::Mean,
            theta_e: false,
            u_dc: false,
        };
        // Half the samples are too few for the rig's current loop.
        let slower = "current_bandwidth = \"150 Hz\"";
        expected.control.current_bandwidth = 150.0;
        assert_eq!(read(&text.replace("current_bandwidth = \"200 Hz\"", slower)).unwrap().scenario, expected);
    }

    #[test]
    fn a_move_repeats_itself() {
        let wave = "id = [{ at = \"0.1 s\", to = \"-2 A\", every = \"0.2 s\", times = 3 }, { at = 0.2, to = 0, every = 0.2, times = 2 }]";
        let read = read(&PAPER_RIG.replace("id = [{ at = \"0.6 s\", to = \"-2 A\" }]", wave)).unwrap();
        let found = [0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.85].map(|t| read.scenario.schedule.id.at(t));
        assert_eq!(found, [0.0, -2.0, 0.0, -2.0, 0.0, -2.0, -2.0, -2.0]);
    }

    #[test]
    fn a_dynamometer_needs_neither_inertia_nor_speed_loop() {
        let text = "duration = 1\n[motor]\nrs = 1\nld = 0.01\nlq = 0.02\npsi_f = 0.2\npole_pairs = 3\n[mechanics]\nkind = \"dyno\"\n\
                    [inverter]\nu_dc = 300\ncarrier = 5e3\n[control]\ncurrent_bandwidth = 100\nmax_current = 10\n\
                    [schedule]\nspeed = \"600 rpm\"\niq = 3\n[[schedule.id]]\nat = 0.5\nto = -1\n";
        let scenario = read(text).unwrap().scenario;
        assert_eq!(scenario.mechanics, Mechanics::Dyno);
        assert_eq!(scenario.schedule.speed, Profile::constant(600.0 * (TAU / 60.0)));
        assert_eq!((scenario.schedule.iq.at(0.0), scenario.schedule.id.at(0.6)), (3.0, -1.0));
        assert_eq!(scenario.control.trip_current, 15.0);
    }

    /// Errors of the reader; those of the drive are in the tests of the command.
    #[test]
    fn errors_name_line_and_key() {
        let cases = [
            (
                "u_dc = \"310 V\"",
                "udc = 310",
                "line 24, key 'udc': this key is not known; [inverter] can hold modulation, u_dc, ripple, \
              ripple_frequency, carrier, update, dead_time, switch_drop, diode_drop and voltage_noise; did you mean u_dc?",
            ),
            ("u_dc = \"310 V\"", "max_current = 3", "line 24, key 'max_current': this key belongs to [control]; move it there"),
            (
                "[sensors]",
                "[sensors]\nduration = 1",
                "line 52, key 'duration': this key belongs above all tables; move it to the top of the file",
            ),
            ("at = \"0.2 s\", ", "", "line 42: the key at is missing; write at = \"0.5 s\""),
            (
                "to = \"10 N m\"",
                "too = 10",
                "line 42, key 'too': this key is not known; a move can hold at, to, over, every and times; did you mean to?",
            ),
            (
                "to = \"10 N m\"",
                "to = \"10 A\"",
                "line 42, key 'to': \"10 A\" is not a torque; write a number, in N m or with its unit, \
              as in \"10 N m\"",
            ),
            (
                "# kind = \"dyno\"",
                "kind = \"dyna\"#",
                "line 18, key 'kind': \"dyna\" is not one of the values; it can be free or dyno; did you mean dyno?",
            ),
            (
                "# flux_map = \"map.csv\"",
                "flux_map = \"map.csv\"",
                "line 9, key 'ld': this key cannot be combined with flux_map; remove one of them",
            ),
            (
                "# current_gain = [1, 1, 1.02]",
                "current_gain = [1, 1]",
                "line 55, key 'current_gain': this is not a list for the phases \
              a, b and c, as in [1, 1, 1.02]; correct it",
            ),
            (
                "# flux_harmonics = [0.006, 0.003]",
                "flux_harmonics = 0.006",
                "line 15, key 'flux_harmonics': this is not a list for the 5th and the 7th harmonic, as in [0.006, 0.003]; correct it",
            ),
            ("# [log]", "[log]\nevery = 0", "line 64, key 'every': \"0\" is out of range; it must be a whole number above zero"),
            ("# [log]", "[log]\nrows = \"last\"", "line 64, key 'rows': \"last\" is not one of the values; it can be first or mean"),
            ("# adc_bits = 12", "adc_bits = 12", "line 51: the key adc_range is missing; write adc_range = \"20 A\" below [sensors]"),
            ("duration = \"0.9 s\"", "", "the key duration is missing; write duration = \"0.5 s\""),
        ];
        for (from, to, sentence) in cases {
            assert!(PAPER_RIG.contains(from), "{from}");
            let place = if sentence.starts_with("line") { ", " } else { ": " };
            assert_eq!(read(&PAPER_RIG.replacen(from, to, 1)), Err(format!("rig.toml{place}{sentence}")), "{to}");
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*|(\\[(motor|schedule|sensors|injection|log)\\]\n|id = |rs=|seed=|voltage = |[0-9.\"'\\[\\]{}=, \n]){0,20}") {
            if let Err(sentence) = read(&text) {
                prop_assert_eq!(sentence.lines().count(), 1);
            }
        }

        /// One value of the template replaced by anything.
        #[test]
        fn no_value_panics(line in 0usize..76, value in "\\PC{0,12}|-?[0-9]{1,20}|\"-?[0-9.e]{1,9} ?(s|A|V|Hz|rpm|H)?\"|\\[[0-9,]{0,9}\\]|\\{[a-z=0-9]{0,9}\\}|nan|true") {
            let change = |(at, text): (usize, &str)| match text.split_once(" = ") {
                Some((key, _)) if at == line => format!("{} = {value}", key.trim_start_matches("# ")),
                _ => text.to_owned(),
            };
            let text: Vec<String> = PAPER_RIG.lines().enumerate().map(change).collect();
            if let Err(sentence) = read(&text.join("\n")) {
                prop_assert_eq!(sentence.lines().count(), 1);
                prop_assert!(sentence.starts_with("rig.toml"), "{}", sentence);
            }
        }

        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..64)) {
            let _ = ReadScenario::parse("rig.toml", &bytes, Path::new(""));
        }
    }
}
