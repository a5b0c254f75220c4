//! Tables of a test bench instead of a log: a row per speed, terminals open or shorted.
//!
//! A table is one if it has a speed, no time, no quantity of the dq frame, and either voltages alone, or currents without voltages. What
//! makes power (a DC supply, shaft power, efficiency) belongs to a motor that is driven, and its table is no characteristic.

use super::{
    resemblance::{is_reference, words},
    table::Table,
};
use crate::{
    block::{ColumnHead, WantedColumn},
    channel::Channel,
    header_unit::{HeaderUnit, split_header, unit_in_row},
    note::Note,
    problem::Problem,
};
use fluxfit::characteristics::{Across, Characteristic, OpenCircuit, OpenCircuitRow, ShortCircuit, ShortCircuitRow};
use fluxfit_files::{FileError, input};
use fluxfit_units::{Dimension, Unit, wording::quote};
use std::path::Path;

/// A characteristic, and what had to be inferred to read it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadCharacteristic {
    /// The table, in SI units.
    pub table: Characteristic,
    /// What was inferred or left out.
    pub notes: Vec<Note>,
}

/// Reads a table if it is a characteristic; `None` if it is something else, or nothing that can be read. What can be read only once
/// (standard input, a pipe) is always taken for a log.
///
/// # Errors
/// If it is one, but cannot be read as such.
pub fn read_characteristic(path: &Path, pole_pairs: Option<u32>) -> Result<Option<ReadCharacteristic>, FileError> {
    if !path.is_file() {
        return Ok(None);
    }
    // What cannot be opened is told by whoever reads it as a log.
    let Ok(table) = input::open(path).and_then(|bytes| Table::open(bytes, None)) else { return Ok(None) };
    read(table, pole_pairs).map_err(|error| error.in_file(&input::name(path)))
}

/// What a column of a characteristic holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Speed,
    Voltage,
    Current,
    Torque,
}

impl Quantity {
    const ALL: [Self; 4] = [Self::Speed, Self::Voltage, Self::Current, Self::Torque];

    fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Voltage => "voltage",
            Self::Current => "current",
            Self::Torque => "torque",
        }
    }

    /// Words of names that have no unit beside them, in several languages.
    fn words(self) -> &'static [&'static str] {
        match self {
            Self::Speed => &["speed", "rpm", "drehzahl", "omega", "velocity", "vitesse", "velocita", "velocidad"],
            Self::Voltage => {
                &["voltage", "urms", "vrms", "ull", "vll", "bemf", "emf", "backemf", "spannung", "tension", "tensione", "voltaje"]
            }
            Self::Current => &["current", "irms", "iph", "strom", "courant", "corrente", "corriente"],
            Self::Torque => &["torque", "drehmoment", "moment", "couple", "coppia", "par"],
        }
    }
}

/// Words of a table of a motor that is driven, or of a log.
const DRIVEN: [&str; 12] =
    ["power", "efficiency", "leistung", "wirkungsgrad", "puissance", "dc", "bus", "battery", "supply", "throttle", "duty", "pwm"];

/// A column with its quantity and its size in SI units.
struct Found {
    index: usize,
    header: String,
    quantity: Quantity,
    /// Whether the unit is stated: names without are less certain.
    has_unit: bool,
    in_si: f64,
    is_electrical: bool,
}

