//! The document of `track`: schema `fluxfit.track/1`, one line for each time that is told.

use crate::{
    temperature::{Temperatures, Thermometer},
    tracker::Tracker,
    verdict::{Tracked, Verdict},
};
use fluxfit::{Parameter, document::ByParameter};
use serde::Serialize;

/// The name of this document.
pub const TRACK: &str = "fluxfit.track/1";

/// A line that `fluxfit track --json` prints: what is known of the motor at one time. Fields are added in later versions, never renamed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = TRACK))]
#[non_exhaustive]
pub struct TrackDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = TRACK)))]
    pub schema: &'static str,
    /// Time of the last row, s.
    pub t: f64,
    /// Rows so far.
    pub rows: u64,
    /// The estimator.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = crate::Method::ALL.map(crate::Method::key))))]
    pub method: &'static str,
    /// The parameters.
    #[serde(flatten)]
    pub parameters: ByParameter<TrackedEntry>,
    /// When the voltages of a row act, as far as it is known.
    pub voltage_timing: &'static str,
    /// Whether that was stated or has become clear.
    pub voltage_timing_settled: bool,
    /// Temperature of the winding from R_s; null without a reference.
    pub winding_temperature: Option<TemperatureEntry>,
    /// Temperature of the magnets from psi_f; null without a reference and their coefficient.
    pub magnet_temperature: Option<TemperatureEntry>,
    /// Steps of parameters that were found.
    pub steps: u32,
    /// Rows that were left out.
    pub left_out: LeftOutEntry,
    /// Whether this is the state at the end.
    pub last: bool,
}

/// One parameter at one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TrackedEntry {
    /// Value; null if the samples do not determine it.
    pub value: Option<f64>,
    /// The unit: ohm, H or Wb.
    pub unit: &'static str,
    /// Standard error; null without a value, and of an estimator without an error covariance.
    pub standard_error: Option<f64>,
    /// The 95 % interval.
    pub ci95: Option<[f64; 2]>,
    /// `identified`: half of the interval is at most 5 % of the value; `weak`: at most 50 %; `holding`: identified before, and nothing has
    /// excited the parameters since; `not-identifiable`; `unknown`: a value without an error covariance.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = Verdict::KEYS)))]
    pub verdict: &'static str,
    /// Since when a value is held, s.
    pub since: Option<f64>,
}

/// A temperature, degC.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TemperatureEntry {
    /// Value, degC.
    pub value: f64,
    /// The 95 % interval, degC, by the interval of the parameter.
    pub ci95: [f64; 2],
}

/// Rows that were left out, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeftOutEntry {
    /// With a value that is no number, or cut off.
    pub not_numbers: u64,
    /// With a value that no drive had.
    pub spikes: u64,
    /// Jumps in time, across which nothing is computed.
    pub gaps: u64,
}

impl TrackedEntry {
    fn of(parameter: Parameter, tracked: &Tracked) -> Self {
        Self {
            value: tracked.value,
            unit: parameter.unit(),
            standard_error: tracked.standard_error,
            ci95: tracked.interval(),
            verdict: tracked.verdict.key(),
            since: match tracked.verdict {
                Verdict::Holding { since } => Some(since),
                _ => None,
            },
        }
    }
}

impl TrackDocument {
    /// What a tracker knows now; during the lead-in nothing of the parameters.
    pub fn of(tracker: &Tracker, thermometer: Option<&Thermometer>, last: bool) -> Self {
        let parameters = tracker.parameters_or_nothing();
        let temperatures = thermometer.map_or(Temperatures { winding: None, magnets: None }, |thermometer| thermometer.read(&parameters));
        let entry = |(value, margin): (f64, f64)| TemperatureEntry { value, ci95: [value - margin, value + margin] };
        let (timing, settled) = tracker.timing();
        let left_out = tracker.left_out();
        Self {
            schema: TRACK,
            t: tracker.time(),
            rows: tracker.rows(),
            method: tracker.settings().method.key(),
            parameters: ByParameter::each(|parameter| TrackedEntry::of(parameter, &parameters[parameter as usize])),
            voltage_timing: timing.key(),
            voltage_timing_settled: settled,
            winding_temperature: temperatures.winding.map(entry),
            magnet_temperature: temperatures.magnets.map(entry),
            steps: tracker.steps(),
            left_out: LeftOutEntry { not_numbers: left_out.not_numbers, spikes: left_out.spikes, gaps: left_out.gaps },
            last,
        }
    }
}

/// The name and the schema of each document of this crate.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, schemars::Schema)> {
    use crate::comparison::{ONLINE, OnlineDocument};
    vec![(TRACK, fluxfit::document::schema_of::<TrackDocument>()), (ONLINE, fluxfit::document::schema_of::<OnlineDocument>())]
}
