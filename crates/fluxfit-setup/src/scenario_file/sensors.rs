//! The table `[sensors]`.

use fluxfit_drive::scenario::{Adc, CurrentSensors, Sensors};
use fluxfit_files::{FileError, Problem as FileProblem, toml_table::Table};
use fluxfit_units::Dimension;

/// Keys of `[sensors]`.
pub(super) const KEYS: &[&str] = &[
    "current_sensors",
    "current_noise",
    "current_offset",
    "current_gain",
    "adc_bits",
    "adc_range",
    "angle_offset",
    "angle_delay",
    "encoder_steps",
    "u_dc_gain",
];

pub(super) fn sensors(table: &Table<'_>) -> Result<Sensors, FileError> {
    let ideal = Sensors::IDEAL;
    let counts = [("3", CurrentSensors::Three), ("2", CurrentSensors::Two)];
    Ok(Sensors {
        current_sensors: table.get("current_sensors").map_or(Ok(ideal.current_sensors), |entry| entry.word(&counts))?,
        current_noise: table.quantity("current_noise", Dimension::Current)?.unwrap_or(ideal.current_noise),
        current_offset: of_phases(table, "current_offset", Dimension::Current, "[\"0 A\", \"0.1 A\", \"0 A\"]", ideal.current_offset)?,
        current_gain: of_phases(table, "current_gain", Dimension::Ratio, "[1, 1, 1.02]", ideal.current_gain)?,
        adc: adc(table)?,
        angle_offset: table.quantity("angle_offset", Dimension::Angle)?.unwrap_or(ideal.angle_offset),
        angle_delay: table.quantity("angle_delay", Dimension::Time)?.unwrap_or(ideal.angle_delay),
        encoder_steps: table.get("encoder_steps").map(|entry| entry.whole(0, "a whole number, at least 16")).transpose()?,
        u_dc_gain: table.quantity("u_dc_gain", Dimension::Ratio)?.unwrap_or(ideal.u_dc_gain),
    })
}

/// One value per phase, for a, b and c.
fn of_phases(table: &Table<'_>, key: &str, dimension: Dimension, example: &str, ideal: [f64; 3]) -> Result<[f64; 3], FileError> {
    let Some(entry) = table.get(key) else { return Ok(ideal) };
    let wanted = || entry.refuse(FileProblem::Value { wanted: format!("a list for the phases a, b and c, as in {example}") });
    let items = entry.items().filter(|items| items.len() == 3).ok_or_else(wanted)?;
    let mut values = ideal;
    for (value, item) in values.iter_mut().zip(items) {
        *value = item.quantity(dimension)?;
    }
    Ok(values)
}

/// Bits and range of the converter: both or neither.
fn adc(table: &Table<'_>) -> Result<Option<Adc>, FileError> {
    match (table.get("adc_bits"), table.quantity("adc_range", Dimension::Current)?) {
        (None, None) => Ok(None),
        (Some(bits), Some(range)) => Ok(Some(Adc { bits: bits.whole(0, "a whole number, from 2 to 32")?, range })),
        (Some(_), None) => Err(table.missing("adc_range", Dimension::Current.example())),
        (None, Some(_)) => Err(table.missing("adc_bits", "12")),
    }
}
