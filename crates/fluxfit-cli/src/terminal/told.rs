//! A finding of the columns or of their samples, ready to be shown.

use fluxfit::SampleFinding;

/// A finding with what mends it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Told {
    /// Its name in files.
    pub(crate) code: &'static str,
    /// The finding, its cause and what mends it, in one sentence.
    pub(crate) sentence: String,
    /// Lines to paste, below it.
    pub(crate) lines: String,
    /// Whether an answer would mean nothing, so that there is none unless the model is stated.
    pub(crate) refuses: bool,
}

impl Told {
    /// Samples that are no measurements: the sentence says what to do, and no option mends them.
    pub(crate) fn of_samples(finding: &SampleFinding) -> Self {
        Self { code: finding.code(), sentence: finding.to_string(), lines: String::new(), refuses: false }
    }
}
