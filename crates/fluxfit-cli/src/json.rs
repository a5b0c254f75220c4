//! Documents as text.

use serde::Serialize;
use std::io;

/// A document as indented JSON, with a newline at its end.
pub(crate) fn text(document: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string_pretty(document)? + "\n")
}