fn found(index: usize, head: &ColumnHead) -> Option<Found> {
    let header = head.name.trim().to_owned();
    if is_reference(&header) {
        return None;
    }
    let unit = |dimension: Dimension| match (split_header(&header, dimension).1, head.unit.as_deref()) {
        (HeaderUnit::Known(unit), _) => Some(unit),
        (_, Some(text)) => match unit_in_row(text, &header, dimension) {
            HeaderUnit::Known(unit) => Some(unit),
            _ => None,
        },
        _ => None,
    };
    let of =
        |quantity, has_unit, in_si, is_electrical| Some(Found { index, header: header.clone(), quantity, has_unit, in_si, is_electrical });
    if let Some(in_si) = torque_unit(&header).or_else(|| head.unit.as_deref().and_then(newton_metres)) {
        return of(Quantity::Torque, true, in_si, false);
    }
    for (quantity, dimension) in
        [(Quantity::Speed, Dimension::Speed), (Quantity::Voltage, Dimension::Voltage), (Quantity::Current, Dimension::Current)]
    {
        if let Some(unit) = unit(dimension) {
            let is_electrical = matches!(unit, Unit::RpmElectrical | Unit::HertzElectrical)
                || unit == Unit::RadianPerSecond && crate::header_unit::states_electrical(&header);
            return of(quantity, true, unit.in_si(), is_electrical);
        }
    }
    if [Dimension::Time, Dimension::Temperature, Dimension::Angle].into_iter().any(|dimension| unit(dimension).is_some()) {
        return None;
    }
    let words = words(&header);
    let quantity = Quantity::ALL.into_iter().find(|quantity| words.iter().any(|word| quantity.words().contains(&word.as_str())))?;
    of(quantity, false, if quantity == Quantity::Speed { Unit::RpmMechanical.in_si() } else { 1.0 }, false)
}

/// The unit of a torque at the end of a header, in N m.
fn torque_unit(header: &str) -> Option<f64> {
    let bracket = [('[', ']'), ('(', ')')].into_iter().find_map(|(open, close)| {
        let text = header.trim().strip_suffix(close)?;
        text.rfind(open).map(|at| &text[at + 1..])
    });
    newton_metres(bracket.or_else(|| header.rsplit_once('_').map(|(_, unit)| unit))?)
}

fn newton_metres(unit: &str) -> Option<f64> {
    let plain: String = unit.to_lowercase().chars().filter(|c| c.is_alphabetic()).collect();
    match plain.as_str() {
        "nm" => Some(1.0),
        "mnm" => Some(1e-3),
        "ncm" => Some(1e-2),
        _ => None,
    }
}

fn read(mut table: Table, pole_pairs: Option<u32>) -> Result<Option<ReadCharacteristic>, FileError> {
    let heads = table.heads();
    let is_driven = |head: &ColumnHead| words(&head.name).iter().any(|word| DRIVEN.contains(&word.as_str()));
    let is_of_log = |head: &ColumnHead| {
        let channel = |channel: Channel| {
            super::alias::is_alias(channel, head) || Channel::from_name(head.name.trim()).is_ok_and(|own| own == channel)
        };
        head.is_time || head.instants.is_some() || [Channel::T, Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq].into_iter().any(channel)
    };
    if heads.iter().any(is_of_log) {
        return Ok(None);
    }
    let columns: Vec<Found> = heads.iter().enumerate().filter_map(|(index, head)| found(index, head)).collect();
    let has = |quantity: Quantity| columns.iter().any(|column| column.quantity == quantity);
    if heads.iter().any(is_driven) {
        let is_curve = has(Quantity::Speed) && has(Quantity::Torque);
        return if is_curve { Err(Problem::LoadCurve.into()) } else { Ok(None) };
    }
    if !has(Quantity::Speed) || has(Quantity::Voltage) == has(Quantity::Current) {
        return Ok(None);
    }
    let wanted: Vec<WantedColumn> = columns
        .iter()
        .map(|column| WantedColumn {
            index: column.index,
            header: column.header.clone(),
            is_time: false,
            is_optional: true,
            instants: None,
        })
        .collect();
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
    let mut refused: Option<FileError> = None;
    table.read(&wanted, &mut |block| {
        values.iter_mut().zip(&block.values).for_each(|(all, values)| all.extend(values));
        refused = refused.take().or(block.refused.iter().flatten().next().cloned());
        if values[0].len() > MOST_ROWS { Err(Problem::LongCharacteristic { most: MOST_ROWS }.into()) } else { Ok(()) }
    })?;
    if let Some(error) = refused {
        return Err(error);
    }
    // A column of zeros measures nothing.
    let columns: Vec<(Found, Vec<f64>)> =
        columns.into_iter().zip(values).filter(|(_, values)| values.iter().any(|value| *value != 0.0)).collect();
    let mut notes = Vec::new();
    let speed = channel(&columns, Quantity::Speed, pole_pairs, &mut notes)?;
    let torque = channel(&columns, Quantity::Torque, pole_pairs, &mut notes)?;
    let voltage = channel(&columns, Quantity::Voltage, pole_pairs, &mut notes)?;
    let across = across(&headers(&columns, Quantity::Voltage));
    let current = channel(&columns, Quantity::Current, pole_pairs, &mut notes)?;
    let Some(speed) = speed else { return Ok(None) };
    let of_row = |k: usize| torque.as_ref().map(|torque| torque[k].0).filter(|torque| torque.is_finite());
    let rows = || speed.iter().map(|(speed, _)| *speed).enumerate();
    let is_whole = |speed: f64, (value, _): (f64, f64)| speed.is_finite() && speed != 0.0 && value.is_finite() && value > 0.0;
    let table = match (voltage, current) {
        (Some(voltage), None) => {
            let rows = rows().filter(|(k, speed)| is_whole(*speed, voltage[*k]));
            let rows = rows.map(|(k, speed)| OpenCircuitRow { speed, voltage: voltage[k].0 });
            Characteristic::OpenCircuit(OpenCircuit { rows: rows.collect(), across })
        }
        (None, Some(current)) => {
            let rows = rows().filter(|(k, speed)| is_whole(*speed, current[*k]));
            let rows =
                rows.map(|(k, speed)| ShortCircuitRow { speed, current: current[k].0, current_error: current[k].1, torque: of_row(k) });
            Characteristic::ShortCircuit(ShortCircuit { rows: rows.collect() })
        }
        _ => return Ok(None),
    };
    let left_out = speed.len() - table.rows();
    if left_out > 0 {
        notes.push(format!("{left_out} of {} rows have no speed or no value above zero and are left out", speed.len()).into());
    }
    Ok(Some(ReadCharacteristic { table, notes }))
}

