//! A dynamometer's table of operating points: dq voltages, dq currents and speed, a row each, and no time.

use super::{
    alias,
    axis_currents::is,
    bench_columns::{Found, INSTANT, Stated, found_all, place, refuse_unclear, values_of},
    bench_convention::{convention, lacks_unit},
    channels::Channels,
    chosen::ChosenColumn,
    layout::Layout,
    mapping::MappedColumn,
    names::automatic,
    options::LogOptions,
    plausibility,
    proposal::stated_unit,
    resemblance::words,
    rms,
    steady_test::ReadCharacteristic,
    table::Table,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    csv::counts,
    header_unit::{HeaderUnit, split_header},
    quantity::{Quantity, TableColumn},
    unclear_table::UnclearTable,
};
use fluxfit::{
    characteristics::{Characteristic, SteadyPoint, SteadyPoints},
    frames::Dq,
};
use fluxfit_files::FileError;
use fluxfit_units::{Unit, wording::quote};

/// More rows are those of a log whose time is missing: a map of a motor has a few hundred points.
const MOST_POINTS: usize = 500;

/// Of the currents' variance, the part that their changes from row to row have at least: of a sweep of 24 currents at each speed it is as
/// much. In the rows of a drive, currents that are held hardly change.
const LEAST_CHANGE: f64 = 0.02;

/// The same of more points than [`FEW_POINTS`], or beside a column that counts the rows: these may be samples of a drive.
const LEAST_CHANGE_OF_MANY: f64 = 0.2;
const FEW_POINTS: usize = 100;

/// The channels of such a table, in the order of their columns.
const CHANNELS: [Channel; 5] = [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq, Channel::OmegaE];

/// The channel that a user calls so: the speed by its name in tables too.
fn channel(name: &str) -> Option<Channel> {
    let of_table = (name == Quantity::Speed.name()).then_some(Channel::OmegaE);
    of_table.or_else(|| Channel::from_name(name).ok().filter(|channel| CHANNELS.contains(channel)))
}

/// Whether a user calls the torque so.
fn is_torque(name: &str) -> bool {
    name == Quantity::Torque.name()
}

/// The entry of a channel in the mapping file.
fn entry(of: Channel, options: &LogOptions) -> Option<&MappedColumn> {
    options.mapping.columns.iter().find(|column| column.channel == of)
}

/// The column that the user names for a channel.
fn said_header(of: Channel, options: &LogOptions) -> Option<&String> {
    let by_option = options.map.iter().find(|(name, _)| channel(name) == Some(of)).map(|(_, header)| header);
    by_option.or_else(|| entry(of, options)?.header.as_ref())
}

/// The unit that the user states of a channel.
fn said_unit(of: Channel, options: &LogOptions) -> Option<Unit> {
    let by_option = options.units.iter().find(|(name, _)| channel(name) == Some(of)).map(|(_, unit)| *unit);
    by_option.or_else(|| entry(of, options)?.unit)
}

