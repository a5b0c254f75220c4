//! Rows that are no readings of a turning drive, taken out: a start where everything is zero, stretches in which a channel froze.

use super::Channels;
use crate::channel::Channel;
use Channel::{IA, IB, IC, Id, Iq, OmegaE, T, ThetaE, UA, UB, UC, Ud, Uq};
use fluxfit_units::number::significant;
use std::ops::Range;

/// Channels that are zero while a drive stands still.
const ALL: [Channel; 11] = [Ud, Uq, Id, Iq, OmegaE, UA, UB, UC, IA, IB, IC];

/// Channels that no drive holds to the bit while it runs; its speed and its DC voltage it may.
const LIVE: [Channel; 11] = [Ud, Uq, Id, Iq, UA, UB, UC, IA, IB, IC, ThetaE];

/// Fewest rows of a standstill that is worth a word.
const STANDSTILL: usize = 50;

/// A value that stays for at least this many rows,
const FROZEN: usize = 30;

/// and this many times longer than the values stay in which half of the channel's rows lie, is frozen,
const LONGER: usize = 20;

/// if another channel changes at least so often meanwhile, of its rows,
const OTHERS_CHANGE: f64 = 0.5;

/// and by at least this much, peak to peak, of its largest value: more than the last digits of a simulation that has settled.
const OTHERS_MOVE: f64 = 1e-3;

/// An angle stands still with its rotor: only if the phases go on turning, from peak to peak, is it frozen.
const PHASES_TURN: f64 = 0.5;

/// Takes rows out; says which.
pub(super) fn repair(channels: &mut Channels) -> Vec<String> {
    [standstill(channels), frozen(channels)].into_iter().flatten().collect()
}

fn standstill(channels: &mut Channels) -> Option<String> {
    let t = channels.get(T)?;
    let live: Vec<&[f64]> = ALL.iter().filter_map(|channel| channels.get(*channel)).collect();
    let still = (0..t.len()).take_while(|row| live.iter().all(|values| values[*row] == 0.0)).count();
    if still < STANDSTILL || still == t.len() {
        return None;
    }
    let note = format!("standstill: the first {still} rows, {} s, are zero in every channel and left out", significant(t[still] - t[0], 3));
    let kept: Vec<bool> = (0..t.len()).map(|row| row >= still).collect();
    channels.retain(&kept);
    Some(note)
}

fn frozen(channels: &mut Channels) -> Option<String> {
    let t = channels.get(T).filter(|t| !t.is_empty())?;
    let live: Vec<(Channel, &[f64])> = LIVE.iter().filter_map(|channel| Some((*channel, channels.get(*channel)?))).collect();
    let changes: Vec<Vec<usize>> = live.iter().map(|(_, values)| changes(values)).collect();
    let mut kept = vec![true; t.len()];
    let mut told = Vec::new();
    for (place, (channel, _)) in live.iter().enumerate() {
        let runs: Vec<(usize, usize)> = changes[place].windows(2).map(|pair| (pair[0], pair[1])).collect();
        let mut lengths: Vec<usize> = runs.iter().map(|(from, to)| to - from).collect();
        lengths.sort_unstable();
        let usual = half_of_rows(&lengths);
        let least_move = if *channel == ThetaE { PHASES_TURN } else { OTHERS_MOVE };
        for (from, to) in runs {
            let length = to - from;
            if length < FROZEN || length < LONGER * usual {
                continue;
            }
            let goes_on = |other: usize| {
                let changed = changes[other].partition_point(|row| *row < to) - changes[other].partition_point(|row| *row <= from);
                changed as f64 >= OTHERS_CHANGE * length as f64 && moves(live[other].1, from..to, least_move)
            };
            if (0..live.len()).any(|other| other != place && goes_on(other)) {
                kept[from..to].fill(false);
                let until = t[to.min(t.len() - 1)];
                told.push(format!("{} from {} s to {} s", channel.name(), significant(t[from], 6), significant(until, 6)));
            }
        }
    }
    let first = told.first()?;
    let more = if told.len() > 1 { format!(", and {} more stretches", told.len() - 1) } else { String::new() };
    let rows = kept.iter().filter(|kept| !**kept).count();
    let note = format!("a channel froze while others went on: {first}{more}; {rows} rows are left out");
    if rows + FROZEN > t.len() {
        return None;
    }
    channels.retain(&kept);
    Some(note)
}

