//! Speeds and angles in counts of an encoder, `[cnt/sec]`, and in `[1/s]`, which may be three things: what the file does not state is
//! asked.

use crate::{channel::Channel, problem::Problem};
use fluxfit_units::Dimension;

/// Counts of an encoder, as drives write them.
const COUNTS: [&str; 16] = [
    "c",
    "cnt",
    "cnts",
    "count",
    "counts",
    "inc",
    "incr",
    "increment",
    "increments",
    "ink",
    "inkr",
    "inkremente",
    "tick",
    "ticks",
    "pulse",
    "pulses",
];

/// Endings of what happens in a second, and in a minute.
const PER_SECOND: [&str; 4] = ["/s", "/sec", "/second", "ps"];
const PER_MINUTE: [&str; 2] = ["/min", "/minute"];

/// Spellings of 1/s.
const INVERSE: [&str; 7] = ["1/s", "1/sec", "s^-1", "s-1", "/s", "s⁻¹", "1/second"];

/// What is asked of a speed or an angle with this text in the place of a unit; nothing if it is another one.
pub(super) fn problem(channel: Channel, text: &str, header: &str) -> Option<Problem> {
    let unit = text.trim().trim_matches(['[', ']', '(', ')']).trim().to_lowercase();
    let header = header.to_owned();
    let text = text.to_owned();
    let is_count = |unit: &str| COUNTS.contains(&unit.trim());
    let ends = |ends: &[&str]| ends.iter().any(|end| unit.strip_suffix(end).is_some_and(is_count));
    match channel.dimension() {
        Dimension::Speed if INVERSE.contains(&unit.as_str()) => Some(Problem::InverseSeconds { channel: channel.name(), text, header }),
        Dimension::Speed if ends(&PER_SECOND) => Some(Problem::Counts { channel: channel.name(), text, header, of_turn: "6.28319" }),
        Dimension::Speed if ends(&PER_MINUTE) => Some(Problem::Counts { channel: channel.name(), text, header, of_turn: "0.10472" }),
        Dimension::Angle if is_count(&unit) => Some(Problem::Counts { channel: channel.name(), text, header, of_turn: "6.28319" }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Channel::{Iq, OmegaE, ThetaE};

    #[test]
    fn counts_are_asked_for_those_of_a_turn() {
        let of_turn = |channel: Channel, text: &str| match problem(channel, text, "x") {
            Some(Problem::Counts { of_turn, .. }) => Some(of_turn),
            _ => None,
        };
        for text in ["cnt/sec", "Counts/s", "inc/s", "[ticks/s]", "cps"] {
            assert_eq!(of_turn(OmegaE, text), Some("6.28319"), "{text}");
        }
        assert_eq!((of_turn(OmegaE, "Inkr/min"), of_turn(ThetaE, "cnt")), (Some("0.10472"), Some("6.28319")));
        for (channel, text) in [(OmegaE, "cnt"), (OmegaE, "pu/s"), (ThetaE, "cnt/s"), (Iq, "cnt")] {
            assert_eq!(problem(channel, text, "x"), None, "{text}");
        }
        assert!(matches!(problem(OmegaE, "1/s", "x"), Some(Problem::InverseSeconds { .. })));
    }
}
