//! Windows of a recorder's log: rows that come far slower than any drive controls, 5 to 100 a second, and are mostly the drive's own means.
//!
//! One such row says as much as hundreds of a drive's samples. So a window is counted in seconds and in a few rows, and what holds in the
//! mean need not stand still: its currents and its speed may move by a few percent, and without current the speed may do what it likes.

use super::{
    CHANNELS, OperatingPoint,
    block::{Block, MIN_CURRENT, NOISE_FACTOR, Scale, TOLERANCE},
    stale::StaleSamples,
    windows::{self, MIN_ROWS},
};
use crate::{error::Error, frames::Dq, log::Log};
use std::ops::Range;

/// Rows slower than this, Hz, are a recorder's: recorders write up to 100 a second, decimated logs of a drive come faster.
const FASTEST: f64 = 200.0;

/// Shortest window, s: a hundred time constants of a winding of 2 ms, so that no transient of the currents is left in its mean.
const SHORTEST: f64 = 0.2;

/// Fewest rows of a window: their scatter about a straight line has two degrees of freedom.
const FEWEST_ROWS: usize = 4;

/// Where the windows that are steady to [`TOLERANCE`] are fewer kinds than this, those that are steady to [`LOOSE`] are taken too: two
/// kinds tell four unknowns, and contradictions show from the third on.
const ENOUGH_KINDS: usize = 4;

/// Currents and speed of the other windows stay within this part of the log's largest: what means of products lose by it is its square.
const LOOSE: f64 = 0.05;

/// Voltages of a window whose halves differ by more than this part of them are of other currents or speeds than its rows say: a value that
/// the recorder repeats looks steady. What steady currents and speeds move them by is less, even if they are steady to [`LOOSE`].
const VOLTAGES_MOVE: f64 = 0.1;

/// Windows whose means differ by less than this part of the log's largest current and speed are of one kind.
const SAME_KIND: f64 = 0.05;

/// Most windows of either sort; more of the same kinds say nothing new.
const MOST_WINDOWS: usize = 60;

/// Rows of a piece of a stretch without current: the speed falls, and each piece has its own.
const COASTING_ROWS: usize = 6;

/// Least speed of such a piece, as a part of the largest: below it the voltage is too small to say anything.
const LEAST_SPEED: f64 = 0.1;

/// Whether the rows are a recorder's.
pub(crate) fn is_recorders(log: &Log) -> bool {
    log.segments().iter().all(|segment| is_period_of_recorder(segment.sample_period))
}

/// Whether a recorder's rows come this far apart, s.
pub(crate) fn is_period_of_recorder(sample_period: f64) -> bool {
    sample_period * FASTEST >= 1.0
}

/// Whether the rows repeat the values of rows before them, as those of a recorder that writes faster than the drive reports.
pub(crate) fn repeats_values(log: &Log) -> bool {
    StaleSamples::of(log, log.segments()).are_present()
}

/// The windows with current, in order.
///
/// # Errors
/// If there is none.
pub(crate) fn loaded(log: &Log) -> Result<Vec<Range<usize>>, Error> {
    let (mut found, _) = windows::find_all(log);
    found.retain(|rows| voltages_stand(log, rows));
    // Repeated samples are rows without news: a few of them are no window.
    let are_stale = repeats_values(log);
    if !are_stale {
        let scale = Scale::of(log);
        for tolerance in [TOLERANCE, LOOSE] {
            if kinds(log, &found, &scale).len() < ENOUGH_KINDS {
                let more = free(log, &found).into_iter().flat_map(|rows| steady_runs(log, rows, tolerance, &scale));
                found.extend(more.filter(|rows| voltages_stand(log, rows)).collect::<Vec<_>>());
            }
        }
        found = different(kinds(log, &found, &scale));
    }
    let least = if are_stale { MIN_ROWS } else { FEWEST_ROWS };
    if found.is_empty() { Err(windows::no_operating_point(log, least)) } else { Ok(found) }
}

/// Pieces of the stretches in which the rotor turns without current, in order.
pub(crate) fn coasting(log: &Log) -> Vec<Range<usize>> {
    let columns = log.columns();
    let (least_current, least_speed) = (windows::least_current(log), LEAST_SPEED * Scale::of(log).0[2]);
    let coasts = |row: usize| columns.id[row].hypot(columns.iq[row]) < least_current && columns.omega_e[row].abs() > least_speed;
    let mut pieces = Vec::new();
    for segment in log.segments() {
        let rows: Vec<usize> = segment.rows.clone().collect();
        for run in rows.chunk_by(|one, other| coasts(*one) == coasts(*other)).filter(|run| coasts(run[0]) && run.len() >= FEWEST_ROWS) {
            let count = (run.len() / COASTING_ROWS).max(1);
            let cut = |piece: usize| run[0] + run.len() * piece / count;
            pieces.extend((0..count).map(|piece| cut(piece)..cut(piece + 1)));
        }
    }
    let every = pieces.len().div_ceil(MOST_WINDOWS).max(1);
    pieces.into_iter().step_by(every).collect()
}

