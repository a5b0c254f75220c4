//! Rows with the same time, as simulations of Modelica and of circuits write them where something switches: one before the event, one
//! behind it.

use super::{channels::Channels, rounded_time::median};
use crate::channel::Channel;
use fluxfit_units::Dimension;

/// Most rows, as a share, that have the time of the row behind them. Beyond, the time is something else, or was rounded.
const MOST: f64 = 1.0 / 3.0;

/// Fewest rows of a simulation: of a few, each is there for a reason.
const FEWEST: usize = 30;

/// Times that differ by less than this share of the usual step are the same.
const SAME: f64 = 1e-6;

/// Times that differ by less than this share of the mean step are the same where the currents are: of some solvers the row before an event
/// is a little before it.
const NEAR: f64 = 1e-3;

/// Of what currents change by otherwise, at most this share is changed within an event: they go on through it, whatever voltages do. What
/// a drive has sampled changes within events alone, and is held from one to the next.
const CONTINUED: f64 = 1e-3;

/// Fewest events of which that is believed.
const FEWEST_EVENTS: usize = 5;

/// Steps that may be too few or too many for a recorder's, by the rows that are stamped alike.
const OF_A_RECORDER: f64 = 0.25;

/// The channels that nothing makes jump: currents, and what turns with the rotor's inertia.
const CONTINUOUS: [Channel; 9] =
    [Channel::Id, Channel::Iq, Channel::IA, Channel::IB, Channel::IC, Channel::IAlpha, Channel::IBeta, Channel::OmegaE, Channel::ThetaE];

/// Leaves out the rows that have the time of the row behind them: what comes after them starts behind the event. Returns a note.
pub(super) fn settle(channels: &mut Channels) -> Option<String> {
    let t = channels.get(Channel::T)?;
    if t.len() < FEWEST {
        return None;
    }
    let kept = of_continued_currents(channels, t).or_else(|| of_some_rows(t))?;
    let left_out = kept.iter().filter(|kept| !**kept).count();
    channels.retain(&kept);
    let rows = if left_out == 1 { "1 row has".to_owned() } else { format!("{left_out} rows have") };
    Some(format!("{rows} the time of the row behind, as simulations write them at events: left out"))
}

/// Which rows to keep where few have the time of the row behind.
fn of_some_rows(t: &[f64]) -> Option<Vec<bool>> {
    if !t.windows(2).any(|pair| pair[0] == pair[1]) {
        return None;
    }
    // One step more, of zero: there may be no other.
    let step = median(t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).chain([0.0]).collect());
    let kept = kept(t, SAME * step);
    let left_out = kept.iter().filter(|kept| !**kept).count() as f64;
    // A recorder that stamps two rows alike leaves out the next stamp: with all rows there are as many steps as the time has.
    let missing = (t[t.len() - 1] - t[0]) / step - (t.len() - 1) as f64;
    let is_recorder = missing.abs() <= OF_A_RECORDER * left_out;
    (!is_recorder && left_out <= MOST * t.len() as f64).then_some(kept)
}

/// Which rows to keep where currents and speed go on through the rows of one time, or are held from these to the next: however many there
/// are. Of two samples whose time was rounded they do neither.
fn of_continued_currents(channels: &Channels, t: &[f64]) -> Option<Vec<bool>> {
    let mean_step = (t[t.len() - 1] - t[0]) / (t.len() - 1) as f64;
    // Most logs have none.
    if t.windows(2).filter(|pair| is_same(pair, NEAR * mean_step)).take(FEWEST_EVENTS).count() < FEWEST_EVENTS {
        return None;
    }
    let kept = kept(t, NEAR * mean_step);
    let changes = |values: &[f64], within: bool| {
        let pairs = values.windows(2).zip(&kept).filter(|(_, kept)| **kept != within);
        pairs.map(|(pair, _)| (pair[1] - pair[0]).abs()).fold(0.0, |sum: f64, change| sum + change)
    };
    let mut currents = channels.iter().filter(|(channel, _)| CONTINUOUS.contains(channel)).map(|(_, values)| values);
    let both = |values: &[f64]| [changes(values, true), changes(values, false)];
    let is_moved = |values: &[f64]| both(values).iter().any(|change| *change > 0.0);
    let moves = channels.iter().any(|(channel, values)| channel.dimension() == Dimension::Current && is_moved(values));
    let is_continued = currents.all(|values| {
        let [within, between] = both(values);
        within <= CONTINUED * between || between <= CONTINUED * within
    });
    (moves && is_continued).then_some(kept)
}

