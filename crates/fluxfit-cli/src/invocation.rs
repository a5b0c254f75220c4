//! How the command was called.

use std::{ffi::OsString, sync::OnceLock};

/// The words of the command that runs.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Keeps the words of the command, so that a report can state them.
pub(crate) fn remember(words: Vec<OsString>) {
    // A process runs one command; of a second one, the first would be stated.
    let _ = WORDS.set(words);
}

/// What follows the program's name; nothing, if no command runs.
pub(crate) fn words() -> &'static [OsString] {
    WORDS.get().and_then(|words| words.get(1..)).unwrap_or_default()
}
