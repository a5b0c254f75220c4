//! Holds that ripple: windows that a ripple cut into pieces, whole again.
//!
//! Dead time, device drops and faulty sensors make currents ripple, periodically, around one operating point. The pieces that look
//! steady would all lie at the same phase of the ripple, alike and all wrong, and pass for many operating points. Over the whole
//! hold the ripple averages out.

use super::windows::{BLOCK_ROWS, Block, HALVES_TOLERANCE, Scale, TOLERANCE};
use crate::log::Log;
use std::ops::Range;

/// Currents that ripple around their mean by no more than this fraction of the log's largest belong to one hold.
const RIPPLE: f64 = 0.05;

/// The means of two pieces of one hold agree within this many times what the blocks of a window may differ.
const PIECES: f64 = 2.0;

/// A hold of fewer rows may show part of a ripple, which looks like a drift.
const MANY_ROWS: usize = 200;

/// The windows, pieces of one hold joined.
pub(super) fn mended(log: &Log, pieces: Vec<Range<usize>>, scale: &Scale) -> Vec<Range<usize>> {
    let mut windows: Vec<Range<usize>> = Vec::new();
    for piece in pieces {
        match windows.last_mut() {
            Some(window) if is_one_hold(log, window, &piece, scale) => window.end = piece.end,
            _ => windows.push(piece),
        }
    }
    windows
}

/// Whether two windows and what lies between them are one hold: their means agree, nothing between leaves the ripple's reach, and
/// the whole does not drift.
fn is_one_hold(log: &Log, one: &Range<usize>, other: &Range<usize>, scale: &Scale) -> bool {
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

#[cfg(test)]
mod tests {
    use crate::{
        log::{Columns, Log},
        steady::windows::find,
    };
    use std::f64::consts::TAU;

    /// 10 A along q with a ripple of i_d, A, 25 rows long; i_q falls by `drift` A over the log.
    fn log(ripple: f64, drift: f64) -> Log {
        let mut columns = Columns::default();
        for k in 0..4000 {
            columns.t.push(f64::from(k) * 1e-4);
            columns.id.push(-2.0 + ripple * (TAU * f64::from(k) / 25.0).sin());
            columns.iq.push(10.0 - drift * f64::from(k) / 4000.0);
            columns.omega_e.push(418.879);
            columns.ud.push(1.0);
            columns.uq.push(1.0);
        }
        Log::new(columns).unwrap()
    }

    /// Of the largest current, 10.2 A, blocks may differ by 1 %; ripples above that cut the hold, or leave nothing of it.
    #[test]
    fn a_hold_that_ripples_is_one_window() {
        for ripple in [0.05, 0.12, 0.15, 0.25, 0.4] {
            let windows = find(&log(ripple, 0.0)).unwrap();
            assert!(windows.len() == 1 && windows[0].len() > 3500, "{ripple} A: {windows:?}");
        }
    }

    /// Two percent of a slow fall are several operating points, with a ripple or without.
    #[test]
    fn a_hold_that_drifts_is_not() {
        for ripple in [0.0, 0.12] {
            let windows = find(&log(ripple, 0.6)).unwrap_or_default();
            assert!(windows.iter().all(|window| window.len() < 2000), "{ripple} A: {windows:?}");
        }
    }
}
