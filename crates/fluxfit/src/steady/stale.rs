//! Repeated (stale) samples: rows in which no channel has changed since the row before.
//!
//! They come from a recorder that polls faster than the drive reports, and from one that keeps writing the last value after the
//! drive has stopped reporting. Such rows carry no information, so the stretches of such a log are measured by the rows in which some
//! channel changes.

use crate::log::{Log, Segment};
use std::ops::Range;

/// Sample periods above this, s, are those of a recorder. A drive's own samples repeat only where nothing is measured, as in a
/// simulation without noise.
const SLOWEST_CONTROL: f64 = 1e-3;

/// A log has stale samples if more than this fraction of its rows repeat the row before, and more than this fraction of its changes
/// come after a repeated row. A simulation without noise is constant for long, but while it changes, it changes in every row.
const MANY: f64 = 0.5;

/// Fewest changes after a repeated row from which this is concluded.
const MIN_CHANGES: usize = 30;

/// Whether the rows of a log are counted by what changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StaleSamples(bool);

impl StaleSamples {
    /// Examines the segments of one log.
    pub(super) fn of(log: &Log, segments: &[Segment]) -> Self {
        let slow = segments.iter().all(|segment| segment.sample_period > SLOWEST_CONTROL);
        let of_all = |count: fn(&Log, &Range<usize>) -> usize| segments.iter().map(|segment| count(log, &segment.rows)).sum::<usize>();
        let (rows, fresh, after_repeat) = (of_all(|_, rows| rows.len()), of_all(fresh_rows), of_all(changes_after_repeat));
        let most = |part: usize, whole: usize| part as f64 > MANY * whole as f64;
        Self(slow && after_repeat >= MIN_CHANGES && most(after_repeat, fresh) && most(rows - fresh, rows))
    }

    /// Whether the log has stale samples.
    pub(super) fn are_present(self) -> bool {
        self.0
    }

    /// Rows of a stretch that carry information.
    pub(super) fn informative_rows(self, log: &Log, rows: &Range<usize>) -> usize {
        if self.0 { fresh_rows(log, rows) } else { rows.len() }
    }
}

/// Whether any channel differs from the row before.
fn has_changed(log: &Log, row: usize) -> bool {
    let columns = log.columns();
    [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].iter().any(|column| column[row] != column[row - 1])
}

/// Rows in which any channel changes, the first row included.
fn fresh_rows(log: &Log, rows: &Range<usize>) -> usize {
    rows.len().min(1) + rows.clone().skip(1).filter(|row| has_changed(log, *row)).count()
}

/// Rows in which a channel changes after a row that repeated the one before.
fn changes_after_repeat(log: &Log, rows: &Range<usize>) -> usize {
    rows.clone().skip(2).filter(|row| has_changed(log, *row) && !has_changed(log, row - 1)).count()
}
