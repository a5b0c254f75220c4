//! All estimators on one log, beside the batch answer: the document `fluxfit.online/1`.

use crate::{
    method::Method,
    start::Start,
    timing::Timing,
    tracker::{TrackSettings, Tracker},
};
use fluxfit::{
    Log, Parameter,
    document::ByParameter,
    motor::{Motor, PARAMETERS},
};
use serde::Serialize;

/// The name of this document.
pub const ONLINE: &str = "fluxfit.online/1";

/// What the batch identification says of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BatchEntry {
    /// Value, SI; null if the log does not determine it.
    pub value: Option<f64>,
    /// Its standard error by noise alone, SI: that of the Cramér-Rao bound, where the residuals are noise.
    pub statistical: Option<f64>,
}

impl BatchEntry {
    /// A batch value and its standard error by noise.
    pub fn new(value: Option<f64>, statistical: Option<f64>) -> Self {
        Self { value, statistical }
    }
}

/// What an estimator ends with, for one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EndEntry {
    /// Value at the end, SI, whether the samples determine it or not; null if it is not finite.
    pub value: Option<f64>,
    /// Its standard error, SI; null of an estimator without an error covariance.
    pub standard_error: Option<f64>,
    /// Whether the samples determine it, by the estimator; null if it cannot tell.
    pub identifiable: Option<bool>,
    /// Difference to the truth, or without one to the batch value, %.
    pub error_percent: Option<f64>,
}

/// One estimator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EstimatorEntry {
    /// Its key.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = Method::ALL.map(Method::key))))]
    pub method: &'static str,
    /// In prose.
    pub label: &'static str,
    /// Whether it has an error covariance.
    pub has_covariance: bool,
    /// The parameters at the end of the log.
    #[serde(flatten)]
    pub parameters: ByParameter<EndEntry>,
}

/// The document that `fluxfit compare --online --json` prints. Fields are added in later versions, never renamed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = ONLINE))]
#[non_exhaustive]
pub struct OnlineDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = ONLINE)))]
    pub schema: &'static str,
    /// Rows of the log.
    pub rows: usize,
    /// When the voltages of a row act.
    pub voltage_timing: &'static str,
    /// True parameters, if they are known.
    pub truth: Option<ByParameter<f64>>,
    /// The batch identification of the same log.
    pub batch: ByParameter<BatchEntry>,
    /// The estimators.
    pub estimators: Vec<EstimatorEntry>,
}

/// Runs all estimators over a log.
pub fn compare_online(log: &Log, timing: Timing, start: &Start, truth: Option<&Motor>, batch: [BatchEntry; PARAMETERS]) -> OnlineDocument {
    let columns = log.columns();
    let run = |method: Method| {
        let mut tracker = Tracker::new(TrackSettings { start: *start, ..TrackSettings::new(method, Some(timing)) });
        (0..log.rows()).filter_map(|k| columns.row(k)).for_each(|row| tracker.push(&row));
        let estimate = tracker.estimator().map(crate::Estimator::estimate);
        let end = |parameter: Parameter| {
            let j = parameter as usize;
            let value = estimate.map(|estimate| estimate.values[j]).filter(|value| value.is_finite());
            let reference = truth.map(|truth| truth.get(parameter)).or(batch[j].value);
            EndEntry {
                value,
                standard_error: estimate
                    .and_then(|estimate| estimate.standard_errors)
                    .map(|errors| errors[j])
                    .filter(|error| error.is_finite()),
                identifiable: estimate.and_then(|estimate| estimate.identifiable).map(|identifiable| identifiable[j]),
                error_percent: value
                    .zip(reference)
                    .map(|(value, reference)| 100.0 * (value / reference - 1.0))
                    .filter(|error| error.is_finite()),
            }
        };
        EstimatorEntry {
            method: method.key(),
            label: method.label(),
            has_covariance: method.has_covariance(),
            parameters: ByParameter::each(end),
        }
    };
    OnlineDocument {
        schema: ONLINE,
        rows: log.rows(),
        voltage_timing: timing.key(),
        truth: truth.map(ByParameter::from),
        batch: batch.into(),
        estimators: Method::ALL.map(run).to_vec(),
    }
}
