//! `MOTOR.toml`: what is known about a motor before identification.
//!
//! ```toml
//! [motor]
//! rs = "0.958 ohm"      # numbers with units; a bare number is SI; every key is optional
//! ld = "5.25 mH"
//! lq = "12 mH"
//! psi_f = "0.1827 Wb"
//! pole_pairs = 4
//! magnet_coefficient = "-0.12 %/K"    # of psi_f, for logs with a temperature
//! [rating]
//! current = "20 A"      # phase peak
//! voltage = "180 V"     # phase peak
//! speed = "3000 rpm"    # mechanical
//! [sensors]
//! current_accuracy = "1 %"     # of all current sensors together; the limit of their data sheet
//! bus_accuracy = "0.5 %"       # of the DC voltage
//! ```

use fluxfit_files::{
    FileError, input,
    toml_table::{Document, Shape, Table},
};
use fluxfit_units::Dimension;
use std::path::Path;

/// What is known about a motor and its drive.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MotorFile {
    /// Stator resistance, ohm; as all parameters above zero.
    pub rs: Option<f64>,
    /// Inductance along d, H.
    pub ld: Option<f64>,
    /// Inductance along q, H.
    pub lq: Option<f64>,
    /// Magnet flux linkage, Wb, peak per phase.
    pub psi_f: Option<f64>,
    /// Number of pole pairs.
    pub pole_pairs: Option<u32>,
    /// By which part of itself the magnets' flux changes per kelvin; of either sign.
    pub magnet_coefficient: Option<f64>,
    /// Rated values.
    pub rating: RatedValues,
    /// Accuracy of the drive's sensors.
    pub sensors: SensorAccuracy,
}

/// Limits of the errors of the drive's sensors, as fractions from 0 up to 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SensorAccuracy {
    /// Of a gain common to all current sensors.
    pub current: Option<f64>,
    /// Of the DC voltage.
    pub bus: Option<f64>,
}

/// Rated values of a motor; every number is above zero.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RatedValues {
    /// Current, A, phase peak.
    pub current: Option<f64>,
    /// Voltage, V, phase peak.
    pub voltage: Option<f64>,
    /// Speed, **mechanical** rad/s.
    pub speed: Option<f64>,
}

const SHAPE: Shape = Shape {
    noun: "a motor file",
    keys: &[],
    tables: &[
        ("motor", &["rs", "ld", "lq", "psi_f", "pole_pairs", "magnet_coefficient"]),
        ("rating", &["current", "voltage", "speed"]),
        ("sensors", &["current_accuracy", "bus_accuracy"]),
    ],
};

const ABOVE_ZERO: &str = "a finite number above zero";

/// Reads a motor file; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, is not TOML, has an unknown key, or a value that is not a quantity of its dimension or not above zero.
pub fn read_motor(path: &Path) -> Result<MotorFile, FileError> {
    MotorFile::parse(&input::name(path), &input::read(path)?)
}

impl MotorFile {
    /// Reads a motor file from memory; `name` is the file's name in messages. An empty file is a motor about which nothing is known.
    ///
    /// # Errors
    /// As [`read_motor`].
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, FileError> {
        let parsed = match input::text(bytes, "TOML") {
            Ok(text) => parse(text),
            Err(_) if bytes.trim_ascii().is_empty() => Ok(Self::default()),
            Err(error) => Err(error),
        };
        parsed.map_err(|error| error.in_file(name))
    }
}

fn parse(text: &str) -> Result<MotorFile, FileError> {
    let document = Document::parse(text, &SHAPE)?;
    let (motor, rating, sensors) = (document.table("motor"), document.table("rating"), document.table("sensors"));
    Ok(MotorFile {
        rs: above_zero(&motor, "rs", Dimension::Resistance)?,
        ld: above_zero(&motor, "ld", Dimension::Inductance)?,
        lq: above_zero(&motor, "lq", Dimension::Inductance)?,
        psi_f: above_zero(&motor, "psi_f", Dimension::FluxLinkage)?,
        pole_pairs: motor.get("pole_pairs").map(|entry| entry.whole(1, "a whole number above zero")).transpose()?,
        magnet_coefficient: motor.get("magnet_coefficient").map(|entry| entry.coefficient()).transpose()?,
        rating: RatedValues {
            current: above_zero(&rating, "current", Dimension::Current)?,
            voltage: above_zero(&rating, "voltage", Dimension::Voltage)?,
            speed: above_zero(&rating, "speed", Dimension::Speed)?,
        },
        sensors: SensorAccuracy { current: accuracy(&sensors, "current_accuracy")?, bus: accuracy(&sensors, "bus_accuracy")? },
    })
}

fn accuracy(table: &Table<'_>, key: &str) -> Result<Option<f64>, FileError> {
    let Some(entry) = table.get(key) else { return Ok(None) };
    let fraction = entry.fraction()?;
    if fraction < 1.0 { Ok(Some(fraction)) } else { Err(entry.out_of_range("a fraction from 0 up to 1")) }
}

