//! The true parameters of a simulated log: `LOG.truth.json`, or a JSON file with them under `"truth"`.
//!
//! ```json
//! { "schema": "fluxfit.truth/1", "rs": 0.958, "ld": 0.00525, "lq": 0.012, "psi_f": 0.1827, "pole_pairs": 4 }
//! { "truth": { "Rs": 0.958, "Ld": 0.00525, "Lq": 0.012, "psi_f": 0.1827 } }
//! ```

use crate::{problem::Problem, scenario_file::ReadScenario};
use fluxfit::{
    document::{TRUTH, TruthDocument},
    motor::{Motor, PARAMETERS, Parameter},
};
use fluxfit_files::{FileError, Problem as FileProblem, input, json_fault};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What a log was simulated with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// The parameters, SI.
    pub motor: Motor,
    /// Number of pole pairs, if the file has it.
    pub pole_pairs: Option<u32>,
}

/// Reads a truth file; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, is not a JSON object, has another schema, or lacks a parameter; resistance and inductances must be
/// above zero, the flux linkage zero or more.
pub fn read_truth(path: &Path) -> Result<Truth, FileError> {
    Truth::parse(&input::name(path), &input::read(path)?)
}

impl Truth {
    /// Reads a truth file from memory; `name` is the file's name in messages.
    ///
    /// # Errors
    /// As [`read_truth`].
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, FileError> {
        input::text(bytes, "JSON").and_then(parse).map_err(|error| error.in_file(name))
    }
}

/// The path of the truth of a log: `rig.truth.json` for `rig.csv`.
pub fn truth_path(log: &Path) -> PathBuf {
    log.with_extension("truth.json")
}

/// The truth file of a simulated log: parameters, and the scenario with which the log can be made again. The inductances and the
/// flux of a motor that is a flux map are null.
pub fn truth_of(read: &ReadScenario, draw: u64) -> TruthDocument<&Value> {
    let motor = &read.scenario.motor;
    let constant = motor.constant_parameters();
    TruthDocument {
        schema: TRUTH,
        rs: motor.rs,
        ld: constant.map(|motor| motor.ld),
        lq: constant.map(|motor| motor.lq),
        psi_f: constant.map(|motor| motor.psi_f),
        pole_pairs: motor.pole_pairs,
        draw,
        scenario: &read.document,
    }
}

fn parse(text: &str) -> Result<Truth, FileError> {
    let document: Value = serde_json::from_str(text).map_err(|error| syntax(&error))?;
    if let Some(found) = document.get("schema").filter(|schema| schema.as_str() != Some(TRUTH)) {
        return Err(FileError::from(Problem::Schema { found: found.to_string(), wanted: TRUTH }).in_key("schema"));
    }
    let holder = document.get("truth").unwrap_or(&document);
    if !holder.is_object() {
        return Err(FileProblem::Value { wanted: "an object with the keys rs, ld, lq and psi_f".to_owned() }.into());
    }
    if ["ld", "lq", "psi_f"].iter().all(|key| holder.get(key).is_some_and(Value::is_null)) {
        return Err(Problem::NoConstants.into());
    }
    let mut values = [0.0; PARAMETERS];
    for (value, parameter) in values.iter_mut().zip(Parameter::ALL) {
        *value = number(holder, parameter)?;
    }
    Ok(Truth { motor: Motor::from(values), pole_pairs: pole_pairs(holder)? })
}

