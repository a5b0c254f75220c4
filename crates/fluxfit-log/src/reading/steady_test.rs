//! Tables of further tests of a test bench: torque against current, voltage against direct current, duty cycle against speed.
//!
//! Each is recognized by what it has and by what it lacks: without the voltages of a dq frame it is no log.

use super::{
    axis_currents::{self, OfD, OfQ, is},
    bench_columns::{Found, INSTANT, Stated, found, is_direct, is_driven, refuse_unclear, values_of},
    bench_convention::{convention, lacks_unit, points, states_wave},
    bench_units::{StatedUnit, stated_unit},
    duty,
    layout::NotALog,
    line_to_line,
    resemblance::{is_reference, words},
    rms,
    table::Table,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header, unit_in_row},
    note::Note,
    problem::Problem,
    quantity::{Quantity, TableColumn},
    unclear_table::UnclearTable,
};
use fluxfit::{
    characteristics::{
        Across, Characteristic, DirectCurrent, DirectCurrentRow, DutyCycle, DutyCycleRow, TorqueOfCurrent, TorqueOfCurrentRow,
    },
    frames::Dq,
};
use fluxfit_files::FileError;
use fluxfit_units::{Dimension, wording::quote};
use std::f64::consts::SQRT_2;

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

/// Whether two columns or more are currents, or voltages, of phases or of the stator's frame: one alone may be that of a test at rest.
fn has_several_phases(heads: &[ColumnHead]) -> bool {
    let of = |dimension: Dimension| {
        let channels = || Channel::PHASES.into_iter().filter(move |channel| channel.dimension() == dimension);
        heads.iter().filter(|head| channels().any(|channel| is(channel, head))).count()
    };
    of(Dimension::Current) > 1 || of(Dimension::Voltage) > 1
}

fn has_word(head: &ColumnHead, some: &[&str]) -> bool {
    words(&head.name).iter().any(|word| some.contains(&word.as_str()))
}

/// Names by which VESC's own programs write a duty cycle; their rpm are electrical.
const DUTY_OF_VESC: [&str; 2] = ["dutyCycleNow", "duty_cycle_now"];

