//! Tables of a test bench instead of a log: a row per speed, terminals open or shorted.
//!
//! A table is one if it has a speed, no time, no quantity of the dq frame, and either voltages alone, or currents without voltages. What
//! makes power (a DC supply, shaft power, efficiency) belongs to a motor that is driven, and its table is no characteristic.

use super::{
    axis_currents::is_axis,
    bench_columns::{Found, INSTANT, Stated, driven, found, found_all, is_direct, place, refuse_unclear, values_of},
    bench_convention::{convention, lacks_unit, points},
    layout::NotALog,
    mapping::Park,
    options::LogOptions,
    polar,
    proposal::propose,
    resemblance::{fit, words},
    steady_points,
    steady_test::{self, ReadCharacteristic},
    table::Table,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    note::Note,
    problem::Problem,
    quantity::{Quantity, TableColumn},
    unclear_table::UnclearTable,
};
use fluxfit::characteristics::{Characteristic, OpenCircuit, OpenCircuitRow, ShortCircuit, ShortCircuitRow};
use fluxfit_files::{FileError, input};
use std::path::{Path, PathBuf};

/// Reads a table if it is a characteristic; `None` if it is something else, or nothing that can be read. What can be read only once
/// (standard input, a pipe) is always taken for a log, and so is a file of which the options name the columns of a log.
/// [`map`](LogOptions::map) may name those of a table: `speed`, `voltage` (`voltage_ll`, `voltage_phase`), `current` or `iq` and `id`,
/// `torque`; of operating points those of the dq frame. Then the file is one.
///
/// # Errors
/// If it is one, but cannot be read as such.
pub fn read_characteristic(path: &Path, options: &LogOptions) -> Result<Option<ReadCharacteristic>, FileError> {
    read_characteristic_among(path, &[], options)
}

/// The same of one of several files: a mapped column has to be in one of them alone.
///
/// # Errors
/// As [`read_characteristic`].
pub fn read_characteristic_among(path: &Path, all: &[PathBuf], options: &LogOptions) -> Result<Option<ReadCharacteristic>, FileError> {
    // What cannot be opened is told by whoever reads it as a log.
    let open = |path: &Path| input::open(path).and_then(|bytes| Table::open(bytes, None));
    // With the time between rows stated they are those of a log; another scaling of the transform is one of logs alone.
    let may_be_points = options.mapping.sample_period.is_none() && options.mapping.park == Park::default() && path.is_file();
    if may_be_points
        && let Ok(table) = open(path)
        && let Some(points) = steady_points::read(table, options).map_err(|error| error.in_file(&input::name(path)))?
    {
        return Ok(Some(points));
    }
    let of_table = |(name, header): &'_ (String, String)| TableColumn::from_name(name).map(|column| (column, header.clone()));
    let map: Option<Vec<(TableColumn, String)>> = options.map.iter().map(of_table).collect();
    let is_of_table = |map: &Vec<(TableColumn, String)>| map.is_empty() || map.iter().any(|(column, _)| !column.is_axis());
    let map = map.filter(|map| is_of_table(map) && options.mapping.columns.is_empty() && path.is_file());
    let Some(mut map) = map else { return Ok(None) };
    let Ok(table) = open(path) else { return Ok(None) };
    let is_of_other = |header: &str| all.iter().any(|other| open(other).is_ok_and(|other| place(other.heads(), header).is_some()));
    map.retain(|(_, header)| place(table.heads(), header).is_some() || !is_of_other(header));
    let speed = options.units.iter().find(|(channel, _)| channel == Channel::OmegaE.name()).map(|(_, unit)| *unit);
    let stated = Stated { pole_pairs: options.pole_pairs.or(options.mapping.pole_pairs), speed, map };
    let read = read(table, &stated).map_err(|error| error.in_file(&input::name(path)))?;
    match options.units.iter().find(|(channel, _)| channel != Channel::OmegaE.name()) {
        Some((channel, _)) if read.is_some() => {
            Err(FileError::from(Problem::UnitOfTable { channel: channel.clone() }).in_file(&input::name(path)))
        }
        _ => Ok(read),
    }
}

