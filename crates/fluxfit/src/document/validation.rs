//! The document of `validate`: schema `fluxfit.validation/1`.

use super::{
    by_parameter::ByParameter, channel::PerChannel, finite::finite, log::ValidatedLogEntry, nuisance::VoltageTimingEntry,
    warning::WarningEntry,
};
use crate::{
    log::Log,
    validation::{
        validate::{Channel, Difference, LITTLE, SIGNIFICANCE, Validation},
        wald::Test,
    },
};
use serde::Serialize;

/// The name of this document.
pub const VALIDATION: &str = "fluxfit.validation/1";

/// The document that `fluxfit validate --json` prints: given parameters, compared with a log that they were not found from. Fields are
/// added in later versions, never renamed. What is not known is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = VALIDATION))]
#[non_exhaustive]
pub struct ValidationDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = VALIDATION)))]
    pub schema: &'static str,
    /// The log.
    pub log: ValidatedLogEntry,
    /// `agrees`: no difference beyond noise and accuracy; `differs-little`: a difference of at most the limit `share`; `contradicts`: a
    /// larger one; `cannot-tell`: nothing could be tested.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::outcomes())))]
    pub outcome: &'static str,
    /// The outcome in sentences.
    pub verdict: String,
    /// The model of the log's own identification.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::models())))]
    pub model: &'static str,
    /// Why this model answered.
    pub model_reason: String,
    /// How the voltage columns were read.
    pub voltage_timing: Option<VoltageTimingEntry>,
    /// The test of all parameters that the log can tell; null if it can tell none.
    pub test: Option<TestEntry>,
    /// Root mean square of the difference of both predictions (by the given and by the log's own parameters), over that of the measured
    /// vector.
    pub share: f64,
    /// Squared residuals above those of the log's own parameters, as a fraction of the noise's.
    pub excess_cost: Option<f64>,
    /// The limits behind the outcomes.
    pub limits: LimitsEntry,
    /// The given parameters beside the log's own.
    pub parameters: ByParameter<DifferenceEntry>,
    /// Measured and predicted, channel by channel.
    pub channels: PerChannel<ChannelEntry>,
    /// What limits the log's own identification.
    pub warnings: Vec<WarningEntry>,
}

impl ValidationDocument {
    /// The document of a validation on a log.
    pub fn of(log: &Log, found: &Validation) -> Self {
        Self {
            schema: VALIDATION,
            log: ValidatedLogEntry::of(log),
            outcome: found.outcome.key(),
            verdict: found.verdict(),
            model: found.own.model.model.key(),
            model_reason: found.own.model.reason.to_string(),
            voltage_timing: VoltageTimingEntry::of(&found.own),
            test: TestEntry::of(&found.test),
            share: found.share,
            excess_cost: finite(found.excess_cost),
            limits: LimitsEntry { significance: SIGNIFICANCE, share: LITTLE },
            parameters: found.parameters.each_ref().map(|difference| DifferenceEntry::of(difference, found)).into(),
            channels: channels(found),
            warnings: found.own.warnings.iter().map(WarningEntry::of).collect(),
        }
    }
}

/// Limits behind an outcome.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LimitsEntry {
    /// Probability of a test's statistic below which there is a difference.
    pub significance: f64,
    /// The largest `share` that counts as little.
    pub share: f64,
}

/// Wald's test: whether two sets of parameters differ by more than their covariances explain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TestEntry {
    /// How many parameters were tested.
    pub parameters: usize,
    /// The statistic per degree of freedom: about one if nothing differs.
    pub statistic: f64,
    /// Degrees of freedom of the statistic, and of the covariance behind it.
    pub degrees_of_freedom: [f64; 2],
    /// Probability that noise and inaccuracy alone give a statistic as large.
    pub probability: f64,
}

impl TestEntry {
    /// None if nothing was tested.
    fn of(test: &Test) -> Option<Self> {
        (test.tested > 0).then_some(Self {
            parameters: test.tested,
            statistic: test.statistic,
            degrees_of_freedom: [test.degrees_of_freedom, test.behind],
            probability: test.probability,
        })
    }
}

/// One parameter, as given and as identified from the log.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DifferenceEntry {
    /// The unit: ohm, H or Wb.
    pub unit: &'static str,
    /// The value that was given.
    pub given: f64,
    /// Its standard error; zero if it is taken as exact.
    pub given_standard_error: f64,
    /// Whether the log can tell this parameter, so that it is tested.
    pub tested: bool,
    /// The log's own value.
    pub own: Option<f64>,
    /// Own less given.
    pub difference: Option<f64>,
    /// The difference in percent of the given value; null if that is zero.
    pub difference_percent: Option<f64>,
    /// Standard error of the difference.
    pub standard_error: Option<f64>,
    /// Half of the 95 % interval of the difference.
    pub half_width95: Option<f64>,
    /// The difference in its standard errors.
    pub standard_errors: Option<f64>,
}

impl DifferenceEntry {
    fn of(difference: &Difference, found: &Validation) -> Self {
        let own = difference.own;
        Self {
            unit: difference.parameter.unit(),
            given: difference.given,
            given_standard_error: found.given.standard_error(difference.parameter),
            tested: own.is_some(),
            own: own.map(|own| own.value),
            difference: difference.difference(),
            difference_percent: difference.percent(),
            standard_error: own.map(|own| own.standard_error),
            half_width95: own.map(|own| own.half_width),
            standard_errors: difference.standard_errors(),
        }
    }
}

/// One channel, measured and predicted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ChannelEntry {
    /// The unit: A or V.
    pub unit: &'static str,
    /// Root mean square of measured less predicted.
    pub rms: f64,
    /// The log's own noise.
    pub noise: f64,
    /// `rms` over `noise`; null if there is no noise.
    pub ratio: Option<f64>,
    /// Share of the measured variance that the prediction explains; null if the channel does not vary.
    pub explained: Option<f64>,
    /// Root mean square of the difference of both predictions, over that of the measured vector.
    pub share: f64,
    /// The test of what the difference of the parameters does to this channel; null if nothing was tested.
    pub test: Option<TestEntry>,
    /// The outcome of this channel, named as that of the whole.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::outcomes())))]
    pub outcome: &'static str,
}

impl ChannelEntry {
    fn of(channel: &Channel) -> Self {
        Self {
            unit: channel.unit,
            rms: channel.rms,
            noise: channel.noise,
            ratio: channel.ratio(),
            explained: channel.explained,
            share: channel.share,
            test: TestEntry::of(&channel.test),
            outcome: channel.outcome.key(),
        }
    }
}

/// The output error predicts currents, the steady model voltages.
fn channels(found: &Validation) -> PerChannel<ChannelEntry> {
    let [d, q] = found.channels.each_ref().map(ChannelEntry::of);
    if found.own.output.is_some() { PerChannel::Currents { id: d, iq: q } } else { PerChannel::Voltages { ud: d, uq: q } }
}