/// Reads such a table, if it is one.
pub(super) fn read(table: &mut Table, columns: &[Found], stated: &Stated) -> Result<Option<ReadCharacteristic>, FileError> {
    let is_mapped = !stated.map.is_empty();
    let heads = table.heads().to_vec();
    let has = |channel: Channel| heads.iter().any(|head| is(channel, head));
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let is_of_log = || {
        NotALog::by_names(&names).is_some()
            || has(Channel::Ud)
            || has(Channel::Uq)
            || has_several_phases(&heads)
            || duty::duties(&heads).is_some()
    };
    if !is_mapped && is_of_log() {
        return Ok(None);
    }
    let all = |quantity: Quantity| columns.iter().filter(|column| column.quantity == quantity).collect::<Vec<_>>();
    let [speeds, voltages, currents, torques] = Quantity::ALL.map(all);
    let is_time = !is_mapped && heads.iter().any(|head| head.is_time || head.instants.is_some() || is(Channel::T, head));
    // Columns of another test are mapped: it is not this one.
    let is_other = |some: &[Quantity]| stated.maps(some);
    let is_of_q = stated.map.iter().any(|(column, _)| *column == TableColumn::AxisQ)
        || !is_other(&[Quantity::Speed, Quantity::Voltage, Quantity::Current]);
    if let (Some(torque), true) = (torques.first(), is_of_q && !is_time) {
        let of_q = axis_currents::of_q(&heads, columns);
        let axis_currents = if let OfQ::MayBe(some) = &of_q { Some(axis_currents::to_map(&heads, some, torque)) } else { None };
        if of_q != OfQ::Absent {
            refuse_unclear([torques.clone()].into_iter(), UnclearTable { axis_currents, ..UnclearTable::default() })?;
        }
        if let OfQ::Is(q) = of_q {
            refuse_computed(torque)?;
            let d = axis_currents::of_d(&heads, columns, Some(q));
            return torque_of_current(table, &d, axis(q, &heads, columns), columns, torque).map(Some);
        }
    }
    let duty = heads.iter().position(|head| has_word(head, &["duty", "dutycycle"]) && !is_reference(&head.name));
    let is_duty = !is_other(&[Quantity::Voltage, Quantity::Current, Quantity::Torque]);
    if let (Some(duty), Some(speed), Some(input), true) = (duty, speeds.first(), heads.iter().position(is_input), is_duty) {
        let unit = lacks_unit(speed).then(|| speed.header.clone());
        refuse_unclear([speeds.clone()].into_iter(), UnclearTable { speed: unit, ..UnclearTable::default() })?;
        return duty_cycle(table, duty, input, speed, stated.pole_pairs);
    }
    if !speeds.is_empty() || is_time || !is_mapped && heads.iter().any(|head| is_driven(head) || has_word(head, &INSTANT)) {
        return Ok(None);
    }
    match (voltages.first(), currents.first(), torques.first()) {
        (Some(voltage), Some(current), None) => {
            let direct_voltage = points(&[voltage]).is_none().then(|| voltage.header.clone());
            refuse_unclear([voltages.clone(), currents.clone()].into_iter(), UnclearTable { direct_voltage, ..UnclearTable::default() })?;
            direct_current(table, voltage, current)
        }
        // The current of a phase, where the rotor's frame is not known: all of it is i_q. A direct current is that of a supply.
        (None, Some(current), Some(torque)) if is_mapped || !heads.iter().any(is_direct) => {
            let is_open = current.mapped.is_none() && !states_wave(&current.described);
            let current_and_torque = is_open.then(|| [current.header.clone(), torque.header.clone()]);
            let unclear = UnclearTable { current_and_torque, ..UnclearTable::default() };
            refuse_unclear([currents.clone(), torques.clone()].into_iter(), unclear)?;
            refuse_computed(torque)?;
            let mut notes = Vec::new();
            let factor = current.in_si * convention(current, Quantity::Current, None, &mut notes) * SQRT_2;
            let d = axis_currents::of_d(&heads, columns, None);
            let read =
                torque_of_current(table, &d, Axis { index: current.index, factor, is_rms: true, tells_unit: true }, columns, torque)?;
            let notes = notes.into_iter().chain(read.notes.into_iter().skip(1)).chain(unused_speed(&heads, stated)).collect();
            Ok(Some(ReadCharacteristic { notes, ..read }))
        }
        _ => Ok(None),
    }
}

/// Words of a torque that a drive computes from its currents.
const COMPUTED: [&str; 10] =
    ["est", "estimate", "estimated", "estimation", "calc", "calculated", "computed", "berechnet", "berechnetes", "geschätzt"];

/// Refuses a torque that is computed by its name, unless the user maps it.
fn refuse_computed(torque: &Found) -> Result<(), FileError> {
    let is_computed = words(&torque.header).iter().any(|word| COMPUTED.contains(&word.as_str()));
    let problem = || Problem::ComputedTorque { header: torque.header.clone() };
    if torque.mapped.is_none() && is_computed { Err(problem().into()) } else { Ok(()) }
}

/// A note on the speed beside a current and a torque that are mapped: with it, they are those of shorted terminals.
fn unused_speed(heads: &[ColumnHead], stated: &Stated) -> Option<Note> {
    let is_speed = |(index, head)| found(index, head).filter(|found| found.quantity == Quantity::Speed);
    let speed = heads.iter().enumerate().find_map(is_speed).filter(|_| !stated.map.is_empty())?;
    let sentence = "current and torque are read as those of a driven or held motor, whatever the speed";
    Some(format!("{sentence}; if its terminals were shorted, map {} as speed too", quote(&speed.header)).into())
}