/// Rows of a table of speeds beyond which it is none.
const MOST_ROWS: usize = 100_000;

/// The columns that a quantity is taken from: those with a unit before those without.
fn candidates(columns: &[(Found, Vec<f64>)], quantity: Quantity) -> Vec<&(Found, Vec<f64>)> {
    let of_quantity: Vec<&(Found, Vec<f64>)> = columns.iter().filter(|(column, _)| column.quantity == quantity).collect();
    let with_unit: Vec<&(Found, Vec<f64>)> = of_quantity.iter().copied().filter(|(column, _)| column.has_unit).collect();
    let mut candidates = if with_unit.is_empty() { of_quantity } else { with_unit };
    // The frequency beside the speed of the shaft says the same.
    if candidates.iter().any(|(column, _)| !column.is_electrical) {
        candidates.retain(|(column, _)| !column.is_electrical);
    }
    candidates
}

fn headers(columns: &[(Found, Vec<f64>)], quantity: Quantity) -> Vec<&str> {
    candidates(columns, quantity).iter().map(|(column, _)| column.header.as_str()).collect()
}

/// The values of a quantity in SI units, each with the standard error by which three phases differ; from one column, or from three whose
/// names differ by the phase alone. Columns with a unit are preferred.
fn channel(
    columns: &[(Found, Vec<f64>)],
    quantity: Quantity,
    pole_pairs: Option<u32>,
    notes: &mut Vec<Note>,
) -> Result<Option<Vec<(f64, f64)>>, FileError> {
    let candidates = candidates(columns, quantity);
    let Some((first, _)) = candidates.first() else { return Ok(None) };
    let headers = headers(columns, quantity);
    let are_phases = headers.first_chunk::<3>().is_some_and(|names| candidates.len() == 3 && are_phases(*names));
    if candidates.len() > 1 && !are_phases {
        let headers = headers.into_iter().map(str::to_owned).collect();
        return Err(Problem::AmbiguousQuantity { quantity: quantity.name(), headers }.into());
    }
    let factor = first.in_si * convention(first, quantity, pole_pairs, notes)?;
    let mean = |k: usize| {
        let values: Vec<f64> = candidates.iter().map(|(_, values)| factor * values[k]).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        (mean, if are_phases { (squares / (count - 1.0) / count).sqrt() } else { 0.0 })
    };
    Ok(Some((0..candidates[0].1.len()).map(mean).collect()))
}

