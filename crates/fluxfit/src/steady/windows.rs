//! Where the drive stands still: finding steady windows, or taking those that were named.
//!
//! A segment is cut into short blocks. A block is steady when its two halves agree, in both currents and in speed; steady
//! neighbours that agree with the mean of the window so far join it. Agreement is a small fraction of the log's largest current
//! and speed, or what the noise of the means allows. Blocks without current are left out: while a drive coasts, its voltage
//! columns are not voltages that act.

use super::{hold::mended, repeats::Repeats};
use crate::{
    error::Error,
    log::{Log, Segment},
};
use std::{f64::consts::TAU, ops::Range};

/// Fewest rows of a window: a few autocorrelation times, and rows enough for a covariance.
pub const MIN_ROWS: usize = 30;

/// Rows per block: a five-hundredth of the log within these limits. Short against a steady stretch, long against the noise.
pub(super) const BLOCK_ROWS: (usize, usize) = (10, 500);

/// A window has at least this many blocks: one could be chance.
const MIN_BLOCKS: usize = 3;

/// A window is at least this fraction of the longest: what is shorter is a pause between transients rather than a point at which
/// the drive was held.
const MIN_SHARE: f64 = 0.2;

/// Means agree within this fraction of the log's largest value. The equations of the means hold while currents drift; what this
/// keeps out are transients that sampling and filters distort.
pub(super) const TOLERANCE: f64 = 0.01;

/// The currents at a window's ends agree with its middle half within this fraction, or they are cut off: a tenth of the above.
const END_TOLERANCE: f64 = 0.001;

/// The currents of a window's halves agree within this fraction: half of what its blocks may differ.
pub(super) const HALVES_TOLERANCE: f64 = 0.005;

/// Ripples of dead time and device drops per electrical turn.
const RIPPLES_PER_TURN: f64 = 6.0;

/// Blocks that average a ripple are taken where they see this many times the rows that short ones do.
const MUCH_MORE: usize = 2;

/// Means agree within this many standard deviations of their difference.
const NOISE_FACTOR: f64 = 4.0;

/// Currents below this fraction of the log's largest carry no information, and may belong to a drive that is not switching.
const MIN_CURRENT: f64 = 0.01;

/// Longest window for the study of the paper's fitness: its sample count.
pub const PAPER_ROWS: usize = 4000;

/// Finds the steady windows of a log, in order; of several logs joined, those of each by itself.
///
/// # Errors
/// If there is none.
pub fn find(log: &Log) -> Result<Vec<Range<usize>>, Error> {
    let (windows, _) = find_all(log);
    if windows.is_empty() { Err(Error::NoOperatingPoint { least: MIN_ROWS }) } else { Ok(windows) }
}

/// The steady windows, and the stretches that are steady but too short beside them; without those that are too short beside these,
/// in which nobody can have meant to hold the drive.
pub(crate) fn find_all(log: &Log) -> (Vec<Range<usize>>, Vec<Range<usize>>) {
    let scale = Scale::of(log);
    let (mut windows, mut short) = (Vec::new(), Vec::new());
    for of_one_log in log.segments().chunk_by(|one, other| one.log == other.log) {
        let repeats = Repeats::of(log, of_one_log);
        let told = |rows: &Range<usize>| repeats.told(log, rows);
        let mut stretches = stretches_of_one_log(log, of_one_log, &scale, repeats);
        // One reading, however often it is repeated, does not show that anything is steady.
        stretches.retain(|rows| told(rows) > 1 || !repeats.any());
        let longest = stretches.iter().map(told).max().unwrap_or(0);
        let (long, rest): (Vec<_>, Vec<_>) = stretches.into_iter().partition(|rows| told(rows) as f64 >= MIN_SHARE * longest as f64);
        windows.extend(long);
        short.extend(rest.into_iter().filter(|rows| told(rows) as f64 >= MIN_SHARE * MIN_SHARE * longest as f64));
    }
    (windows, short)
}

/// The steady stretches of the segments of one log: those of short blocks; or those of blocks that average a ripple, where these
/// see much more.
fn stretches_of_one_log(log: &Log, segments: &[Segment], scale: &Scale, repeats: Repeats) -> Vec<Range<usize>> {
    let rows: usize = segments.iter().map(|segment| segment.rows.len()).sum();
    // Long blocks calm noise; a recorder's rows are too far apart for that, and a drive holds few of them.
    let short = if repeats.any() { BLOCK_ROWS.0 } else { (rows / 500).clamp(BLOCK_ROWS.0, BLOCK_ROWS.1) };
    let found = stretches(log, segments, scale, |_, _| short);
    let averaging = stretches(log, segments, scale, |segment, start| {
        let turn = (log.columns().omega_e[start] * segment.sample_period).abs();
        short.max((2.0 * TAU / (RIPPLES_PER_TURN * turn)).round().min(BLOCK_ROWS.1 as f64) as usize)
    });
    let rows_of = |windows: &[Range<usize>]| windows.iter().map(ExactSizeIterator::len).sum::<usize>();
    if rows_of(&averaging) > MUCH_MORE * rows_of(&found) { averaging } else { found }
}

