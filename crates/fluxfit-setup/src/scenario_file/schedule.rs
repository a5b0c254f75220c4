//! The tables `[schedule]` and `[injection]`.

use fluxfit_drive::{
    scenario::{Axis, Injection, Schedule, Waveform},
    schedule::{Profile, Ramp},
};
use fluxfit_files::{
    FileError, Problem as FileProblem,
    toml_table::{Entry, Table},
};
use fluxfit_units::Dimension;

/// A ramp, as an example in messages.
const RAMP: &str = "{ at = \"0.2 s\", to = .., over = \"10 ms\" }";

/// Keys of `[schedule]`.
pub(super) const SCHEDULE_KEYS: &[&str] = &["id", "iq", "speed", "load"];

pub(super) fn schedule(table: &Table<'_>, injection: &Table<'_>) -> Result<Schedule, FileError> {
    let course = |key, dimension| table.get(key).map_or(Ok(Profile::default()), |entry| course(&entry, dimension));
    Ok(Schedule {
        id: course("id", Dimension::Current)?,
        iq: course("iq", Dimension::Current)?,
        speed: course("speed", Dimension::Speed)?,
        load: course("load", Dimension::Torque)?,
        injection: if injection.is_present() { Some(test_voltage(injection)?) } else { None },
    })
}

/// Keys of `[injection]`.
pub(super) const INJECTION_KEYS: &[&str] = &["axis", "waveform", "frequency", "voltage"];

fn test_voltage(table: &Table<'_>) -> Result<Injection, FileError> {
    let needed = |key, example| table.get(key).ok_or_else(|| table.missing(key, example));
    Ok(Injection {
        axis: needed("axis", "\"d\"")?.word(&[("d", Axis::D), ("q", Axis::Q)])?,
        waveform: needed("waveform", "\"square\"")?.word(&[("sine", Waveform::Sine), ("square", Waveform::Square)])?,
        frequency: table.needed("frequency", Dimension::Frequency)?,
        voltage: course(&needed("voltage", "[{ at = \"0.3 s\", to = \"5 V\" }]")?, Dimension::Voltage)?,
    })
}

/// A list of ramps, or a constant value.
fn course(entry: &Entry<'_>, dimension: Dimension) -> Result<Profile, FileError> {
    let Some(items) = entry.items() else {
        let wanted = || entry.refuse(FileProblem::Value { wanted: format!("a quantity, or a list of ramps as in [{RAMP}]") });
        return entry.as_written().ok_or_else(wanted).and_then(|_| entry.quantity(dimension)).map(Profile::constant);
    };
    items.iter().map(|item| one_move(item, dimension)).collect::<Result<_, _>>().map(Profile::new)
}

fn one_move(item: &Entry<'_>, dimension: Dimension) -> Result<Ramp, FileError> {
    let table = item.table(&["at", "to", "over"], "a move", RAMP)?;
    Ok(Ramp {
        at: table.needed("at", Dimension::Time)?,
        to: table.needed("to", dimension)?,
        over: table.quantity("over", Dimension::Time)?.unwrap_or(0.0),
    })
}