/// What a name says of the convention, as a factor; and what is assumed where it says nothing.
fn convention(column: &Found, quantity: Quantity, pole_pairs: Option<u32>, notes: &mut Vec<Note>) -> Result<f64, FileError> {
    let name = quote(&column.header);
    match quantity {
        Quantity::Voltage | Quantity::Current => {
            let (factor, how, is_stated) = to_rms(&column.header);
            let doubt = if is_stated { "" } else { ", because its name does not say so; if it is an amplitude, add 'peak' to the name" };
            notes.push(format!("the {} {name} is read as {how}{doubt}", quantity.name()).into());
            Ok(factor)
        }
        Quantity::Speed if column.is_electrical => match pole_pairs {
            Some(pole_pairs) => Ok(1.0 / f64::from(pole_pairs)),
            None => Err(Problem::ElectricalSpeed { header: column.header.clone() }.into()),
        },
        Quantity::Speed => {
            notes.push(format!("the speed {name} is read as that of the shaft").into());
            Ok(1.0)
        }
        Quantity::Torque => Ok(1.0),
    }
}

/// The rms value over what a column holds, what that is, and whether its name states it.
fn to_rms(header: &str) -> (f64, &'static str, bool) {
    let words = words(header);
    // Last in a word too: `Urms`, `Vpp`.
    let ends = |ends: &[&str]| words.iter().any(|word| ends.iter().any(|end| word.ends_with(end)));
    let are_two = |one: &str| words.windows(2).any(|pair| pair[0].ends_with(one) && pair[1] == one);
    if ends(&["pp", "pkpk", "p2p", "peak2peak"]) || are_two("pk") || words.windows(3).any(|of| of[0] == "peak" && of[2] == "peak") {
        (0.125_f64.sqrt(), "peak to peak", true)
    } else if ends(&["peak", "pk", "amplitude", "amplitudes", "ampl", "spitze", "scheitel", "scheitelwert"]) {
        (0.5_f64.sqrt(), "amplitude", true)
    } else {
        (1.0, "rms", ends(&["rms", "eff", "effektiv", "efficace", "efficaz"]))
    }
}

/// Between which points voltages were measured, by the names of their columns: `U_12`, `Uab` and `line voltage` between lines, `U_a`,
/// `U_1N` and `phase voltage` of a phase. Channels of an instrument, `U1` to `U3`, say nothing.
fn across(headers: &[&str]) -> Option<Across> {
    let words = words(headers.first()?);
    let count = |some: &[&str]| words.iter().filter(|word| some.iter().any(|one| word.contains(one))).count();
    let has = |some: &[&str]| words.iter().any(|word| some.contains(&word.as_str()));
    let of_phase = count(&["phase", "strang", "stern", "neutral"]) + usize::from(has(&["ph", "ln", "vln", "uln", "star"]));
    let pairs = words.windows(2).filter(|pair| pair[0] == pair[1] && ["l", "ph"].contains(&pair[0].as_str())).count();
    let between_lines = pairs > 0 || of_phase > 1 || count(&["verkettet", "leiter", "line"]) > 0 || has(&["ll", "vll", "ull"]);
    match (of_phase, between_lines) {
        // Phase to phase is from line to line; line to neutral is of a phase.
        (_, true) if !words.iter().any(|word| ["neutral", "star", "stern"].contains(&word.as_str())) => Some(Across::Lines),
        (1.., _) => Some(Across::Phase),
        (0, _) => headers.first_chunk::<3>().filter(|_| headers.len() == 3).and_then(|names| across_by_letters(*names)),
    }
}

