//! Removal of rows that are not measurements of a running drive: zeros before the start, and repeated (stale) samples of a channel.

use super::channels::Channels;
use crate::channel::Channel;
use Channel::{IA, IB, IC, Id, Iq, OmegaE, T, ThetaE, UA, UB, UC, Ud, Uq};
use fluxfit_units::significant;
use std::ops::Range;

/// Channels that are zero while a drive stands still.
const ALL: [Channel; 11] = [Ud, Uq, Id, Iq, OmegaE, UA, UB, UC, IA, IB, IC];

/// Channels that are never constant to the bit while a drive runs; speed and DC voltage may be.
const LIVE: [Channel; 11] = [Ud, Uq, Id, Iq, UA, UB, UC, IA, IB, IC, ThetaE];

/// Minimum number of rows of a standstill that is removed.
const STANDSTILL: usize = 50;

/// A channel is frozen if a value repeats for at least this many rows,
const FROZEN: usize = 30;

/// and for at least this many times its usual run length,
const LONGER: usize = 20;

/// if another channel changes in at least this share of those rows,
const OTHERS_CHANGE: f64 = 0.5;

/// and changes by at least this share of its largest value, peak to peak: more than the last digits of a settled simulation.
const OTHERS_MOVE: f64 = 1e-3;

/// An angle is constant at standstill. Where no speed says whether it should turn, it is frozen only if a phase quantity swings to either
/// side of zero by at least this share of its largest value.
const PHASES_TURN: f64 = 0.25;

/// An angle is not frozen if, by the speed, the rotor turns less than this meanwhile, rad: a locked or standing rotor.
const LEAST_TURN: f64 = 0.2;

/// A channel that has settled changes by less than this share of its largest value from row to row before it stands still: a simulation
/// without noise. A channel that freezes was moving.
const SETTLED: f64 = 1e-3;

/// Rows beside a run that show whether the channel moves: a few, since a transient is short.
const BESIDE: usize = 10;

/// At the start of a log nothing is known of the rows before. There, a channel was frozen if it begins with a jump that is this many times
/// as large as what follows.
const JUMP: f64 = 5.0;

/// Removes such rows. Returns notes.
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
    // Usually no value repeats for long, and nothing needs to be remembered of the rows.
    if !live.iter().any(|(_, values)| repeats(values, FROZEN)) {
        return None;
    }
    let changes: Vec<Vec<usize>> = live.iter().map(|(_, values)| changes(values)).collect();
    let mut kept = vec![true; t.len()];
    let mut found = Vec::new();
    for (place, (channel, _)) in live.iter().enumerate() {
        let runs: Vec<(usize, usize)> = changes[place].windows(2).map(|pair| (pair[0], pair[1])).collect();
        let mut lengths: Vec<usize> = runs.iter().map(|(from, to)| to - from).collect();
        lengths.sort_unstable();
        let usual = usual_length(&lengths);
        for (from, to) in runs {
            let length = to - from;
            if length < FROZEN || length < LONGER * usual {
                continue;
            }
            let may_stand_still = match channel {
                ThetaE => turn(t, channels.get(OmegaE), from..to).is_some_and(|turn| turn < LEAST_TURN),
                _ => has_settled(live[place].1, from, to),
            };
            let changes_meanwhile = |other: usize| {
                let changed = changes[other].partition_point(|row| *row < to) - changes[other].partition_point(|row| *row <= from);
                let (name, values) = live[other];
                changed as f64 >= OTHERS_CHANGE * length as f64 && is_evidence(*channel, name) && {
                    if *channel == ThetaE { swings(values, from..to) } else { moves(values, from..to, OTHERS_MOVE) }
                }
            };
            if !may_stand_still && (0..live.len()).any(|other| other != place && changes_meanwhile(other)) {
                kept[from..to].fill(false);
                let until = t[to.min(t.len() - 1)];
                found.push(format!("{} from {} s to {} s", channel.name(), significant(t[from], 6), significant(until, 6)));
            }
        }
    }
    let first = found.first()?;
    let more = if found.len() > 1 { format!(", and {} more stretches", found.len() - 1) } else { String::new() };
    let rows = kept.iter().filter(|kept| !**kept).count();
    let note = format!("a channel was frozen while others changed: {first}{more}; {rows} rows are left out");
    if rows + FROZEN > t.len() {
        return None;
    }
    channels.retain(&kept);
    Some(note)
}

