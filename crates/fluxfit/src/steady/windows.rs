//! Steady windows: finding them, or taking those that the user named.
//!
//! A segment is cut into short blocks. A block is steady when its two halves agree, in both currents and in speed; steady
//! neighbours that agree with the mean of the window so far join it. Means agree if they differ by no more than a small fraction of
//! the log's largest current and speed, or than their noise allows. Blocks without current are left out: while a drive coasts, its
//! inverter is off and the voltage columns are not the terminal voltages.

use super::{
    block::{BLOCK_ROWS, Block, HALVES_TOLERANCE, MIN_CURRENT, Scale, TOLERANCE, mean_of},
    ripple::merge_rippling,
    stale::StaleSamples,
};
use crate::{
    error::{Error, ErrorKind},
    log::{Log, Segment},
};
use std::{f64::consts::TAU, ops::Range};

/// Fewest rows of a window: a few autocorrelation times, and enough rows for a covariance.
pub const MIN_ROWS: usize = 30;

/// Fewest blocks of a window: a single block can look steady by chance.
const MIN_BLOCKS: usize = 3;

/// Length of the shortest window as a fraction of the longest: a shorter stretch is a pause between transients rather than an
/// intended operating point.
const MIN_SHARE: f64 = 0.2;

/// Blocks at a window's ends whose currents differ from its middle half by more than this fraction are cut off: a tenth of
/// [`TOLERANCE`].
const END_TOLERANCE: f64 = 0.001;

/// Ripples of dead time and device drops per electrical turn.
const RIPPLES_PER_TURN: f64 = 6.0;

/// Blocks long enough to average a ripple are used where the windows that they give have more than this many times the rows.
const MUCH_MORE: usize = 2;

/// Longest window for the study of the paper's fitness: the paper's sample count.
pub const PAPER_ROWS: usize = 4000;

/// Finds the steady windows of a log, in order; those of joined logs separately for each.
///
/// # Errors
/// If there is no steady window.
pub fn find(log: &Log) -> Result<Vec<Range<usize>>, Error> {
    let (windows, _) = find_all(log);
    if windows.is_empty() { Err(no_operating_point(log, MIN_ROWS)) } else { Ok(windows) }
}

/// The error of a log without an operating point of at least so many rows: a shorter log than a window has none to be named.
pub(super) fn no_operating_point(log: &Log, least: usize) -> Error {
    let rows = log.segments().iter().map(|segment| segment.rows.len()).max().unwrap_or(0);
    let kind = if rows < MIN_ROWS { ErrorKind::FewRows { rows, least: MIN_ROWS } } else { ErrorKind::NoOperatingPoint { least } };
    kind.into()
}

/// The steady windows, and the steady stretches that are too short to be windows. Stretches that are still shorter by the same factor
/// are dropped.
pub(crate) fn find_all(log: &Log) -> (Vec<Range<usize>>, Vec<Range<usize>>) {
    let scale = Scale::of(log);
    let (mut windows, mut short) = (Vec::new(), Vec::new());
    for of_one_log in log.segments().chunk_by(|one, other| one.log == other.log) {
        let stale = StaleSamples::of(log, of_one_log);
        let length = |rows: &Range<usize>| stale.informative_rows(log, rows);
        let mut stretches = stretches_of_one_log(log, of_one_log, &scale, stale);
        // A single sample, however often repeated, does not show a steady state.
        stretches.retain(|rows| length(rows) > 1 || !stale.are_present());
        let longest = stretches.iter().map(length).max().unwrap_or(0);
        let (long, rest): (Vec<_>, Vec<_>) = stretches.into_iter().partition(|rows| length(rows) as f64 >= MIN_SHARE * longest as f64);
        windows.extend(long);
        short.extend(rest.into_iter().filter(|rows| length(rows) as f64 >= MIN_SHARE * MIN_SHARE * longest as f64));
    }
    (windows, short)
}