/// Reads such a table, if it is one. A file of which the user maps other channels is none.
///
/// # Errors
/// If several columns could be the speed, or its unit is open; if the values are none in the units that are assumed.
pub(super) fn read(mut table: Table, options: &LogOptions) -> Result<Option<ReadCharacteristic>, FileError> {
    let heads = table.heads().to_vec();
    let find = |channel: Channel| if is_of_log(&heads, options) { None } else { find(channel, &heads, options) };
    let [Some(ud), Some(uq), Some(id), Some(iq)] = [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq].map(find) else {
        return Ok(None);
    };
    let pole_pairs = options.pole_pairs.or(options.mapping.pole_pairs);
    let torque = options.map.iter().filter(|(name, _)| is_torque(name)).map(|(_, header)| (Quantity::Torque, header));
    let said = said_header(Channel::OmegaE, options).map(|header| (Quantity::Speed, header));
    let map = said.into_iter().chain(torque).map(|(quantity, header)| (TableColumn::Of(quantity), header.clone())).collect();
    let columns = found_all(&heads, &Stated { pole_pairs, speed: said_unit(Channel::OmegaE, options), map })?;
    let of = |quantity: Quantity| columns.iter().filter(|column| column.quantity == quantity).collect::<Vec<&Found>>();
    let (speeds, torques) = (of(Quantity::Speed), of(Quantity::Torque));
    let Some(speed) = speeds.first() else { return Ok(None) };
    let torque = torques.first().filter(|_| torques.len() == 1);
    // The channel's own name is that of electrical rad/s.
    let is_own = automatic(Channel::OmegaE, &heads).ok().flatten() == Some(speed.index) && !speed.has_unit;
    let mut notes = vec![
        "a row is an operating point, because no column is a time; if the rows are samples of a drive, write the time between them into a \
         mapping file, as in sample_period = \"0.1 ms\""
            .to_owned()
            .into(),
        "voltages and currents are read as peak values of a phase, unless a unit says rms".to_owned().into(),
    ];
    let per_turn = match is_own {
        true => 1.0 / f64::from(pole_pairs.unwrap_or(1)),
        false => speed.in_si * convention(speed, Quantity::Speed, pole_pairs, &mut notes),
    };
    let used: Vec<usize> = [ud.index, uq.index, id.index, iq.index, speed.index].into_iter().chain(torque.map(|own| own.index)).collect();
    let wanted: Vec<(usize, &str)> = used.iter().map(|index| (*index, heads[*index].name.as_str())).collect();
    let first_cells = table.first_cells();
    // What cannot be read, or is too long, is told by whoever reads it as a log.
    let Ok(mut values) = values_of(&mut table, &wanted) else { return Ok(None) };
    let chosen = [ud, uq, id, iq];
    for (column, values) in chosen.iter().zip(&mut values) {
        column.to_si(values);
    }
    let per_turn = per_turn * entry(Channel::OmegaE, options).map_or(1.0, |entry| entry.factor);
    let factors = [per_turn].into_iter().chain(torque.map(|torque| torque.in_si));
    values[chosen.len()..].iter_mut().zip(factors).for_each(|(values, factor)| values.iter_mut().for_each(|value| *value *= factor));
    let rows = rows(&values);
    let is_counted = (0..heads.len()).any(|k| !used.contains(&k) && first_cells.get(k).is_some_and(|cells| cells.counts));
    // A current that counts the rows is the number of the row.
    let is_row = values[2..4].iter().any(|values| counts(values) && values.iter().all(|value| value.fract() == 0.0));
    if is_row || !are_points(&rows, is_counted) {
        return Ok(None);
    }
    if torques.len() > 1 {
        let names = torques.iter().map(|torque| quote(&torque.header)).collect::<Vec<_>>().join(" and ");
        notes.push(format!("{names} could each be the torque: none is compared until one of them is mapped").into());
    }
    let unit = (!is_own && is_open(speed, &heads, options)).then(|| speed.header.clone());
    refuse_unclear([speeds.clone()].into_iter(), UnclearTable { speed: unit, ..UnclearTable::default() })?;
    refuse_unlikely(&chosen, &values, is_own.then(|| ChosenColumn::of(Channel::OmegaE, speed.index, &heads[speed.index])))?;
    let count = values[0].len();
    if rows.len() < count {
        notes.push(format!("{} of {count} rows are not whole and are left out", count - rows.len()).into());
    }
    let names = ["voltage", "voltage", "current", "current", "speed", "torque"];
    let columns = names.into_iter().zip(wanted).map(|(quantity, (_, header))| (quantity, header.trim().to_owned())).collect();
    let has_electrical_speed = pole_pairs.is_none() && (is_own || speed.is_electrical);
    let table = Characteristic::SteadyPoints(SteadyPoints { rows });
    Ok(Some(ReadCharacteristic { columns, table, notes, has_electrical_speed }))
}

/// Whether the columns, or what the user says of them, are those of a log or of another table.
fn is_of_log(heads: &[ColumnHead], options: &LogOptions) -> bool {
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let is_instant = |head: &ColumnHead| {
        let of_row = words(&head.name).iter().any(|word| INSTANT.contains(&word.as_str()));
        head.is_time || head.instants.is_some() || is(Channel::T, head) || of_row
    };
    let is_other = |name: &str| channel(name).is_none() && !is_torque(name);
    let is_entry_of_log = |column: &MappedColumn| column.is_times_u_dc || !CHANNELS.contains(&column.channel);
    // The layout of a tool is that of a log.
    options.map.iter().any(|(name, _)| is_other(name))
        || options.mapping.columns.iter().any(is_entry_of_log)
        || heads.iter().any(is_instant)
        || Layout::recognize(&names).is_some()
}

