//! Tables of a test bench instead of a log: a row per speed, terminals open or shorted.
//!
//! A table is one if it has a speed, no time, no quantity of the dq frame, and either voltages alone, or currents without voltages. What
//! makes power (a DC supply, shaft power, efficiency) belongs to a motor that is driven, and its table is no characteristic.

use super::{
    bench_columns::{DRIVEN, Found, INSTANT, across, convention, found, found_all, refuse_unclear, values_of},
    layout::NotALog,
    options::LogOptions,
    proposal::propose,
    resemblance::words,
    steady_test::{self, SteadyTest},
    table::Table,
};
use crate::{block::ColumnHead, channel::Channel, note::Note, problem::Problem, quantity::Quantity};
use fluxfit::characteristics::{Characteristic, OpenCircuit, OpenCircuitRow, ShortCircuit, ShortCircuitRow};
use fluxfit_files::{FileError, input};
use std::path::Path;

/// A characteristic, and what had to be inferred to read it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadCharacteristic {
    /// The quantities and the columns that they were taken from.
    pub columns: Vec<(&'static str, String)>,
    /// The table, in SI units.
    pub table: Characteristic,
    /// What was inferred or left out.
    pub notes: Vec<Note>,
    /// The speeds are electrical, because nobody says how many pole pairs the motor has: the table tells the motor's own values.
    pub has_electrical_speed: bool,
}

/// Reads a table if it is a characteristic; `None` if it is something else, or nothing that can be read. What can be read only once
/// (standard input, a pipe) is always taken for a log, and so is a file of which the options name the columns of a log.
/// [`map`](LogOptions::map) may name those of a table: `speed`, `voltage`, `current`, `torque`.
///
/// # Errors
/// If it is one, but cannot be read as such.
pub fn read_characteristic(path: &Path, options: &LogOptions) -> Result<Option<ReadCharacteristic>, FileError> {
    let of_table = |(name, header): &'_ (String, String)| Quantity::from_name(name).map(|quantity| (quantity, header.clone()));
    let map: Option<Vec<(Quantity, String)>> = options.map.iter().map(of_table).collect();
    let Some(map) = map.filter(|_| options.mapping.columns.is_empty() && path.is_file()) else { return Ok(None) };
    let pole_pairs = options.pole_pairs.or(options.mapping.pole_pairs);
    // What cannot be opened is told by whoever reads it as a log.
    let Ok(table) = input::open(path).and_then(|bytes| Table::open(bytes, None)) else { return Ok(None) };
    read(table, pole_pairs, &map).map_err(|error| error.in_file(&input::name(path)))
}

/// The quantity that a column of such a table may hold.
pub(super) fn quantity(index: usize, head: &ColumnHead) -> Option<&'static str> {
    found(index, head).map(|found| found.quantity.name())
}

/// What makes a table a log.
const LOG: [Channel; 5] = [Channel::T, Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq];