/// The steady stretches of the segments of one log, found with short blocks; or with blocks long enough to average a ripple, where
/// those find many more rows.
fn stretches_of_one_log(log: &Log, segments: &[Segment], scale: &Scale, stale: StaleSamples) -> Vec<Range<usize>> {
    let rows: usize = segments.iter().map(|segment| segment.rows.len()).sum();
    // Long blocks average noise. The rows of a recorder are too far apart for that: an operating point has few of them.
    let short = if stale.are_present() { BLOCK_ROWS.0 } else { (rows / 500).clamp(BLOCK_ROWS.0, BLOCK_ROWS.1) };
    let found = stretches(log, segments, scale, |_, _| short);
    let averaging = stretches(log, segments, scale, |segment, start| {
        let turn = (log.columns().omega_e[start] * segment.sample_period).abs();
        short.max((2.0 * TAU / (RIPPLES_PER_TURN * turn)).round().min(BLOCK_ROWS.1 as f64) as usize)
    });
    let rows_of = |windows: &[Range<usize>]| windows.iter().map(ExactSizeIterator::len).sum::<usize>();
    if rows_of(&averaging) > MUCH_MORE * rows_of(&found) { averaging } else { found }
}

/// The steady stretches found with blocks of `block_rows` rows, which may depend on where the block starts.
fn stretches(log: &Log, segments: &[Segment], scale: &Scale, block_rows: impl Fn(&Segment, usize) -> usize) -> Vec<Range<usize>> {
    let mut windows = Vec::new();
    let mut shortest = usize::MAX;
    for segment in segments {
        let mut open: Option<Window> = None;
        let mut start = segment.rows.start;
        while start < segment.rows.end {
            let block_rows = block_rows(segment, start);
            shortest = shortest.min(block_rows);
            let block = Some(start..start + block_rows)
                .filter(|rows| rows.end <= segment.rows.end)
                .and_then(|rows| Block::steady(log, rows, scale));
            match (&mut open, block) {
                (Some(window), Some(block)) if window.agrees(&block, scale) => window.join(block),
                (_, block) => windows.extend(std::mem::replace(&mut open, block.map(Window::start)).and_then(|window| window.rows(scale))),
            }
            start += block_rows;
        }
        windows.extend(open.and_then(|window| window.rows(scale)));
    }
    let mut windows = merge_rippling(log, windows, scale);
    let least = MIN_ROWS.max(MIN_BLOCKS * shortest.min(BLOCK_ROWS.1));
    windows.retain(|rows| rows.len() >= least);
    windows
}

/// A part of a log, on the log's own time, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeWindow {
    /// Start, s.
    pub from: f64,
    /// End, s.
    pub to: f64,
}

/// The rows of each segment within a window.
///
/// # Errors
/// If no segment has at least [`MIN_ROWS`] rows in it.
pub fn between(log: &Log, TimeWindow { from, to }: TimeWindow) -> Result<Vec<Range<usize>>, Error> {
    let t = &log.columns().t;
    let within = log.segments().iter().map(|segment| {
        let times = &t[segment.rows.clone()];
        segment.rows.start + times.partition_point(|t| *t < from)..segment.rows.start + times.partition_point(|t| *t <= to)
    });
    let (windows, short): (Vec<_>, Vec<_>) = within.partition(|rows| rows.len() >= MIN_ROWS);
    if windows.is_empty() {
        let rows = short.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
        let (start, end) = t.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(*t), high.max(*t)));
        return Err(ErrorKind::Window { from, to, rows, least: MIN_ROWS, start, end }.into());
    }
    Ok(windows)
}

/// The last [`PAPER_ROWS`] rows of each window: the paper's sample count, as far as possible from the transient before the window.
pub fn at_most_paper_rows(windows: &[Range<usize>]) -> Vec<Range<usize>> {
    windows.iter().map(|rows| rows.end.saturating_sub(PAPER_ROWS).max(rows.start)..rows.end).collect()
}

/// Currents below this, A, are too small to carry information.
pub fn least_current(log: &Log) -> f64 {
    MIN_CURRENT * log.peak_current()
}

/// Number of rows whose current is too small to carry information: a drive at rest or coasting.
pub fn rows_without_current(log: &Log) -> usize {
    let least = least_current(log);
    let columns = log.columns();
    columns.id.iter().zip(&columns.iq).filter(|(id, iq)| id.hypot(**iq) < least).count()
}

