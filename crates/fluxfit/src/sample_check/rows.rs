//! Columns and rows of a log as its samples are examined.

use crate::log::{Log, Segment};
use std::ops::Range;

/// Voltages and currents, the columns that a running drive changes in every row.
pub(super) fn live(log: &Log) -> [(&'static str, &[f64]); 4] {
    let columns = log.columns();
    [("ud", &columns.ud), ("uq", &columns.uq), ("id", &columns.id), ("iq", &columns.iq)].map(|(name, values)| (name, values.as_slice()))
}

/// The rows that have a row before them in the same segment.
pub(super) fn with_row_before(segments: &[Segment]) -> impl Iterator<Item = usize> + Clone {
    segments.iter().flat_map(|segment| segment.rows.clone().skip(1))
}

/// The median; 0 of none.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Neighbouring rows as runs, of rows in order.
pub(super) fn runs(rows: &[usize]) -> impl Iterator<Item = Range<usize>> {
    rows.chunk_by(|one, next| one + 1 == *next).map(|run| run[0]..run[0] + run.len())
}