/// Gives windows of a few rows the noise that they have on average, those with current, those without and the slow ones: the scatter of a
/// few rows is a poor estimate of their own.
pub(crate) fn pool_noise(points: &mut [OperatingPoint], least_current: f64) {
    for with_current in [true, false] {
        let is_one = |point: &OperatingPoint| point.rows.len() < MIN_ROWS && (point.current().magnitude() >= least_current) == with_current;
        let degrees: usize = points.iter().filter(|point| is_one(point)).map(|point| point.degrees_of_freedom).sum();
        let mut of_a_row = [[0.0; CHANNELS]; CHANNELS];
        let mut of_a_slope = Dq::default();
        for point in points.iter().filter(|point| is_one(point)) {
            let share = point.degrees_of_freedom as f64 / degrees as f64;
            let weight = share * point.rows.len() as f64;
            for (sums, row) in of_a_row.iter_mut().zip(&point.covariance) {
                sums.iter_mut().zip(row).for_each(|(sum, entry)| *sum += weight * entry);
            }
            of_a_slope.d += share * point.drift_variance.d;
            of_a_slope.q += share * point.drift_variance.q;
        }
        for point in points.iter_mut().filter(|point| is_one(point)) {
            point.covariance = of_a_row.map(|row| row.map(|entry| entry / point.rows.len() as f64));
            (point.drift_variance, point.degrees_of_freedom) = (of_a_slope, degrees);
        }
    }
}

