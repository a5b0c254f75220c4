//! Spikes: single rows or short runs whose voltage, current, speed or DC voltage no drive had.
//!
//! A lost byte, a counter that overflows or a disturbed converter writes a value far beyond everything else in its column, and the next
//! rows are as before. Such rows are left out, as a gap. A row is one if its value is many times the largest of all other rows, *and*
//! nothing that would have to come with it is in the log:
//!
//! - speed: the rotor would have to accelerate as no rotor can;
//! - voltage: `L di/dt = u - R i - e`, so the currents of the next rows would have to change as never elsewhere in the log;
//! - current: by the same equation, the voltages of the rows around would have to;
//! - DC voltage: its capacitor holds it.
//!
//! A pulse of voltage that acted, a current that was driven, and whatever repeats or lasts are kept: a spike that stays costs accuracy,
//! a transient that is lost costs a parameter. Smaller errors are left to the residuals of the fit.

use super::columns::Columns;
use std::ops::Range;

/// A spike is this many times as large as every row that is none. Real pulses within a few rows reach that too; they are told apart by
/// what comes with them.
const FACTOR: f64 = 10.0;

/// Rows of a spike. What lasts longer is a state of the drive.
const MAX_RUN: usize = 3;

/// Rows that may be spikes: this share of all, or as many as one run. What comes more often is a signal.
const MAX_SHARE: f64 = 1e-3;

/// Fewest rows of a log in which anything can be called unlike the rest.
const LEAST_ROWS: usize = 50;

/// Largest acceleration of a rotor, electrical rad/s²: small servo motors reach 2e5 mechanical, at up to ten pole pairs.
const MAX_ACCELERATION: f64 = 2e6;

/// Longest sample period, s, at which a pulse of current outlasts its row: windings have an `L/R` of 0.3 ms and more. With a longer one
/// nothing but the speed is examined.
const MAX_PERIOD: f64 = 2.5e-4;

/// Rows before and after a spike in which its cause or its effect would show: a command acts up to two rows later.
const REACH: usize = 3;

/// A short run of rows that were left out because one quantity has a value that no drive had.
#[derive(Debug, Clone, PartialEq)]
pub struct Spike {
    /// Canonical name of the column.
    pub column: &'static str,
    /// The rows, counted from 0 over all rows of its log as they were given.
    pub rows: Range<usize>,
    /// Number of the log, from 0, among those joined.
    pub log: usize,
    /// Time of the row with the largest value, s.
    pub time: f64,
    /// That value, in the column's SI unit.
    pub value: f64,
}

/// The rows that were left out of a log as [spikes](Spike), in the order of time. It prints as a sentence.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Spikes(Vec<Spike>);

impl Spikes {
    /// All of them.
    pub fn all(&self) -> &[Spike] {
        &self.0
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of rows that were left out.
    pub fn rows(&self) -> usize {
        let mut end = (0, 0);
        let mut rows = 0;
        // In order of rows: those of two quantities may overlap.
        for spike in &self.0 {
            let start = if spike.log == end.0 { spike.rows.start.max(end.1) } else { spike.rows.start };
            rows += spike.rows.end.saturating_sub(start);
            end = (spike.log, spike.rows.end.max(start));
        }
        rows
    }

    /// Adds those of a log that is joined as number `log`.
    pub(super) fn append(&mut self, other: Self, log: usize) {
        self.0.extend(other.0.into_iter().map(|spike| Spike { log, ..spike }));
    }

    /// Finds the spikes of columns whose rows without a gap in time are these.
    pub(super) fn find(columns: &Columns, segments: &[Range<usize>], sample_period: f64) -> Self {
        if columns.t.len() < LEAST_ROWS {
            return Self::default();
        }
        let speed = Quantity::of([Some(("omega_e", &columns.omega_e)), None]);
        let voltage = Quantity::of([Some(("ud", &columns.ud)), Some(("uq", &columns.uq))]);
        let current = Quantity::of([Some(("id", &columns.id)), Some(("iq", &columns.iq))]);
        let mut found: Vec<Spike> = speed.spikes(columns, segments, |run, segment| is_too_fast(columns, run, segment));
        if sample_period <= MAX_PERIOD {
            let mut runs = [voltage.runs.as_slice(), &current.runs].concat();
            runs.sort_by_key(|run| (run.start, run.end));
            for (quantity, other) in [(&voltage, &current), (&current, &voltage)] {
                let elsewhere = if quantity.runs.is_empty() { 0.0 } else { other.change_elsewhere(segments, &runs) };
                found.extend(quantity.spikes(columns, segments, |run, segment| other.is_quiet(run, segment, elsewhere)));
            }
            if let Some(u_dc) = &columns.u_dc {
                let returns = |run: &Range<usize>, segment: &Range<usize>| around(run, segment).is_some();
                found.extend(Quantity::of([Some(("u_dc", u_dc)), None]).spikes(columns, segments, returns));
            }
        }
        found.sort_by_key(|spike| (spike.rows.start, spike.rows.end));
        Self(found)
    }
}

/// One or two columns that are one quantity, and the rows in which it stands out.
struct Quantity<'a> {
    columns: [Option<(&'static str, &'a [f64])>; 2],
    /// Runs of rows that are [`FACTOR`] times as large as all others, in order.
    runs: Vec<Range<usize>>,
}

