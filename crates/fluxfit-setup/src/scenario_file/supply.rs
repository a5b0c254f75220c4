//! The tables `[inverter]` and `[control]`.

use fluxfit_drive::scenario::{Control, Inverter, Mechanics, Modulation, Update};
use fluxfit_files::{FileError, toml_table::Table};
use fluxfit_units::Dimension;

/// Keys of `[inverter]`.
pub(super) const INVERTER_KEYS: &[&str] =
    &["modulation", "u_dc", "ripple", "ripple_frequency", "carrier", "update", "dead_time", "switch_drop", "diode_drop", "voltage_noise"];

pub(super) fn inverter(table: &Table<'_>) -> Result<Inverter, FileError> {
    let ideal = Inverter::ideal(table.needed("u_dc", Dimension::Voltage)?, table.needed("carrier", Dimension::Frequency)?);
    let ripple = table.quantity("ripple", Dimension::Voltage)?;
    let ripple_frequency = table.quantity("ripple_frequency", Dimension::Frequency)?;
    if ripple.is_some() && ripple_frequency.is_none() {
        return Err(table.missing("ripple_frequency", "\"300 Hz\""));
    }
    let modulations = [("switched", Modulation::Switched), ("averaged", Modulation::Averaged)];
    let updates = [("double", Update::Double), ("single", Update::Single)];
    Ok(Inverter {
        modulation: table.get("modulation").map_or(Ok(ideal.modulation), |entry| entry.word(&modulations))?,
        ripple: ripple.unwrap_or(0.0),
        ripple_frequency: ripple_frequency.unwrap_or(0.0),
        update: table.get("update").map_or(Ok(ideal.update), |entry| entry.word(&updates))?,
        dead_time: table.quantity("dead_time", Dimension::Time)?.unwrap_or(0.0),
        switch_drop: table.quantity("switch_drop", Dimension::Voltage)?.unwrap_or(0.0),
        diode_drop: table.quantity("diode_drop", Dimension::Voltage)?.unwrap_or(0.0),
        voltage_noise: table.quantity("voltage_noise", Dimension::Voltage)?.unwrap_or(0.0),
        ..ideal
    })
}

/// Keys of `[control]`.
pub(super) const CONTROL_KEYS: &[&str] = &["current_bandwidth", "speed_bandwidth", "max_current", "trip_current", "field_weakening"];

pub(super) fn control(table: &Table<'_>, mechanics: Mechanics) -> Result<Control, FileError> {
    let current_bandwidth = table.needed("current_bandwidth", Dimension::Frequency)?;
    let speed_bandwidth = match mechanics {
        Mechanics::Free { .. } => table.needed("speed_bandwidth", Dimension::Frequency)?,
        // A dynamometer has no speed loop; the key is ignored.
        Mechanics::Dyno => table.quantity("speed_bandwidth", Dimension::Frequency)?.unwrap_or(0.0),
    };
    let usual = Control::new(current_bandwidth, speed_bandwidth, table.needed("max_current", Dimension::Current)?);
    Ok(Control {
        trip_current: table.quantity("trip_current", Dimension::Current)?.unwrap_or(usual.trip_current),
        field_weakening: table.get("field_weakening").map_or(Ok(usual.field_weakening), |entry| entry.boolean())?,
        ..usual
    })
}