/// The column of a channel with its unit: the one that the user maps, or that has one of its names, also as a root mean square.
fn find(of: Channel, heads: &[ColumnHead], options: &LogOptions) -> Option<ChosenColumn> {
    let by_name = || automatic(of, heads).ok().flatten().or_else(|| alias::find(of, heads));
    let by_name = || by_name().or_else(|| heads.iter().position(|head| is(of, head)));
    // Whoever reads it as a log says that a column is not there.
    let index = said_header(of, options).map_or_else(by_name, |header| place(heads, header))?;
    let head = &heads[index];
    let of_rms = rms::unit(of).filter(|_| rms::is_rms(head));
    let unit = said_unit(of, options).or(of_rms).or_else(|| stated_unit(of, head));
    // Whoever reads it as a log says what is wrong with another unit.
    let is_readable = unit.is_some() || has_no_unit(of, head);
    let scale = entry(of, options).map_or(1.0, |entry| entry.factor);
    let is_unit_written = unit.is_some() || scale != 1.0;
    let column = ChosenColumn { is_unit_written, unit: unit.unwrap_or(of.unit()), scale, ..ChosenColumn::of(of, index, head) };
    is_readable.then_some(column)
}

/// Whether nothing states the unit of a speed, or whether it is that of the shaft: in a log rad/s is the electrical one.
fn is_open(speed: &Found, heads: &[ColumnHead], options: &LogOptions) -> bool {
    let unit = stated_unit(Channel::OmegaE, &heads[speed.index]);
    let is_of_either = !speed.is_electrical && matches!(unit, Some(Unit::RadianPerSecond | Unit::DegreePerSecond));
    lacks_unit(speed) || is_of_either && said_unit(Channel::OmegaE, options).is_none()
}

/// The rows that are whole, in SI; the torque is the last column, if there is one.
fn rows(values: &[Vec<f64>]) -> Vec<SteadyPoint> {
    let row = |row: usize| SteadyPoint {
        voltage: Dq { d: values[0][row], q: values[1][row] },
        current: Dq { d: values[2][row], q: values[3][row] },
        speed: values[4][row],
        torque: values.get(5).map(|torque| torque[row]).filter(|torque| torque.is_finite()),
    };
    let is_whole = |row: &usize| values[..CHANNELS.len()].iter().all(|values| values[*row].is_finite());
    (0..values[0].len()).filter(is_whole).map(row).collect()
}

/// Whether neither the name nor a row of units has a unit.
fn has_no_unit(channel: Channel, head: &ColumnHead) -> bool {
    let is_blank = |text: &str| text.trim().trim_matches(['[', ']', '(', ')', '-', '#']).is_empty();
    !matches!(split_header(&head.name, channel.dimension()).1, HeaderUnit::Unknown(_)) && head.unit.as_deref().is_none_or(is_blank)
}

/// Refuses what a log is refused for by the size of its numbers: digits, mA and mV, values per unit.
fn refuse_unlikely(chosen: &[ChosenColumn], values: &[Vec<f64>], speed: Option<ChosenColumn>) -> Result<(), FileError> {
    let mut channels = Channels::default();
    CHANNELS.into_iter().zip(values).for_each(|(channel, values)| channels.set(channel, values.clone()));
    let chosen: Vec<ChosenColumn> = chosen.iter().cloned().chain(speed).collect();
    plausibility::refuse_digits(&chosen, &channels)?;
    plausibility::refuse_per_unit(&chosen, &channels)?;
    plausibility::refuse_high_voltage(&chosen, &channels)?;
    plausibility::refuse_thousandths(&chosen, &channels)
}

/// Whether the currents change from row to row as those of different points do; beside a column that counts the rows, or not.
fn are_points(rows: &[SteadyPoint], is_counted: bool) -> bool {
    let are_many = rows.len() > FEW_POINTS;
    if rows.len() > MOST_POINTS || is_counted && are_many {
        return false;
    }
    let least = if are_many || is_counted { LEAST_CHANGE_OF_MANY } else { LEAST_CHANGE };
    let count = rows.len() as f64;
    let mean = |of: fn(&SteadyPoint) -> f64| rows.iter().map(of).sum::<f64>() / count;
    let (d, q) = (mean(|row| row.current.d), mean(|row| row.current.q));
    let variance: f64 = rows.iter().map(|row| (row.current.d - d).powi(2) + (row.current.q - q).powi(2)).sum();
    let change = |pair: &[SteadyPoint]| (pair[1].current.d - pair[0].current.d).powi(2) + (pair[1].current.q - pair[0].current.q).powi(2);
    variance > 0.0 && rows.windows(2).map(change).sum::<f64>() > least * variance
}

