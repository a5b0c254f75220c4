//! Logs that read well and mean nothing: standardized files, references in place of measurements.

use super::{Channels, columns::Chosen};
use crate::{channel::Channel, problem::Problem};
use fluxfit_files::FileError;

/// A mean of less than this many standard deviations is near zero,
const NORMALIZED_MEAN: f64 = 0.2;

/// and a standard deviation in this range near one. An excerpt of a standardized file is neither exactly; of a drive, no five
/// channels are all like that: its speed alone would have to swing by about 1 rad/s around standstill.
const NORMALIZED_DEVIATION: std::ops::Range<f64> = 0.5..1.5;

/// Fewest rows whose mean and deviation say anything.
const NORMALIZED_ROWS: usize = 20;

/// Words in the name of a column that holds what was asked for.
const REFERENCE: [&str; 13] =
    ["ref", "reference", "req", "request", "requested", "cmd", "command", "target", "setpoint", "demand", "desired", "set", "soll"];

/// Fewest rows of which it is said how many change.
const MANY_ROWS: usize = 200;

/// Measured currents change more often than in this part of the rows where the voltages do in most.
const SELDOM: f64 = 0.02;

/// Refuses a standardized file. `values` are as the file has them, before any unit.
pub(super) fn refuse_standardized(chosen: &[Chosen], channels: &Channels) -> Result<(), FileError> {
    let five = [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq, Channel::OmegaE];
    let looks = |channel: &Channel| {
        let column = chosen.iter().find(|column| column.channel == *channel);
        column.zip(channels.get(*channel)).is_some_and(|(column, values)| is_standard(values, column.factor()))
    };
    if five.iter().all(looks) { Err(Problem::Standardized.into()) } else { Ok(()) }
}

/// Whether values, `factor` of which are one of the file's, have a mean near 0 and a deviation near 1 there.
fn is_standard(values: &[f64], factor: f64) -> bool {
    let rows = values.len() as f64;
    let mean = values.iter().sum::<f64>() / rows / factor;
    let deviation = (values.iter().map(|value| (value / factor - mean).powi(2)).sum::<f64>() / rows).sqrt();
    values.len() >= NORMALIZED_ROWS && NORMALIZED_DEVIATION.contains(&deviation) && mean.abs() < NORMALIZED_MEAN * deviation
}

/// Whether a column's name says that it holds a reference.
pub(super) fn is_reference(header: &str) -> bool {
    super::resemblance::words(header).iter().any(|word| REFERENCE.contains(&word.as_str()))
}

/// What is said of currents that look like references: steps, where the voltages change all the time.
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
            "id and iq change in only {:.1} % of the rows, and the voltages in most: if the currents are references and not measured, the answer means nothing",
            100.0 * currents
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standardized_column_is_told_from_one_of_a_drive() {
        let wave: Vec<f64> = (0..100).map(|i| 1.3 * (f64::from(i) * 0.3).sin()).collect();
        assert!(is_standard(&wave, 1.0));
        // In mV, say: what the file has is a thousand times more.
        assert!(!is_standard(&wave, 1e-3));
        assert!(!is_standard(&wave.iter().map(|value| value + 100.0).collect::<Vec<_>>(), 1.0));
        assert!(!is_standard(&[f64::NAN; 50], 1.0) && !is_standard(&[], 1.0));
    }

    #[test]
    fn references_are_known_by_name() {
        for header in ["IqReq", "id_ref", "i_d_ref (A)", "iq setpoint", "ID_CMD"] {
            assert!(is_reference(header), "{header}");
        }
        for header in ["id", "motor_id_a", "Id preferred", "i_q", "offset_id"] {
            assert!(!is_reference(header), "{header}");
        }
    }
}