fn above_zero(table: &Table<'_>, key: &str, dimension: Dimension) -> Result<Option<f64>, FileError> {
    let Some(entry) = table.get(key) else { return Ok(None) };
    let number = entry.quantity(dimension)?;
    if number > 0.0 { Ok(Some(number)) } else { Err(entry.out_of_range(ABOVE_ZERO)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn read(text: &str) -> Result<MotorFile, String> {
        MotorFile::parse("motor.toml", text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_papers_motor() {
        let text = "[motor]\nrs = \"0.958 ohm\"\nld = \"5.25 mH\"\nlq = 12e-3\npsi_f = \"0.1827 Wb\"\npole_pairs = 4\n\
                    [rating]\ncurrent = 20\nvoltage = \"180 V\"\nspeed = \"3000 rpm\"\n";
        let expected = MotorFile {
            rs: Some(0.958),
            ld: Some(5.25e-3),
            lq: Some(12e-3),
            psi_f: Some(0.1827),
            pole_pairs: Some(4),
            magnet_coefficient: None,
            rating: RatedValues { current: Some(20.0), voltage: Some(180.0), speed: Some(3000.0 * (TAU / 60.0)) },
            sensors: SensorAccuracy::default(),
        };
        assert_eq!(read(text), Ok(expected));
        assert_eq!(read(""), Ok(MotorFile::default()));
        assert_eq!(read("motor.magnet_coefficient = \"-0.12 %/K\"").map(|motor| motor.magnet_coefficient), Ok(Some(-0.0012)));
        assert_eq!(read("motor.ld = \"5.25mH\"").map(|motor| motor.ld), Ok(Some(5.25e-3)));
    }

    #[test]
    fn the_accuracy_of_sensors_is_a_number_or_a_percentage() {
        let sensors = |text: &str| read(text).map(|motor| motor.sensors);
        let both = Ok(SensorAccuracy { current: Some(0.01), bus: Some(0.005) });
        assert_eq!(sensors("[sensors]\ncurrent_accuracy = \"±1 %\"\nbus_accuracy = 0.005\n"), both);
        assert_eq!(sensors("[sensors]\ncurrent_accuracy = 0.01\nbus_accuracy = \"0.5%\"\n"), both);
        assert_eq!(sensors("[motor]\n"), Ok(SensorAccuracy::default()));
    }

    #[test]
    fn errors_name_line_and_key() {
        let cases = [
            (
                "[motor]\n\nl_d = 1",
                "line 3, key 'l_d': this key is not known; [motor] can hold rs, ld, lq, psi_f, pole_pairs and magnet_coefficient; did you mean ld?",
            ),
            ("rs = 1", "line 1, key 'rs': this key is outside of its table; put it below a line [motor]"),
            (
                "[ratings]",
                "line 1, key 'ratings': this key is not known; a motor file can hold motor, rating and sensors; did you mean rating?",
            ),
            ("motor = 1", "line 1, key 'motor': this is not a table, as in [motor]; correct it"),
            (
                "[motor]\nrs = \"1 H\"",
                "line 2, key 'rs': \"1 H\" is not a resistance; write a number, in ohm or with its unit, as in \"0.958 ohm\"",
            ),
            ("[motor]\nrs = 0", "line 2, key 'rs': \"0\" is out of range; it must be a finite number above zero"),
            ("[motor]\nld = -1e-3", "line 2, key 'ld': \"-1e-3\" is out of range; it must be a finite number above zero"),
            (
                "[motor]\nrs = nan",
                "line 2, key 'rs': \"nan\" is not a resistance; write a number, in ohm or with its unit, as in \"0.958 ohm\"",
            ),
            ("[motor]\nrs = [1]", "line 2, key 'rs': this is not a number, or one with its unit in quotes; correct it"),
            ("[sensors]\nbus_accuracy = 1", "line 2, key 'bus_accuracy': \"1\" is out of range; it must be a fraction from 0 up to 1"),
            ("[sensors]\nbus_accuracy = -0.1", "line 2, key 'bus_accuracy': \"-0.1\" is out of range; it must be zero or more"),
            (
                "[sensors]\ncurrent_accuracy = \"1 A\"",
                "line 2, key 'current_accuracy': \"1 A\" is not a fraction; write a number or a percentage, as in 0.01 or 1%",
            ),
            ("[motor]\npole_pairs = 0", "line 2, key 'pole_pairs': \"0\" is out of range; it must be a whole number above zero"),
            ("[motor]\npole_pairs = 4.0", "line 2, key 'pole_pairs': this is not a whole number, as in pole_pairs = 4; correct it"),
            ("[motor]\nrs = 1\nrs = 2", "line 3: this is not TOML: duplicate key; correct it"),
            ("[motor]\nrs = 0.958 ohm", "line 2: this is not TOML: string values must be quoted, expected literal string; correct it"),
        ];
        for (text, sentence) in cases {
            assert_eq!(read(text), Err(format!("motor.toml, {sentence}")), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(text in "\\PC*|(\\[motor\\]\n|rs = |ld=|[0-9.\"'\\[\\]{}= \n]){0,20}") {
            if let Err(sentence) = read(&text) {
                prop_assert_eq!(sentence.lines().count(), 1);
            }
        }
    }
}