fn read(mut table: Table, pole_pairs: Option<u32>, map: &[(Quantity, String)]) -> Result<Option<ReadCharacteristic>, FileError> {
    let heads = table.heads().to_vec();
    let is_driven = |head: &ColumnHead| words(&head.name).iter().any(|word| DRIVEN.contains(&word.as_str()));
    let is_of_log = |head: &ColumnHead| {
        let channel = |channel: Channel| {
            super::alias::is_alias(channel, head) || Channel::from_name(head.name.trim()).is_ok_and(|own| own == channel)
        };
        let is_instant = words(&head.name).iter().any(|word| INSTANT.contains(&word.as_str()));
        is_instant
            || head.is_time
            || head.instants.is_some()
            || [Channel::T, Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq].into_iter().any(channel)
    };
    // The dq quantities over time are a log, whatever else is beside them: a duty cycle and a DC voltage, as of a VESC.
    if propose(&LOG, &heads, |_, _| Some(0.0)).len() == LOG.len() {
        return Ok(None);
    }
    let columns = found_all(&heads, map)?;
    if let Some(SteadyTest { table, columns, notes, has_electrical_speed }) = steady_test::read(&mut table, &columns, pole_pairs)? {
        return Ok(Some(ReadCharacteristic { columns, table, notes, has_electrical_speed }));
    }
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    if heads.iter().any(is_of_log) || NotALog::by_names(&names).is_some() {
        return Ok(None);
    }
    let has = |quantity: Quantity| columns.iter().any(|column| column.quantity == quantity);
    if heads.iter().any(is_driven) {
        let is_curve = has(Quantity::Speed) && has(Quantity::Torque) && turns_and_pulls(&mut table, &columns);
        return if is_curve { Err(Problem::LoadCurve.into()) } else { Ok(None) };
    }
    if !has(Quantity::Speed) || has(Quantity::Voltage) == has(Quantity::Current) {
        return Ok(None);
    }
    let wanted: Vec<(usize, &str)> = columns.iter().map(|column| (column.index, column.header.as_str())).collect();
    let values = values_of(&mut table, &wanted)?;
    // Rms values have one sign; a column with both is a wave.
    let is_wave = |(column, values): (&Found, &Vec<f64>)| {
        matches!(column.quantity, Quantity::Voltage | Quantity::Current) && values.iter().any(|value| *value < 0.0)
    };
    if columns.iter().zip(&values).any(is_wave) {
        return Ok(None);
    }
    // A column of zeros measures nothing.
    let columns: Vec<(Found, Vec<f64>)> =
        columns.into_iter().zip(values).filter(|(_, values)| values.iter().any(|value| *value != 0.0)).collect();
    let of_all = Quantity::ALL.map(|quantity| candidates(&columns, quantity));
    let has_shaft = [Quantity::Torque, Quantity::Current].iter().all(|quantity| !of_all[*quantity as usize].is_empty());
    let of_frequency = of_all[Quantity::Speed as usize].first().filter(|(column, _)| column.is_electrical && has_shaft);
    let electrical = of_frequency.filter(|_| pole_pairs.is_none()).map(|(column, _)| column.header.clone());
    refuse_unclear(of_all.iter().map(|of_one| of_one.iter().map(|(column, _)| column).collect()), electrical, None)?;
    let mut notes = Vec::new();
    let speed = channel(&columns, Quantity::Speed, pole_pairs, &mut notes);
    let torque = channel(&columns, Quantity::Torque, pole_pairs, &mut notes);
    let voltage = channel(&columns, Quantity::Voltage, pole_pairs, &mut notes);
    let across = across(&headers(&columns, Quantity::Voltage));
    let current = channel(&columns, Quantity::Current, pole_pairs, &mut notes);
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
    let speeds = candidates(&columns, Quantity::Speed);
    let electrical = speeds.first().filter(|(column, _)| column.is_electrical && pole_pairs.is_none());
    let left_out = speed.len() - table.rows();
    if left_out > 0 {
        notes.push(format!("{left_out} of {} rows have no speed or no value above zero and are left out", speed.len()).into());
    }
    let used =
        Quantity::ALL.into_iter().flat_map(|quantity| headers(&columns, quantity).into_iter().map(move |name| (quantity.name(), name)));
    let used = used.map(|(quantity, header)| (quantity, header.to_owned())).collect();
    Ok(Some(ReadCharacteristic { columns: used, table, notes, has_electrical_speed: electrical.is_some() }))
}

