//! The columns of a table of a test bench: their quantities, units and conventions, by their names.

use super::{
    bench_units::{StatedUnit, stated_unit},
    resemblance::{is_reference, says_reference, words},
    table::Table,
};
use crate::{
    block::{ColumnHead, WantedColumn},
    header_unit::states_electrical,
    problem::Problem,
    quantity::{Quantity, TableColumn},
    unclear_table::UnclearTable,
};
use fluxfit_files::FileError;
use fluxfit_units::Unit;

impl Quantity {
    /// The size in SI of the unit that is assumed where none is stated.
    fn assumed_unit(self) -> f64 {
        if self == Self::Speed { Unit::RpmMechanical.in_si() } else { 1.0 }
    }

    /// Words of names that have no unit beside them, in several languages.
    pub(super) fn words(self) -> &'static [&'static str] {
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
const DRIVEN: [&str; 11] =
    ["power", "efficiency", "leistung", "wirkungsgrad", "puissance", "bus", "battery", "supply", "throttle", "duty", "pwm"];

/// Words of what a motor loses while it is driven, where current and torque are beside it; with open terminals a bench measures it too.
const LOSS: [&str; 5] = ["loss", "losses", "verlust", "verluste", "verlustleistung"];

/// Words of the two sides of a machine that transmits power.
const SIDES: [[&str; 2]; 2] = [["input", "output"], ["eingang", "ausgang"]];

/// The column that makes speed and torque those of a motor that drives a load, by its name.
pub(super) fn driven<'a>(heads: &'a [ColumnHead], columns: &[Found]) -> Option<&'a ColumnHead> {
    let has = |quantity: Quantity| columns.iter().any(|column| column.quantity == quantity);
    let is_loss = |head: &ColumnHead| has(Quantity::Current) && has(Quantity::Torque) && has_word(head, &LOSS);
    let of = |quantity: Quantity, word: &str| {
        columns.iter().find(|column| column.quantity == quantity && has_word(&heads[column.index], &[word])).map(|column| column.index)
    };
    let output = || {
        let sides = || SIDES.into_iter().flat_map(|sides| [Quantity::Speed, Quantity::Torque].map(|quantity| (quantity, sides)));
        sides().find_map(|(quantity, [input, output])| of(quantity, input).and(of(quantity, output)))
    };
    let by_name = heads.iter().find(|head| is_driven(head) || is_direct(head) || is_loss(head));
    by_name.or_else(|| output().map(|index| &heads[index]))
}

/// Words of a direct voltage or current: of a supply, or of a test at rest.
const DIRECT: [&str; 7] = ["dc", "udc", "vdc", "adc", "idc", "mvdc", "madc"];

/// Whether a column is one of a motor that is driven.
pub(super) fn is_driven(head: &ColumnHead) -> bool {
    has_word(head, &DRIVEN)
}

/// Whether a column is that of a direct voltage or current, by its name or unit.
pub(super) fn is_direct(head: &ColumnHead) -> bool {
    has_word(head, &DIRECT)
}

fn has_word(head: &ColumnHead, some: &[&str]) -> bool {
    words(&described(head)).iter().any(|word| some.contains(&word.as_str()))
}

/// Words of a row that is an instant, not a steady test.
pub(super) const INSTANT: [&str; 7] = ["position", "angle", "theta", "timestep", "timestamp", "sample", "encoder"];

/// A column with its quantity and its size in SI units.
pub(super) struct Found {
    pub(super) index: usize,
    pub(super) header: String,
    /// The name, and what a row of units says besides.
    pub(super) described: String,
    pub(super) quantity: Quantity,
    /// Whether the unit is stated: names without are less certain.
    pub(super) has_unit: bool,
    pub(super) in_si: f64,
    pub(super) is_electrical: bool,
    /// What the user says that it is.
    pub(super) mapped: Option<TableColumn>,
}

pub(super) fn found(index: usize, head: &ColumnHead) -> Option<Found> {
    if is_reference(&head.name) { None } else { by_unit_or_name(index, head) }
}

/// The maximum of a wave, `U_max`: beside the voltage or the current itself it would be that of something else, as a limit.
fn maximum(index: usize, head: &ColumnHead) -> Option<Found> {
    let is_maximum = |word: &str| ["max", "maximum"].contains(&word);
    let others: Vec<String> = words(&head.name).into_iter().filter(|word| !is_maximum(word)).collect();
    let of_wave = |found: &Found| matches!(found.quantity, Quantity::Voltage | Quantity::Current);
    by_unit_or_name(index, head).filter(|found| !says_reference(&others) && of_wave(found))
}