/// The steady stretches under blocks of so many rows, which may depend on where a block starts.
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
    let mut windows = mended(log, windows, scale);
    let least = MIN_ROWS.max(MIN_BLOCKS * shortest.min(BLOCK_ROWS.1));
    windows.retain(|rows| rows.len() >= least);
    windows
}

/// The rows of each segment between two times, s, both included.
///
/// # Errors
/// If no segment has enough rows between them.
pub fn between(log: &Log, (from, to): (f64, f64)) -> Result<Vec<Range<usize>>, Error> {
    let t = &log.columns().t;
    let within = log.segments().iter().map(|segment| {
        let times = &t[segment.rows.clone()];
        segment.rows.start + times.partition_point(|t| *t < from)..segment.rows.start + times.partition_point(|t| *t <= to)
    });
    let (windows, short): (Vec<_>, Vec<_>) = within.partition(|rows| rows.len() >= MIN_ROWS);
    if windows.is_empty() {
        let rows = short.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
        let (start, end) = t.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(*t), high.max(*t)));
        return Err(Error::Window { from, to, rows, least: MIN_ROWS, start, end });
    }
    Ok(windows)
}

/// The last [`PAPER_ROWS`] rows of each window: the paper's sample count, farthest from the transient before.
pub fn at_most_paper_rows(windows: &[Range<usize>]) -> Vec<Range<usize>> {
    windows.iter().map(|rows| rows.end.saturating_sub(PAPER_ROWS).max(rows.start)..rows.end).collect()
}

/// Currents below this, A, are too small to tell anything.
pub fn least_current(log: &Log) -> f64 {
    MIN_CURRENT * log.peak_current()
}

/// Rows of a log whose current is too small to tell anything: a standing or coasting drive.
pub fn rows_without_current(log: &Log) -> usize {
    let least = least_current(log);
    let columns = log.columns();
    columns.id.iter().zip(&columns.iq).filter(|(id, iq)| id.hypot(**iq) < least).count()
}

/// The log's largest current (A) and speed (rad/s): i_d, i_q, omega_e.
pub(super) struct Scale(pub(super) [f64; 3]);

impl Scale {
    fn of(log: &Log) -> Self {
        let speed = log.columns().omega_e.iter().fold(0.0_f64, |most, omega| most.max(omega.abs()));
        Self([log.peak_current(), log.peak_current(), speed])
    }

    /// Whether two triples of means agree, given the variance of their differences. Speed may always move by [`TOLERANCE`]: its
    /// slope is not in the equations.
    pub(super) fn agree(&self, current_tolerance: f64, one: &[f64; 3], other: &[f64; 3], variance: &[f64; 3]) -> bool {
        let tolerances = [current_tolerance, current_tolerance, TOLERANCE];
        (0..3).all(|c| (one[c] - other[c]).abs() <= tolerances[c] * self.0[c] + NOISE_FACTOR * variance[c].sqrt())
    }
}

pub(super) struct Block {
    rows: Range<usize>,
    /// Means of i_d, i_q, omega_e.
    pub(super) means: [f64; 3],
    /// Variances of those means, if their noise is white.
    variances: [f64; 3],
}

impl Block {
    pub(super) fn of(log: &Log, rows: Range<usize>) -> Self {
        let columns = log.columns();
        let n = rows.len() as f64;
        let channels = [&columns.id, &columns.iq, &columns.omega_e].map(|column| &column[rows.clone()]);
        let means = channels.map(|values| values.iter().sum::<f64>() / n);
        // From differences of neighbours: a slope in the block does not count as noise.
        let variances =
            channels.map(|values| values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>() / (2.0 * (n - 1.0)) / n);
        Self { rows, means, variances }
    }

