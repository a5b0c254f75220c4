//! Outliers: single rows far beside the row before and the row after, without what would cause them.
//!
//! The height of a row is how far it stands out on one side of both its neighbours; a step has none. An outlier is many times as high as
//! all rows that are none. A pulse that acted is no outlier: around it the other quantity of `u = R i + L di/dt + e` does more than usual.

use super::{
    finding::{SampleFault, SampleFinding},
    rows::{median, with_row_before},
};
use crate::log::{Log, Segment};
use std::ops::Range;

/// An outlier is this many times as high as every row that is none: the highest of a million normal values are within 1.5 of each other.
const FACTOR: f64 = 5.0;

/// Rows that may be outliers: this share of all, or a few. What comes more often is a signal.
const MAX_SHARE: f64 = 1e-3;
const FEW: usize = 3;

/// A column is examined if it changes in more than this share of its rows: of a speed that an encoder counts in rare steps, each step
/// would be an outlier.
const LIVE: f64 = 0.5;

/// Longest sample period, s, at which a pulse of current outlasts its row, as in the search for spikes: windings have an `L/R` of 0.3 ms
/// and more.
const MAX_PERIOD: f64 = 2.5e-4;

/// Rows before and after an outlier in which its cause or its effect would show: a command acts up to two rows later.
const REACH: usize = 3;

/// A quantity does no more than usual if it changes by less than this many times the median change of as many rows. The range of
/// a few normal values is seldom beyond that.
const USUAL: f64 = 2.0;

/// A column, the two that its outliers are compared with, and the rows before and after in which those are.
type Examined<'a> = (&'static str, &'a [f64], [&'a [f64]; 2], (usize, usize));

/// Outliers of each column.
pub(super) fn find(log: &Log) -> Vec<SampleFinding> {
    let columns = log.columns();
    if log.segments().iter().any(|segment| segment.sample_period > MAX_PERIOD) {
        return Vec::new();
    }
    let (voltages, currents) = ([columns.ud.as_slice(), &columns.uq], [columns.id.as_slice(), &columns.iq]);
    // What drives a current comes before it; the controller answers what was measured. A voltage acts after it.
    let (before, around) = ((REACH, 0), (REACH, REACH));
    let examined: [Examined; 5] = [
        ("ud", &columns.ud, currents, around),
        ("uq", &columns.uq, currents, around),
        ("id", &columns.id, voltages, before),
        ("iq", &columns.iq, voltages, before),
        ("omega_e", &columns.omega_e, currents, around),
    ];
    let of_column = |(name, values, other, reach): Examined| {
        let high = outstanding(values, log.segments());
        if high.is_empty() {
            return None;
        }
        let usual = usual_change(other, log.segments());
        let is_quiet = |row: &usize| around_row(*row, reach, log.segments()).is_some_and(|rows| change(other, rows) <= USUAL * usual);
        let rows: Vec<usize> = high.into_iter().filter(is_quiet).collect();
        SampleFinding::of(SampleFault::Outlier, Some(name), &rows, log)
    };
    examined.into_iter().filter_map(of_column).collect()
}

/// The rows that are many times as high as all others.
fn outstanding(values: &[f64], segments: &[Segment]) -> Vec<usize> {
    let steps = with_row_before(segments);
    let (all, changed) = (steps.clone().count(), steps.filter(|row| values[*row] != values[row - 1]).count());
    if (changed as f64) < LIVE * all as f64 {
        return Vec::new();
    }
    let inner = segments.iter().flat_map(|segment| segment.rows.start + 1..segment.rows.end.saturating_sub(1).max(segment.rows.start + 1));
    let mut order: Vec<(f64, usize)> = inner.map(|row| (height(values, row), row)).collect();
    let most = FEW.max((MAX_SHARE * values.len() as f64) as usize);
    if order.len() <= 2 * most {
        return Vec::new();
    }
    // The row beside an outlier may stand out on the other side, by its own noise only.
    order.select_nth_unstable_by(most, |a, b| b.0.total_cmp(&a.0));
    order.truncate(most + 1);
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let count = (1..=most).rev().find(|count| order[count - 1].0 > FACTOR * order[*count].0 && order[*count].0 > 0.0).unwrap_or(0);
    order[..count].iter().map(|(_, row)| *row).collect()
}

/// How far a row stands out on one side of both its neighbours.
fn height(values: &[f64], row: usize) -> f64 {
    let (before, after) = (values[row] - values[row - 1], values[row] - values[row + 1]);
    if before * after > 0.0 { before.abs().min(after.abs()) } else { 0.0 }
}

/// The rows around a row, itself not included where nothing behind it counts; none where the log does not show them.
fn around_row(row: usize, (before, after): (usize, usize), segments: &[Segment]) -> Option<Range<usize>> {
    let segment = &segments.get(segments.partition_point(|segment| segment.rows.end <= row))?.rows;
    let end = if after > 0 { row + after + 1 } else { row };
    (row >= segment.start + before && end <= segment.end).then(|| row - before..end)
}

/// The median change of two columns within as many rows as are examined around a row.
fn usual_change(columns: [&[f64]; 2], segments: &[Segment]) -> f64 {
    const LENGTH: usize = 2 * REACH + 1;
    let starts =
        segments.iter().flat_map(|segment| segment.rows.clone().step_by(LENGTH).filter(|start| start + LENGTH <= segment.rows.end));
    median(starts.map(|start| change(columns, start..start + LENGTH)))
}

/// The largest change of two columns among these rows.
fn change(columns: [&[f64]; 2], rows: Range<usize>) -> f64 {
    let range = |values: &[f64]| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values[rows.clone()].iter().fold(ends, |(low, high), value| (low.min(*value), high.max(*value)));
        high - low
    };
    range(columns[0]).hypot(range(columns[1]))
}
