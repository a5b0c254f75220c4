//! Channels that were sampled at different instants are interpolated to common ones, those of the currents.

use super::{channels::Channels, lines::Lines};
use crate::{channel::Channel, problem::Problem};
use Channel::{IA, Id, T};
use fluxfit_files::FileError;
use fluxfit_units::wording::list;

/// A table with a larger share of complete rows has missing values; one with a smaller share was written message by message, each
/// row with the channels of one message.
const COMPLETE: f64 = 0.5;

/// Values that are further apart than this many usual time steps of the channel are not interpolated: there it has a gap, by the
/// same factor as a log.
const GAP: f64 = 2.5;

/// Minimum number of values of a channel.
const FEWEST: usize = 2;

/// Interpolates the missing values of a log that was written message by message; a log with missing cells is refused. Returns a note
/// if something was interpolated.
pub(super) fn align(channels: &mut Channels, lines: &Lines) -> Result<Option<String>, FileError> {
    let rows = channels.rows();
    let is_missing = |row: usize| channels.iter().any(|(_, values)| values[row].is_nan());
    let Some(first) = (0..rows).find(|row| is_missing(*row)) else { return Ok(None) };
    let complete = (first..rows).filter(|row| !is_missing(*row)).count() + first;
    let counts: Vec<(Channel, usize)> =
        channels.iter().map(|(channel, values)| (channel, values.iter().filter(|value| !value.is_nan()).count())).collect();
    let can_align =
        counts.iter().all(|(_, count)| *count >= FEWEST) && counts.iter().any(|(channel, count)| *channel == T && *count == rows);
    if complete as f64 > COMPLETE * rows as f64 || !can_align {
        let without = counts.iter().find(|(_, count)| *count == 0).map(|(channel, _)| *channel);
        let of_row = || channels.iter().find(|(_, values)| values[first].is_nan()).map(|(channel, _)| channel);
        return Err(channels.refuse_missing(without.or_else(of_row).unwrap_or(T), lines, first));
    }
    let t = channels.get(T).map(<[f64]>::to_vec).unwrap_or_default();
    let base = [Id, IA].into_iter().find(|channel| channels.get(*channel).is_some()).unwrap_or(Channel::IAlpha);
    let instants: Vec<f64> = present(&t, channels.get(base).unwrap_or(&[])).map(|(t, _)| t).collect();
    let mut moved: Vec<Channel> = Vec::new();
    for (channel, _) in counts.iter().filter(|(channel, _)| *channel != T) {
        let Some(values) = channels.get(*channel) else { continue };
        let (at, values): (Vec<f64>, Vec<f64>) = present(&t, values).unzip();
        if at != instants && !channel.is_slow() {
            moved.push(*channel);
        }
        let on_common = if channel.is_slow() { held(&at, &values, &instants) } else { interpolated(&at, &values, &instants) };
        channels.set(*channel, on_common);
    }
    channels.set(T, instants);
    let kept: Vec<bool> = (0..channels.rows()).map(|row| channels.iter().all(|(_, values)| !values[row].is_nan())).collect();
    refuse_turning(channels, &moved)?;
    if !kept.contains(&true) {
        return Err(Problem::NoCommonInstants { base: base.name() }.into());
    }
    channels.retain(&kept);
    Ok((!moved.is_empty()).then(|| note(&moved, base)))
}

/// Refuses to interpolate what turns with the rotor: phase quantities are not straight lines between two instants, and an angle jumps
/// at the end of a turn. If dq quantities are logged, the angle is not needed and is left out.
pub(super) fn refuse_turning(channels: &mut Channels, moved: &[Channel]) -> Result<(), FileError> {
    let has_phases = Channel::PHASES.into_iter().any(|channel| channels.get(channel).is_some());
    let turns = |channel: &Channel| *channel == Channel::ThetaE || Channel::PHASES.contains(channel);
    if !moved.iter().any(turns) {
        return Ok(());
    }
    if has_phases || channels.get(Channel::OmegaE).is_none() {
        return Err(Problem::ChannelsNotSimultaneous.into());
    }
    channels.take(Channel::ThetaE);
    Ok(())
}

/// The note on interpolated channels.
pub(super) fn note(moved: &[Channel], base: Channel) -> String {
    let moved: Vec<&str> = moved.iter().map(|channel| channel.name()).collect();
    let (was, is) = if moved.len() == 1 { ("was", "is") } else { ("were", "are") };
    format!(
        "{} {was} sampled at other instants than {} and {is} interpolated to them; only steady operating points are used",
        list(&moved),
        base.name()
    )
}

/// The values that are present, with their times.
pub(super) fn present<'a>(t: &'a [f64], values: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    t.iter().copied().zip(values.iter().copied()).filter(|(_, value)| !value.is_nan())
}

/// Values at other instants by linear interpolation; NaN before the first, after the last, and within gaps.
pub(super) fn interpolated(at: &[f64], values: &[f64], instants: &[f64]) -> Vec<f64> {
    let mut steps: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let usual = if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 };
    let mut after = 0;
    let value = |instant: &f64| {
        while after < at.len() && at[after] < *instant {
            after += 1;
        }
        match (at.get(after), after.checked_sub(1)) {
            (Some(right), _) if right == instant => values[after],
            (Some(right), Some(before)) if right - at[before] <= GAP * usual => {
                let part = (instant - at[before]) / (right - at[before]);
                values[before] + part * (values[after] - values[before])
            }
            _ => f64::NAN,
        }
    };
    instants.iter().map(value).collect()
}

/// Values of a channel that changes slowly, at other instants: linear between two values however far apart, and beyond the ends as there.
pub(super) fn held(at: &[f64], values: &[f64], instants: &[f64]) -> Vec<f64> {
    let value = |instant: &f64| {
        let after = at.partition_point(|at| at < instant);
        match (after.checked_sub(1), at.get(after)) {
            (Some(before), Some(right)) => {
                let part = (instant - at[before]) / (right - at[before]);
                values[before] + part * (values[after] - values[before])
            }
            (before, _) => values.get(before.unwrap_or(after)).copied().unwrap_or(f64::NAN),
        }
    };
    instants.iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_channel_is_held_across_gaps_and_beyond_its_ends() {
        let found = held(&[0.0, 1.0, 5.0], &[20.0, 22.0, 30.0], &[-1.0, 0.0, 0.5, 1.0, 3.0, 5.0, 9.0]);
        assert_eq!(found, [20.0, 20.0, 21.0, 22.0, 26.0, 30.0, 30.0]);
    }

    #[test]
    fn values_are_interpolated_linearly_except_in_gaps() {
        let found = interpolated(&[0.0, 1.0, 2.0, 8.0, 9.0], &[0.0, 10.0, 10.0, 0.0, 4.0], &[-1.0, 0.0, 0.25, 2.0, 5.0, 8.5, 9.0, 9.5]);
        let expected = [f64::NAN, 0.0, 2.5, 10.0, f64::NAN, 2.0, 4.0, f64::NAN];
        assert!(found.iter().zip(expected).all(|(a, b)| *a == b || a.is_nan() && b.is_nan()), "{found:?}");
    }
}