/// Whether what another channel does shows that this one is frozen. A drive that is told a duty holds both its voltages whatever the
/// currents do; so only the other voltage shows that one is frozen. An angle is shown by the phases that turn with it.
fn is_evidence(channel: Channel, other: Channel) -> bool {
    match channel {
        Ud | Uq => matches!(other, Ud | Uq),
        ThetaE => matches!(other, UA | UB | UC | IA | IB | IC),
        _ => true,
    }
}

/// How far the rotor turns in these rows by the speed, electrical rad; none without a speed.
fn turn(t: &[f64], omega_e: Option<&[f64]>, rows: Range<usize>) -> Option<f64> {
    let omega_e = omega_e?;
    let last = rows.end.min(t.len()) - 1;
    Some((rows.start..last).map(|row| omega_e[row].abs() * (t[row + 1] - t[row])).sum())
}

/// Whether a channel that stands still in the rows from `from` to `to` came to rest rather than froze.
fn has_settled(values: &[f64], from: usize, to: usize) -> bool {
    let median = |rows: Range<usize>| {
        let mut steps: Vec<f64> = values[rows].windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
        let middle = steps.len() / 2;
        (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    };
    if from > 0 {
        let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        return median(from.saturating_sub(BESIDE)..from + 1).is_some_and(|step| step < SETTLED * largest);
    }
    let end = (to + BESIDE).min(values.len());
    to >= end || median(to..end).is_some_and(|step| (values[to] - values[to - 1]).abs() < JUMP * step)
}

/// Whether a value repeats for at least this many rows.
fn repeats(values: &[f64], rows: usize) -> bool {
    let mut first = 0;
    (1..values.len()).any(|row| {
        if values[row] != values[row - 1] {
            first = row;
        }
        row - first + 1 >= rows
    })
}

/// The usual length of runs of one value: half of the rows are in runs of at most this length. It is long where values have coarse
/// steps.
fn usual_length(sorted: &[usize]) -> usize {
    let all: usize = sorted.iter().sum();
    let mut rows = 0;
    let reached = |length: &&usize| {
        rows += **length;
        2 * rows >= all
    };
    sorted.iter().find(reached).copied().unwrap_or(0)
}

/// Whether a channel changes by at least this share of its largest value, peak to peak.
fn moves(values: &[f64], rows: Range<usize>, least: f64) -> bool {
    let (low, high) =
        values[rows].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    high - low >= least * largest
}

/// Whether a phase quantity swings to either side of zero.
fn swings(values: &[f64], rows: Range<usize>) -> bool {
    let (low, high) =
        values[rows].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let least = PHASES_TURN * values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    low < -least && high > least
}

/// The first row of each run of one value, and the number of rows.
fn changes(values: &[f64]) -> Vec<usize> {
    let starts = (0..values.len()).filter(|row| *row == 0 || values[*row] != values[row - 1]);
    starts.chain([values.len()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DQ: [Channel; 5] = [Ud, Uq, Id, Iq, OmegaE];

    /// Repairs a log in which everything changes in every row, after `change`.
    fn repaired(change: impl Fn(&mut Channels)) -> (Vec<String>, usize) {
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
    fn a_log_without_faults_is_not_changed() {
        assert_eq!(repaired(|_| ()), (vec![], 1000));
        // A constant speed is not a fault; nor is a pause in which nothing changes.
        assert_eq!(repaired(|channels| fill(channels, OmegaE, 0..1000, 400.0)).1, 1000);
        assert_eq!(repaired(|channels| DQ.iter().for_each(|channel| fill(channels, *channel, 300..500, 1.0))).1, 1000);
    }

    #[test]
    fn zeros_before_the_start_are_left_out() {
        let (notes, rows) = repaired(|channels| DQ.iter().for_each(|channel| fill(channels, *channel, 0..200, 0.0)));
        assert_eq!((notes[0].as_str(), rows), ("standstill: the first 200 rows, 0.200 s, are zero in every channel and left out", 800));
    }

    /// Currents with coarse resolution repeat a value for long, which is not a fault.
    #[test]
    fn coarse_resolution_is_not_a_frozen_channel() {
        let coarse = |channels: &mut Channels| {
            let steps = (0..1000).map(|row| if row < 100 { f64::from(row % 7) } else { 4.0 + f64::from(row / 300) * 0.1 });
            channels.set(Iq, steps.collect());
        };
        assert_eq!(repaired(coarse), (vec![], 1000));
    }

    #[test]
    fn an_angle_that_is_frozen_while_phases_turn_is_reported() {
        let turning = |channels: &mut Channels| {
            let wave = |phase: f64| (0..1000).map(|row| 5.0 * (f64::from(row) * 0.1 + phase).sin()).collect::<Vec<_>>();
            [(UA, 0.3), (UB, 2.0), (IA, 1.0), (IB, 3.0)].into_iter().for_each(|(channel, phase)| channels.set(channel, wave(phase)));
            channels.set(ThetaE, (0..1000).map(|row| f64::from(if (300..400).contains(&row) { 300 } else { row }) * 0.1).collect());
        };
        let (notes, rows) = repaired(turning);
        assert!(notes[0].contains("theta_e from 0.300000 s to 0.400000 s") && rows == 900, "{notes:?}");
    }

    /// A locked rotor: constant angle, no speed, i_d steps.
    #[test]
    fn an_angle_that_stands_with_the_rotor_is_kept() {
        let locked = |channels: &mut Channels| {
            fill(channels, OmegaE, 0..1000, 0.0);
            let steps = (0..1000).map(|row| if row % 200 < 100 { 5.0 } else { -5.0 } + 0.01 * (f64::from(row) * 0.7).sin());
            channels.set(IA, steps.collect());
            channels.set(ThetaE, (0..1000).map(|row| if row < 300 { 0.5 } else { 0.6 }).collect());
        };
        assert_eq!(repaired(locked), (vec![], 1000));
    }

    /// Without noise i_d settles to a value, to the last digit of the file, while i_q moves on; then it goes to the next value.
    #[test]
    fn a_current_that_settles_is_kept() {
        let settling = |channels: &mut Channels| {
            let value = |row: i32| if row < 500 { 1.0 - (-f64::from(row) / 5.0).exp() } else { 1.0 + (-f64::from(row - 500) / 5.0).exp() };
            channels.set(Id, (0..1000).map(|row| (1e6 * value(row)).round() * 1e-6).collect());
        };
        assert_eq!(repaired(settling), (vec![], 1000));
        // From the first row on, and then a step that takes many rows.
        let zero = |channels: &mut Channels| {
            let value = |row: i32| if row < 500 { 0.0 } else { 1.0 - (-f64::from(row - 499) / 5.0).exp() };
            channels.set(Id, (0..1000).map(|row| (1e6 * value(row)).round() * 1e-6).collect());
        };
        assert_eq!(repaired(zero), (vec![], 1000));
    }

    /// A drive that is told a duty holds both voltages, and the currents follow the load.
    #[test]
    fn voltages_that_are_held_are_kept() {
        let held = |channels: &mut Channels| [Ud, Uq].iter().for_each(|channel| fill(channels, *channel, 400..700, 3.0));
        assert_eq!(repaired(held), (vec![], 1000));
        // One alone is frozen, and so is a current that starts with a jump.
        assert_eq!(repaired(|channels| fill(channels, Uq, 400..700, 3.0)).1, 700);
        assert_eq!(repaired(|channels| fill(channels, Iq, 0..200, 0.0)).1, 800);
    }

    #[test]
    fn a_frozen_channel_is_reported() {
        let (notes, rows) = repaired(|channels| fill(channels, Iq, 400..520, 3.0));
        let sentence = "a channel was frozen while others changed: iq from 0.400000 s to 0.520000 s; 120 rows are left out";
        assert_eq!((notes[0].as_str(), rows), (sentence, 880));
    }
}