fn by_unit_or_name(index: usize, head: &ColumnHead) -> Option<Found> {
    let header = head.name.trim().to_owned();
    let of = |quantity, has_unit, in_si, is_electrical| {
        Some(Found { index, header: header.clone(), described: described(head), quantity, has_unit, in_si, is_electrical, mapped: None })
    };
    match stated_unit(head) {
        StatedUnit::Of(quantity, in_si, is_electrical) => {
            // A speed in Hz may be that of the shaft, or the frequency of the currents.
            let in_hertz = is_electrical && in_si == Unit::HertzElectrical.in_si() && !states_electrical(&header);
            let is_open = quantity == Quantity::Speed && in_hertz && has_word(head, &["speed", "velocity"]);
            return of(quantity, !is_open, in_si, is_electrical);
        }
        // Nothing to guess the size of.
        StatedUnit::Other => return None,
        StatedUnit::None => {}
    }
    let words = words(&header);
    let has_word = |quantity: &Quantity| words.iter().any(|word| quantity.words().contains(&word.as_str()));
    // `V_LL_amplitude`.
    let is_symbol = || words.windows(2).any(|pair| ["u", "v", "e"].contains(&pair[0].as_str()) && ["ll", "ln"].contains(&pair[1].as_str()));
    let quantity = Quantity::ALL.into_iter().find(has_word).or_else(|| is_symbol().then_some(Quantity::Voltage))?;
    of(quantity, false, quantity.assumed_unit(), false)
}

/// The name of a column with the unit that a row of units states.
fn described(head: &ColumnHead) -> String {
    let unit = head.unit.as_deref().map(|unit| format!(" [{}]", unit.trim().trim_matches(['[', ']', '(', ')']))).unwrap_or_default();
    format!("{}{unit}", head.name.trim())
}

/// What is stated of a table besides its file.
#[derive(Default)]
pub(super) struct Stated {
    pub(super) pole_pairs: Option<u32>,
    /// The unit of the speed.
    pub(super) speed: Option<Unit>,
    /// What columns are, by their names.
    pub(super) map: Vec<(TableColumn, String)>,
}

impl Stated {
    /// Whether a column is said to be one of some quantities, and not a current of the rotor's frame.
    pub(super) fn maps(&self, some: &[Quantity]) -> bool {
        self.map.iter().any(|(column, _)| !column.is_axis() && some.contains(&column.quantity()))
    }
}

/// The columns of a table: of a quantity that the user mapped that column alone, in the unit of its name, or in SI and r/min. What the
/// mapped ones leave no place for is left out: beside speed and voltage a current is that of another test.
///
/// # Errors
/// If the table has no such column, its name states a unit of something else, or two are mapped to one quantity.
pub(super) fn found_all(heads: &[ColumnHead], stated: &Stated) -> Result<Vec<Found>, FileError> {
    let mut columns: Vec<Found> = heads.iter().enumerate().filter_map(|(index, head)| found(index, head)).collect();
    if columns.iter().all(|column| !matches!(column.quantity, Quantity::Voltage | Quantity::Current)) {
        columns.extend(heads.iter().enumerate().filter_map(|(index, head)| maximum(index, head)));
    }
    for (column, header) in &stated.map {
        map(&mut columns, heads, *column, header, stated.speed)?;
    }
    let is_axis = stated.map.iter().any(|(column, _)| column.is_axis());
    let mapped = [Quantity::Speed, Quantity::Voltage, Quantity::Current].map(|quantity| stated.maps(&[quantity]));
    let others: &[Quantity] = match mapped {
        _ if is_axis => &[Quantity::Speed, Quantity::Voltage, Quantity::Current],
        [_, true, true] => &[Quantity::Speed, Quantity::Torque],
        [true, true, false] => &[Quantity::Current, Quantity::Torque],
        // With a speed it would be that of shorted terminals.
        [false, false, true] if stated.maps(&[Quantity::Torque]) => &[Quantity::Speed, Quantity::Voltage],
        [_, false, true] => &[Quantity::Voltage],
        _ => &[],
    };
    columns.retain(|column| column.mapped.is_some() || !others.contains(&column.quantity));
    if let Some(unit) = stated.speed {
        for speed in columns.iter_mut().filter(|column| column.quantity == Quantity::Speed) {
            (speed.has_unit, speed.in_si, speed.is_electrical) = (true, unit.in_si(), !unit.is_mechanical());
        }
    }
    columns.sort_by_key(|column| column.index);
    Ok(columns)
}

