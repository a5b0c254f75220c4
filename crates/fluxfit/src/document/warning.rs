//! Warnings, as the documents list them.

use super::by_parameter::ByParameter;
use crate::{Counted, Unseen, Warning};
use serde::Serialize;

/// What limits an answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WarningEntry {
    /// The name of its kind, such as `saturation`; it stays the same from version to version.
    pub code: &'static str,
    /// One or two sentences.
    pub message: String,
}

impl WarningEntry {
    pub(super) fn of(warning: &Warning) -> Self {
        Self { code: warning.code(), message: warning.to_string() }
    }
}

/// An error that no log shows, because the motor of another one fits as well.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct UnseenEntry {
    /// The name of its kind, such as `current-gain`.
    pub code: &'static str,
    /// What it is, and what it does to the parameters.
    pub message: String,
    /// The fraction by which it moves each parameter.
    pub moves: ByParameter<f64>,
}

impl UnseenEntry {
    pub(super) fn of(unseen: &Unseen) -> Self {
        Self { code: unseen.error.key(), message: unseen.to_string(), moves: unseen.moves.into() }
    }
}

/// An error that no log shows, and that the intervals count, because its size is stated.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CountedEntry {
    /// The name of its kind, such as `current-gain`.
    pub code: &'static str,
    /// What it is, and how large it may be.
    pub message: String,
    /// Its largest size, as a fraction, to either side: half of a 95 % interval.
    pub accuracy: f64,
}

impl CountedEntry {
    pub(super) fn of(counted: &Counted) -> Self {
        Self { code: counted.error.key(), message: counted.to_string(), accuracy: counted.accuracy }
    }
}