/// Whether the voltages' means of both halves of a window agree, within [`VOLTAGES_MOVE`] and their noise.
fn voltages_stand(log: &Log, rows: &Range<usize>) -> bool {
    let middle = rows.start.midpoint(rows.end);
    let [d, q] = [&log.columns().ud, &log.columns().uq].map(|column| {
        let mean = |rows: Range<usize>| column[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let (first, second) = (mean(rows.start..middle), mean(middle..rows.end));
        // From differences of neighbours: what moves does not count as noise.
        let steps = column[rows.clone()].windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>();
        let variance = steps / (2 * (rows.len() - 1)) as f64 * 4.0 / rows.len() as f64;
        ((second - first).powi(2), ((first + second) / 2.0).powi(2), variance)
    });
    let [moved, voltage, noise] = [d.0 + q.0, d.1 + q.1, d.2 + q.2].map(f64::sqrt);
    moved <= VOLTAGES_MOVE * voltage + NOISE_FACTOR * noise
}

/// The rows of each segment that no window has.
fn free(log: &Log, taken: &[Range<usize>]) -> Vec<Range<usize>> {
    let is_free = |row: usize| !taken.iter().any(|rows| rows.contains(&row));
    let mut free = Vec::new();
    for segment in log.segments() {
        let rows: Vec<usize> = segment.rows.clone().collect();
        let runs = rows.chunk_by(|one, other| is_free(*one) == is_free(*other)).filter(|run| is_free(run[0]));
        free.extend(runs.map(|run| run[0]..run[run.len() - 1] + 1));
    }
    free
}

/// Runs of rows with current whose currents and speed stay within a tolerance, the earliest first, each as long as it gets.
fn steady_runs(log: &Log, rows: Range<usize>, tolerance: f64, scale: &Scale) -> Vec<Range<usize>> {
    let columns = log.columns();
    let value = |row: usize| [columns.id[row], columns.iq[row], columns.omega_e[row]];
    let carries_current = |[id, iq, _]: [f64; 3]| id.hypot(iq) >= MIN_CURRENT * scale.0[0];
    let mut runs = Vec::new();
    let mut start = rows.start;
    while start < rows.end {
        let (mut low, mut high) = (value(start), value(start));
        let mut end = start;
        while end < rows.end && carries_current(value(end)) {
            let next = value(end);
            (0..3).for_each(|c| (low[c], high[c]) = (low[c].min(next[c]), high[c].max(next[c])));
            if (0..3).any(|c| high[c] - low[c] > tolerance * scale.0[c]) {
                break;
            }
            end += 1;
        }
        if end - start >= FEWEST_ROWS && columns.t[end - 1] - columns.t[start] >= SHORTEST {
            runs.push(start..end);
            start = end;
        } else {
            start += 1;
        }
    }
    runs
}

/// Windows by kind, the longest of each first.
fn kinds(log: &Log, found: &[Range<usize>], scale: &Scale) -> Vec<Vec<Range<usize>>> {
    let mut kinds: Vec<([f64; 3], Vec<Range<usize>>)> = Vec::new();
    for rows in found {
        let means = Block::of(log, rows.clone()).means;
        let same = |(other, _): &&mut ([f64; 3], _)| (0..3).all(|c| (means[c] - other[c]).abs() <= SAME_KIND * scale.0[c]);
        match kinds.iter_mut().find(same) {
            Some((_, kind)) => kind.push(rows.clone()),
            None => kinds.push((means, vec![rows.clone()])),
        }
    }
    let longest_first = |mut kind: Vec<Range<usize>>| {
        kind.sort_by_key(|rows| std::cmp::Reverse(rows.len()));
        kind
    };
    kinds.into_iter().map(|(_, kind)| longest_first(kind)).collect()
}

/// At most as many windows as are worth their time: the longest of each kind, then the second of each, and so on; in order.
fn different(kinds: Vec<Vec<Range<usize>>>) -> Vec<Range<usize>> {
    let most = kinds.iter().map(Vec::len).max().unwrap_or(0);
    let in_turn = (0..most).flat_map(|place| kinds.iter().filter_map(move |kind| kind.get(place).cloned()));
    let mut windows: Vec<Range<usize>> = in_turn.take(MOST_WINDOWS).collect();
    windows.sort_by_key(|rows| rows.start);
    windows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    /// Ten rows a second of (i_q, omega_e).
    fn log(rows: impl IntoIterator<Item = (f64, f64)>) -> Log {
        let mut columns = Columns::default();
        for (k, (iq, omega_e)) in rows.into_iter().enumerate() {
            columns.t.push(k as f64 * 0.1);
            columns.id.push(0.0);
            columns.iq.push(iq);
            columns.omega_e.push(omega_e);
            // A voltage that changes from row to row, as no stale sample's does.
            columns.ud.push((k % 2) as f64);
            columns.uq.push(omega_e / 10.0);
        }
        Log::new(columns).unwrap()
    }

    /// Half a second at each load, and three rows that are too short for a window.
    #[test]
    fn a_few_rows_are_a_window() {
        let loads = [(5, 10.0), (3, 4.0), (6, 20.0), (4, 15.0), (5, 8.0)];
        let log = log(loads.into_iter().flat_map(|(rows, iq)| vec![(iq, 300.0); rows]));
        assert!(is_recorders(&log));
        assert_eq!(loaded(&log).unwrap(), [0..5, 8..14, 14..18, 18..23]);
    }

    /// i_q rises by 0.1 A a row: 1 % of 20 A are two rows, 5 % ten. The four loads stand still, so that the ramp is not needed.
    #[test]
    fn what_moves_is_taken_where_too_little_stands_still() {
        let ramp = || (0..11).map(|k| (10.0 + 0.1 * f64::from(k), 300.0));
        let two = [(5, 5.0), (5, 20.0)].into_iter().flat_map(|(rows, iq)| vec![(iq, 300.0); rows]);
        assert_eq!(loaded(&log(two.chain(ramp()))).unwrap(), [0..5, 5..10, 10..21]);
        let four = [(5, 5.0), (5, 20.0), (5, 15.0), (5, 7.0)].into_iter().flat_map(|(rows, iq)| vec![(iq, 300.0); rows]);
        assert_eq!(loaded(&log(four.chain(ramp()))).unwrap(), [0..5, 5..10, 10..15, 15..20]);
    }

    /// The fourth load is written down for as long as the others, while the voltage of another one, 45 V in place of 30, already acts.
    #[test]
    fn repeated_currents_under_other_voltages_are_no_window() {
        let log = log([10.0, 4.0, 20.0, 15.0, 7.0].into_iter().flat_map(|iq| vec![(iq, 300.0); 12]));
        let of_all: Vec<_> = (0..5).map(|load| 12 * load..12 * (load + 1)).collect();
        assert_eq!(loaded(&log).unwrap(), of_all);
        let mut columns = log.columns().clone();
        columns.uq[42..48].fill(45.0);
        assert_eq!(loaded(&Log::new(columns).unwrap()).unwrap(), [&of_all[..3], &of_all[4..]].concat());
    }

    /// Twelve rows without current at speed are two pieces; three rows are none, nor are those at less than a tenth of the speed.
    #[test]
    fn stretches_without_current_are_cut_in_pieces() {
        let rows = vec![(9.0, 500.0); 5].into_iter().chain((0..12).map(|k| (0.0, 500.0 - 10.0 * f64::from(k))));
        let rows = rows.chain(vec![(9.0, 400.0); 5]).chain(vec![(0.0, 300.0); 3]).chain(vec![(9.0, 300.0); 5]).chain(vec![(0.0, 30.0); 9]);
        assert_eq!(coasting(&log(rows)), [5..11, 11..17]);
    }
}