/// The values of some columns, those that are rows of the test: finite in all of them.
fn rows<const N: usize>(table: &mut Table, columns: [(usize, f64); N]) -> Result<Vec<[f64; N]>, FileError> {
    let heads = table.heads().to_vec();
    let wanted = columns.map(|(index, _)| (index, heads[index].name.as_str()));
    let values = values_of(table, &wanted)?;
    let count = values.first().map_or(0, Vec::len);
    let row = |row: usize| std::array::from_fn(|k| columns[k].1 * values[k][row]);
    Ok((0..count).map(row).filter(|row: &[f64; N]| row.iter().all(|value| value.is_finite())).collect())
}

/// The factor to SI of a column of this channel.
pub(super) fn in_si(head: &ColumnHead, channel: Channel) -> f64 {
    let dimension = channel.dimension();
    if let Some(unit) = rms::unit(channel).filter(|_| rms::is_rms(head)) {
        return unit.in_si();
    }
    let of_row = || head.unit.as_deref().map(|unit| unit_in_row(unit, &head.name, dimension));
    match (split_header(&head.name, dimension).1, of_row()) {
        (HeaderUnit::Known(unit), _) | (_, Some(HeaderUnit::Known(unit))) => unit.in_si(),
        _ => 1.0,
    }
}

/// A current of the rotor's frame: its column, and the factor to a peak value in A.
struct Axis {
    index: usize,
    factor: f64,
    is_rms: bool,
    /// Whether it is said already which unit is assumed, or that is stated.
    tells_unit: bool,
}

/// The current of an axis by its column: a peak value of the phases, unless its name says that it is a root mean square.
fn axis(index: usize, heads: &[ColumnHead], columns: &[Found]) -> Axis {
    let in_si = columns.iter().find(|column| column.index == index && column.quantity == Quantity::Current).map_or(1.0, |own| own.in_si);
    let is_rms = rms::is_rms(&heads[index]);
    let tells_unit = matches!(stated_unit(&heads[index]), StatedUnit::Of(..));
    Axis { index, factor: if is_rms { in_si * SQRT_2 } else { in_si }, is_rms, tells_unit }
}

fn torque_of_current(table: &mut Table, d: &OfD, q: Axis, columns: &[Found], torque: &Found) -> Result<ReadCharacteristic, FileError> {
    let heads = table.heads().to_vec();
    let of_d = d.index().map(|index| axis(index, &heads, columns)).map_or((q.index, 0.0), |d| (d.index, d.factor));
    let mut rows: Vec<TorqueOfCurrentRow> = rows(table, [of_d, (q.index, q.factor), (torque.index, torque.in_si)])?
        .into_iter()
        .map(|[d, q, torque]| TorqueOfCurrentRow { current: Dq { d, q }, torque })
        .collect();
    // A torque sensor may count the other way round.
    let slope: f64 = rows.iter().map(|row| row.torque * row.current.q).sum();
    if slope < 0.0 {
        rows.iter_mut().for_each(|row| row.torque = -row.torque);
    }
    let name = |index: usize| heads[index].name.trim().to_owned();
    let how = if q.is_rms { "an rms value of a phase" } else { "the peak value of a phase, as of all dq currents here" };
    let mut notes: Vec<Note> = vec![format!("the current {} is read as {how}", quote(&name(q.index))).into()];
    notes.extend(d.note(&heads));
    let assumed = |header: &str, unit: &str| {
        let example = format!("{header} [m{}]", unit.replace(' ', ""));
        format!(
            "nothing states the unit of {}, so {unit} is assumed; if it is another, write it into the name, as in {}",
            quote(header),
            quote(&example)
        )
    };
    notes.extend((!q.tells_unit).then(|| assumed(&name(q.index), "A").into()));
    notes.extend((!torque.has_unit).then(|| assumed(&torque.header, "N m").into()));
    let of_d = d.index().map(name);
    let used = [Some(("current", name(q.index))), Some(("torque", torque.header.clone())), of_d.map(|name| ("current", name))];
    let table = Characteristic::TorqueOfCurrent(TorqueOfCurrent { rows });
    let columns = used.into_iter().flatten().collect();
    Ok(ReadCharacteristic { table, columns, notes, has_electrical_speed: false })
}

