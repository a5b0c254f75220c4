//! Columns that are shares of the DC voltage, by their names: duty cycles of the phases, and a modulation in the dq frame.

use super::{
    alias::field,
    resemblance::{is_reference, words},
};
use crate::block::ColumnHead;

/// Words for the share of a period during which a leg of the inverter is switched to the upper rail.
const DUTY: [&str; 4] = ["duty", "dutycycle", "tastgrad", "pwmduty"];

/// The duty cycles of the phases a, b, c, if exactly one column has the name of each: `duty_a`, `Duty U [%]`, `dutyCycle1`.
pub(super) fn duties(heads: &[ColumnHead]) -> Option<[usize; 3]> {
    let phase = |head: &ColumnHead| {
        let name = words(field(head.name.split(['[', '(', '%']).next().unwrap_or(&head.name))).concat();
        let phases = [["a", "u", "1"], ["b", "v", "2"], ["c", "w", "3"]];
        phases.iter().position(|letters| {
            let is = |duty: &&str| letters.iter().any(|letter| name == format!("{duty}{letter}") || name == format!("{letter}{duty}"));
            !is_reference(&head.name) && DUTY.iter().any(is)
        })
    };
    let of: Vec<Option<usize>> = heads.iter().map(phase).collect();
    let only = |phase: usize| {
        let mut columns = (0..of.len()).filter(|index| of[*index] == Some(phase));
        columns.next().filter(|_| columns.next().is_none())
    };
    Some([only(0)?, only(1)?, only(2)?])
}

/// Words for the modulation of the inverter, a share of the DC voltage: ODrive's `mod_d`.
const MODULATION: [&str; 5] = ["mod", "modulation", "modulationsgrad", "duty", "dutycycle"];

/// Whether a name says that a column is a modulation, and no voltage.
pub(super) fn is_modulation(name: &str) -> bool {
    words(field(name)).iter().any(|word| MODULATION.contains(&word.as_str()))
}

/// Whether a column is in percent.
pub(super) fn is_percent(head: &ColumnHead) -> bool {
    head.name.contains('%')
        || head.unit.as_deref().is_some_and(|unit| unit.contains('%'))
        || words(&head.name).iter().any(|word| word == "pct")
}

/// Words of a modulation that ODrive writes.
const OF_ODRIVE: [&str; 2] = ["mod", "modulation"];

/// What a modulation of 1 is of the DC voltage at ODrive.
pub(super) const SHARE_OF_ODRIVE: f64 = 2.0 / 3.0;

/// The modulations along d and q, `axis0.motor.foc.mod_d` and `.mod_q`, if there is one pair of them.
pub(super) fn modulations(heads: &[ColumnHead]) -> Option<[usize; 2]> {
    let parts: Vec<Vec<String>> = heads.iter().map(|head| words(&head.name)).collect();
    let axis = |index: usize, axis: &str| {
        let (last, stem) = parts[index].split_last()?;
        let is_named = stem.last().is_some_and(|word| OF_ODRIVE.contains(&word.as_str()));
        (last == axis && is_named && !is_reference(&heads[index].name)).then_some(stem)
    };
    let of_q = |stem: &[String]| (0..heads.len()).find(|index| axis(*index, "q") == Some(stem));
    let mut pairs = (0..heads.len()).filter_map(|d| Some([d, of_q(axis(d, "d")?)?]));
    pairs.next().filter(|_| pairs.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn duty_cycles_of_three_phases_are_found_together_or_not_at_all() {
        let of = |names: &[&str]| {
            duties(&names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect::<Vec<_>>())
        };
        assert_eq!(of(&["t", "duty_a", "duty_b", "duty_c"]), Some([1, 2, 3]));
        assert_eq!(of(&["Duty W [%]", "Duty U [%]", "Duty V [%]"]), Some([1, 2, 0]));
        assert_eq!(of(&["foc.dutyCycle1", "foc.dutyCycle2", "foc.dutyCycle3", "duty"]), Some([0, 1, 2]));
        assert_eq!(of(&["duty_a", "duty_b"]), None);
        assert_eq!(of(&["duty_a", "duty_a", "duty_b", "duty_c"]), None);
        assert_eq!(of(&["duty_cycle", "duty_d", "duty_q"]), None);
    }

    #[test]
    fn a_modulation_has_both_axes_once() {
        let of = |names: &[&str]| {
            modulations(&names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect::<Vec<_>>())
        };
        assert_eq!(of(&["t", "axis0.motor.foc.mod_q", "axis0.motor.foc.mod_d"]), Some([2, 1]));
        assert_eq!(of(&["Mod d", "Mod q"]), Some([0, 1]));
        for names in [
            &["mod_d", "iq"][..],
            &["a.mod_d", "b.mod_q"],
            &["mod_d_ref", "mod_q_ref"],
            &["axis0.mod_d", "axis0.mod_q", "axis1.mod_d", "axis1.mod_q"],
        ] {
            assert_eq!(of(names), None, "{names:?}");
        }
    }
}
