//! The tables `[schedule]`, `[changes]` and `[injection]`.

use fluxfit::motor::PARAMETERS;
use fluxfit_drive::{
    scenario::{Axis, Injection, Schedule, Waveform},
    schedule::{Profile, Ramp},
};
use fluxfit_files::{
    FileError, Problem as FileProblem,
    toml_table::{Entry, Table},
};
use fluxfit_units::Dimension;

/// Most repetitions of a move: a step every tenth of a second of the longest log.
const MOST_TIMES: u32 = 30_000;

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

/// Keys of `[changes]`, in the order of the parameters.
pub(super) const CHANGES_KEYS: &[&str] = &["rs", "ld", "lq", "psi_f"];

pub(super) fn changes(table: &Table<'_>) -> Result<[Profile; PARAMETERS], FileError> {
    let mut changes: [Profile; PARAMETERS] = Default::default();
    for (change, key) in changes.iter_mut().zip(CHANGES_KEYS) {
        if let Some(entry) = table.get(key) {
            *change = course(&entry, Dimension::Ratio)?;
        }
    }
    Ok(changes)
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
    let mut ramps = Vec::new();
    for item in &items {
        ramps.extend(moves(item, dimension)?);
    }
    Ok(Profile::new(ramps))
}

/// A move, and its repetitions.
fn moves(item: &Entry<'_>, dimension: Dimension) -> Result<impl Iterator<Item = Ramp> + use<>, FileError> {
    let table = item.table(&["at", "to", "over", "every", "times"], "a move", RAMP)?;
    let (at, to) = (table.needed("at", Dimension::Time)?, table.needed("to", dimension)?);
    let over = table.quantity("over", Dimension::Time)?.unwrap_or(0.0);
    let (every, times) = match (table.quantity("every", Dimension::Time)?, table.get("times")) {
        (None, None) => (0.0, 1),
        (Some(every), Some(times)) => {
            let range = "a whole number from 1 to 30000";
            let count = times.whole(1, range)?;
            if count > MOST_TIMES {
                return Err(times.out_of_range(range));
            }
            (every, count)
        }
        (None, Some(_)) => return Err(table.missing("every", "\"0.5 s\"")),
        (Some(_), None) => return Err(table.missing("times", "10")),
    };
    Ok((0..times).map(move |time| Ramp { at: at + f64::from(time) * every, to, over }))
}
