//! What can be wrong with a motor, a scenario, a truth or a flux map.

use fluxfit_files::{Advice, FileError, FileErrorKind};
use fluxfit_units::wording::{columns, list, quote, shorten};

/// The problems and their sentences. Texts taken from files are quoted and shortened here and nowhere else.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Problem {
    #[error("this key cannot be combined with {by}; remove one of them")]
    Excluded { by: &'static str },
    #[error("{0}")]
    Drive(fluxfit_drive::Error),
    #[error("{}", missing_map_columns(.missing, .present))]
    MapColumns { missing: Vec<&'static str>, present: Vec<String> },
    #[error("this truth has no constant parameters, because the motor of the simulation was a flux map; compare without a truth")]
    NoConstants,
    #[error("the schema is {} where {wanted} is needed; give a truth file", shorten(.found))]
    Schema { found: String, wanted: &'static str },
    #[error("the schema is {}, which contains no motor; give a motor file, the JSON of an identification or a truth file", quote(.found))]
    MotorSchema { found: String },
    #[error("the {} missing; validation needs all four: write {} below [motor]", parameters(.missing, "is", "are"), them(.missing))]
    MissingParameters { missing: Vec<&'static str> },
    #[error(
        "the {} no value, because the log could not determine {them} when the motor was identified; identify again with a log that excites {them}, or give {them} as known",
        parameters(.undetermined, "has", "have"), them = them(.undetermined)
    )]
    UndeterminedParameters { undetermined: Vec<&'static str> },
}

impl From<Problem> for FileError {
    fn from(problem: Problem) -> Self {
        let kind = match &problem {
            Problem::Excluded { .. } => FileErrorKind::Key,
            Problem::Drive(_) | Problem::NoConstants => FileErrorKind::Value,
            Problem::MapColumns { .. } => FileErrorKind::Columns,
            Problem::Schema { .. } | Problem::MotorSchema { .. } => FileErrorKind::Format,
            Problem::MissingParameters { .. } | Problem::UndeterminedParameters { .. } => FileErrorKind::Key,
        };
        let advice = match &problem {
            Problem::UndeterminedParameters { undetermined } => vec![Advice::FixParameters(undetermined.clone())],
            _ => Vec::new(),
        };
        Self::new(kind, problem).with_advice(advice)
    }
}

fn parameters(keys: &[&str], one: &str, several: &str) -> String {
    if keys.len() == 1 { format!("parameter {} {one}", list(keys)) } else { format!("parameters {} {several}", list(keys)) }
}

fn them(keys: &[&str]) -> &'static str {
    if keys.len() == 1 { "it" } else { "them" }
}

fn missing_map_columns(missing: &[&str], present: &[String]) -> String {
    let (noun, are) = if missing.len() == 1 { ("column", "is") } else { ("columns", "are") };
    let what = format!("the {noun} {} {are} missing; the file has {}", list(missing), columns(present));
    format!("{what}, and a flux map needs id, iq in A, psi_d, psi_q in Wb")
}
