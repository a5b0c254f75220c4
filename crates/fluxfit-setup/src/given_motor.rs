//! A motor with all four parameters known, against which a log is validated: from a motor file, the document of an identification, or
//! a truth file.

use crate::{
    motor_file::MotorFile,
    problem::Problem,
    truth::{self, Truth},
};
use fluxfit::{
    Given,
    document::{IDENTIFICATION, TRUTH},
    motor::{Motor, PARAMETERS, Parameter},
};
use fluxfit_files::{FileError, Problem as FileProblem, input};
use serde_json::Value;
use std::path::Path;

/// A motor with all four parameters known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivenMotor {
    /// Its parameters, with standard errors if the file has them.
    pub given: Given,
    /// The same as a motor file, with pole pairs and rating.
    pub file: MotorFile,
}

/// Reads a motor with all four parameters known; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, is none of the three kinds, or lacks parameters, which are named.
pub fn read_given_motor(path: &Path) -> Result<GivenMotor, FileError> {
    GivenMotor::parse(&input::name(path), &input::read(path)?)
}

impl GivenMotor {
    /// Reads one from memory; `name` is the file's name in messages. A file that begins with a brace is JSON, otherwise it is TOML.
    ///
    /// # Errors
    /// As [`read_given_motor`].
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, FileError> {
        let text = input::text(bytes, "TOML or JSON").map_err(|error| error.in_file(name))?;
        if !text.trim_start().starts_with('{') {
            return of_motor_file(MotorFile::parse(name, bytes)?).map_err(|error| error.in_file(name));
        }
        let document: Value = serde_json::from_str(text).map_err(|error| truth::syntax(&error).in_file(name))?;
        match document.get("schema").and_then(Value::as_str) {
            Some(IDENTIFICATION) => of_identification(&document).map_err(|error| error.in_file(name)),
            Some(TRUTH) | None => Truth::parse(name, bytes).map(of_truth),
            Some(other) => Err(FileError::from(Problem::MotorSchema { found: other.to_owned() }).in_key("schema").in_file(name)),
        }
    }
}

fn of_motor_file(file: MotorFile) -> Result<GivenMotor, FileError> {
    let MotorFile { rs, ld, lq, psi_f, .. } = file;
    let motor = complete([rs, ld, lq, psi_f]).map_err(|missing| Problem::MissingParameters { missing })?;
    Ok(GivenMotor { given: motor.into(), file })
}

fn of_truth(truth: Truth) -> GivenMotor {
    GivenMotor { given: truth.motor.into(), file: file(&truth.motor, truth.pole_pairs) }
}

fn of_identification(document: &Value) -> Result<GivenMotor, FileError> {
    let of = |parameter: Parameter, key: &'static str| number(&document["parameters"][parameter.key()][key], parameter);
    let (mut values, mut errors) = ([None; PARAMETERS], [0.0; PARAMETERS]);
    for parameter in Parameter::ALL {
        values[parameter as usize] = of(parameter, "value")?;
        errors[parameter as usize] = of(parameter, "standard_error")?.unwrap_or(0.0);
    }
    let motor = complete(values).map_err(|undetermined| Problem::UndeterminedParameters { undetermined })?;
    let correlation = |p: usize, q: usize| document["diagnostics"]["correlation"][p][q].as_f64().unwrap_or(0.0).clamp(-1.0, 1.0);
    let correlation = std::array::from_fn(|p| std::array::from_fn(|q| correlation(p, q)));
    Ok(GivenMotor { given: Given::with_errors(motor, errors, &correlation), file: file(&motor, None) })
}

/// A number, zero or more; none if it is null or missing.
fn number(value: &Value, parameter: Parameter) -> Result<Option<f64>, FileError> {
    if value.is_null() {
        return Ok(None);
    }
    let refuse = |problem: FileProblem| FileError::from(problem).in_key(parameter.key());
    let number = value.as_f64().ok_or_else(|| refuse(FileProblem::Value { wanted: "a number or null".to_owned() }))?;
    let allowed = number >= 0.0 && number.is_finite();
    if allowed { Ok(Some(number)) } else { Err(refuse(FileProblem::Range { text: value.to_string(), range: "zero or more" })) }
}

