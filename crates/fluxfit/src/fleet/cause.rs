//! Why answers are missing: equal reasons of different motors counted together. Two sentences are equal if they differ only in the names of
//! motor and file and in numbers.

use super::row::FleetRow;
use crate::{Verdict, motor::Parameter};
use std::collections::BTreeMap;

/// How many motors of a cause are named.
const NAMED: usize = 5;

/// What is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// The whole answer.
    Answer,
    /// The value of a parameter, or a better verdict.
    Parameter(Parameter, Verdict),
}

/// Why something is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// What is missing.
    pub missing: Missing,
    /// The sentence of the first motor.
    pub example: String,
    /// How many motors have it.
    pub motors: usize,
    /// The first of them.
    pub names: Vec<String>,
}

/// Counts causes.
#[derive(Default)]
pub(super) struct Causes {
    found: BTreeMap<(usize, usize, String), Cause>,
}

impl Causes {
    /// Takes a motor: the errors of all its rows, and the reasons of the row that tells most.
    pub(super) fn add(&mut self, rows: &[FleetRow], best: &FleetRow) {
        let errors = rows.iter().filter_map(|row| Some((Missing::Answer, row.error.as_deref()?, row)));
        let reasons = Parameter::ALL.into_iter().filter_map(|parameter| {
            let estimate = &best.estimates[parameter as usize];
            let is_missing = estimate.verdict != Verdict::Identified && best.error.is_none();
            is_missing.then_some((Missing::Parameter(parameter, estimate.verdict), estimate.reason.as_deref()?, best))
        });
        let mut seen: Vec<(usize, usize, String)> = Vec::new();
        for (missing, sentence, row) in errors.chain(reasons) {
            let (what, verdict) = match missing {
                Missing::Answer => (0, 0),
                Missing::Parameter(parameter, verdict) => (1 + parameter as usize, verdict as usize),
            };
            let key = (what, verdict, kind(sentence, row));
            if seen.contains(&key) {
                continue;
            }
            let new = || Cause { missing, example: sentence.to_owned(), motors: 0, names: Vec::new() };
            let cause = self.found.entry(key.clone()).or_insert_with(new);
            cause.motors += 1;
            if cause.names.len() < NAMED {
                cause.names.push(best.motor.to_string());
            }
            seen.push(key);
        }
    }

    /// All causes, first those without an answer, then those of most motors.
    pub(super) fn most_first(self) -> Vec<Cause> {
        let mut causes: Vec<Cause> = self.found.into_values().collect();
        causes.sort_by_key(|cause| (cause.missing != Missing::Answer, std::cmp::Reverse(cause.motors)));
        causes
    }
}

/// A sentence without the names of motor and file, and with one sign for each number.
fn kind(sentence: &str, row: &FleetRow) -> String {
    // Sentences name the motor in one of these ways; a short name is a usual word too, and is looked for last.
    let label = format!("motor {} of {}", row.motor, row.source);
    let without = [&*label, &*row.source, &*row.motor].map(|name| without_word(sentence, name));
    let text = without.into_iter().find(|text| text != sentence).unwrap_or_else(|| sentence.to_owned());
    let mut kind = String::new();
    for character in text.chars() {
        if !(character.is_ascii_digit() || (character == '.' && kind.ends_with('#'))) {
            kind.push(character);
        } else if !kind.ends_with('#') {
            kind.push('#');
        }
    }
    kind
}

/// A text with a sign in place of a name that stands by itself.
fn without_word(text: &str, name: &str) -> String {
    if name.is_empty() {
        return text.to_owned();
    }
    let (mut left, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once(name) {
        left += before;
        let is_apart = !left.ends_with(char::is_alphanumeric) && !after.starts_with(char::is_alphanumeric);
        left += if is_apart { "*" } else { name };
        rest = after;
    }
    left + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::row::FleetEstimate;

    fn row(motor: &str, error: &str) -> FleetRow {
        let nothing = FleetEstimate { verdict: Verdict::NotIdentifiable, value: None, reason: None };
        FleetRow {
            motor: motor.into(),
            source: "fleet.csv".into(),
            window_start: None,
            estimates: std::array::from_fn(|_| nothing.clone()),
            warnings: Vec::new(),
            error: Some(error.into()),
        }
    }

    #[test]
    fn sentences_that_differ_in_names_and_numbers_are_one_cause() {
        let mut causes = Causes::default();
        for (motor, error) in [
            ("a", "motor a of fleet.csv, row 17: 'nine' is not a number"),
            ("m2", "motor m2 of fleet.csv, row 3: 'nine' is not a number"),
            ("rows", "the rows of rows stand in several places"),
            ("m4", "the rows of m4 stand in several places"),
            ("m5", "motor m5 of fleet.csv, row 30.5: 'nine' is not a number"),
        ] {
            let row = row(motor, error);
            causes.add(std::slice::from_ref(&row), &row);
        }
        let causes = causes.most_first();
        // The motor that is named like a word of its sentence stays alone; that is no wrong count.
        assert_eq!(causes.iter().map(|cause| cause.motors).collect::<Vec<_>>(), [3, 1, 1]);
        assert_eq!(causes[0].names, ["a", "m2", "m5"]);
        assert!(causes[0].example.starts_with("motor a of"));
    }

    #[test]
    fn a_motor_counts_once_for_a_cause_of_all_its_windows() {
        let rows = [row("m", "row 1: omega_e is zero"), row("m", "row 2: omega_e is zero")];
        let mut causes = Causes::default();
        causes.add(&rows, &rows[0]);
        assert_eq!(causes.most_first()[0].motors, 1);
    }
}
