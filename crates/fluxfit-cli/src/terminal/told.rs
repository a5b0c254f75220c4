//! A finding of the columns, ready to be shown.

/// A finding with what mends it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Told {
    /// Its name in files.
    pub(crate) code: &'static str,
    /// The finding, its cause and what mends it, in one sentence.
    pub(crate) sentence: String,
    /// Lines to paste, below it.
    pub(crate) lines: String,
}