/// All four, or the keys of those that are missing.
fn complete(values: [Option<f64>; PARAMETERS]) -> Result<Motor, Vec<&'static str>> {
    let missing: Vec<&str> = Parameter::ALL.into_iter().filter(|p| values[*p as usize].is_none()).map(Parameter::key).collect();
    if missing.is_empty() { Ok(Motor::from(values.map(Option::unwrap_or_default))) } else { Err(missing) }
}

fn file(motor: &Motor, pole_pairs: Option<u32>) -> MotorFile {
    let Motor { rs, ld, lq, psi_f } = *motor;
    MotorFile { rs: Some(rs), ld: Some(ld), lq: Some(lq), psi_f: Some(psi_f), pole_pairs, ..MotorFile::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PAPER: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
    const FOUND: &str = r#"{
        "schema": "fluxfit.identification/1",
        "parameters": {
            "rs": { "value": 0.958, "standard_error": 0.01 }, "ld": { "value": 0.00525, "standard_error": 0.0001 },
            "lq": { "value": 0.012, "standard_error": 0.0002 }, "psi_f": { "value": 0.1827, "standard_error": 0.001 }
        },
        "diagnostics": { "correlation": [[1, 0, 0, -0.5], [0, 1, 0, 0], [0, 0, 1, 0], [-0.5, 0, 0, 1]] }
    }"#;

    fn read(text: &str) -> Result<GivenMotor, String> {
        GivenMotor::parse("m", text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn all_three_kinds_are_read() {
        let motor_file = "[motor]\nrs = \"0.958 ohm\"\nld = \"5.25 mH\"\nlq = 12e-3\npsi_f = \"0.1827 Wb\"\npole_pairs = 4\n";
        let truth = r#"{"schema": "fluxfit.truth/1", "rs": 0.958, "ld": 0.00525, "lq": 0.012, "psi_f": 0.1827, "pole_pairs": 4}"#;
        for text in [motor_file, truth] {
            let found = read(text).unwrap();
            assert_eq!((found.given, found.file.pole_pairs), (PAPER.into(), Some(4)));
        }
        let found = read(FOUND).unwrap();
        assert_eq!((found.given.motor, found.file.rs, found.file.pole_pairs), (PAPER, Some(0.958), None));
        assert_eq!(Parameter::ALL.map(|parameter| found.given.standard_error(parameter)), [0.01, 1e-4, 2e-4, 1e-3]);
        // -0.5 times 0.01 ohm times 0.001 Wb.
        assert!((found.given.covariance[3][0] + 5e-6).abs() < 1e-18 && found.given.covariance[0][1] == 0.0);
    }

    #[test]
    fn errors_name_all_missing_parameters() {
        let cases = [
            (
                "[motor]\nrs = 1\nlq = 1e-3\n".to_owned(),
                "m: the parameters ld and psi_f are missing; validation needs all four: write them below [motor]",
            ),
            (
                FOUND.replace("0.00525", "null"),
                "m: the parameter ld has no value, because the log could not determine it when the motor was identified; identify again with a log that excites it, or give it as known",
            ),
            (FOUND.replace("0.00525", "-1"), "m, key 'ld': \"-1\" is out of range; it must be zero or more"),
            (FOUND.replace("0.00525", "\"x\""), "m, key 'ld': this is not a number or null; correct it"),
            (
                FOUND.replace("identification/1", "study/1"),
                "m, key 'schema': the schema is \"fluxfit.study/1\", which contains no motor; give a motor file, the JSON of an identification or a truth file",
            ),
            ("{}".to_owned(), "m: the key rs is missing; write it in ohm"),
            ("{".to_owned(), "m, line 1: this is not JSON: it ends before its last bracket or quotation mark; correct it"),
            (String::new(), "m: the file is empty; export it again"),
        ];
        for (text, sentence) in cases {
            assert_eq!(read(&text), Err(sentence.to_owned()), "{text}");
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
