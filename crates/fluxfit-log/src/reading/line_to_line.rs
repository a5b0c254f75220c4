//! Voltages between two phases, by their names: a log needs those of the phases.

use super::resemblance::{fit, words};
use crate::{block::ColumnHead, channel::Channel, header_unit::split_header};
use Channel::{UA, UAlpha, UB, UBeta, UC, Ud, Uq};
use fluxfit_units::Dimension;

/// Words that say between which points a voltage is.
const WORDS: [&str; 7] = ["ll", "l2l", "lineline", "linetoline", "line2line", "verkettet", "phph"];

/// Letters and numbers of the three phases; of each the names of its three voltages.
const PAIRS: [[&str; 3]; 5] = [["ab", "bc", "ca"], ["uv", "vw", "wu"], ["12", "23", "31"], ["rs", "st", "tr"], ["l1l2", "l2l3", "l3l1"]];

/// What stands before the phases.
const VOLTAGES: [&str; 6] = ["u", "v", "ull", "vll", "voltage", "spannung"];

/// Columns of line-to-line voltages.
#[derive(Debug, Default, PartialEq)]
pub(super) struct LineToLine {
    /// Columns that resemble a channel but for a word such as `ll`, with the channel.
    pub(super) scaled: Vec<(Channel, usize)>,
    /// Columns of voltages between two phases.
    pub(super) pairs: Vec<usize>,
}

/// The columns of a table that are such voltages.
pub(super) fn find(heads: &[ColumnHead]) -> LineToLine {
    let voltages = [Ud, Uq, UA, UB, UC, UAlpha, UBeta];
    let channel = |name: &str| voltages.into_iter().find(|channel| fit(*channel, name).is_some());
    let scaled = heads.iter().enumerate().filter(|(_, head)| is_line_to_line(&head.name));
    let scaled = scaled.filter_map(|(index, head)| Some((channel(&head.name)?, index))).collect();
    let stems: Vec<String> = heads.iter().map(|head| words(split_header(&head.name, Dimension::Voltage).0).concat()).collect();
    let of = |quantity: &str, pairs: &[&str; 3]| -> Vec<usize> {
        let is_pair = |stem: &String| stem.strip_prefix(quantity).is_some_and(|pair| pairs.contains(&pair));
        (0..stems.len()).filter(|index| is_pair(&stems[*index])).collect()
    };
    // One alone may be anything: `v12` is a supply.
    let mut all = VOLTAGES.into_iter().flat_map(|quantity| PAIRS.iter().map(move |pairs| of(quantity, pairs)));
    let pairs = all.find(|pairs| pairs.len() > 1).unwrap_or_default();
    LineToLine { scaled, pairs }
}

/// Whether a name says so in a word.
pub(super) fn is_line_to_line(name: &str) -> bool {
    let words = words(name);
    let runs = (1..=3).flat_map(|length| words.windows(length).map(<[String]>::concat));
    runs.into_iter().any(|run| WORDS.contains(&run.as_str()))
}

/// What a voltage is called before the letters of its points.
const BEFORE: [&str; 8] = ["u", "v", "e", "voltage", "spannung", "emf", "bemf", "volt"];

/// Whether some words of a name are a voltage with the letters of its two phases: `U_12`, `Uab`, `V A-B`.
pub(super) fn is_pair(name: &str) -> bool {
    has_points(name, |points| PAIRS.iter().flatten().any(|pair| *pair == points))
}

/// Whether some words of a name are a voltage with the letter of its phase and an n: `U1N`, `V_an`.
pub(super) fn is_to_star(name: &str) -> bool {
    has_points(name, |points| points.strip_suffix('n').is_some_and(|phase| PHASES.contains(&phase)))
}

/// Whether some words of a name are a voltage between a terminal and the two others: `U U-VW`, `V A-BC`.
pub(super) fn is_to_both(name: &str) -> bool {
    let words = words(name.split(['[', '(']).next().unwrap_or(name));
    let is = |run: &[String]| {
        let is_of = |phases: &[&str]| {
            phases.contains(&run[1].as_str()) && {
                let others: Vec<&str> = phases.iter().copied().filter(|phase| *phase != run[1]).collect();
                run[2] == others.concat() || run[2] == others.iter().rev().copied().collect::<String>()
            }
        };
        BEFORE.contains(&run[0].as_str()) && PHASES.chunks(3).any(is_of)
    };
    words.windows(3).any(is)
}

/// The three phases, by each of their names.
const PHASES: [&str; 12] = ["a", "b", "c", "u", "v", "w", "1", "2", "3", "l1", "l2", "l3"];

fn has_points(name: &str, are_points: impl Fn(&str) -> bool) -> bool {
    let words = words(name.split(['[', '(']).next().unwrap_or(name));
    let mut runs = (1..=3).flat_map(|length| words.windows(length).map(<[String]>::concat));
    runs.any(|run| BEFORE.iter().any(|before| run.strip_prefix(before).is_some_and(&are_points)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(names: &[&str]) -> LineToLine {
        find(&names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect::<Vec<_>>())
    }

    #[test]
    fn line_to_line_voltages_are_known_by_name() {
        assert_eq!(of(&["t", "ud_ll", "uq line-to-line [V]", "id"]).scaled, [(Ud, 1), (Uq, 2)]);
        for names in
            [["t", "uab", "ubc", "uca"], ["x", "V_AB [V]", "V_BC [V]", "V_CA [V]"], ["ud", "Uuv", "Uvw", "Uwu"], ["t", "U12", "U23", "U31"]]
        {
            assert_eq!(of(&names).pairs, [1, 2, 3], "{names:?}");
        }
        assert_eq!(of(&["t", "ua", "ub", "v12", "v5", "uvw", "uv", "all_d", "ud"]), LineToLine::default());
    }

    #[test]
    fn a_terminal_against_the_others_is_no_pair() {
        for (name, expected) in [
            ("U U-VW [V]", true),
            ("V A-CB", true),
            ("Spannung 1-23 [V]", true),
            ("U_12", false),
            ("V_uw [V]", false),
            ("U U-V [V]", false),
        ] {
            assert_eq!(is_to_both(name), expected, "{name}");
        }
    }
}
