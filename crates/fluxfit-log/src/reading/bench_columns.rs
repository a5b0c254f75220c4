//! The columns of a table of a test bench: their quantities, units and conventions, by their names.

use super::{
    resemblance::{is_reference, words},
    table::Table,
};
use crate::{
    block::{ColumnHead, WantedColumn},
    header_unit::{HeaderUnit, split_header, states_electrical, unit_in_row},
    note::Note,
    problem::Problem,
    quantity::Quantity,
};
use fluxfit::characteristics::Across;
use fluxfit_files::FileError;
use fluxfit_units::{Dimension, Unit, wording::quote};

impl Quantity {
    /// The size in SI of the unit that is assumed where none is stated.
    fn assumed_unit(self) -> f64 {
        if self == Self::Speed { Unit::RpmMechanical.in_si() } else { 1.0 }
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
pub(super) const DRIVEN: [&str; 12] =
    ["power", "efficiency", "leistung", "wirkungsgrad", "puissance", "dc", "bus", "battery", "supply", "throttle", "duty", "pwm"];

/// Words of a row that is an instant, not a steady test.
pub(super) const INSTANT: [&str; 7] = ["position", "angle", "theta", "timestep", "timestamp", "sample", "encoder"];

/// A column with its quantity and its size in SI units.
pub(super) struct Found {
    pub(super) index: usize,
    pub(super) header: String,
    pub(super) quantity: Quantity,
    /// Whether the unit is stated: names without are less certain.
    pub(super) has_unit: bool,
    pub(super) in_si: f64,
    pub(super) is_electrical: bool,
}

pub(super) fn found(index: usize, head: &ColumnHead) -> Option<Found> {
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
                || matches!(unit, Unit::RadianPerSecond | Unit::DegreePerSecond) && states_electrical(&header);
            return of(quantity, true, unit.in_si(), is_electrical);
        }
    }
    if [Dimension::Time, Dimension::Temperature, Dimension::Angle].into_iter().any(|dimension| unit(dimension).is_some()) {
        return None;
    }
    // A unit that is not known: of another quantity, or nothing to guess the size of.
    let is_other = |text: &str| !text.trim().trim_matches(['[', ']', '(', ')', '-', '#']).is_empty();
    if matches!(split_header(&header, Dimension::Speed).1, HeaderUnit::Unknown(_)) || head.unit.as_deref().is_some_and(is_other) {
        return None;
    }
    let words = words(&header);
    let quantity = Quantity::ALL.into_iter().find(|quantity| words.iter().any(|word| quantity.words().contains(&word.as_str())))?;
    of(quantity, false, quantity.assumed_unit(), false)
}

/// The columns of a table. Of a quantity that the user mapped that column alone, in the unit of its header, or in SI and r/min.
///
/// # Errors
/// If the table has no such column.
pub(super) fn found_all(heads: &[ColumnHead], map: &[(Quantity, String)]) -> Result<Vec<Found>, FileError> {
    let mut columns: Vec<Found> = heads.iter().enumerate().filter_map(|(index, head)| found(index, head)).collect();
    for (quantity, header) in map {
        let is_named = |head: &ColumnHead| head.name.trim().eq_ignore_ascii_case(header.trim());
        let Some(index) = heads.iter().position(is_named) else {
            let present = heads.iter().map(|head| head.name.clone()).collect();
            return Err(Problem::MappedHeader { channel: quantity.name(), header: header.clone(), present, nearest: None }.into());
        };
        let own = columns.iter().position(|column| column.index == index).map(|place| columns.swap_remove(place));
        columns.retain(|column| column.quantity != *quantity);
        columns.push(own.filter(|own| own.quantity == *quantity).unwrap_or_else(|| Found {
            index,
            header: heads[index].name.trim().to_owned(),
            quantity: *quantity,
            has_unit: true,
            in_si: quantity.assumed_unit(),
            is_electrical: false,
        }));
    }
    columns.sort_by_key(|column| column.index);
    Ok(columns)
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
        "mnm" | "nmm" => Some(1e-3),
        "ncm" => Some(1e-2),
        _ => None,
    }
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

/// What a name says of the convention, as a factor; and what is assumed where it says nothing.
pub(super) fn convention(column: &Found, quantity: Quantity, pole_pairs: Option<u32>, notes: &mut Vec<Note>) -> f64 {
    let name = quote(&column.header);
    match quantity {
        Quantity::Voltage | Quantity::Current => {
            let (factor, how, is_stated) = to_rms(&column.header);
            let doubt = if is_stated { "" } else { ", because its name does not say so; if it is an amplitude, add 'peak' to the name" };
            notes.push(format!("the {} {name} is read as {how}{doubt}", quantity.name()).into());
            factor
        }
        Quantity::Speed if column.is_electrical => {
            let doubt = if states_electrical(&column.header) { "" } else { "; if it is that of the shaft, add 'mech' to its name" };
            notes.push(format!("the speed {name} is read as the electrical one{doubt}").into());
            1.0 / f64::from(pole_pairs.unwrap_or(1))
        }
        Quantity::Speed => {
            notes.push(format!("the speed {name} is read as that of the shaft").into());
            1.0
        }
        Quantity::Torque => 1.0,
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
pub(super) fn across(headers: &[&str]) -> Option<Across> {
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

/// Refuses a table of which some things have to be stated, all of them at once: the column of a quantity that several could be, the pole
/// pairs where a torque of the shaft stands beside an electrical speed, and between which points a direct voltage was measured.
///
/// # Errors
/// If there is one of these.
pub(super) fn refuse_unclear<'a>(
    candidates: impl Iterator<Item = Vec<&'a Found>>,
    electrical: Option<String>,
    direct_voltage: Option<String>,
) -> Result<(), FileError> {
    let several = candidates.filter(|of_one| of_one.len() > 1).filter_map(|of_one| {
        let headers: Vec<String> = of_one.iter().map(|column| column.header.clone()).collect();
        let names = of_one.iter().map(|column| column.header.as_str()).collect::<Vec<_>>();
        let are_phases = names.first_chunk::<3>().is_some_and(|three| names.len() == 3 && are_phases(*three));
        (!are_phases).then(|| (of_one[0].quantity.name(), headers))
    });
    let several: Vec<(&'static str, Vec<String>)> = several.collect();
    match several.is_empty() && electrical.is_none() && direct_voltage.is_none() {
        true => Ok(()),
        false => Err(Problem::UnclearTable { several, electrical, direct_voltage }.into()),
    }
}

/// Letters and digits of three phases.
const PHASES: [[char; 3]; 4] = [['1', '2', '3'], ['a', 'b', 'c'], ['u', 'v', 'w'], ['r', 's', 't']];

/// Whether three names differ by their phases alone: `Iu`, `Iv`, `Iw`; or `U_12`, `U_23`, `U_31`.
pub(super) fn are_phases(names: [&str; 3]) -> bool {
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
    fn names_of_three_phases_differ_by_these_alone() {
        for names in [["Iu", "Iv", "Iw"], ["U_ab [V]", "U_bc [V]", "U_ca [V]"], ["Phase A current", "Phase B current", "Phase C current"]] {
            assert!(are_phases(names), "{names:?}");
        }
        for names in [["I1", "I2", "I4"], ["I1", "I2", "I12"], ["Iu", "Iu", "Iw"], ["M1", "M2", "n3"], ["I", "I", "I"]] {
            assert!(!are_phases(names), "{names:?}");
        }
    }
}