/// The quantity that a column of such a table may hold.
pub(super) fn quantity(index: usize, head: &ColumnHead) -> Option<&'static str> {
    found(index, head).map(|found| found.quantity.name())
}

/// What makes a table a log.
const LOG: [Channel; 5] = [Channel::T, Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq];

/// Reads a table. Of a file of which the user maps columns it has to be one, and all that is mapped has to be used.
fn read(mut table: Table, stated: &Stated) -> Result<Option<ReadCharacteristic>, FileError> {
    let heads = table.heads().to_vec();
    // The dq quantities over time are a log, whatever else is beside them: a duty cycle and a DC voltage, as of a VESC.
    if stated.map.is_empty() && propose(&LOG, &heads, |_, _| Some(0.0)).len() == LOG.len() {
        return Ok(None);
    }
    let columns = found_all(&heads, stated)?;
    // All of such a current would be taken for i_q, or for that of shorted terminals.
    let names = || heads.iter().map(|head| head.name.clone()).collect::<Vec<String>>();
    if stated.map.is_empty()
        && !heads.iter().any(is_of_log)
        && NotALog::by_names(&names()).is_none()
        && let Some(problem) = polar::problem(&heads)
    {
        return Err(problem.into());
    }
    let mapped: Vec<(&'static str, String)> =
        columns.iter().filter_map(|column| Some((column.mapped?.name(), column.header.clone()))).collect();
    let Some(read) = read_columns(&mut table, columns, stated)? else {
        return if mapped.is_empty() { unnamed(&heads) } else { Err(Problem::NoTable.into()) };
    };
    match mapped.into_iter().find(|(_, header)| read.columns.iter().all(|(_, used)| used != header)) {
        Some((column, header)) => Err(Problem::UnusedColumn { column, header, table: read.table.label() }.into()),
        None => Ok(Some(read)),
    }
}

/// Refuses a table of which some names are the symbol of a quantity and nothing else: its unit is open.
fn unnamed(heads: &[ColumnHead]) -> Result<Option<ReadCharacteristic>, FileError> {
    let symbol = |head: &ColumnHead| match head.name.trim() {
        "n" | "N" => Some(Quantity::Speed),
        "U" | "V" | "E" => Some(Quantity::Voltage),
        "I" => Some(Quantity::Current),
        "M" | "T" => Some(Quantity::Torque),
        _ => None,
    };
    let found = |(index, head): (usize, &ColumnHead)| symbol(head).or_else(|| found(index, head).map(|found| found.quantity));
    let Some(quantities) = heads.iter().enumerate().map(found).collect::<Option<Vec<Quantity>>>() else { return Ok(None) };
    let are = |some: &[Quantity]| some.len() == quantities.len() && some.iter().all(|one| quantities.contains(one));
    let is_table = are(&[Quantity::Speed, Quantity::Voltage])
        || are(&[Quantity::Speed, Quantity::Current])
        || are(&[Quantity::Speed, Quantity::Current, Quantity::Torque])
        || are(&[Quantity::Voltage, Quantity::Current]);
    if !is_table || heads.iter().any(|head| head.unit.is_some() || head.is_time || head.instants.is_some()) {
        return Ok(None);
    }
    let symbols: Vec<(&'static str, String)> =
        heads.iter().filter_map(|head| symbol(head).map(|quantity| (quantity.name(), head.name.trim().to_owned()))).collect();
    match symbols.is_empty() {
        true => Ok(None),
        false => {
            let is_direct = !quantities.contains(&Quantity::Speed);
            let direct_voltage = symbols.iter().find(|(quantity, _)| is_direct && *quantity == Quantity::Voltage.name());
            let direct_voltage = direct_voltage.map(|(_, header)| header.clone());
            Err(Problem::UnclearTable(UnclearTable { symbols, direct_voltage, ..UnclearTable::default() }).into())
        }
    }
}

/// Whether a column is one of a log: its time, a quantity of the rotor's frame, an angle.
fn is_of_log(head: &ColumnHead) -> bool {
    let channel =
        |channel: Channel| super::alias::is_alias(channel, head) || Channel::from_name(head.name.trim()).is_ok_and(|own| own == channel);
    let is_instant = words(&head.name).iter().any(|word| INSTANT.contains(&word.as_str()));
    is_instant
        || head.is_time
        || head.instants.is_some()
        || [Channel::T, Channel::Ud, Channel::Uq].into_iter().any(channel)
        || [Channel::Id, Channel::Iq].into_iter().any(|axis| is_axis(axis, head))
}

/// Whether of what a log has there is only its time, with its speed and its DC voltage: thrust stands and dynamometers record a time beside
/// each point of a curve.
fn is_time_alone(heads: &[ColumnHead]) -> bool {
    let of_curve = [Channel::T, Channel::OmegaE, Channel::UDc];
    let is_other = |head: &ColumnHead| {
        // The letter of `Current (A)` is no phase.
        let bare = head.name.split(['[', '(']).next().unwrap_or_default();
        let others = || Channel::all().filter(|channel| !of_curve.contains(channel));
        others().any(|channel| super::alias::is_alias(channel, head) || fit(channel, bare).is_some())
    };
    let is_instant = |head: &ColumnHead| head.is_time || head.instants.is_some() || super::alias::is_alias(Channel::T, head);
    heads.iter().any(is_instant) && !heads.iter().any(is_other)
}

fn read_columns(table: &mut Table, columns: Vec<Found>, stated: &Stated) -> Result<Option<ReadCharacteristic>, FileError> {
    let heads = table.heads().to_vec();
    let pole_pairs = stated.pole_pairs;
    if let Some(test) = steady_test::read(table, &columns, stated)? {
        return Ok(Some(test));
    }
    let has = |quantity: Quantity| columns.iter().any(|column| column.quantity == quantity);
    // What the user says is no matter of the other names.
    if stated.map.is_empty() {
        let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
        if heads.iter().any(is_of_log) && !is_time_alone(&heads) || NotALog::by_names(&names).is_some() {
            return Ok(None);
        }
        if let Some(driven) = driven(&heads, &columns) {
            let is_curve = has(Quantity::Speed) && has(Quantity::Torque) && turns_and_pulls(table, &columns);
            return if is_curve { Err(load_curve(&columns, driven.name.trim())) } else { Ok(None) };
        }
        if heads.iter().any(is_of_log) {
            return Ok(None);
        }
    } else if stated.maps(&[Quantity::Torque])
        && !stated.maps(&[Quantity::Voltage])
        && let Some(voltage) = columns.iter().find(|column| column.quantity == Quantity::Voltage).filter(|_| !has(Quantity::Current))
    {
        return Err(load_curve(&columns, &voltage.header));
    }
    if !has(Quantity::Speed) || has(Quantity::Voltage) == has(Quantity::Current) {
        return Ok(None);
    }
    let wanted: Vec<(usize, &str)> = columns.iter().map(|column| (column.index, column.header.as_str())).collect();
    let values = values_of(table, &wanted)?;
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
    let speed = of_all[Quantity::Speed as usize].iter().find(|(column, _)| lacks_unit(column)).map(|(column, _)| column.header.clone());
    let of_shorted = of_all[Quantity::Speed as usize].first().map(|(column, _)| column.header.clone());
    let unclear = UnclearTable { electrical, speed, of_shorted, ..UnclearTable::default() };
    // Of open terminals no torque is used.
    let asked =
        Quantity::ALL.into_iter().filter(|quantity| *quantity != Quantity::Torque || !of_all[Quantity::Current as usize].is_empty());
    refuse_unclear(asked.map(|quantity| of_all[quantity as usize].iter().map(|(column, _)| column).collect()), unclear)?;
    // Only mapped ones come here.
    let is_of_motor = |column: &Found| matches!(column.quantity, Quantity::Voltage | Quantity::Current);
    if let Some((direct, _)) = columns.iter().find(|(column, _)| is_of_motor(column) && is_direct(&heads[column.index])) {
        return Err(Problem::DirectQuantity { header: direct.header.clone() }.into());
    }
    let mut notes = Vec::new();
    let speed = channel(&columns, Quantity::Speed, pole_pairs, &mut notes);
    let torque = channel(&columns, Quantity::Torque, pole_pairs, &mut notes);
    let voltage = channel(&columns, Quantity::Voltage, pole_pairs, &mut notes);
    let voltages = candidates(&columns, Quantity::Voltage);
    let across = points(&voltages.iter().map(|(column, _)| column).collect::<Vec<_>>());
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
    // Of open terminals a torque is only what the bench loses.
    let is_used = |quantity: &Quantity| *quantity != Quantity::Torque || matches!(table, Characteristic::ShortCircuit(_));
    let used = Quantity::ALL.into_iter().filter(is_used);
    let used = used.flat_map(|quantity| headers(&columns, quantity).into_iter().map(move |name| (quantity.name(), name)));
    let used = used.map(|(quantity, header)| (quantity, header.to_owned())).collect();
    Ok(Some(ReadCharacteristic { columns: used, table, notes, has_electrical_speed: electrical.is_some() }))
}

/// Refuses speed and torque that this column makes those of a load.
fn load_curve(columns: &[Found], header: &str) -> FileError {
    let first = |quantity: Quantity| columns.iter().find(|column| column.quantity == quantity).map(|column| column.header.clone());
    let names = [Quantity::Speed, Quantity::Torque].into_iter().filter_map(first).chain([header.to_owned()]);
    Problem::LoadCurve { names: names.collect() }.into()
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
    parse_stated(text, &Stated { pole_pairs, ..Stated::default() })
}

/// The same, with what the user says.
#[cfg(test)]
pub(super) fn parse_stated(text: &'static str, stated: &Stated) -> Result<Option<ReadCharacteristic>, FileError> {
    read(Table::open(input::Bytes::Stream(Box::new(std::io::Cursor::new(text.as_bytes()))), None)?, stated)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit::characteristics::{Across, DirectCurrent};
    use fluxfit_units::Unit;

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

    /// Of psi_f = 10 mWb at 1000 electrical rad/s: 10 V amplitude of a phase, sqrt 3 times as much between lines, rms 1 / sqrt 2, peak to
    /// peak twice. So much rms has every reading of it.
    #[test]
    fn units_say_what_of_a_wave_was_measured_and_names_between_which_points() {
        let (amplitude, lines) = (10.0, 3.0_f64.sqrt());
        for (voltage, factor, across) in [
            ("U_ll [Vpp]", 2.0 * lines, Some(Across::Lines)),
            ("Vpp line-line", 2.0 * lines, Some(Across::Lines)),
            ("Phase Voltage (Vpk)", 1.0, Some(Across::Phase)),
            ("V_AB (Vrms)", lines * 0.5_f64.sqrt(), Some(Across::Lines)),
            ("Line to Line Voltage (VAC)", lines * 0.5_f64.sqrt(), Some(Across::Lines)),
            ("motor phase-phase voltage (V) rms", lines * 0.5_f64.sqrt(), Some(Across::Lines)),
            ("vll_rms", lines * 0.5_f64.sqrt(), Some(Across::Lines)),
            ("L-N (V rms)", 0.5_f64.sqrt(), Some(Across::Phase)),
            ("Voltage (V AC)", 0.5_f64.sqrt(), None),
            ("Vpp", 2.0, None),
            ("Vll_p", lines, Some(Across::Lines)),
            ("Vll_max", lines, Some(Across::Lines)),
            ("V_LL_amplitude", lines, Some(Across::Lines)),
            ("Uab_max [V]", lines, Some(Across::Lines)),
        ] {
            let rows = [1.0, 2.0, 3.0].map(|k| format!("{},{}\n", 1000.0 * k, k * factor * amplitude)).concat();
            let read = of(format!("speed [rad/s],{voltage}\n{rows}").leak()).unwrap().expect(voltage);
            let Characteristic::OpenCircuit(table) = read.table else { panic!("{voltage}") };
            let of_phase = if across == Some(Across::Lines) { 1.0 / lines } else { 1.0 };
            let rms = table.rows[2].voltage * of_phase;
            assert!((rms - 30.0 * 0.5_f64.sqrt()).abs() < 1e-9, "{voltage}: {rms}");
            assert_eq!(table.across, across, "{voltage}");
        }
    }

    /// 10 A rms are 14.1 A at their peak, and 2 N m are 17.7 pounds of force at an inch.
    #[test]
    fn shorted_terminals_have_the_units_of_their_meters() {
        for (current, of_ten) in [("Isc [A rms]", 10.0), ("Isc [Arms]", 10.0), ("Current [Apk]", 10.0 * 2.0_f64.sqrt()), ("I [mArms]", 1e4)]
        {
            let inch_pounds = 2.0 / (0.453_592_37 * 9.80665 * 0.0254);
            let text = format!("n [rpm],{current},Torque [lbf-in]\n1000,{of_ten},{inch_pounds}\n2000,{of_ten},{inch_pounds}\n");
            let Characteristic::ShortCircuit(table) = of(text.leak()).unwrap().unwrap().table else { panic!("{current}") };
            assert!((table.rows[0].current - 10.0).abs() < 1e-9 && (table.rows[0].torque.unwrap() - 2.0).abs() < 1e-9, "{current}");
        }
    }

    /// 250 r/min/V is no voltage of 250 kV.
    #[test]
    fn a_constant_beside_the_voltages_is_left_alone() {
        for constant in ["Kv", "KV", "kt", "Ke"] {
            let read = of(format!("rpm,U_ll (V),{constant}\n500,2,250\n1000,4,250\n").leak()).unwrap().unwrap();
            let Characteristic::OpenCircuit(table) = read.table else { panic!("{constant}") };
            assert_eq!(table.rows.iter().map(|row| row.voltage).collect::<Vec<_>>(), [2.0, 4.0], "{constant}");
        }
    }

    fn mapped(text: &str, map: &[(&str, &str)], speed: Option<Unit>) -> Result<Option<ReadCharacteristic>, FileError> {
        let map = map.iter().map(|(name, header)| (TableColumn::from_name(name).unwrap(), (*header).to_owned())).collect();
        parse_stated(text.to_owned().leak(), &Stated { speed, map, ..Stated::default() })
    }

    /// What is mapped has to be a table, whatever else the names say; 20 V of a phase are 20 V.
    #[test]
    fn mapped_columns_are_a_table_and_all_of_them_are_used() {
        let phase = mapped("n,x\n100,10\n200,20\n", &[("speed", "n"), ("voltage_phase", "X")], Some(Unit::RadianPerSecondMechanical));
        let Characteristic::OpenCircuit(phase) = phase.unwrap().unwrap().table else { panic!() };
        assert_eq!((phase.rows[1], phase.across), (OpenCircuitRow { speed: 200.0, voltage: 20.0 }, Some(Across::Phase)));
        // A column of a log, of a supply, of a quantity of another test beside.
        let supply = mapped("U_DC [V],I_DC [A],power\n1,10,10\n2,20,40\n", &[("voltage_ll", "U_DC [V]"), ("current", "I_DC [A]")], None);
        assert!(matches!(supply.unwrap().unwrap().table, Characteristic::DirectCurrent(DirectCurrent { across: Across::Lines, .. })));
        let dyno = "rpm,T (Nm),bus i (A),motor phase-phase voltage (V) rms,iq (A),V_dc [V]\n100,1,1,2,3,3\n200,2,1,4,6,6\n";
        let voltage = "motor phase-phase voltage (V) rms";
        let open = mapped(dyno, &[("speed", "rpm"), ("voltage", voltage)], None).unwrap().unwrap();
        assert!(matches!(open.table, Characteristic::OpenCircuit(OpenCircuit { across: Some(Across::Lines), .. })));
        let torques = mapped(dyno, &[("iq", "iq (A)"), ("torque", "T (Nm)")], None).unwrap().unwrap();
        assert!(matches!(torques.table, Characteristic::TorqueOfCurrent(_)));
        // What no table has a place for is refused, not passed over.
        for (map, said) in [
            (&[("voltage", voltage), ("torque", "T (Nm)")][..], "make no table"),
            (
                &[("iq", "iq (A)"), ("torque", "T (Nm)"), ("speed", "rpm")],
                "'rpm' is mapped to speed, which a table of torque against current",
            ),
            (
                &[("speed", "rpm"), ("voltage", voltage), ("torque", "T (Nm)")],
                "'T (Nm)' is mapped to torque, which a table of open-circuit",
            ),
            (&[("speed", "rpm"), ("voltage", "iq (A)")], "states another unit than one of voltage"),
            (&[("speed", "rpm"), ("voltage", "no")], "which the file does not have"),
            (&[("speed", "rpm"), ("voltage_ll", "V_dc [V]")], "is a direct one by its name"),
            (&[("voltage", voltage), ("voltage_ll", "rpm")], "given twice"),
        ] {
            let refusal = mapped(dyno, map, None).unwrap_err().to_string();
            assert!(refusal.contains(said), "{map:?}: {refusal}");
        }
    }

    /// As of a power meter beside a torque sensor: two speeds, at each any current. With the speed mapped too, terminals are shorted.
    #[test]
    fn a_mapped_current_beside_a_mapped_torque_is_that_of_a_load() {
        let text = "Speed [rpm],I_SIGMA [A],Torque [Nm],other [A]\n500,10,1,0\n500,20,2,0\n1000,10,1,0\n1000,30,3,0\n";
        let map = [("current", "I_SIGMA [A]"), ("torque", "Torque [Nm]")];
        let read = mapped(text, &map, None).unwrap().unwrap();
        assert!(matches!(read.table, Characteristic::TorqueOfCurrent(_)), "{:?}", read.table);
        assert!(read.notes.iter().any(|note| note.to_string().contains("map \"Speed [rpm]\" as speed too")), "{:?}", read.notes);
        let shorted = mapped(text, &[&map[..], &[("speed", "Speed [rpm]")]].concat(), None).unwrap().unwrap();
        assert!(matches!(shorted.table, Characteristic::ShortCircuit(_)));
        // Of shorted terminals that several columns could be, the speed is proposed, too.
        let several = of("n_rpm,I1 [A],I4 [A],M1 [Nm],torque shaft [Nm]\n1,2,3,4,5\n2,2,3,4,5\n").unwrap_err();
        let pairs = [("speed", "n_rpm"), ("current", "I1 [A]"), ("torque", "M1 [Nm]")];
        let pairs = pairs.map(|(name, header)| (name, Some(header.to_owned())));
        assert_eq!(several.advice(), [fluxfit_files::Advice::MapColumns(pairs.to_vec())]);
    }

    /// Of three phases the mean is taken: 11 V.
    #[test]
    fn one_of_three_phases_is_mapped_for_all_of_them() {
        let text = "n [rpm],U1 [V],U2 [V],U3 [V]\n100,10,11,12\n200,20,22,24\n";
        let read = mapped(text, &[("voltage_ll", "U1 [V]")], None).unwrap().unwrap();
        let Characteristic::OpenCircuit(table) = read.table else { panic!() };
        assert_eq!((table.rows[0].voltage, table.across), (11.0, Some(Across::Lines)));
    }

    #[test]
    fn what_states_no_unit_is_asked_for_it() {
        for text in ["n,U\n1,2\n2,4\n", "n,I,M\n1,2,3\n2,2,3\n", "V,I\n1,2\n2,4\n", "n,U_ll [V]\n1,2\n2,4\n"] {
            let refusal = of(text).unwrap_err().to_string();
            assert!(refusal.contains("state no units") && refusal.contains("of a table of a test bench"), "{text}: {refusal}");
        }
        for speed in ["speed", "omega", "velocity"] {
            let text = format!("{speed},U_ll [V]\n1,2\n2,4\n");
            let refusal = of(text.clone().leak()).unwrap_err().to_string();
            assert!(refusal.contains(&format!("nothing states the unit of the speed \"{speed}\"")), "{refusal}");
            let map = [("speed", speed), ("voltage", "U_ll [V]")];
            let of_unit = |unit: Unit| {
                let read = mapped(&text, &map, Some(unit)).unwrap().unwrap();
                let Characteristic::OpenCircuit(table) = read.table else { panic!() };
                (table.rows[1].speed, read.has_electrical_speed)
            };
            // 2 r/min of the shaft are 2 pi / 30 rad/s.
            assert!((of_unit(Unit::RpmMechanical).0 - std::f64::consts::TAU / 30.0).abs() < 1e-12);
            assert_eq!(of_unit(Unit::RadianPerSecond), (2.0, true));
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
            // Waves, an instant of each row, a unit that is not known.
            "speed_rpm,voltage_V\n1,2\n2,-2\n",
            "timestep,speed_rpm,voltage_V\n0,1,2\n1,2,4\n",
            "speed [m/s],voltage_V\n1,2\n2,4\n",
            // Behind a rectifier.
            "speed [rpm],U_ll [VDC]\n1,2\n2,4\n",
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
        // Turns of the shaft in a second; of a speed in Hz it is asked.
        let read = of("Drehfrequenz [Hz],U [V]\n50,10\n100,20\n").unwrap().unwrap();
        assert!(!read.has_electrical_speed);
        let asked = of("Motor speed [Hz],U [V]\n50,10\n100,20\n").unwrap_err().to_string();
        assert!(asked.contains("unit") && asked.contains("Motor speed [Hz]"), "{asked}");
        // A torque is that of the shaft.
        let of_torque = of("f [Hz],I [A],T [Nm]\n50,10,1\n100,20,2\n").unwrap_err().to_string();
        assert!(of_torque.contains("number of pole pairs"), "{of_torque}");
    }

    #[test]
    fn the_curve_of_a_driven_motor_is_named() {
        let error = of("Speed (RPM),Torque (Nm),Current (A),Supplied Power (W)\n1,2,3,4\n2,2,3,4\n").unwrap_err().to_string();
        assert!(error.contains("a motor that drives a load"), "{error}");
        // As a thrust stand records it, beside its time; with the currents of phases it may be a log.
        let of_stand =
            "Time (s),Motor Electrical Speed (RPM),Torque (N·m),Voltage (V),Current (A),Electrical Power (W)\n0,1,2,3,4,5\n1,2,3,3,4,5\n";
        let error = of(of_stand).unwrap_err().to_string();
        assert!(error.contains("a motor that drives a load"), "{error}");
        assert_eq!(of("Time (s),Speed (RPM),Torque (Nm),Ia (A),Ib (A),Power (W)\n0,1,2,3,4,5\n1,2,3,3,4,5\n"), Ok(None));
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