#[cfg(test)]
mod tests {
    use super::{super::mapping::Mapping, *};
    use fluxfit_files::input;

    fn of(text: &str, pole_pairs: Option<u32>, map: &[(&str, &str)]) -> Result<Option<ReadCharacteristic>, FileError> {
        let bytes = input::Bytes::Stream(Box::new(std::io::Cursor::new(text.as_bytes().to_vec())));
        let map = map.iter().map(|(name, header)| ((*name).to_owned(), (*header).to_owned())).collect();
        read(Table::open(bytes, None)?, &LogOptions { pole_pairs, map, ..LogOptions::default() })
    }

    /// Points of 500 to 4000 r/min and some currents.
    fn points(header: &str, row: impl Fn(f64, f64, f64) -> String) -> String {
        let rows = [500.0, 1000.0, 2000.0, 4000.0].into_iter().flat_map(|speed| {
            let row = &row;
            [(0.0, 10.0), (-5.0, 10.0), (0.0, 20.0), (-10.0, 20.0)].map(|(id, iq)| row(speed, id, iq)).into_iter()
        });
        format!("{header}\n{}", rows.collect::<String>())
    }

    #[test]
    fn a_row_without_a_time_is_an_operating_point() {
        let row = |speed: f64, id: f64, iq: f64| format!("{speed};{iq};{};{iq};{};{}\n", 1000.0 * id, -0.1 * iq, 0.01 * speed);
        let text = points("n [rpm];T [Nm];Id [mA];Iq [A];Ud [V];Uq [V]", row);
        let read = of(&text, Some(4), &[]).unwrap().unwrap();
        let Characteristic::SteadyPoints(table) = read.table else { panic!() };
        let SteadyPoint { speed, voltage, current, torque } = table.rows[3];
        assert!((speed - 500.0 * std::f64::consts::TAU / 60.0).abs() < 1e-9);
        assert_eq!((table.rows.len(), voltage, current, torque), (16, Dq { d: -2.0, q: 5.0 }, Dq { d: -10.0, q: 20.0 }, Some(20.0)));
        // Electrical rad/s by its name: of the shaft a quarter.
        let text = points("omega_e,id,iq,ud,uq", |speed, id, iq| format!("{speed},{id},{iq},1,2\n"));
        let Characteristic::SteadyPoints(table) = of(&text, Some(4), &[]).unwrap().unwrap().table else { panic!() };
        assert_eq!(table.rows[0].speed, 125.0);
        assert!(of(&text, None, &[]).unwrap().unwrap().has_electrical_speed);
    }

    #[test]
    fn its_columns_may_be_mapped() {
        let text = points("n [rpm],d current [A],q current [A],ud,uq", |speed, id, iq| format!("{speed},{id},{iq},1,2\n"));
        let map = [("id", "d current [A]"), ("iq", "q current [A]")];
        let Characteristic::SteadyPoints(table) = of(&text, None, &map).unwrap().unwrap().table else { panic!() };
        assert_eq!(table.rows[1].current, Dq { d: -5.0, q: 10.0 });
        // A speed and a torque whose names say nothing.
        let text = points("n,id,iq,ud,uq,load", |speed, id, iq| format!("{speed},{id},{iq},1,2,{iq}\n"));
        let map = [("speed", "n"), ("torque", "load")].map(|(name, header)| (name.to_owned(), header.to_owned())).to_vec();
        let bytes = input::Bytes::Stream(Box::new(std::io::Cursor::new(text.into_bytes())));
        let options = LogOptions { map, units: vec![("omega_e".into(), Unit::RpmMechanical)], ..LogOptions::default() };
        let Characteristic::SteadyPoints(table) = read(Table::open(bytes, None).unwrap(), &options).unwrap().unwrap().table else {
            panic!()
        };
        assert!((table.rows[0].speed - 500.0 * std::f64::consts::TAU / 60.0).abs() < 1e-9 && table.rows[0].torque == Some(10.0));
    }

