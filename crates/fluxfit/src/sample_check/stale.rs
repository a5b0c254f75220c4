//! Stale samples: values that a recorder repeats while the drive moves on, of one column or of whole rows.
//!
//! A drive that stands still repeats values too: a simulation without noise that has settled, a duty that is held, a locked rotor. There
//! the column comes to rest in small steps, or is at rest in much of the log, or both voltages rest together. A stale sample interrupts
//! a column that moves in nearly every row, and the next ones are as far away as usual.

use super::{
    finding::{SampleFault, SampleFinding},
    rows::{live, median, runs, with_row_before},
};
use crate::log::Log;
use std::{collections::BTreeSet, ops::Range};

/// A column moves if fewer than this share of its rows repeat the value before. Coarse digits repeat more.
const SELDOM: f64 = 0.05;

/// Repetitions are stale if noise in digits would bring one of that length with less than this probability in the whole log.
const BY_CHANCE: f64 = 0.01;

/// Fewest repetitions in a row of one column. Two equal values are no sign of anything.
const FEWEST: usize = 2;

/// Longest run of repeated rows. What lasts longer is a state of the drive, or is left out as frozen when the log is read.
const LONGEST: usize = 30;

/// The step into a run, and out of it, is at least this share of the column's median step; what settles ends in smaller ones.
const STEP_IN: f64 = 0.05;
const STEP_OUT: f64 = 0.5;

/// Another column moves in at least this share of the rows of a run.
const OTHERS_MOVE: f64 = 0.5;

/// Stale rows first, then stale samples of each column.
pub(super) fn find(log: &Log) -> Vec<SampleFinding> {
    let stale_rows = whole_rows(log);
    let of_rows = SampleFinding::of(SampleFault::Stale, None, &stale_rows, log);
    let of_column = |(name, _): (&'static str, &[f64])| SampleFinding::of(SampleFault::Stale, Some(name), &of_column(log, name), log);
    of_rows.into_iter().chain(live(log).into_iter().filter_map(of_column)).collect()
}

/// The rows in which one column repeats its value while others move.
fn of_column(log: &Log, name: &str) -> Vec<usize> {
    let columns = live(log);
    let Some((_, values)) = columns.into_iter().find(|(other, _)| *other == name) else { return Vec::new() };
    let all = with_row_before(log.segments()).count().max(1) as f64;
    let repeated: Vec<usize> = with_row_before(log.segments()).filter(|row| values[*row] == values[row - 1]).collect();
    if repeated.is_empty() || repeated.len() as f64 > SELDOM * all {
        return Vec::new();
    }
    let single = (runs(&repeated).filter(|run| run.len() == 1).count() + 1) as f64 / all;
    let least = FEWEST.max(((BY_CHANCE / all).ln() / single.ln()).ceil() as usize);
    let step = median_step(values, log);
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    // A converter at its limit, or a quantity that is switched off.
    let is_limit = |value: f64| value == low || value == high || value == 0.0;
    let others = columns.into_iter().filter(|(other, _)| *other != name && is_evidence(name, other));
    let moving: Vec<(&[f64], f64)> = others.map(|(_, values)| (values, median_step(values, log))).collect();
    let others_move = |run: &Range<usize>| {
        let moves = |(values, step): &(&[f64], f64)| {
            let moved = run.clone().filter(|row| (values[*row] - values[row - 1]).abs() > STEP_IN * step).count();
            *step > 0.0 && moved as f64 >= OTHERS_MOVE * run.len() as f64
        };
        moving.iter().any(moves)
    };
    let is_candidate = |run: &Range<usize>| run.len() >= least && !is_limit(values[run.start]) && others_move(run);
    interruptions(values, runs(&repeated).filter(is_candidate), step, log).into_iter().flatten().collect()
}

/// A drive that is told a duty holds both its voltages whatever the currents do, so only the other voltage shows that one is stale.
fn is_evidence(column: &str, other: &str) -> bool {
    !column.starts_with('u') || other.starts_with('u')
}

/// The rows in which nothing changes though both currents move in the other rows.
fn whole_rows(log: &Log) -> Vec<usize> {
    let (columns, speed) = (live(log), log.columns().omega_e.as_slice());
    let theta_e = log.columns().theta_e.as_deref();
    let repeats = |row: &usize| {
        columns.iter().all(|(_, values)| values[*row] == values[row - 1])
            && speed[*row] == speed[row - 1]
            && theta_e.is_none_or(|theta_e| theta_e[*row] == theta_e[row - 1])
    };
    let (repeated, fresh): (Vec<usize>, Vec<usize>) = with_row_before(log.segments()).partition(repeats);
    let currents = [columns[2].1, columns[3].1];
    let moves = |values: &&[f64]| {
        let still = fresh.iter().filter(|row| values[**row] == values[*row - 1]).count();
        (still as f64) < SELDOM * fresh.len() as f64
    };
    if repeated.is_empty() || !currents.iter().all(moves) {
        return Vec::new();
    }
    let steps = currents.map(|values| median(fresh.iter().map(|row| (values[*row] - values[row - 1]).abs())));
    let short: Vec<Range<usize>> = runs(&repeated).filter(|run| run.len() < LONGEST).collect();
    let of_current = |(values, step)| interruptions(values, short.iter().cloned(), step, log);
    let stale: BTreeSet<usize> = currents.into_iter().zip(steps).flat_map(of_current).flatten().collect();
    stale.into_iter().collect()
}

/// The repetitions that interrupt a column that moves: they come with a step, and go with one that is as large as usual. A single step
/// may be small by chance, so the median over all repetitions counts.
fn interruptions(values: &[f64], runs: impl Iterator<Item = Range<usize>>, step: f64, log: &Log) -> Vec<Range<usize>> {
    let segments = log.segments();
    let is_inside = |run: &Range<usize>| {
        let segment = segments.get(segments.partition_point(|segment| segment.rows.end <= run.start));
        segment.is_some_and(|segment| run.start >= segment.rows.start + 2 && run.end < segment.rows.end)
    };
    let found: Vec<Range<usize>> = runs.filter(is_inside).collect();
    let median_step_at = |row: fn(&Range<usize>) -> usize| median(found.iter().map(|run| (values[row(run)] - values[row(run) - 1]).abs()));
    // The first of the equal values is the row before the run.
    let (come, go) = (median_step_at(|run| run.start - 1), median_step_at(|run| run.end));
    if step > 0.0 && come >= STEP_IN * step && go >= STEP_OUT * step { found } else { Vec::new() }
}

fn median_step(values: &[f64], log: &Log) -> f64 {
    median(with_row_before(log.segments()).map(|row| (values[row] - values[row - 1]).abs()))
}
