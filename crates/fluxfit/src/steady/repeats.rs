//! Rows that only repeat the one before: a recorder that asks more often than the drive answers, and a last answer that stands for
//! seconds after the drive has stopped to talk.
//!
//! Such a row is no reading. How much a stretch of such a log tells is counted by the rows in which anything changes.

use crate::log::{Log, Segment};
use std::ops::Range;

/// Rows slower than this, s, are a recorder's; a drive's own samples repeat only where nothing is measured, as in a simulation without
/// noise.
const SLOWEST_CONTROL: f64 = 1e-3;

/// A log repeats itself if this part of its rows does.
const MANY: f64 = 0.5;

/// Whether rows of a log are counted by what changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Repeats(bool);

impl Repeats {
    /// Looks at the segments of one log.
    pub(super) fn of(log: &Log, segments: &[Segment]) -> Self {
        let slow = segments.iter().all(|segment| segment.sample_period > SLOWEST_CONTROL);
        let rows: usize = segments.iter().map(|segment| segment.rows.len()).sum();
        let told: usize = segments.iter().map(|segment| changes(log, &segment.rows)).sum();
        Self(slow && told > segments.len() && ((rows - told) as f64) > MANY * rows as f64)
    }

    /// Whether the log repeats itself.
    pub(super) fn any(self) -> bool {
        self.0
    }

    /// Rows of a stretch that tell something.
    pub(super) fn told(self, log: &Log, rows: &Range<usize>) -> usize {
        if self.0 { changes(log, rows) } else { rows.len() }
    }
}

/// Rows in which anything changes, the first one included.
fn changes(log: &Log, rows: &Range<usize>) -> usize {
    let columns = log.columns();
    let all = [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e];
    let changed = |row: &usize| all.iter().any(|column| column[*row] != column[row - 1]);
    rows.len().min(1) + rows.clone().skip(1).filter(changed).count()
}