    /// Voltages in digits of 5 mV by a mapping file; a column that is not there is for the log to name.
    #[test]
    fn a_mapping_file_may_have_its_scales() {
        let text = points("n [rpm],id [A],iq [A],ud,uq", |n, id, iq| format!("{n},{id},{iq},{},{}\n", 200.0 * id, 20.0 * n));
        let read = |columns: &str| {
            let mapping = Mapping::parse("m.toml", format!("[columns]\n{columns}").as_bytes()).unwrap();
            let bytes = input::Bytes::Stream(Box::new(std::io::Cursor::new(text.clone().into_bytes())));
            read(Table::open(bytes, None).unwrap(), &LogOptions { mapping, ..LogOptions::default() })
        };
        assert!(read("").unwrap_err().to_string().contains("whole numbers"));
        let scaled = read("ud = { column = \"ud\", scale = 0.005 }\nuq = { column = \"uq\", scale = 0.005 }\n").unwrap().unwrap();
        let Characteristic::SteadyPoints(table) = scaled.table else { panic!() };
        assert_eq!(table.rows[1].voltage, Dq { d: -5.0, q: 50.0 });
        let reversed =
            read("ud = { scale = 0.005 }\nuq = { scale = 0.005 }\nomega_e = { column = \"n [rpm]\", unit = \"rpm-mech\", sign = -1 }\n");
        let Characteristic::SteadyPoints(table) = reversed.unwrap().unwrap().table else { panic!() };
        assert!((table.rows[1].speed + 500.0 * std::f64::consts::TAU / 60.0).abs() < 1e-9);
        assert!(matches!(read("ud = \"vd\"\n"), Ok(None)));
    }

    /// mA under the channels' names, digits, values per unit; and a speed whose unit nobody says.
    #[test]
    fn what_is_open_is_asked() {
        let table = |volts: f64, amperes: f64, speed: &str| {
            let row =
                |n: f64, id: f64, iq: f64| format!("{n},{},{},{:.3},{:.3}\n", amperes * id, amperes * iq, volts * 0.011 * n, volts * iq);
            points(&format!("{speed},id,iq,ud,uq"), row)
        };
        for (text, expected) in [
            (table(1.0, 1000.0, "n [rpm]"), "whole numbers"),
            (table(1.0, 1000.37, "n [rpm]"), "mA"),
            (table(5000.37, 1.37, "n [rpm]"), "kV"),
            (table(1.0, 1.0, "speed"), "unit"),
            (table(1.0, 1.0, "omega [rad/s]"), "unit"),
        ] {
            let refused = of(&text, None, &[]).unwrap_err().to_string();
            assert!(refused.contains(expected), "{refused}");
        }
        assert!(of(&table(1.0, 1.0, "n [rpm]"), None, &[]).unwrap().is_some());
        let options =
            LogOptions { units: vec![("id".into(), Unit::Milliampere), ("iq".into(), Unit::Milliampere)], ..LogOptions::default() };
        let text = table(1.0, 1000.0, "n [rpm]");
        let bytes = input::Bytes::Stream(Box::new(std::io::Cursor::new(text.into_bytes())));
        let Characteristic::SteadyPoints(table) = read(Table::open(bytes, None).unwrap(), &options).unwrap().unwrap().table else {
            panic!()
        };
        assert_eq!(table.rows[1].current, Dq { d: -5.0, q: 10.0 });
    }

    /// Rows with a time or a sample number, or in per cent; and a log whose currents are held for many rows.
    #[test]
    fn what_may_be_a_log_is_none() {
        let row = |speed: f64, id: f64, iq: f64| format!("{speed},{id},{iq},1,2,3\n");
        for header in [
            "rpm_mech,id,iq,ud,uq,t",
            "rpm_mech,id,iq,ud,uq,sample",
            "rpm_mech,id,iq,ud [%],uq [%],x",
            "rpm_mech,id,iq,ud,uq,x\nrpm,%,%,%,%,-",
        ] {
            assert!(matches!(of(&points(header, row), None, &[]), Ok(None)), "{header}");
        }
        // Samples that are counted; and a number of the row that is called ID.
        for header in ["tick,rpm_mech,id,iq,ud,uq", "rpm_mech,ID,q_current,ud,uq,d_current"] {
            let row = |k: i32| format!("{k},{k},{},{},1,2\n", f64::from(k % 7), f64::from(k % 5));
            let text = format!("{header}\n{}", (0..120).map(row).collect::<String>());
            assert!(matches!(of(&text, None, &[]), Ok(None)), "{header}");
        }
        let held: String = (0..900).map(|k| format!("1000,0,{},1,2\n", f64::from(1 + k / 300) + 0.01 * f64::from(k % 2))).collect();
        assert!(matches!(of(&format!("speed_rpm,id,iq,ud,uq\n{held}"), None, &[]), Ok(None)));
    }
}