impl<'a> Quantity<'a> {
    fn of(columns: [Option<(&'static str, &'a Vec<f64>)>; 2]) -> Self {
        let columns = columns.map(|column| column.map(|(name, values)| (name, values.as_slice())));
        let mut quantity = Self { columns, runs: Vec::new() };
        quantity.runs = quantity.outstanding();
        quantity
    }

    /// Squared magnitude of a row.
    fn squared(&self, row: usize) -> f64 {
        self.columns.iter().flatten().map(|(_, values)| values[row] * values[row]).sum()
    }

    /// The runs of rows that stand out, none of them long.
    fn outstanding(&self) -> Vec<Range<usize>> {
        let rows = self.columns.iter().flatten().map(|(_, values)| values.len()).next().unwrap_or(0);
        let most = MAX_RUN.max((MAX_SHARE * rows as f64) as usize);
        let step = FACTOR * FACTOR;
        let largest = (0..rows).map(|row| self.squared(row)).fold(0.0, f64::max);
        // Of nearly all logs this is all that is done.
        if (0..rows).filter(|row| step * self.squared(*row) >= largest).take(most + 1).count() > most {
            return Vec::new();
        }
        let mut order: Vec<(f64, usize)> = (0..rows).map(|row| (self.squared(row), row)).collect();
        order.select_nth_unstable_by(most, |a, b| b.0.total_cmp(&a.0));
        order.truncate(most + 1);
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        // As many rows as stand out, and none of them for long.
        let stand_out = |count: &usize| order[count - 1].0 > step * order[*count].0;
        let runs = (1..=most).rev().filter(stand_out).map(|count| runs(order[..count].iter().map(|(_, row)| *row).collect()));
        runs.into_iter().find(|runs| runs.iter().all(|run| run.len() <= MAX_RUN)).unwrap_or_default()
    }

    /// The runs that stand out and that `is_spike` finds to be spikes, given their segment.
    fn spikes(&self, columns: &Columns, segments: &[Range<usize>], is_spike: impl Fn(&Range<usize>, &Range<usize>) -> bool) -> Vec<Spike> {
        let of_run = |run: &Range<usize>| {
            let segment = segments.get(segments.partition_point(|segment| segment.end <= run.start))?;
            let is_inside = segment.end >= run.end;
            let values = || self.columns.iter().flatten().flat_map(|(name, values)| run.clone().map(|row| (*name, row, values[row])));
            let (column, row, value) = values().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
            let spike = Spike { column, rows: run.clone(), log: 0, time: columns.t[row], value };
            (is_inside && is_spike(run, segment)).then_some(spike)
        };
        self.runs.iter().filter_map(of_run).collect()
    }

    /// Whether this quantity changes around a spike of another one by no more than `elsewhere`.
    fn is_quiet(&self, run: &Range<usize>, segment: &Range<usize>, elsewhere: f64) -> bool {
        around(run, segment).is_some_and(|[before, after]| self.change(before.chain(after)) <= elsewhere)
    }

    /// Largest change within as many rows as are examined around a spike, away from all runs that stand out.
    fn change_elsewhere(&self, segments: &[Range<usize>], runs: &[Range<usize>]) -> f64 {
        const LENGTH: usize = MAX_RUN + 2 * REACH;
        let starts =
            segments.iter().flat_map(|segment| segment.clone().step_by(LENGTH / 2).take_while(|start| start + LENGTH <= segment.end));
        let is_elsewhere = |start: &usize| {
            let next = runs.partition_point(|run| run.end + LENGTH <= *start);
            runs.get(next).is_none_or(|run| run.start >= start + 2 * LENGTH)
        };
        starts.filter(is_elsewhere).map(|start| self.change(start..start + LENGTH)).fold(0.0, f64::max)
    }