/// A parameter, whose key may have its first letter in upper case.
fn number(holder: &Value, parameter: Parameter) -> Result<f64, FileError> {
    let key = parameter.key();
    let mut letters = key.chars();
    let capital: String = letters.next().iter().flat_map(|first| first.to_uppercase()).chain(letters).collect();
    let found = holder.get(key).map(|value| (key, value)).or_else(|| holder.get(&capital).map(|value| (capital.as_str(), value)));
    let Some((key, value)) = found else {
        let remedy = match parameter {
            Parameter::Rs => "it in ohm",
            Parameter::Ld | Parameter::Lq => "it in H",
            Parameter::PsiF => "it in Wb",
        };
        return Err(FileProblem::MissingKey { key: key.to_owned(), remedy: remedy.to_owned() }.into());
    };
    let refuse = |problem: FileProblem| FileError::from(problem).in_key(key);
    let number = value.as_f64().ok_or_else(|| refuse(FileProblem::Value { wanted: "a number".to_owned() }))?;
    // A reluctance motor has no magnet.
    let (allowed, range) = if parameter == Parameter::PsiF { (number >= 0.0, "zero or more") } else { (number > 0.0, "above zero") };
    if allowed && number.is_finite() { Ok(number) } else { Err(refuse(FileProblem::Range { text: value.to_string(), range })) }
}

fn pole_pairs(holder: &Value) -> Result<Option<u32>, FileError> {
    let Some(value) = holder.get("pole_pairs").filter(|value| !value.is_null()) else { return Ok(None) };
    let found = value.as_u64().and_then(|number| u32::try_from(number).ok()).filter(|number| *number > 0);
    let refusal =
        || FileError::from(FileProblem::Range { text: value.to_string(), range: "a whole number above zero" }).in_key("pole_pairs");
    found.map(Some).ok_or_else(refusal)
}

/// What is wrong with a text that is no JSON, and where.
pub(crate) fn syntax(error: &serde_json::Error) -> FileError {
    FileError::from(FileProblem::Syntax { format: "JSON", message: json_fault(error) }).at_line(error.line() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PAPER: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

    fn read(text: &str) -> Result<Truth, String> {
        Truth::parse("a.json", text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn both_forms_are_read() {
        let ours =
            r#"{"schema": "fluxfit.truth/1", "rs": 0.958, "ld": 0.00525, "lq": 0.012, "psi_f": 0.1827, "pole_pairs": 4, "scenario": {}}"#;
        assert_eq!(read(ours), Ok(Truth { motor: PAPER, pole_pairs: Some(4) }));
        let theirs = r#"{"case": "a", "truth": {"Rs": 0.958, "Ld": 0.00525, "Lq": 0.012, "psi_f": 0.1827}}"#;
        assert_eq!(read(theirs), Ok(Truth { motor: PAPER, pole_pairs: None }));
    }

    #[test]
    fn errors_are_one_sentence() {
        let cases = [
            ("{\n\"rs\": }", "a.json, line 2: this is not JSON: it breaks off at character 7 of this line; correct it"),
            ("[]", "a.json: this is not an object with the keys rs, ld, lq and psi_f; correct it"),
            ("{\"truth\": 3}", "a.json: this is not an object with the keys rs, ld, lq and psi_f; correct it"),
            (r#"{"rs": 1, "ld": 1, "psi_f": 1}"#, "a.json: the key lq is missing; write it in H"),
            (r#"{"Rs": "1"}"#, "a.json, key 'Rs': this is not a number; correct it"),
            (r#"{"rs": -1}"#, "a.json, key 'rs': \"-1\" is out of range; it must be above zero"),
            (
                r#"{"schema": "fluxfit.study/1"}"#,
                "a.json, key 'schema': the schema is \"fluxfit.study/1\" where fluxfit.truth/1 is needed; give a truth file",
            ),
            (
                r#"{"rs": 1, "ld": 1, "lq": 1, "psi_f": 0, "pole_pairs": 0}"#,
                "a.json, key 'pole_pairs': \"0\" is out of range; it must be a whole number above zero",
            ),
            (
                r#"{"rs": 0.63, "ld": null, "lq": null, "psi_f": null}"#,
                "a.json: this truth has no constant parameters, because the motor of the simulation was a flux map; compare without a truth",
            ),
            ("", "a.json: the file is empty; export it again"),
        ];
        for (text, sentence) in cases {
            assert_eq!(read(text), Err(sentence.to_owned()), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*|[\\[\\]{}\":,0-9a-z ]{0,30}") {
            if let Err(sentence) = read(&text) {
                prop_assert_eq!(sentence.lines().count(), 1);
            }
        }
    }
}