fn direct_current(table: &mut Table, voltage: &Found, current: &Found) -> Result<Option<ReadCharacteristic>, FileError> {
    /// Ohms of one winding and the two others side by side, over those of one.
    const TO_BOTH: f64 = 1.5;
    let to_both = voltage.mapped.is_none() && line_to_line::is_to_both(&voltage.header);
    let of_points = if to_both { Some(Across::Phase) } else { points(&[voltage]) };
    let Some(across) = of_points else { return Ok(None) };
    let in_si = if to_both { voltage.in_si / TO_BOTH } else { voltage.in_si };
    let rows: Vec<DirectCurrentRow> = rows(table, [(voltage.index, in_si), (current.index, current.in_si)])?
        .into_iter()
        .filter(|[_, current]| *current != 0.0)
        .map(|[voltage, current]| DirectCurrentRow { current, voltage })
        .collect();
    let used = vec![("voltage", voltage.header.clone()), ("current", current.header.clone())];
    let between = match across {
        _ if to_both => "one terminal and the two others, so that R_s is two thirds of their ratio",
        Across::Lines => "two terminals, so that R_s is half of their ratio",
        Across::Phase => "a terminal and the star point, so that R_s is their ratio",
    };
    let note = format!("voltage and current are read as those of a direct current, the rotor at rest, between {between}");
    let table = Characteristic::DirectCurrent(DirectCurrent { rows, across });
    Ok(Some(ReadCharacteristic { table, columns: used, notes: vec![note.into()], has_electrical_speed: false }))
}

/// Words of the DC voltage beside a duty cycle.
const INPUT: [&str; 9] = ["input", "inp", "inpvoltage", "dc", "bus", "battery", "supply", "vin", "vbat"];

/// Whether a column is the DC voltage beside a duty cycle.
fn is_input(head: &ColumnHead) -> bool {
    let words = words(&head.name);
    let is_voltage = words.iter().any(|word| ["voltage", "volt", "spannung", "vin", "vbat"].contains(&word.as_str()));
    is(Channel::UDc, head) || is_voltage && words.iter().any(|word| INPUT.contains(&word.as_str()))
}

fn duty_cycle(
    table: &mut Table,
    duty: usize,
    input: usize,
    speed: &Found,
    pole_pairs: Option<u32>,
) -> Result<Option<ReadCharacteristic>, FileError> {
    let heads = table.heads().to_vec();
    // The current of the supply is not that of the motor.
    let is_of_motor =
        |head: &ColumnHead| has_word(head, &["current", "strom"]) && has_word(head, &["motor", "phase"]) && !has_word(head, &INPUT);
    let current = heads.iter().position(is_of_motor);
    let mut notes = Vec::new();
    let is_vesc = DUTY_OF_VESC.contains(&heads[duty].name.trim());
    let per_turn = speed.in_si
        * if is_vesc {
            notes.push(format!("the speed {} is read as the electrical one, as VESC counts it", quote(&speed.header)).into());
            1.0 / f64::from(pole_pairs.unwrap_or(1))
        } else {
            convention(speed, Quantity::Speed, pole_pairs, &mut notes)
        };
    let has_electrical_speed = pole_pairs.is_none() && (is_vesc || speed.is_electrical);
    let percent = |head: &ColumnHead| head.name.contains('%') || head.unit.as_deref().is_some_and(|unit| unit.contains('%'));
    let share = if percent(&heads[duty]) { 0.01 } else { 1.0 };
    let of_current = current.map_or((duty, 0.0), |index| (index, in_si(&heads[index], Channel::Iq)));
    let columns = [(duty, share), (input, in_si(&heads[input], Channel::UDc)), (speed.index, per_turn), of_current];
    let rows: Vec<DutyCycleRow> = rows(table, columns)?
        .into_iter()
        .filter(|[duty, input, speed, _]| *duty != 0.0 && *input > 0.0 && *speed != 0.0)
        .map(|[duty, input_voltage, speed, value]| DutyCycleRow {
            speed: speed.abs(),
            duty: duty.abs(),
            input_voltage,
            current: current.map(|_| value),
        })
        .collect();
    if rows.iter().any(|row| row.duty > 1.0) {
        return Ok(None);
    }
    let duty_name = quote(heads[duty].name.trim());
    notes.push(format!("a duty {duty_name} of 1 is read as a phase amplitude of u_dc / sqrt 3, as VESC counts it").into());
    let named = [("duty", Some(duty)), ("input voltage", Some(input)), ("speed", Some(speed.index)), ("current", current)];
    let used = named.into_iter().filter_map(|(what, index)| Some((what, heads[index?].name.trim().to_owned())));
    let used = used.collect();
    Ok(Some(ReadCharacteristic { table: Characteristic::DutyCycle(DutyCycle { rows }), columns: used, notes, has_electrical_speed }))
}