/// The same, by the letters in which three names differ: two of each, or one with an `n` behind it or with a letter of a phase.
fn across_by_letters(names: [&str; 3]) -> Option<Across> {
    let places = differing(names)?;
    let letters: Vec<char> = names[0].to_lowercase().chars().collect();
    match places.as_slice() {
        [one, other] if one + 1 == *other => Some(Across::Lines),
        [place] if letters.get(place + 1) == Some(&'n') => Some(Across::Phase),
        [place] if letters[*place].is_alphabetic() => Some(Across::Phase),
        _ => None,
    }
}

/// Letters and digits of three phases.
const PHASES: [[char; 3]; 4] = [['1', '2', '3'], ['a', 'b', 'c'], ['u', 'v', 'w'], ['r', 's', 't']];

/// Whether three names differ by their phases alone: `Iu`, `Iv`, `Iw`; or `U_12`, `U_23`, `U_31`.
fn are_phases(names: [&str; 3]) -> bool {
    differing(names).is_some()
}

/// The places in which three names differ, if all of them hold phases.
fn differing(names: [&str; 3]) -> Option<Vec<usize>> {
    let letters = names.map(|name| name.to_lowercase().chars().collect::<Vec<char>>());
    let [one, two, three] = &letters;
    if one.len() != two.len() || one.len() != three.len() {
        return None;
    }
    let is_phase = |place: &usize| {
        let mut of_three = [one[*place], two[*place], three[*place]];
        of_three.sort_unstable();
        PHASES.contains(&of_three)
    };
    let differ = |place: &usize| one[*place] != two[*place] || one[*place] != three[*place];
    let different: Vec<usize> = (0..one.len()).filter(differ).collect();
    (!different.is_empty() && different.iter().all(is_phase)).then_some(different)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn of(text: &'static str) -> Result<Option<ReadCharacteristic>, FileError> {
        read(Table::open(input::Bytes::Stream(Box::new(Cursor::new(text.as_bytes()))), None).unwrap(), None)
    }

    #[test]
    fn three_phases_and_a_speed_of_the_shaft() {
        let read = of("n [1/min];U_12 [V];U_23 [V];U_31 [V];Temp [°C]\n300;10;11;12;20\n600;20;22;24;20\n").unwrap().unwrap();
        let Characteristic::OpenCircuit(table) = read.table else { panic!() };
        assert_eq!(table.rows.len(), 2);
        assert!((table.rows[0].speed - 31.415_926).abs() < 1e-5);
        assert!((table.rows[1].voltage - 22.0).abs() < 1e-12);
    }

    #[test]
    fn amplitudes_and_phases_are_told_by_their_name() {
        let Some(ReadCharacteristic { table: Characteristic::OpenCircuit(table), .. }) =
            of("speed_rpm,phase_voltage_peak_V\n1000,10\n2000,20\n").unwrap()
        else {
            panic!()
        };
        assert!((table.rows[0].voltage - 10.0 * 0.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(table.across, Some(Across::Phase));
    }

    #[test]
    fn names_tell_between_which_points_voltages_were_measured() {
        let three = |one: &'static str, two: &'static str, three: &'static str| vec![one, two, three];
        for (names, expected) in [
            (three("U_12 [V]", "U_23 [V]", "U_31 [V]"), Some(Across::Lines)),
            (three("Uuv", "Uvw", "Uwu"), Some(Across::Lines)),
            (three("U_a [V]", "U_b [V]", "U_c [V]"), Some(Across::Phase)),
            (three("U1N", "U2N", "U3N"), Some(Across::Phase)),
            (three("PA1_URMS_1 [V]", "PA1_URMS_2 [V]", "PA1_URMS_3 [V]"), None),
            (vec!["voltage_V"], None),
            (vec!["U_ll_rms [V]"], Some(Across::Lines)),
            (vec!["Line voltage (V)"], Some(Across::Lines)),
            (vec!["L-L voltage [V]"], Some(Across::Lines)),
            (vec!["phase-to-phase voltage [V]"], Some(Across::Lines)),
            (vec!["line to line [V]"], Some(Across::Lines)),
            (vec!["line-to-neutral voltage [V]"], Some(Across::Phase)),
            (vec!["Strangspannung [V]"], Some(Across::Phase)),
            (vec!["Spannung verkettet [V]"], Some(Across::Lines)),
            (vec!["Phase voltage RMS (V)"], Some(Across::Phase)),
        ] {
            assert_eq!(across(&names), expected, "{names:?}");
        }
    }

    #[test]
    fn names_tell_what_of_a_wave_was_measured() {
        let eighth = 0.125_f64.sqrt();
        for (name, factor, is_stated) in [
            ("Vpp [V]", eighth, true),
            ("bemf pk-pk (V)", eighth, true),
            ("U peak to peak [V]", eighth, true),
            ("Vpk", 2.0 * eighth, true),
            ("Scheitelwert U [V]", 2.0 * eighth, true),
            ("PA1_URMS_1 [V]", 1.0, true),
            ("current [A]", 1.0, false),
        ] {
            let (found, _, states) = to_rms(name);
            assert_eq!((found, states), (factor, is_stated), "{name}");
        }
    }

    #[test]
    fn shorted_terminals_have_current_and_torque() {
        let Some(ReadCharacteristic { table: Characteristic::ShortCircuit(table), .. }) =
            of("Drehzahl (1/min),Strom (A),Drehmoment (mNm)\n0,0,0\n1000,10,-500\n").unwrap()
        else {
            panic!()
        };
        assert_eq!(table.rows.len(), 1);
        assert!((table.rows[0].torque.unwrap() + 0.5).abs() < 1e-12);
    }

    #[test]
    fn logs_and_curves_of_driven_motors_are_none() {
        for text in [
            "t,ud,uq,id,iq,omega_e\n0,1,2,3,4,5\n1,1,2,3,4,5\n",
            "speed_rpm,DC current (A),Supplied Power (W)\n1,2,3\n2,2,3\n",
            "a,b\n1,2\n3,4\n",
            "time_s,speed_rpm,voltage_V\n0,1,2\n1,1,2\n",
        ] {
            assert_eq!(of(text).unwrap(), None, "{text}");
        }
    }

    #[test]
    fn the_speed_of_the_shaft_is_taken_before_its_frequency() {
        let read = of("f [Hz],n [1/min],U [V]\n50,1000,10\n100,2000,20\n").unwrap().unwrap();
        let Characteristic::OpenCircuit(table) = read.table else { panic!() };
        assert!((table.rows[0].speed - 104.719_755).abs() < 1e-5);
        assert!(of("f [Hz],U [V]\n50,10\n100,20\n").unwrap_err().to_string().contains("number of pole pairs"));
    }

    #[test]
    fn names_of_three_phases_differ_by_these_alone() {
        for names in [["Iu", "Iv", "Iw"], ["U_ab [V]", "U_bc [V]", "U_ca [V]"], ["Phase A current", "Phase B current", "Phase C current"]] {
            assert!(are_phases(names), "{names:?}");
        }
        for names in [["I1", "I2", "I4"], ["I1", "I2", "I12"], ["Iu", "Iu", "Iw"], ["M1", "M2", "n3"], ["I", "I", "I"]] {
            assert!(!are_phases(names), "{names:?}");
        }
    }

    #[test]
    fn the_curve_of_a_driven_motor_is_named() {
        let error = of("Speed (RPM),Torque (Nm),Current (A),Supplied Power (W)\n1,2,3,4\n2,2,3,4\n").unwrap_err().to_string();
        assert!(error.contains("a motor that drives a load"), "{error}");
    }

    #[test]
    fn two_torques_are_ambiguous() {
        let error = of("n_rpm,I [A],M1 [Nm],torque shaft [Nm]\n1,2,3,4\n2,2,3,4\n").unwrap_err().to_string();
        assert!(error.contains("'M1 [Nm]'") && error.contains("torque"), "{error}");
    }
}
