//! Warnings, as the documents list them.

use crate::Warning;
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