/// Takes the column with a name for what the user says that it is, and a speed to be in the unit that the user states.
fn map(
    columns: &mut Vec<Found>,
    heads: &[ColumnHead],
    column: TableColumn,
    header: &str,
    unit_of_speed: Option<Unit>,
) -> Result<(), FileError> {
    let quantity = column.quantity();
    let Some(index) = place(heads, header) else {
        let present = heads.iter().map(|head| head.name.clone()).collect();
        return Err(Problem::MappedHeader { channel: column.name(), header: header.to_owned(), present, nearest: None }.into());
    };
    let is_same = |other: TableColumn| other == column || !other.is_axis() && !column.is_axis() && other.quantity() == quantity;
    if let Some(other) = columns.iter().find(|other| other.index != index && other.mapped.is_some_and(is_same)) {
        // Of three phases all are mapped with one.
        let are_phases = other.mapped == Some(column) && column.across().is_some();
        return if are_phases { Ok(()) } else { Err(Problem::Twice { channel: column.name() }.into()) };
    }
    let (in_si, is_electrical, has_unit) = match stated_unit(&heads[index]) {
        StatedUnit::Of(own, in_si, is_electrical) if own == quantity => (in_si, is_electrical, true),
        StatedUnit::None => (quantity.assumed_unit(), false, false),
        _ if quantity == Quantity::Speed && unit_of_speed.is_some() => (quantity.assumed_unit(), false, false),
        _ => {
            let of_name = stated_unit(&ColumnHead { unit: None, ..heads[index].clone() });
            let of_row = heads[index].unit.as_deref().filter(|_| of_name == StatedUnit::None).map(|unit| unit.trim().to_owned());
            return Err(Problem::MappedUnit { column: column.name(), header: header.to_owned(), of_row }.into());
        }
    };
    // What holds of the terminals of one phase holds of all three that are averaged.
    let phases: Vec<usize> = columns.iter().filter(|other| other.quantity == quantity).map(|other| other.index).collect();
    let names: Vec<&str> = phases.iter().map(|index| heads[*index].name.trim()).collect();
    let are_phases = names.first_chunk::<3>().is_some_and(|three| names.len() == 3 && are_phases(*three));
    if column.across().is_some() && are_phases && phases.contains(&index) {
        columns.iter_mut().filter(|other| other.quantity == quantity).for_each(|other| other.mapped = Some(column));
        return Ok(());
    }
    columns.retain(|other| other.index != index && (other.quantity != quantity || other.mapped.is_some_and(TableColumn::is_axis)));
    let (header, described) = (heads[index].name.trim().to_owned(), described(&heads[index]));
    columns.push(Found { index, header, described, quantity, has_unit, in_si, is_electrical, mapped: Some(column) });
    Ok(())
}

/// The column with a name, in whatever case.
pub(super) fn place(heads: &[ColumnHead], header: &str) -> Option<usize> {
    heads.iter().position(|head| head.name.trim().eq_ignore_ascii_case(header.trim()))
}

/// The values of columns, by their places and names.
pub(super) fn values_of(table: &mut Table, columns: &[(usize, &str)]) -> Result<Vec<Vec<f64>>, FileError> {
    let wanted = |(index, header): &(usize, &str)| WantedColumn {
        index: *index,
        header: (*header).to_owned(),
        is_time: false,
        is_optional: true,
        instants: None,
    };
    let wanted: Vec<WantedColumn> = columns.iter().map(wanted).collect();
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
    let mut refused: Option<FileError> = None;
    table.read(&wanted, &mut |block| {
        values.iter_mut().zip(&block.values).for_each(|(all, values)| all.extend(values));
        refused = refused.take().or(block.refused.iter().flatten().next().cloned());
        if values[0].len() > MOST_ROWS { Err(Problem::LongCharacteristic { most: MOST_ROWS }.into()) } else { Ok(()) }
    })?;
    refused.map_or(Ok(values), Err)
}

/// Rows of a table of speeds beyond which it is none.
const MOST_ROWS: usize = 100_000;

/// Refuses a table of which some things have to be stated, all of them at once: `unclear`, and the column of a quantity that several could
/// be.
///
/// # Errors
/// If there is one of these.
pub(super) fn refuse_unclear<'a>(candidates: impl Iterator<Item = Vec<&'a Found>>, unclear: UnclearTable) -> Result<(), FileError> {
    let several = candidates.filter(|of_one| of_one.len() > 1).filter_map(|of_one| {
        let headers: Vec<String> = of_one.iter().map(|column| column.header.clone()).collect();
        let names = of_one.iter().map(|column| column.header.as_str()).collect::<Vec<_>>();
        let are_phases = names.first_chunk::<3>().is_some_and(|three| names.len() == 3 && are_phases(*three));
        (!are_phases).then(|| (of_one[0].quantity.name(), headers))
    });
    let unclear = UnclearTable { several: several.collect(), ..unclear };
    if unclear.is_clear() { Ok(()) } else { Err(Problem::UnclearTable(unclear).into()) }
}

/// Letters and digits of three phases.
const PHASES: [[char; 3]; 4] = [['1', '2', '3'], ['a', 'b', 'c'], ['u', 'v', 'w'], ['r', 's', 't']];

/// Whether three names differ by their phases alone: `Iu`, `Iv`, `Iw`; or `U_12`, `U_23`, `U_31`.
pub(super) fn are_phases(names: [&str; 3]) -> bool {
    differing(names).is_some()
}

/// The places in which three names differ, if all of them hold phases.
pub(super) fn differing(names: [&str; 3]) -> Option<Vec<usize>> {
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

    #[test]
    fn names_of_three_phases_differ_by_these_alone() {
        for names in [["Iu", "Iv", "Iw"], ["U_ab [V]", "U_bc [V]", "U_ca [V]"], ["Phase A current", "Phase B current", "Phase C current"]] {
            assert!(are_phases(names), "{names:?}");
        }
        for names in [["I1", "I2", "I4"], ["I1", "I2", "I12"], ["Iu", "Iu", "Iw"], ["M1", "M2", "n3"], ["I", "I", "I"]] {
            assert!(!are_phases(names), "{names:?}");
        }
    }
}