#[cfg(test)]
mod tests {
    use super::super::characteristic::parse_characteristic as of;
    use super::*;

    fn table(text: &'static str) -> Characteristic {
        of(text, Some(2)).unwrap().unwrap().table
    }

    #[test]
    fn torque_of_a_current_grows_with_it_and_has_its_unit() {
        let Characteristic::TorqueOfCurrent(read) = table("Iq [A],Id (mA),torque [mNm]\n1,-500,-20\n2,-500,-40\n") else { panic!() };
        assert_eq!(read.rows[1], TorqueOfCurrentRow { current: Dq { d: -0.5, q: 2.0 }, torque: 0.04 });
    }

    #[test]
    fn a_direct_current_needs_to_know_its_terminals() {
        let Characteristic::DirectCurrent(read) = table("U_ll [V],I [A]\n1,10\n0,0\n-2,-20\n") else { panic!() };
        assert_eq!(read.rows, [DirectCurrentRow { current: 10.0, voltage: 1.0 }, DirectCurrentRow { current: -20.0, voltage: -2.0 }]);
        assert_eq!(read.across, Across::Lines);
        assert!(of("U [V],I [A]\n1,10\n2,20\n", None).unwrap_err().to_string().contains("two terminals in series"));
    }

    /// 24 mV for each A.
    #[test]
    fn a_direct_current_is_read_under_the_names_that_a_refusal_asks_for() {
        for (names, across) in [
            ("V_phase [V],I [A]", Across::Phase),
            ("U_phase [V],I_DC [A]", Across::Phase),
            ("V phase (V),I (A)", Across::Phase),
            ("phase voltage (V),current (A)", Across::Phase),
            ("U_DC_phase [V],I_DC [A]", Across::Phase),
            ("U_DC_ll [V],I_DC [A]", Across::Lines),
            ("Vdc_ll [VDC],Idc [ADC]", Across::Lines),
            ("Uab [V],Ia [A]", Across::Lines),
        ] {
            let text = format!("{names}\n0.24,10\n0.48,20\n0.96,40\n");
            let Characteristic::DirectCurrent(read) = table(text.leak()) else { panic!("{names}") };
            assert_eq!((read.rows[2], read.across), (DirectCurrentRow { current: 40.0, voltage: 0.96 }, across), "{names}");
        }
        let Characteristic::DirectCurrent(read) = table("U U-VW [V],I [A]\n0.24,10\n0.48,20\n0.96,40\n") else { panic!() };
        assert!((read.rows[2].voltage - 0.64).abs() < 1e-12 && read.across == Across::Phase);
        for names in ["U_DC [V],I_DC [A]", "Vdc (V),Idc (A)", "voltage,current"] {
            let refusal = of(format!("{names}\n0.24,10\n0.48,20\n").leak(), None).unwrap_err().to_string();
            assert!(refusal.contains("put 'll'"), "{names}: {refusal}");
        }
        assert_eq!(of("bus voltage (V),bus current (A)\n1,10\n2,20\n", None), Ok(None));
    }

