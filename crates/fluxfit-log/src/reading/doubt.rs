//! What the first rows and the name of a column say against proposing it, though its name resembles that of a channel.

use super::resemblance::words;
use crate::{block::ColumnHead, channel::Channel, csv::FirstCells};
use fluxfit_units::Dimension;

/// Words of what is on or off, and no measured value.
const FLAGS: [&str; 11] = ["flag", "flags", "fault", "faults", "wakeup", "enable", "enabled", "alarm", "alarms", "warning", "warnings"];

/// What is taken from a resemblance if only columns that do not move have it: they are proposed where nothing else resembles the channel.
const DOES_NOT_MOVE: f64 = 1.0;

/// What is to be taken from the resemblance of a column to a channel; none if it cannot be the channel.
pub(super) fn doubt(channel: Channel, index: usize, heads: &[ColumnHead], first_cells: &[FirstCells]) -> Option<f64> {
    if words(&heads[index].name).iter().any(|word| FLAGS.contains(&word.as_str())) {
        return None;
    }
    let Some(cells) = first_cells.get(index) else { return Some(0.0) };
    let is_possible = cells.has_numbers
        && match channel.dimension() {
            // A count of ns since 1970 is large.
            Dimension::Time => cells.constant.is_none() && !cells.falls,
            // The noise of a current that flows changes some digit; before a drive starts all are zero.
            Dimension::Current => !cells.has_no_value && cells.constant.is_none_or(|constant| constant == 0.0),
            Dimension::Speed => !cells.has_no_value && !cells.is_flag,
            _ => !cells.has_no_value,
        };
    is_possible.then_some(if cells.constant.is_some() { DOES_NOT_MOVE } else { 0.0 })
}
