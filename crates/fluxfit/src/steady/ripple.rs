//! Merging of windows that a current ripple divided.
//!
//! Dead time, device drops and faulty sensors make the currents ripple periodically around one operating point. The pieces between
//! which the ripple exceeds the tolerance all lie at the same phase of it: they have the same error, and would count as several
//! operating points. Over the whole stretch the ripple averages out.

use super::block::{BLOCK_ROWS, Block, HALVES_TOLERANCE, Scale, TOLERANCE};
use crate::log::Log;
use std::ops::Range;

/// Largest ripple of the block means around their mean within one operating point, as a fraction of the log's largest current.
const RIPPLE: f64 = 0.05;

/// The means of two pieces of one operating point agree within this many times the tolerance between blocks.
const PIECES: f64 = 2.0;

/// A window of fewer rows may hold only part of a ripple period, which looks like a drift: its halves are not compared.
const MANY_ROWS: usize = 200;

/// Merges consecutive windows that belong to one operating point with a current ripple.
pub(super) fn merge_rippling(log: &Log, pieces: Vec<Range<usize>>, scale: &Scale) -> Vec<Range<usize>> {
    let mut windows: Vec<Range<usize>> = Vec::new();
    for piece in pieces {
        match windows.last_mut() {
            Some(window) if is_one_operating_point(log, window, &piece, scale) => window.end = piece.end,
            _ => windows.push(piece),
        }
    }
    windows
}

/// Whether two windows and the rows between them are one operating point: the means of both agree, the blocks between stay within
/// the ripple, and the whole does not drift.
fn is_one_operating_point(log: &Log, one: &Range<usize>, other: &Range<usize>, scale: &Scale) -> bool {
    if log.segment_of(one.start) != log.segment_of(other.start) {
        return false;
    }
    let means = |rows: Range<usize>| Block::of(log, rows).means;
    let before = means(one.clone());
    let near = |tolerance: f64, means: [f64; 3]| (0..3).all(|c| (means[c] - before[c]).abs() <= tolerance * scale.0[c]);
    let between = (one.end..other.start).step_by(BLOCK_ROWS.0).map(|start| start..(start + BLOCK_ROWS.0).min(other.start));
    if !near(PIECES * TOLERANCE, means(other.clone())) || !between.map(means).all(|means| near(RIPPLE, means)) {
        return false;
    }
    let middle = one.start.midpoint(other.end);
    let (early, late) = (means(one.start..middle), means(middle..other.end));
    other.end - one.start < MANY_ROWS || scale.agree(HALVES_TOLERANCE, &early, &late, &[0.0; 3])
}