/// Consecutive blocks that agree.
struct Window {
    blocks: Vec<Block>,
    means: [f64; 3],
}

impl Window {
    fn start(block: Block) -> Self {
        Self { means: block.means, blocks: vec![block] }
    }

    fn agrees(&self, block: &Block, scale: &Scale) -> bool {
        // The variance of the window's mean is at most the block's.
        scale.agree(TOLERANCE, &self.means, &block.means, &block.variances.map(|variance| 2.0 * variance))
    }

    fn join(&mut self, block: Block) {
        let share = 1.0 / (self.blocks.len() + 1) as f64;
        self.means = std::array::from_fn(|c| self.means[c] + share * (block.means[c] - self.means[c]));
        self.blocks.push(block);
    }

    /// The rows without the tails of the transients at the ends; `None` if the window drifts as a whole.
    fn rows(&self, scale: &Scale) -> Option<Range<usize>> {
        let n = self.blocks.len();
        let middle = mean_of(&self.blocks[n / 4..n - n / 4]);
        let settled = |block: &Block| scale.agree(END_TOLERANCE, &middle, &block.means, &block.variances);
        let first = self.blocks.iter().position(settled)?;
        let last = self.blocks.iter().rposition(settled)?;
        let (early, late) = self.blocks[first..=last].split_at((last + 1 - first) / 2);
        let steady = !early.is_empty() && scale.agree(HALVES_TOLERANCE, &mean_of(early), &mean_of(late), &[0.0; 3]);
        steady.then_some(self.blocks[first].rows.start..self.blocks[last].rows.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    const PERIOD: f64 = 1e-3;

    /// A log of (i_d, i_q, omega_e) per row, one millisecond apart; the voltages are not used here.
    fn log(rows: impl IntoIterator<Item = (f64, f64, f64)>) -> Log {
        log_at(rows, |k| k as f64 * PERIOD)
    }

    fn log_at(rows: impl IntoIterator<Item = (f64, f64, f64)>, time: impl Fn(usize) -> f64) -> Log {
        let mut columns = Columns::default();
        for (k, (id, iq, omega_e)) in rows.into_iter().enumerate() {
            columns.t.push(time(k));
            columns.id.push(id);
            columns.iq.push(iq);
            columns.omega_e.push(omega_e);
            columns.ud.push(1.0);
            columns.uq.push(1.0);
        }
        Log::new(columns).unwrap()
    }

    /// A straight line from one value to another in so many rows.
    fn ramp(from: f64, to: f64, rows: usize) -> impl Iterator<Item = f64> {
        (0..rows).map(move |k| from + (to - from) * k as f64 / rows as f64)
    }

    #[test]
    fn windows_cover_two_plateaus_between_ramps() {
        // Rows 0..300 rise, 300..800 are constant, 800..1000 rise, 1000..1600 are constant, 1600..1900 fall. Blocks have 10 rows.
        let iq =
            ramp(0.0, 5.0, 300).chain(ramp(5.0, 5.0, 500)).chain(ramp(5.0, 9.0, 200)).chain(ramp(9.0, 9.0, 600)).chain(ramp(9.0, 0.0, 300));
        assert_eq!(find(&log(iq.map(|iq| (-1.0, iq, 400.0)))).unwrap(), [300..800, 1000..1600]);
    }

    #[test]
    fn the_tail_of_a_transient_is_cut_off() {
        // i_q settles to 8 A from 2 A with a time constant of 50 rows: within 0.1 % of 8.06 A (the peak) after 50 ln(6/0.008) = 331 rows.
        let rows = (0..2000).map(|k| (-1.0, 8.0 - 6.0 * (-f64::from(k) / 50.0).exp(), 400.0));
        let windows = find(&log(rows)).unwrap();
        assert_eq!(windows.len(), 1);
        // Block means are compared, and the noise is estimated from differences of neighbours: one or two blocks of tolerance.
        assert!((290..=350).contains(&windows[0].start) && windows[0].end == 2000, "{windows:?}");
    }

    #[test]
    fn rows_of_a_coasting_drive_are_left_out_and_counted() {
        // 0.5 % of the current at constant speed.
        let rows = (0..1200).map(|k| if k < 600 { (0.0, 8.0, 400.0) } else { (0.0, 0.04, 400.0) });
        let log = log(rows);
        assert_eq!(find(&log).unwrap(), vec![0..600; 1]);
        assert_eq!(rows_without_current(&log), 600);
    }

    #[test]
    fn a_log_without_steady_state_has_no_operating_point() {
        let rows = ramp(1.0, 9.0, 1000).map(|iq| (0.0, iq, 400.0));
        assert_eq!(find(&log(rows)), Err(ErrorKind::NoOperatingPoint { least: 30 }.into()));
        let rows = ramp(1.0, 9.0, 26).map(|iq| (0.0, iq, 400.0));
        assert_eq!(find(&log(rows)), Err(ErrorKind::FewRows { rows: 26, least: 30 }.into()));
        // A slow oscillation of 10 %: steady within each block, but not over a window.
        let rows = (0..4000).map(|k| (0.0, 8.0 + 0.8 * (f64::from(k) / 100.0).sin(), 400.0));
        assert!(find(&log(rows)).map_or_else(|_| true, |windows| windows.iter().all(|rows| rows.len() < 100)));
    }

    #[test]
    fn no_window_crosses_a_gap_in_time() {
        let log = log_at((0..1000).map(|_| (-1.0, 8.0, 400.0)), |k| k as f64 * PERIOD + if k < 437 { 0.0 } else { 0.1 });
        let windows = find(&log).unwrap();
        assert!(windows.iter().all(|rows| rows.end <= 437 || rows.start >= 437), "{windows:?}");
        assert_eq!(windows.len(), 2);
        assert_eq!(between(&log, TimeWindow { from: 0.0, to: 2.0 }).unwrap(), [0..437, 437..1000]);
    }

    #[test]
    fn named_windows_include_their_ends_and_short_ones_are_errors() {
        let log = log((0..1000).map(|_| (-1.0, 8.0, 400.0)));
        assert_eq!(between(&log, TimeWindow { from: 0.1, to: 0.2 }).unwrap(), vec![100..201; 1]);
        let short = between(&log, TimeWindow { from: 0.0995, to: 0.1285 });
        assert_eq!(short, Err(ErrorKind::Window { from: 0.0995, to: 0.1285, rows: 29, least: 30, start: 0.0, end: 0.999 }.into()));
        let outside = between(&log, TimeWindow { from: 5.0, to: 6.0 });
        assert_eq!(outside, Err(ErrorKind::Window { from: 5.0, to: 6.0, rows: 0, least: 30, start: 0.0, end: 0.999 }.into()));
    }

    #[test]
    fn at_most_paper_rows_keeps_the_last_rows() {
        assert_eq!(at_most_paper_rows(&[100..5000, 6000..6100, 0..4000, 0..4001]), [1000..5000, 6000..6100, 0..4000, 1..4001]);
    }

    /// 10 A along q with a ripple of i_d, A, 25 rows long; i_q falls by `drift` A over the log.
    fn rippling_log(ripple: f64, drift: f64) -> Log {
        let rows = (0..4000).map(|k| {
            let k = f64::from(k);
            (-2.0 + ripple * (TAU * k / 25.0).sin(), 10.0 - drift * k / 4000.0, 418.879)
        });
        log_at(rows, |k| k as f64 * 1e-4)
    }

    /// Blocks may differ by 1 % of the largest current, 10.2 A; a larger ripple divides the window, or leaves nothing of it.
    #[test]
    fn a_rippling_operating_point_is_one_window() {
        for ripple in [0.05, 0.12, 0.15, 0.25, 0.4] {
            let windows = find(&rippling_log(ripple, 0.0)).unwrap();
            assert!(windows.len() == 1 && windows[0].len() > 3500, "{ripple} A: {windows:?}");
        }
    }

    /// A slow fall of i_q by 6 % makes several operating points, with a ripple or without.
    #[test]
    fn a_drifting_current_is_not_one_window() {
        for ripple in [0.0, 0.12] {
            let windows = find(&rippling_log(ripple, 0.6)).unwrap_or_default();
            assert!(windows.iter().all(|window| window.len() < 2000), "{ripple} A: {windows:?}");
        }
    }
}
