//! The stretches of a log whose rows are fitted; of a long log, the pieces by which readings and faults are chosen and those that are
//! fitted.

use crate::{
    error::Error,
    log::Log,
    steady::{
        OperatingPoint,
        windows::{self, TimeWindow},
    },
};
use std::ops::Range;

/// The windows that are named, or all that the log has without a gap; of a very long log, pieces.
///
/// # Errors
/// If a window is not in the log.
pub(crate) fn fitted(log: &Log, windows: &[TimeWindow]) -> Result<Vec<Range<usize>>, Error> {
    Ok(different(log, all(log, windows)?))
}

/// The windows that are named, or every segment of the log.
///
/// # Errors
/// If a window is not in the log.
pub(crate) fn all(log: &Log, windows: &[TimeWindow]) -> Result<Vec<Range<usize>>, Error> {
    let mut named = Vec::new();
    for times in windows {
        named.extend(windows::between(log, *times)?);
    }
    if named.is_empty() {
        named.extend(log.segments().iter().map(|segment| segment.rows.clone()));
    }
    Ok(named)
}

/// Each stretch as one operating point, steady or not: for the size of currents, voltages and speeds.
pub(crate) fn as_points(log: &Log, stretches: &[Range<usize>]) -> Vec<OperatingPoint> {
    stretches.iter().map(|rows| OperatingPoint::measure(log, rows.clone(), None)).collect()
}

/// Rows by which readings and faults are chosen: enough to see faults of a tenth of the noise.
const CHOICE_ROWS: usize = 40_000;

/// Rows that are fitted. Of more, the pieces that differ most are: noise has long ceased to limit the answer, and each row takes
/// a kilobyte.
pub(crate) const FIT_ROWS: usize = 1 << 17;

/// Rows of a piece, of a log that is longer: transients and turns in it, and its start of a few rows does not weigh.
const PIECE_ROWS: usize = 5_000;

/// The stretches, or pieces spread evenly over them if they are long.
pub(crate) fn spread(stretches: &[Range<usize>]) -> Vec<Range<usize>> {
    if rows(stretches) <= CHOICE_ROWS {
        return stretches.to_vec();
    }
    let all = cut(stretches);
    let wanted = (CHOICE_ROWS / PIECE_ROWS).min(all.len());
    // The middle of each share.
    (0..wanted).map(|k| all[(2 * k + 1) * all.len() / (2 * wanted)].clone()).collect()
}

/// The stretches, or those pieces of them that differ most in the means and spreads of currents and speed: each next one is the
/// farthest from those that are taken.
fn different(log: &Log, stretches: Vec<Range<usize>>) -> Vec<Range<usize>> {
    if rows(&stretches) <= FIT_ROWS {
        return stretches;
    }
    let all = cut(&stretches);
    let columns = log.columns();
    let features = [&columns.id, &columns.iq, &columns.omega_e].map(|column| {
        let of = all.iter().map(|rows| variance_and_mean(&column[rows.clone()])).collect::<Vec<_>>();
        let range =
            of.iter().map(|(_, mean)| *mean).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), mean| (low.min(mean), high.max(mean)));
        let scale = if range.1 > range.0 { range.1 - range.0 } else { 1.0 };
        of.into_iter().map(|(variance, mean)| [mean / scale, variance.sqrt() / scale]).collect::<Vec<_>>()
    });
    let distance =
        |a: usize, b: usize| features.iter().map(|of| (of[a][0] - of[b][0]).powi(2) + (of[a][1] - of[b][1]).powi(2)).sum::<f64>();
    let mut taken = vec![0];
    let mut apart: Vec<f64> = (0..all.len()).map(|piece| distance(piece, 0)).collect();
    while taken.len() < (FIT_ROWS / PIECE_ROWS).min(all.len()) {
        let farthest = (0..all.len()).filter(|piece| !taken.contains(piece)).max_by(|a, b| apart[*a].total_cmp(&apart[*b]));
        let Some(next) = farthest else { break };
        taken.push(next);
        apart.iter_mut().enumerate().for_each(|(piece, apart)| *apart = apart.min(distance(piece, next)));
    }
    taken.sort_unstable();
    taken.into_iter().map(|piece| all[piece].clone()).collect()
}

fn variance_and_mean(values: &[f64]) -> (f64, f64) {
    let rows = values.len() as f64;
    let mean = values.iter().sum::<f64>() / rows;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / rows, mean)
}

fn rows(stretches: &[Range<usize>]) -> usize {
    stretches.iter().map(ExactSizeIterator::len).sum()
}

/// Pieces of [`PIECE_ROWS`] rows.
fn cut(stretches: &[Range<usize>]) -> Vec<Range<usize>> {
    let pieces = stretches.iter().flat_map(|rows| rows.clone().step_by(PIECE_ROWS).map(|first| first..(first + PIECE_ROWS).min(rows.end)));
    pieces.collect()
}