/// Whether speed and torque have two rows or more that are not zero: of a curve there are some. What cannot be read is left to the names.
fn turns_and_pulls(table: &mut Table, columns: &[Found]) -> bool {
    let of = |quantity: Quantity| columns.iter().find(|column| column.quantity == quantity);
    let wanted: Vec<(usize, &str)> =
        [of(Quantity::Speed), of(Quantity::Torque)].into_iter().flatten().map(|column| (column.index, column.header.as_str())).collect();
    let are_some = |values: &Vec<f64>| values.iter().filter(|value| **value != 0.0).count() > 1;
    values_of(table, &wanted).map_or(true, |values| values.iter().all(are_some))
}

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
fn channel(columns: &[(Found, Vec<f64>)], quantity: Quantity, pole_pairs: Option<u32>, notes: &mut Vec<Note>) -> Option<Vec<(f64, f64)>> {
    let candidates = candidates(columns, quantity);
    let (first, _) = candidates.first()?;
    let are_phases = candidates.len() == 3;
    let factor = first.in_si * convention(first, quantity, pole_pairs, notes);
    let mean = |k: usize| {
        let values: Vec<f64> = candidates.iter().map(|(_, values)| factor * values[k]).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        (mean, if are_phases { (squares / (count - 1.0) / count).sqrt() } else { 0.0 })
    };
    Some((0..candidates[0].1.len()).map(mean).collect())
}

/// From a text, for tests of this module and of the one for further tests.
#[cfg(test)]
pub(super) fn parse_characteristic(text: &'static str, pole_pairs: Option<u32>) -> Result<Option<ReadCharacteristic>, FileError> {
    read(Table::open(input::Bytes::Stream(Box::new(std::io::Cursor::new(text.as_bytes()))), None)?, pole_pairs, &[])
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit::characteristics::Across;

    fn of(text: &'static str) -> Result<Option<ReadCharacteristic>, FileError> {
        parse_characteristic(text, None)
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
            // Waves, an instant of each row, a unit that is not known.
            "speed_rpm,voltage_V\n1,2\n2,-2\n",
            "timestep,speed_rpm,voltage_V\n0,1,2\n1,2,4\n",
            "speed [m/s],voltage_V\n1,2\n2,4\n",
            // A duty cycle beside what makes a log.
            "t_day,Duty,RPM,Input Voltage,my vd,my vq,my id,my iq\n1,0.1,900,46,0,2,0,3\n2,0.2,1800,46,0,4,0,3\n",
        ] {
            assert_eq!(of(text).unwrap(), None, "{text}");
        }
    }

    #[test]
    fn the_speed_of_the_shaft_is_taken_before_its_frequency() {
        let read = of("f [Hz],n [1/min],U [V]\n50,1000,10\n100,2000,20\n").unwrap().unwrap();
        let Characteristic::OpenCircuit(table) = read.table else { panic!() };
        assert!((table.rows[0].speed - 104.719_755).abs() < 1e-5);
        let read = of("f [Hz],U [V]\n50,10\n100,20\n").unwrap().unwrap();
        let Characteristic::OpenCircuit(table) = &read.table else { panic!() };
        assert!(read.has_electrical_speed && (table.rows[0].speed - 314.159_265).abs() < 1e-5);
        // A torque is that of the shaft.
        let of_torque = of("f [Hz],I [A],T [Nm]\n50,10,1\n100,20,2\n").unwrap_err().to_string();
        assert!(of_torque.contains("number of pole pairs"), "{of_torque}");
    }

    #[test]
    fn the_curve_of_a_driven_motor_is_named() {
        let error = of("Speed (RPM),Torque (Nm),Current (A),Supplied Power (W)\n1,2,3,4\n2,2,3,4\n").unwrap_err().to_string();
        assert!(error.contains("a motor that drives a load"), "{error}");
        // One row, or rows of zeros, are no curve.
        for rows in ["1,2,3,4\n", "0,0,0,0\n0,0,0,0\n"] {
            let text: String = format!("Speed (RPM),Torque (Nm),Current (A),Supplied Power (W)\n{rows}");
            assert_eq!(of(text.leak()), Ok(None), "{rows}");
        }
    }

    #[test]
    fn two_torques_are_ambiguous() {
        let error = of("n_rpm,I [A],M1 [Nm],torque shaft [Nm]\n1,2,3,4\n2,2,3,4\n").unwrap_err().to_string();
        assert!(error.contains("'M1 [Nm]'") && error.contains("torque"), "{error}");
    }
}