/// Whether the row behind each row is later by more than this.
fn kept(t: &[f64], same: f64) -> Vec<bool> {
    t.windows(2).map(|pair| !is_same(pair, same)).chain([true]).collect()
}

fn is_same(pair: &[f64], same: f64) -> bool {
    (0.0..=same).contains(&(pair[1] - pair[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(t: Vec<f64>) -> (Option<String>, Vec<f64>) {
        let mut channels = Channels { columns: vec![(Channel::T, t)], ..Channels::default() };
        (settle(&mut channels), channels.take(Channel::T).unwrap())
    }

    /// Two events of a simulation, the second with a step that is none.
    #[test]
    fn the_row_behind_an_event_is_kept() {
        let even = || (0..100).map(|row| f64::from(row) * 1e-4);
        let mut t: Vec<f64> = even().collect();
        t.insert(40, t[40]);
        t.insert(80, t[80] - 1e-15);
        let (note, left) = settled(t);
        assert_eq!(note.unwrap(), "2 rows have the time of the row behind, as simulations write them at events: left out");
        assert!(left.iter().eq(even().collect::<Vec<f64>>().iter()), "{left:?}");
    }

    /// Each sample is an event, its first row at the time of the second one or a little before it: a voltage jumps, the current goes on.
    #[test]
    fn an_event_at_every_sample_is_told_by_the_currents() {
        let current = |row: usize| (0.3 * row as f64).sin();
        for before in [0.0, 1e-9] {
            let both = |of: &dyn Fn(usize) -> [f64; 2]| (0..100).flat_map(of).collect::<Vec<f64>>();
            let t = both(&|row| [row as f64 * 1e-4 - if row > 0 { before } else { 0.0 }, row as f64 * 1e-4]);
            let columns = |behind: f64| {
                vec![
                    (Channel::T, t.clone()),
                    (Channel::Ud, both(&|row| [row as f64, row as f64 + 1.0])),
                    (Channel::Iq, both(&|row| [current(row), current(row) + behind])),
                ]
            };
            let mut channels = Channels { columns: columns(0.0), ..Channels::default() };
            assert!(settle(&mut channels).unwrap().starts_with("100 rows have the time of the row behind"));
            assert!(channels.get(Channel::T).unwrap().iter().enumerate().all(|(row, t)| (t - row as f64 * 1e-4).abs() < 1e-15));
            assert_eq!(channels.get(Channel::Ud).unwrap()[..2], [1.0, 2.0]);
        }
    }

    /// A drive's own samples jump at the event at which they are taken, and are held from there.
    #[test]
    fn sampled_currents_are_held_between_events() {
        let both = |of: &dyn Fn(usize) -> f64| (0..200).map(of).collect::<Vec<f64>>();
        let t = both(&|row| (row / 2) as f64 * 1e-4);
        let columns = vec![(Channel::T, t), (Channel::Iq, both(&|row| (0.3 * row.div_ceil(2) as f64).sin()))];
        let mut channels = Channels { columns, ..Channels::default() };
        assert!(settle(&mut channels).is_some());
        assert!((channels.get(Channel::Iq).unwrap()[3] - 1.2_f64.sin()).abs() < 1e-15);
    }

    /// The currents differ within them as from one to the next.
    #[test]
    fn two_samples_whose_time_was_rounded_are_no_event() {
        let both = |of: &dyn Fn(usize) -> f64| (0..200).map(of).collect::<Vec<f64>>();
        let t = both(&|row| (row / 2) as f64 * 1e-4);
        let columns = vec![(Channel::T, t), (Channel::Iq, both(&|row| (0.3 * row as f64).sin()))];
        assert_eq!(settle(&mut Channels { columns, ..Channels::default() }), None);
    }

    /// A recorder whose clock has whole milliseconds, each tenth of which it writes twice and leaves out the next; and one time throughout.
    #[test]
    fn stamps_of_a_recorder_are_left_to_be_refused() {
        let stamps: Vec<f64> = (0..100).map(|row| f64::from(if row % 10 == 5 { row - 1 } else { row }) * 1e-3).collect();
        assert_eq!(settled(stamps.clone()), (None, stamps));
        assert_eq!(settled(vec![1.0; 50]), (None, vec![1.0; 50]));
    }
}
