//! Notes: what reading a log inferred or repaired.

use fluxfit_files::Advice;
use std::fmt;

/// One sentence about what was inferred, repaired or left out; and what the user can state to change it. The sentence names no option
/// of any interface.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// The sentence.
    pub sentence: String,
    /// Statements that would change what was done.
    pub advice: Vec<Advice>,
}

impl Note {
    /// A note with advice.
    pub(crate) fn with_advice(sentence: String, advice: Advice) -> Self {
        Self { sentence, advice: vec![advice] }
    }
}

impl From<String> for Note {
    fn from(sentence: String) -> Self {
        Self { sentence, advice: Vec::new() }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}
