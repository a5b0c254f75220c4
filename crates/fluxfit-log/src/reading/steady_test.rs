//! Tables of further tests of a test bench: torque against current, voltage against direct current, duty cycle against speed.
//!
//! Each is recognized by what it has and by what it lacks: without the voltages of a dq frame it is no log.

use super::{
    alias,
    bench_columns::{DRIVEN, Found, INSTANT, across, convention, refuse_unclear, values_of},
    duty,
    layout::NotALog,
    resemblance::{is_reference, words},
    rms,
    table::Table,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header, unit_in_row},
    note::Note,
    quantity::Quantity,
};
use fluxfit::{
    characteristics::{Characteristic, DirectCurrent, DirectCurrentRow, DutyCycle, DutyCycleRow, TorqueOfCurrent, TorqueOfCurrentRow},
    frames::Dq,
};
use fluxfit_files::FileError;
use fluxfit_units::wording::quote;

/// A table that is such a test.
pub(super) struct SteadyTest {
    pub(super) table: Characteristic,
    /// The quantities and the columns that they were taken from.
    pub(super) columns: Vec<(&'static str, String)>,
    pub(super) notes: Vec<Note>,
    pub(super) has_electrical_speed: bool,
}

/// Whether a column may be a channel.
fn is(channel: Channel, head: &ColumnHead) -> bool {
    alias::is_alias(channel, head) || Channel::from_name(head.name.trim()).is_ok_and(|own| own == channel)
}

fn has_word(head: &ColumnHead, some: &[&str]) -> bool {
    words(&head.name).iter().any(|word| some.contains(&word.as_str()))
}

/// Names by which VESC's own programs write a duty cycle; their rpm are electrical.
const DUTY_OF_VESC: [&str; 2] = ["dutyCycleNow", "duty_cycle_now"];

/// Reads such a table, if it is one.
pub(super) fn read(table: &mut Table, columns: &[Found], pole_pairs: Option<u32>) -> Result<Option<SteadyTest>, FileError> {
    let heads = table.heads().to_vec();
    let has = |channel: Channel| heads.iter().any(|head| is(channel, head));
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    if NotALog::by_names(&names).is_some()
        || has(Channel::Ud)
        || has(Channel::Uq)
        || Channel::PHASES.into_iter().any(has)
        || duty::duties(&heads).is_some()
    {
        return Ok(None);
    }
    let all = |quantity: Quantity| columns.iter().filter(|column| column.quantity == quantity).collect::<Vec<_>>();
    let [speeds, voltages, currents, torques] = Quantity::ALL.map(all);
    let is_time = heads.iter().any(|head| head.is_time || head.instants.is_some() || is(Channel::T, head));
    let place = |channel: Channel| heads.iter().position(|head| is(channel, head));
    if let (Some(q), Some(torque), false) = (place(Channel::Iq), torques.first(), is_time) {
        refuse_unclear([torques.clone()].into_iter(), None, None)?;
        return torque_of_current(table, place(Channel::Id), q, torque).map(Some);
    }
    let duty = heads.iter().position(|head| has_word(head, &["duty", "dutycycle"]) && !is_reference(&head.name));
    if let (Some(duty), Some(speed), Some(input)) = (duty, speeds.first(), heads.iter().position(is_input)) {
        refuse_unclear([speeds.clone()].into_iter(), None, None)?;
        return duty_cycle(table, duty, input, speed, pole_pairs);
    }
    let is_driven = heads.iter().any(|head| has_word(head, &DRIVEN));
    let is_instant = heads.iter().any(|head| has_word(head, &INSTANT));
    match (voltages.first(), currents.first()) {
        (Some(voltage), Some(current)) if speeds.is_empty() && torques.is_empty() && !is_time && !is_driven && !is_instant => {
            let unnamed = across(&[&voltage.header]).is_none().then(|| voltage.header.clone());
            refuse_unclear([voltages.clone(), currents.clone()].into_iter(), None, unnamed)?;
            direct_current(table, voltage, current)
        }
        _ => Ok(None),
    }
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
fn in_si(head: &ColumnHead, channel: Channel) -> f64 {
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

fn torque_of_current(table: &mut Table, d: Option<usize>, q: usize, torque: &Found) -> Result<SteadyTest, FileError> {
    let heads = table.heads().to_vec();
    let factor = in_si(&heads[q], Channel::Iq);
    // Without a column of i_d it is taken as zero.
    let of_d = d.map_or((q, 0.0), |d| (d, in_si(&heads[d], Channel::Id)));
    let mut rows: Vec<TorqueOfCurrentRow> = rows(table, [of_d, (q, factor), (torque.index, torque.in_si)])?
        .into_iter()
        .map(|[d, q, torque]| TorqueOfCurrentRow { current: Dq { d, q }, torque })
        .collect();
    // A torque sensor may count the other way round.
    let slope: f64 = rows.iter().map(|row| row.torque * row.current.q).sum();
    if slope < 0.0 {
        rows.iter_mut().for_each(|row| row.torque = -row.torque);
    }
    let q_name = heads[q].name.trim().to_owned();
    let how = if rms::is_rms(&heads[q]) { "an rms value of a phase" } else { "the peak value of a phase, as of all dq currents here" };
    let mut notes: Vec<Note> = vec![format!("the current {} is read as {how}", quote(&q_name)).into()];
    let mut used = vec![("current", q_name), ("torque", torque.header.clone())];
    match d {
        Some(d) => used.push(("current", heads[d].name.trim().to_owned())),
        None => notes.push("i_d is taken as zero: no column has it".to_owned().into()),
    }
    let table = Characteristic::TorqueOfCurrent(TorqueOfCurrent { rows });
    Ok(SteadyTest { table, columns: used, notes, has_electrical_speed: false })
}

fn direct_current(table: &mut Table, voltage: &Found, current: &Found) -> Result<Option<SteadyTest>, FileError> {
    let Some(across) = across(&[&voltage.header]) else { return Ok(None) };
    let rows: Vec<DirectCurrentRow> = rows(table, [(voltage.index, voltage.in_si), (current.index, current.in_si)])?
        .into_iter()
        .filter(|[_, current]| *current != 0.0)
        .map(|[voltage, current]| DirectCurrentRow { current, voltage })
        .collect();
    let used = vec![("voltage", voltage.header.clone()), ("current", current.header.clone())];
    let note = "voltage and current are read as those of a direct current, the rotor at rest".to_owned();
    let table = Characteristic::DirectCurrent(DirectCurrent { rows, across });
    Ok(Some(SteadyTest { table, columns: used, notes: vec![note.into()], has_electrical_speed: false }))
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
) -> Result<Option<SteadyTest>, FileError> {
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
    Ok(Some(SteadyTest { table: Characteristic::DutyCycle(DutyCycle { rows }), columns: used, notes, has_electrical_speed }))
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
        assert_eq!(read.across, fluxfit::characteristics::Across::Lines);
        assert!(of("U [V],I [A]\n1,10\n2,20\n", None).unwrap_err().to_string().contains("two terminals in series"));
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
