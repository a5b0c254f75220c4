//! Samples that are no measurements: facts.

use crate::log::Log;

/// Samples of one column, or whole rows, that are no measurements. It prints as a sentence.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleFinding {
    /// What they are.
    pub kind: SampleFault,
    /// The column; none if all of them are concerned.
    pub column: Option<&'static str>,
    /// How many rows.
    pub rows: usize,
    /// The first of them, counted from 0 over the rows of the log.
    pub first_row: usize,
    /// Its time, s.
    pub first_time: f64,
}

/// What is wrong with samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SampleFault {
    /// Single values far beside those before and after them, without what would cause them.
    Outlier,
    /// Values that are repeated while other columns move.
    Stale,
}

impl SampleFinding {
    /// Name in files.
    pub fn code(&self) -> &'static str {
        match self.kind {
            SampleFault::Outlier => "outliers",
            SampleFault::Stale => "stale-samples",
        }
    }

    /// The codes of all findings.
    pub const CODES: [&'static str; 2] = ["outliers", "stale-samples"];

    /// The finding of these rows of a log; none of none.
    pub(super) fn of(kind: SampleFault, column: Option<&'static str>, rows: &[usize], log: &Log) -> Option<Self> {
        let first_row = rows.iter().copied().min()?;
        Some(Self { kind, column, rows: rows.len(), first_row, first_time: log.columns().t[first_row] })
    }
}
