//! All estimators on one log, beside the batch answer: the document `fluxfit.online/1`.

use crate::{
    method::Method,
    start::Start,
    timing::Timing,
    tracker::{TrackSettings, Tracker},
    verdict::Tracked,
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

impl OnlineDocument {
    /// What the numbers are, in a sentence.
    pub fn explanation(&self) -> String {
        let reference = if self.truth.is_some() { "the true values" } else { "the batch values" };
        format!(
            "{} rows, voltages read as {}; difference to {reference} at the end, %; in brackets what the estimator itself does not call identifiable",
            self.rows, self.voltage_timing
        )
    }
}

/// How many times of a course are kept: more than a figure of fourteen estimators has pixels for.
const KEPT: usize = 240;

/// What an estimator told in the course of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// The estimator.
    pub method: Method,
    /// What was told of rs, ld, lq and psi_f after each row that is kept.
    pub told: Vec<[Tracked; PARAMETERS]>,
}

/// All estimators on one log.
#[derive(Debug, Clone, PartialEq)]
pub struct OnlineComparison {
    /// What they end with.
    pub document: OnlineDocument,
    /// The rows after which the courses were kept, in ascending order.
    pub rows: Vec<usize>,
    /// How they came there.
    pub courses: Vec<Course>,
}

/// Runs all estimators over a log.
pub fn compare_online(
    log: &Log,
    timing: Timing,
    start: &Start,
    truth: Option<&Motor>,
    batch: [BatchEntry; PARAMETERS],
) -> OnlineComparison {
    let columns = log.columns();
    let every = log.rows().div_ceil(KEPT).max(1);
    // The last row is always kept.
    let rows: Vec<usize> = (0..log.rows()).rev().step_by(every).collect::<Vec<_>>().into_iter().rev().collect();
    let run = |method: Method| {
        let mut tracker = Tracker::new(TrackSettings { start: *start, ..TrackSettings::new(method, Some(timing)) });
        let mut told = Vec::with_capacity(rows.len());
        for k in 0..log.rows() {
            if let Some(row) = columns.row(k) {
                tracker.push(&row);
            }
            if rows.get(told.len()) == Some(&k) {
                told.push(tracker.parameters_or_nothing());
            }
        }
        (end(&tracker, truth, &batch), Course { method, told })
    };
    let (estimators, courses) = Method::ALL.map(run).into_iter().unzip();
    let document = OnlineDocument {
        schema: ONLINE,
        rows: log.rows(),
        voltage_timing: timing.key(),
        truth: truth.map(ByParameter::from),
        batch: batch.into(),
        estimators,
    };
    OnlineComparison { document, rows, courses }
}

fn end(tracker: &Tracker, truth: Option<&Motor>, batch: &[BatchEntry; PARAMETERS]) -> EstimatorEntry {
    let method = tracker.settings().method;
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
}
