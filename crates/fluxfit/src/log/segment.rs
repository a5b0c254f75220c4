//! Segments: rows without a gap in time between them.

use std::ops::Range;

/// Rows slower than this, Hz, need not be a drive's own periods: most drives control faster.
pub(crate) const CONTROL_RATE: f64 = 5e3;

/// A time step this many times the median one is a gap: one lost row (2) is not, two (3) are.
const GAP_FACTOR: f64 = 2.5;

/// Rows without a gap between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its rows in the log.
    pub rows: Range<usize>,
    /// Number of the log that it came from, from 0, among those joined.
    pub log: usize,
    /// Median time step of that log, s.
    pub sample_period: f64,
    /// Quantization steps of that log's channels, in their units: `ud, uq, id, iq, omega_e`; zero for those that are not quantized.
    pub steps: [f64; 5],
}

/// The segments of a log with these times, s, and quantization steps. One also begins at each of `starts`, rows in order.
pub(super) fn split(t: &[f64], steps: [f64; 5], starts: &[usize]) -> Vec<Segment> {
    let sample_period = median_step(t);
    let mut starts = starts.iter().copied().peekable();
    let mut segments = Vec::new();
    for Range { mut start, end } in without_gaps(t) {
        while let Some(next) = starts.next_if(|next| *next < end) {
            if next > start {
                segments.push(Segment { rows: start..next, log: 0, sample_period, steps });
                start = next;
            }
        }
        segments.push(Segment { rows: start..end, log: 0, sample_period, steps });
    }
    segments
}

/// Stretches of rows with these times, s, split where a step is a gap: more than 2.5 times the median one.
pub fn without_gaps(t: &[f64]) -> Vec<Range<usize>> {
    // The median lies between the shortest and the longest step, and is not needed where these are close.
    let steps = || t.windows(2).map(|pair| pair[1] - pair[0]);
    let (shortest, longest) = steps().fold((f64::INFINITY, 0.0_f64), |(shortest, longest), step| (shortest.min(step), longest.max(step)));
    if t.len() > 1 && longest <= GAP_FACTOR * shortest {
        return std::iter::once(0..t.len()).collect();
    }
    let sample_period = median_step(t);
    let mut stretches = Vec::new();
    let mut start = 0;
    for end in 1..=t.len() {
        if end == t.len() || t[end] - t[end - 1] > GAP_FACTOR * sample_period {
            stretches.push(start..end);
            start = end;
        }
    }
    stretches
}

/// The median time step, s; 0 of fewer than two times.
pub(super) fn median_step(t: &[f64]) -> f64 {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
