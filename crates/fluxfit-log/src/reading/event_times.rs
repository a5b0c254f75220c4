//! Rows with the same time, as simulations of Modelica and of circuits write them where something switches: one before the event, one
//! behind it.

use super::{channels::Channels, rounded_time::median};
use crate::channel::Channel;

/// Most rows, as a share, that have the time of the row behind them. Beyond, the time is something else, or was rounded.
const MOST: f64 = 1.0 / 3.0;

/// Fewest rows of a simulation: of a few, each is there for a reason.
const FEWEST: usize = 30;

/// Times that differ by less than this share of the usual step are the same.
const SAME: f64 = 1e-6;

/// Steps that may be too few or too many for a recorder's, by the rows that are stamped alike.
const OF_A_RECORDER: f64 = 0.25;

/// Leaves out the rows that have the time of the row behind them: what comes after them starts behind the event. Returns a note.
pub(super) fn settle(channels: &mut Channels) -> Option<String> {
    let t = channels.get(Channel::T)?;
    let is_at_once = |pair: &[f64]| pair[0] == pair[1];
    if t.len() < FEWEST || !t.windows(2).any(is_at_once) {
        return None;
    }
    // One step more, of zero: there may be no other.
    let step = median(t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).chain([0.0]).collect());
    let is_same = |pair: &[f64]| (0.0..=SAME * step).contains(&(pair[1] - pair[0]));
    let kept: Vec<bool> = t.windows(2).map(|pair| !is_same(pair)).chain([true]).collect();
    let left_out = kept.iter().filter(|kept| !**kept).count();
    // A recorder that stamps two rows alike leaves out the next stamp: with all rows there are as many steps as the time has.
    let missing = (t[t.len() - 1] - t[0]) / step - (t.len() - 1) as f64;
    let is_recorder = missing.abs() <= OF_A_RECORDER * left_out as f64;
    if is_recorder || left_out as f64 > MOST * t.len() as f64 {
        return None;
    }
    channels.retain(&kept);
    let rows = if left_out == 1 { "1 row has".to_owned() } else { format!("{left_out} rows have") };
    Some(format!("{rows} the time of the row behind, as simulations write them at events: left out"))
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

    /// A recorder whose clock has whole milliseconds, each tenth of which it writes twice and leaves out the next; and one time throughout.
    #[test]
    fn stamps_of_a_recorder_are_left_to_be_refused() {
        let stamps: Vec<f64> = (0..100).map(|row| f64::from(if row % 10 == 5 { row - 1 } else { row }) * 1e-3).collect();
        assert_eq!(settled(stamps.clone()), (None, stamps));
        assert_eq!(settled(vec![1.0; 50]), (None, vec![1.0; 50]));
    }
}