    /// The block, if it is steady and carries current.
    fn steady(log: &Log, rows: Range<usize>, scale: &Scale) -> Option<Self> {
        let block = Self::of(log, rows);
        let middle = block.rows.start.midpoint(block.rows.end);
        let (first, second) = (Self::of(log, block.rows.start..middle), Self::of(log, middle..block.rows.end));
        let variance: [f64; 3] = std::array::from_fn(|c| first.variances[c] + second.variances[c]);
        let carries_current = block.means[0].hypot(block.means[1]) >= MIN_CURRENT * scale.0[0];
        (carries_current && scale.agree(TOLERANCE, &first.means, &second.means, &variance)).then_some(block)
    }
}

/// Blocks in a row that agree.
struct Window {
    blocks: Vec<Block>,
    means: [f64; 3],
}

impl Window {
    fn start(block: Block) -> Self {
        Self { means: block.means, blocks: vec![block] }
    }

    fn agrees(&self, block: &Block, scale: &Scale) -> bool {
        // The window's own mean is at least as quiet as the block's.
        scale.agree(TOLERANCE, &self.means, &block.means, &block.variances.map(|variance| 2.0 * variance))
    }

    fn join(&mut self, block: Block) {
        let share = 1.0 / (self.blocks.len() + 1) as f64;
        self.means = std::array::from_fn(|c| self.means[c] + share * (block.means[c] - self.means[c]));
        self.blocks.push(block);
    }

    /// The rows, without the tails of the transients at the ends; none if the window drifts as a whole.
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

fn mean_of(blocks: &[Block]) -> [f64; 3] {
    std::array::from_fn(|c| blocks.iter().map(|block| block.means[c]).sum::<f64>() / blocks.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    const PERIOD: f64 = 1e-3;

    /// A log of (i_d, i_q, omega_e) per row, one millisecond apart; voltages that nobody reads here.
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
    fn two_plateaus_between_ramps_are_found_whole() {
        // Rows 0..300 rise, 300..800 hold, 800..1000 rise, 1000..1600 hold, 1600..1900 fall. Blocks have 10 rows.
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
        // A block counts by its mean, and noise is read from neighbours, so a block or two either way.
        assert!((290..=350).contains(&windows[0].start) && windows[0].end == 2000, "{windows:?}");
    }

    #[test]
    fn a_coasting_drive_is_left_out_and_counted() {
        // 0.5 % of the current while the speed holds.
        let rows = (0..1200).map(|k| if k < 600 { (0.0, 8.0, 400.0) } else { (0.0, 0.04, 400.0) });
        let log = log(rows);
        assert_eq!(find(&log).unwrap(), vec![0..600; 1]);
        assert_eq!(rows_without_current(&log), 600);
    }

    #[test]
    fn where_nothing_stands_still_there_is_no_operating_point() {
        let rows = ramp(1.0, 9.0, 1000).map(|iq| (0.0, iq, 400.0));
        assert_eq!(find(&log(rows)), Err(Error::NoOperatingPoint { least: 30 }));
        // A slow swing of 10 %: steady from block to block, never over a window.
        let rows = (0..4000).map(|k| (0.0, 8.0 + 0.8 * (f64::from(k) / 100.0).sin(), 400.0));
        assert!(find(&log(rows)).map_or_else(|_| true, |windows| windows.iter().all(|rows| rows.len() < 100)));
    }

    #[test]
    fn no_window_crosses_a_gap_in_time() {
        let log = log_at((0..1000).map(|_| (-1.0, 8.0, 400.0)), |k| k as f64 * PERIOD + if k < 437 { 0.0 } else { 0.1 });
        let windows = find(&log).unwrap();
        assert!(windows.iter().all(|rows| rows.end <= 437 || rows.start >= 437), "{windows:?}");
        assert_eq!(windows.len(), 2);
        assert_eq!(between(&log, (0.0, 2.0)).unwrap(), [0..437, 437..1000]);
    }

    #[test]
    fn named_windows_hold_their_ends_and_a_short_one_says_what_it_has() {
        let log = log((0..1000).map(|_| (-1.0, 8.0, 400.0)));
        assert_eq!(between(&log, (0.1, 0.2)).unwrap(), vec![100..201; 1]);
        let short = between(&log, (0.0995, 0.1285));
        assert_eq!(short, Err(Error::Window { from: 0.0995, to: 0.1285, rows: 29, least: 30, start: 0.0, end: 0.999 }));
        let outside = between(&log, (5.0, 6.0));
        assert_eq!(outside, Err(Error::Window { from: 5.0, to: 6.0, rows: 0, least: 30, start: 0.0, end: 0.999 }));
    }

    #[test]
    fn the_papers_rows_are_the_last_ones() {
        assert_eq!(at_most_paper_rows(&[100..5000, 6000..6100, 0..4000, 0..4001]), [1000..5000, 6000..6100, 0..4000, 1..4001]);
    }
}
