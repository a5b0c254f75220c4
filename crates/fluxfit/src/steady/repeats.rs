//! Rows that only repeat the one before: a recorder that asks more often than the drive answers, and a last answer that stands for
//! seconds after the drive has stopped to talk.
//!
//! Such a row is no reading. How much a stretch of such a log tells is counted by the rows in which anything changes.

use crate::log::{Log, Segment};
use std::ops::Range;

/// Rows slower than this, s, are a recorder's; a drive's own samples repeat only where nothing is measured, as in a simulation without
/// noise.
const SLOWEST_CONTROL: f64 = 1e-3;

/// A log repeats itself if more than this part of its rows does, and more than this part of what changes comes after a repetition: a
/// simulation without noise stands still for long, but where it moves, it moves in every row.
const MANY: f64 = 0.5;

/// Changes after a repetition that make a habit.
const HABIT: usize = 30;

/// Whether rows of a log are counted by what changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Repeats(bool);

impl Repeats {
    /// Looks at the segments of one log.
    pub(super) fn of(log: &Log, segments: &[Segment]) -> Self {
        let slow = segments.iter().all(|segment| segment.sample_period > SLOWEST_CONTROL);
        let of_all = |count: fn(&Log, &Range<usize>) -> usize| segments.iter().map(|segment| count(log, &segment.rows)).sum::<usize>();
        let (rows, told, waited) = (of_all(|_, rows| rows.len()), of_all(changes), of_all(waits));
        let most = |part: usize, whole: usize| part as f64 > MANY * whole as f64;
        Self(slow && waited >= HABIT && most(waited, told) && most(rows - told, rows))
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

/// Whether anything differs from the row before.
fn changed(log: &Log, row: usize) -> bool {
    let columns = log.columns();
    [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].iter().any(|column| column[row] != column[row - 1])
}

/// Rows in which anything changes, the first one included.
fn changes(log: &Log, rows: &Range<usize>) -> usize {
    rows.len().min(1) + rows.clone().skip(1).filter(|row| changed(log, *row)).count()
}

/// Rows in which something changes after one in which nothing did.
fn waits(log: &Log, rows: &Range<usize>) -> usize {
    rows.clone().skip(2).filter(|row| changed(log, *row) && !changed(log, row - 1)).count()
}
