//! Plausible but meaningless data: standardized files, references in place of measurements.

use super::{channels::Channels, chosen::ChosenColumn};
use crate::{channel::Channel, problem::Problem};
use fluxfit_files::FileError;

/// A column looks standardized if its mean is less than this many standard deviations,
const NORMALIZED_MEAN: f64 = 0.2;

/// and its standard deviation is in this range: in an excerpt of a standardized file neither is exact. The five channels of a drive are
/// never all like that: its speed alone would have to vary by about 1 rad/s around standstill.
const NORMALIZED_DEVIATION: std::ops::Range<f64> = 0.5..1.5;

/// Minimum number of rows for this check.
const NORMALIZED_ROWS: usize = 20;

/// Minimum number of rows for the check of references.
const MANY_ROWS: usize = 200;

/// Measured currents change in more than this share of the rows if the voltages change in most of them.
const SELDOM: f64 = 0.02;

/// Refuses a standardized file. The statistics are those of the values in the file, before any unit is applied.
pub(super) fn refuse_standardized(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let five = [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq, Channel::OmegaE];
    let looks = |channel: &Channel| {
        let column = chosen.iter().find(|column| column.channel == *channel);
        column.zip(channels.get(*channel)).is_some_and(|(column, values)| is_standard(values, column.factor()))
    };
    if five.iter().all(looks) { Err(Problem::Standardized.into()) } else { Ok(()) }
}

/// Whether values have a mean near 0 and a standard deviation near 1 in the file, where they were smaller by `factor`.
fn is_standard(values: &[f64], factor: f64) -> bool {
    let rows = values.len() as f64;
    let mean = values.iter().sum::<f64>() / rows / factor;
    let deviation = (values.iter().map(|value| (value / factor - mean).powi(2)).sum::<f64>() / rows).sqrt();
    values.len() >= NORMALIZED_ROWS && NORMALIZED_DEVIATION.contains(&deviation) && mean.abs() < NORMALIZED_MEAN * deviation
}

/// A note on currents that look like references: they rarely change while the voltages change all the time.
pub(super) fn note_references(channels: &Channels) -> Option<String> {
    let changing = |channels: &Channels, channel: Channel| {
        let values = channels.get(channel)?;
        (values.len() >= MANY_ROWS).then(|| values.windows(2).filter(|pair| pair[0] != pair[1]).count() as f64 / values.len() as f64)
    };
    let of = |channel: Channel| changing(channels, channel);
    let currents = of(Channel::Id)?.max(of(Channel::Iq)?);
    let voltages = of(Channel::Ud)?.min(of(Channel::Uq)?);
    (currents < SELDOM && voltages > 0.5).then(|| {
        format!(
            "id and iq change in only {:.1} % of the rows, the voltages in most: if these are references and not measured currents, the result is meaningless",
            100.0 * currents
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standardized_column_is_distinguished_from_one_of_a_drive() {
        let wave: Vec<f64> = (0..100).map(|i| 1.3 * (f64::from(i) * 0.3).sin()).collect();
        assert!(is_standard(&wave, 1.0));
        // In mV, for example: the values in the file are a thousand times larger.
        assert!(!is_standard(&wave, 1e-3));
        assert!(!is_standard(&wave.iter().map(|value| value + 100.0).collect::<Vec<_>>(), 1.0));
        assert!(!is_standard(&[f64::NAN; 50], 1.0) && !is_standard(&[], 1.0));
    }
}