/// The length of runs, of which at least as long ones hold half of the rows: where values come in coarse steps, a long one.
fn half_of_rows(sorted: &[usize]) -> usize {
    let all: usize = sorted.iter().sum();
    let mut rows = 0;
    let reached = |length: &&usize| {
        rows += **length;
        2 * rows >= all
    };
    sorted.iter().find(reached).copied().unwrap_or(0)
}

/// Whether a channel moves by at least this part of its largest value.
fn moves(values: &[f64], rows: Range<usize>, least: f64) -> bool {
    let (low, high) =
        values[rows].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    high - low >= least * largest
}

/// First rows of runs of one value, and behind the last one.
fn changes(values: &[f64]) -> Vec<usize> {
    let starts = (0..values.len()).filter(|row| *row == 0 || values[*row] != values[row - 1]);
    starts.chain([values.len()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DQ: [Channel; 5] = [Ud, Uq, Id, Iq, OmegaE];

    /// A log in which everything changes with every row; `change` spoils it.
    fn spoilt(change: impl Fn(&mut Channels)) -> (Vec<String>, usize) {
        let mut channels = Channels::default();
        let wave = |phase: f64| (0..1000).map(|row| 5.0 + (f64::from(row) * 0.7 + phase).sin()).collect::<Vec<_>>();
        channels.set(T, (0..1000).map(|row| f64::from(row) * 1e-3).collect());
        DQ.iter().zip(1..).for_each(|(channel, phase)| channels.set(*channel, wave(f64::from(phase))));
        change(&mut channels);
        let notes = repair(&mut channels);
        (notes, channels.rows())
    }

    fn fill(channels: &mut Channels, channel: Channel, rows: std::ops::Range<usize>, value: f64) {
        let mut values = channels.get(channel).unwrap().to_vec();
        values[rows].fill(value);
        channels.set(channel, values);
    }

    #[test]
    fn a_log_that_lives_is_left_alone() {
        assert_eq!(spoilt(|_| ()), (vec![], 1000));
        // A speed that is held, or logged in coarse steps, is no fault; nor is a pause in which nothing changes.
        assert_eq!(spoilt(|channels| fill(channels, OmegaE, 0..1000, 400.0)).1, 1000);
        assert_eq!(spoilt(|channels| DQ.iter().for_each(|channel| fill(channels, *channel, 300..500, 1.0))).1, 1000);
    }

    #[test]
    fn a_start_at_standstill_is_left_out() {
        let (notes, rows) = spoilt(|channels| DQ.iter().for_each(|channel| fill(channels, *channel, 0..200, 0.0)));
        assert_eq!((notes[0].as_str(), rows), ("standstill: the first 200 rows, 0.200 s, are zero in every channel and left out", 800));
    }

    /// Currents in steps of a tenth stay on one for long, and are none the worse.
    #[test]
    fn coarse_values_are_no_frozen_ones() {
        let coarse = |channels: &mut Channels| {
            let steps = (0..1000).map(|row| if row < 100 { f64::from(row % 7) } else { 4.0 + f64::from(row / 300) * 0.1 });
            channels.set(Iq, steps.collect());
        };
        assert_eq!(spoilt(coarse), (vec![], 1000));
    }

    #[test]
    fn an_angle_that_freezes_under_turning_phases_is_named() {
        let turning = |channels: &mut Channels| {
            let wave = |phase: f64| (0..1000).map(|row| 5.0 * (f64::from(row) * 0.1 + phase).sin()).collect::<Vec<_>>();
            [(UA, 0.3), (UB, 2.0), (IA, 1.0), (IB, 3.0)].into_iter().for_each(|(channel, phase)| channels.set(channel, wave(phase)));
            channels.set(ThetaE, (0..1000).map(|row| f64::from(if (300..400).contains(&row) { 300 } else { row }) * 0.1).collect());
        };
        let (notes, rows) = spoilt(turning);
        assert!(notes[0].contains("theta_e from 0.300000 s to 0.400000 s") && rows == 900, "{notes:?}");
    }

    #[test]
    fn a_channel_that_freezes_is_named() {
        let (notes, rows) = spoilt(|channels| fill(channels, Iq, 400..520, 3.0));
        let sentence = "a channel froze while others went on: iq from 0.400000 s to 0.520000 s; 120 rows are left out";
        assert_eq!((notes[0].as_str(), rows), (sentence, 880));
    }
}