    /// 3 A rms are an amplitude of 3 sqrt 2 A.
    #[test]
    fn a_torque_may_stand_beside_rms_values() {
        let peak = 3.0 * 2.0_f64.sqrt();
        for (name, size) in [
            ("Iq [Arms]", peak),
            ("Iq rms (A)", peak),
            ("Iq_rms [mA]", 1e-3 * peak),
            ("Phase current rms [A]", peak),
            ("Current [Arms]", peak),
            ("phase current [Apk]", 3.0),
            ("Iq [A]", 3.0),
        ] {
            let Characteristic::TorqueOfCurrent(read) = table(format!("{name},torque [Nm]\n3,1\n6,2\n").leak()) else { panic!("{name}") };
            assert!((read.rows[0].current.q - size).abs() < 1e-12 && read.rows[0].current.d == 0.0, "{name}: {:?}", read.rows[0]);
        }
        let refusal = of("Current (A),Torque (Nm)\n3,1\n6,2\n", None).unwrap_err().to_string();
        assert!(refusal.contains("map it as iq") && refusal.contains("as current"), "{refusal}");
    }

    /// A torque in N mm would make a flux a thousand times too large: what is assumed is said.
    #[test]
    fn units_of_torque_and_current_that_nothing_states_are_said() {
        for (names, assumed) in [
            ("Iq [A],torque [Nm]", &[][..]),
            ("Iq [A],torque", &["\"torque\", so N m"][..]),
            ("iq,torque [mNm]", &["\"iq\", so A"]),
            ("iq,torque", &["\"iq\", so A", "\"torque\", so N m"]),
        ] {
            let read = of(format!("{names}\n3,1\n6,2\n").leak(), None).unwrap().unwrap();
            let notes: Vec<String> = read.notes.iter().map(ToString::to_string).filter(|note| note.contains("nothing states")).collect();
            assert!(
                notes.len() == assumed.len() && notes.iter().zip(assumed).all(|(note, said)| note.contains(said)),
                "{names}: {notes:?}"
            );
        }
    }

    #[test]
    fn a_torque_that_is_computed_by_its_name_is_refused() {
        for header in ["torque_est [Nm]", "Motor Torque Estimate [Nm]", "Drehmoment berechnet [Nm]"] {
            for current in ["iq [A]", "Current [Arms]"] {
                let refusal = of(format!("{current},{header}\n3,1\n6,2.1\n9,3.1\n").leak(), None).unwrap_err().to_string();
                assert!(refusal.contains("computed by the drive"), "{header}: {refusal}");
            }
        }
    }

    #[test]
    fn duty_cycles_take_the_current_of_the_motor_and_not_of_the_supply() {
        let text = "t,inpVoltage,avgMotorCurrent,avgInputCurrent,rpm,dutyCycleNow\n0,12,3,1,6000,0.5\n1,12,3,1,0,0\n";
        // Without pole pairs the speed stays electrical.
        let electrical = of(text, None).unwrap().unwrap();
        assert!(electrical.has_electrical_speed);
        let Characteristic::DutyCycle(read) = electrical.table else { panic!() };
        assert!((read.rows[0].speed - 628.318_531).abs() < 1e-5);
        let Characteristic::DutyCycle(read) = table(text) else { panic!() };
        let [row] = read.rows[..] else { panic!() };
        // Of VESC, 6000 electrical r/min are 3000 of the shaft with two pole pairs.
        assert!((row.speed - 314.159_265).abs() < 1e-5);
        assert_eq!((row.duty, row.input_voltage, row.current), (0.5, 12.0, Some(3.0)));
        let Characteristic::DutyCycle(read) = table("speed_rpm,duty [%],V_dc\n100,-50,12\n") else { panic!() };
        assert_eq!((read.rows[0].duty, read.rows[0].current), (0.5, None));
    }

    #[test]
    fn logs_with_voltages_are_none() {
        for text in
            ["t,iq,torque_Nm\n0,1,2\n1,1,2\n", "ud,uq,iq,torque_Nm\n0,1,2,3\n1,1,2,3\n", "speed_rpm,duty,vdc,ud\n1,0.2,3,4\n2,0.2,3,4\n"]
        {
            assert!(matches!(of(text, None), Ok(None)), "{text}");
        }
    }
}