    /// Largest change among these rows.
    fn change(&self, rows: impl Iterator<Item = usize> + Clone) -> f64 {
        let range = |values: &[f64]| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = rows.clone().fold(ends, |(low, high), row| (values[row].min(low), values[row].max(high)));
            high - low
        };
        self.columns.iter().flatten().map(|(_, values)| range(values)).fold(0.0, f64::hypot)
    }
}

/// Neighbouring rows as runs, in order.
fn runs(mut rows: Vec<usize>) -> Vec<Range<usize>> {
    rows.sort_unstable();
    rows.chunk_by(|one, next| one + 1 == *next).map(|run| run[0]..run[0] + run.len()).collect()
}

/// The rows within reach before and after a run; `None` where the log does not show what follows, or what was before.
fn around(run: &Range<usize>, segment: &Range<usize>) -> Option<[Range<usize>; 2]> {
    let is_shown = run.start >= segment.start + REACH && run.end + REACH <= segment.end;
    is_shown.then(|| [run.start - REACH..run.start, run.end..run.end + REACH])
}

/// Whether the speed changes faster than that of any rotor: into the run and out of it, as far as the segment shows both.
fn is_too_fast(columns: &Columns, run: &Range<usize>, segment: &Range<usize>) -> bool {
    let (t, omega_e) = (&columns.t, &columns.omega_e);
    let jumps = |at: usize| (omega_e[at] - omega_e[at - 1]).abs() > MAX_ACCELERATION * (t[at] - t[at - 1]);
    let edges = [(run.start > segment.start, run.start), (run.end < segment.end, run.end)];
    let mut shown = edges.into_iter().filter(|(is_shown, _)| *is_shown).map(|(_, at)| at).peekable();
    shown.peek().is_some() && shown.all(jumps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        log::{Log, LogBuilder},
        optimizer::Draws,
    };

    const PERIOD: f64 = 1e-4;

    /// A winding of 50 mOhm and 0.1 mH at 400 rad/s, 10 kHz: what the currents do of these voltages, with noise.
    fn log(rows: usize, uq: impl Fn(usize) -> f64) -> Columns {
        let mut draws = Draws::seeded(3, 0);
        let mut columns = Columns::default();
        let mut current = 0.0;
        for k in 0..rows {
            let voltage = uq(k);
            columns.t.push(k as f64 * PERIOD);
            columns.ud.push(0.01 * draws.normal());
            columns.uq.push(voltage + 0.01 * draws.normal());
            columns.id.push(0.05 * draws.normal());
            columns.iq.push(current + 0.05 * draws.normal());
            columns.omega_e.push(400.0 + draws.normal());
            current += PERIOD / 1e-4 * (voltage - 0.05 * current);
        }
        columns
    }

    /// Steps between 0.5 and 1 V every hundred rows.
    fn steps(k: usize) -> f64 {
        if (k / 100).is_multiple_of(2) { 0.5 } else { 1.0 }
    }

    fn with(mut columns: Columns, change: impl Fn(&mut Columns)) -> Log {
        change(&mut columns);
        Log::new(columns).unwrap()
    }

    fn rows_of(log: &Log) -> Vec<(&'static str, Range<usize>)> {
        log.spikes().all().iter().map(|spike| (spike.column, spike.rows.clone())).collect()
    }

    #[test]
    fn a_row_that_no_drive_had_is_left_out_as_a_gap() {
        type Change = fn(&mut Columns, f64);
        let changes: [(&str, Change); 5] = [
            ("ud", |c, value| c.ud[350] = value),
            ("uq", |c, value| c.uq[350] = value),
            ("id", |c, value| c.id[350] = value),
            ("iq", |c, value| c.iq[350] = value),
            ("omega_e", |c, value| c.omega_e[350] = value),
        ];
        let clean = log(1000, steps);
        for (column, change) in changes {
            for value in [1e5, -1e6, 1e9] {
                let log = with(clean.clone(), |columns| change(columns, value));
                assert_eq!(rows_of(&log), [(column, 350..351)], "{value}");
                let spike = &log.spikes().all()[0];
                assert_eq!((spike.value, spike.time, log.spikes().rows()), (value, 0.035, 1));
                assert_eq!(log.rows(), 999);
                let segments: Vec<_> = log.segments().iter().map(|segment| segment.rows.clone()).collect();
                assert_eq!(segments, [0..350, 350..999]);
            }
        }
        assert!(with(clean, |_| ()).spikes().is_empty());
    }

    #[test]
    fn a_row_of_garbage_and_the_first_and_last_row_are_found() {
        let garbage = |columns: &mut Columns| {
            for row in [0, 500, 501, 999] {
                columns.omega_e[row] = 4e7;
                columns.uq[row] = -3e7;
                columns.iq[row] = 5e6;
            }
        };
        // The log does not show what voltage and current did before its first row, so there the speed alone decides. A run is at most
        // three rows: more are a thousandth of the log.
        let log = with(log(5000, steps).clone(), garbage);
        assert_eq!(log.spikes().rows(), 4);
        assert_eq!(log.rows(), 4996);
    }

    /// The drive is never at rest or never slow, and nothing of it is taken away.
    #[test]
    fn transients_are_kept() {
        let count = |columns: Columns| rows_of(&Log::new(columns).unwrap());
        // One pulse of two rows, thirty times the voltage of the rest: the current answers.
        assert_eq!(count(log(1000, |k| if (500..502).contains(&k) { 30.0 } else { 1.0 })), []);
        // There and back: the current stands out as well, for three rows.
        assert_eq!(count(log(1000, |k| [30.0, 0.0, -30.0].get(k.wrapping_sub(500)).copied().unwrap_or(0.05))), []);
        // Two such pulses, and one with a disturbed measurement elsewhere, which is left out.
        let twice = |k: usize| [30.0, 0.0, -30.0].get(k.wrapping_sub(500).min(k.wrapping_sub(700))).copied().unwrap_or(0.05);
        let mut disturbed = log(5000, twice);
        disturbed.uq[2000] = 45.0;
        assert_eq!(count(disturbed), [("uq", 2000..2001)]);
        // Short pulses again and again.
        assert_eq!(count(log(1000, |k| if k % 50 == 0 { 30.0 } else { 0.0 })), []);
        // A log that ends when a step begins, and one that begins when it ends.
        assert_eq!(count(log(1000, |k| if k >= 998 { 30.0 } else { 1.0 })), []);
        assert_eq!(count(log(1000, |k| if k < 2 { 30.0 } else { 1.0 })), []);
        // A start from standstill in four milliseconds.
        let mut start = log(1000, steps);
        start.omega_e.iter_mut().enumerate().for_each(|(k, omega_e)| *omega_e = 5000.0 * ((k as f64 - 900.0) / 40.0).clamp(0.0, 1.0));
        assert_eq!(count(start), []);
        // An encoder that counts one step in the whole log, as a speed: 2 pi 4 / 4096 rad in a row.
        let mut still = log(1000, steps);
        still.omega_e.fill(0.0);
        still.omega_e[400] = 61.0;
        assert_eq!(count(still), []);
    }

    /// A recorder's row may hold a whole transient: of it, only the speed is examined.
    #[test]
    fn rows_of_a_recorder_may_jump() {
        let mut slow = log(1000, steps);
        slow.t.iter_mut().for_each(|t| *t *= 1000.0);
        slow.uq[350] = 40.0;
        slow.iq[350] = 600.0;
        slow.omega_e[350] = 5000.0;
        assert!(Log::new(slow.clone()).unwrap().spikes().is_empty());
        slow.omega_e[350] = 1e6;
        assert_eq!(rows_of(&Log::new(slow).unwrap()), [("omega_e", 350..351)]);
    }

    #[test]
    fn rows_that_arrive_one_by_one_give_the_same_log_and_joined_logs_keep_theirs() {
        let mut columns = log(500, steps);
        columns.omega_e[123] = 1e6;
        let mut builder = LogBuilder::new();
        for k in 0..500 {
            builder.push(columns.row(k).unwrap()).unwrap();
        }
        let (whole, by_row) = (Log::new(columns).unwrap(), builder.finish().unwrap());
        assert_eq!(whole.spikes(), by_row.spikes());
        assert_eq!(whole, by_row);
        let joined = Log::join([by_row, whole]).unwrap();
        assert_eq!(joined.spikes().all().iter().map(|spike| spike.log).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(joined.spikes().rows(), 2);
    }
}
