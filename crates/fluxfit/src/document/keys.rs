//! The keys that a field of a document can hold, for its schema.

use crate::{
    identify::{model::Model, verdict::Verdict},
    validate::Outcome,
};

/// Of the models.
pub(super) fn models() -> [&'static str; 2] {
    [Model::Steady, Model::OutputError].map(Model::key)
}

/// Of the verdicts on a parameter.
pub(super) fn verdicts() -> [&'static str; 3] {
    [Verdict::Identified, Verdict::Weak, Verdict::NotIdentifiable].map(Verdict::key)
}

/// Of the outcomes of a validation.
pub(super) fn outcomes() -> [&'static str; 4] {
    [Outcome::Agrees, Outcome::DiffersLittle, Outcome::Contradicts, Outcome::CannotTell].map(Outcome::key)
}
