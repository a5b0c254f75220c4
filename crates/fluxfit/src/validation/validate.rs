//! Validation: how well given parameters predict a log that they were not found from.
//!
//! [`validate`] lets the log answer for itself first: what is [identified](crate::identify) from it is the reference, and what that
//! leaves is the log's own noise. Then two questions are kept apart. *Is there a difference?* A [test](super::wald) of the given
//! parameters against the log's own, with the covariance of both. *Does it matter?* The share of the current (or voltage) by which
//! the predictions differ.
//!
//! Parameters that the log cannot tell are not tested. They are taken as given, so that what hangs on them is tested under that
//! condition: one load tells nothing of R_s and psi_f alone, but it tells psi_f for a given R_s.

use super::{
    given::Given,
    prediction::{Predicted, Prediction, Value},
    wald::{Covariance, Test},
};
use crate::{
    error::{Error, ErrorKind},
    identification::{
        judge::verdict::WEAK,
        progress::{Progress, silent},
        request::{Known, Request, Swarm},
        solve::{Identification, solve},
    },
    log::Log,
    motor::{PARAMETERS, Parameter},
};

/// Probability of a test's statistic, were the given parameters true, below which they are not: one false alarm in a hundred validations.
pub const SIGNIFICANCE: f64 = 0.01;

/// Share of the current (or voltage) vector up to which a difference is little: what current sensors of drives are good to.
pub const LITTLE: f64 = 0.01;

/// Standard errors from which on a parameter is different: as the test's significance, of one parameter alone.
const DIFFERENT: f64 = 2.58;

/// A ratio this close to a power of ten, in decades, is a matter of units: the parameters of one kind of motor do not differ more.
const NEAR_A_DECADE: f64 = 0.1;

/// What is missed by more than this many times the noise is not missed by noise.
const MUCH_MORE: f64 = 3.0;

/// A channel whose variance is less than this many times its noise's has no course of its own that could be explained.
const COURSE: f64 = 2.0;

/// What a validation says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// No difference beyond what noise and accuracy explain.
    Agrees,
    /// A difference, by a share of at most [`LITTLE`].
    DiffersLittle,
    /// A larger one.
    Contradicts,
    /// Nothing could be tested.
    CannotTell,
}

impl Outcome {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::DiffersLittle => "differs-little",
            Self::Contradicts => "contradicts",
            Self::CannotTell => "cannot-tell",
        }
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::DiffersLittle => "differs by little",
            Self::Contradicts => "contradicts",
            Self::CannotTell => "cannot tell",
        }
    }

    /// Of a test, and the share by which predictions differ.
    fn of(test: &Test, share: f64) -> Self {
        match test.probability {
            _ if test.tested == 0 => Self::CannotTell,
            probability if probability >= SIGNIFICANCE => Self::Agrees,
            _ if share <= LITTLE => Self::DiffersLittle,
            _ => Self::Contradicts,
        }
    }
}

/// Given parameters, compared with a log.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Validation {
    /// The parameters.
    pub given: Given,
    /// What is identified from this log alone; parameters that it cannot tell are held at the given values.
    pub own: Identification,
    /// Given and own, parameter by parameter.
    pub parameters: [Difference; PARAMETERS],
    /// The test of all parameters that the log tells, together.
    pub test: Test,
    /// The channels that are predicted: `id, iq`, or `ud, uq`.
    pub channels: [Channel; 2],
    /// How far the sum of the squared residuals lies above that of the log's own answer, as a fraction of the noise's.
    pub excess_cost: f64,
    /// Root mean square of the difference of both predictions over that of the measured vector.
    pub share: f64,
    /// The verdict.
    pub outcome: Outcome,
    /// Measured and predicted.
    pub prediction: Prediction,
}

impl Validation {
    /// Parameters that the log cannot tell, so that they are not tested.
    pub fn untested(&self) -> impl Iterator<Item = &Difference> {
        self.parameters.iter().filter(|difference| difference.own.is_none())
    }
}

/// One parameter, given and as the log has it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// Which.
    pub parameter: Parameter,
    /// As given, SI.
    pub given: f64,
    /// What the log says; `None` where it cannot tell.
    pub own: Option<Own>,
}

/// What a log says of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Own {
    /// Its value, SI.
    pub value: f64,
    /// Standard error of the difference to the given one, SI: both errors.
    pub standard_error: f64,
    /// Half of the 95 % interval of that difference, SI.
    pub half_width: f64,
}

impl Difference {
    /// Own less given, SI.
    pub fn difference(&self) -> Option<f64> {
        self.own.map(|own| own.value - self.given)
    }

    /// The same in percent of the given one; `None` where that is zero.
    pub fn percent(&self) -> Option<f64> {
        let difference = self.difference().filter(|_| self.given > 0.0)?;
        Some(100.0 * difference / self.given)
    }

    /// Whether the log has another value, by more than chance lets a single parameter differ.
    pub fn is_different(&self) -> bool {
        self.standard_errors().is_some_and(|errors| errors.abs() >= DIFFERENT)
    }

    /// The power of ten, other than zero, by which the given value has to be multiplied to be that of the log: it then probably has
    /// another unit than was read.
    pub fn power_of_ten(&self) -> Option<i32> {
        let own = self.own.filter(|own| own.value > 0.0 && self.given > 0.0 && own.half_width <= WEAK * own.value.max(self.given))?;
        let decades = (own.value / self.given).log10();
        let whole = decades.round();
        (whole != 0.0 && (decades - whole).abs() <= NEAR_A_DECADE).then_some(whole as i32)
    }

    /// The same in standard errors.
    pub fn standard_errors(&self) -> Option<f64> {
        let own = self.own.filter(|own| own.standard_error > 0.0)?;
        Some((own.value - self.given) / own.standard_error)
    }
}

/// One channel, measured and predicted; A or V.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Channel {
    /// Its column.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Root mean square of measured less predicted.
    pub rms: f64,
    /// The log's own noise: what its own parameters leave of a current; the uncertainty of an operating point's voltage, of which a fit of
    /// few points leaves less.
    pub noise: f64,
    /// Share of the measured variance that the prediction explains; none where the channel stands still.
    pub explained: Option<f64>,
    /// Root mean square of the difference of both predictions over that of the measured vector.
    pub share: f64,
    /// The test of what the parameters' difference does to this channel.
    pub test: Test,
    /// The verdict.
    pub outcome: Outcome,
}

impl Channel {
    /// How many times the noise is missed; none where there is no noise.
    pub fn ratio(&self) -> Option<f64> {
        (self.noise > 0.0).then(|| self.rms / self.noise)
    }

    /// Whether far more than noise is missed, and it agrees nevertheless: because the intervals of the parameters allow as much.
    pub fn is_within_intervals_alone(&self) -> bool {
        self.outcome == Outcome::Agrees && self.ratio().is_some_and(|ratio| ratio > MUCH_MORE)
    }
}

/// Compares given parameters with a log that they were not found from. A motor taken as exact is `&motor.into()`; the answer to another
/// log is [`Given::of`]. Of the request only the model, the windows, the voltages' timing and the voltages' accuracy count.
///
/// # Errors
/// If a given parameter is not one that a motor can have (psi_f may be zero, the others must be positive), a value of the request is out of
/// range, or the log holds nothing to be predicted.
pub fn validate(log: &Log, given: &Given, request: &Request) -> Result<Validation, Error> {
    validate_with_progress(log, given, request, &silent)
}

/// [`validate`], with a callback that is told each step.
///
/// # Errors
/// As [`validate`].
pub fn validate_with_progress(log: &Log, given: &Given, request: &Request, progress: Progress) -> Result<Validation, Error> {
    check(given)?;
    if log.is_short_circuit() {
        // Only ratios of the parameters could be tested, and no voltage says by how much they differ.
        return Err(Error::no_voltages());
    }
    let (own, tested) = own_answer(log, given, request, progress)?;
    let predicted = Predicted::of(log, &own, given, request)?;
    let covariance = Covariance::of(&own, given, &tested);
    let parameters = differences(&own, given, &tested);
    let test = covariance.joint();

    let channels = [0, 1].map(|axis| channel(axis, &predicted, &covariance));
    let share = channels[0].share.hypot(channels[1].share);
    Ok(Validation {
        excess_cost: predicted.excess_cost(),
        outcome: Outcome::of(&test, share),
        prediction: predicted.prediction,
        given: *given,
        own,
        parameters,
        test,
        channels,
        share,
    })
}

fn check(given: &Given) -> Result<(), Error> {
    for parameter in Parameter::ALL {
        let (value, standard_error) = (given.motor.get(parameter), given.standard_error(parameter));
        // A reluctance motor has no magnet.
        let least = if parameter == Parameter::PsiF { 0.0 } else { f64::MIN_POSITIVE };
        if !(value >= least && value.is_finite()) {
            let range = if parameter == Parameter::PsiF { "a finite number, zero or more" } else { "a finite number above zero" };
            return Err(ErrorKind::Setting { setting: parameter.symbol(), value, range }.into());
        }
        if !standard_error.is_finite() {
            return Err(
                ErrorKind::Setting { setting: "the standard error of a given parameter", value: standard_error, range: "finite" }.into()
            );
        }
    }
    Ok(())
}

/// Identifies from the log what it tells. One by one, what it tells least is held at what is given, until the rest is told.
fn own_answer(log: &Log, given: &Given, request: &Request, progress: Progress) -> Result<(Identification, Vec<Parameter>), Error> {
    let mut request = Request { known: [Known::Nothing; PARAMETERS], swarm: Swarm::Off, hold_out: false, ..request.clone() };
    let mut tested = Parameter::ALL.to_vec();
    loop {
        let own = solve(log, &request, progress)?;
        let widths = tested.iter().map(|parameter| (*parameter, width(&own, given, *parameter)));
        let untold = widths.filter(|(_, width)| *width > WEAK || width.is_nan());
        let Some((worst, _)) = untold.max_by(|one, other| one.1.total_cmp(&other.1)) else {
            return Ok((own, tested));
        };
        tested.retain(|parameter| *parameter != worst);
        if tested.is_empty() {
            return Ok((own, tested));
        }
        let (value, standard_error) = (given.motor.get(worst), given.standard_error(worst));
        request.known[worst as usize] = if standard_error > 0.0 { Known::Prior { value, standard_error } } else { Known::Fixed(value) };
    }
}

/// Half of a parameter's interval as a fraction of its value: the given or the log's own, whichever is larger, so that a value which is
/// small only because it is wrong is found out.
fn width(own: &Identification, given: &Given, parameter: Parameter) -> f64 {
    let judgement = own.parameter(parameter);
    judgement.uncertainty.half_width / judgement.raw.abs().max(given.motor.get(parameter))
}

fn differences(own: &Identification, given: &Given, tested: &[Parameter]) -> [Difference; PARAMETERS] {
    Parameter::ALL.map(|parameter| {
        let judgement = own.parameter(parameter);
        let alone = judgement.uncertainty.standard_error();
        let both = alone.hypot(given.standard_error(parameter));
        // Student's t of the log's own interval serves both.
        let t = if alone > 0.0 { judgement.uncertainty.half_width / alone } else { 0.0 };
        let own = Own { value: judgement.raw, standard_error: both, half_width: t * both };
        Difference { parameter, given: given.motor.get(parameter), own: tested.contains(&parameter).then_some(own) }
    })
}

fn channel(axis: usize, predicted: &Predicted, covariance: &Covariance) -> Channel {
    let values = &predicted.values;
    let rms = |of: &dyn Fn(&Value) -> f64| (values.iter().map(|value| of(value).powi(2)).sum::<f64>() / values.len().max(1) as f64).sqrt();
    let vector = rms(&|value| value.measured[0].hypot(value.measured[1]));
    let left = rms(&|value| value.left[axis]);
    let noise = rms(&|value| value.noise[axis]);
    let mean = values.iter().map(|value| value.measured[axis]).sum::<f64>() / values.len().max(1) as f64;
    let course = rms(&|value| value.measured[axis] - mean);
    let difference = rms(&|value| value.left[axis] - value.left_by_own[axis]);
    let share = if vector > 0.0 { difference / vector } else { 0.0 };
    let test = covariance.effect(&predicted.sensitivity[axis]);
    let (name, unit) = predicted.channels[axis];
    Channel {
        name,
        unit,
        rms: left,
        noise,
        explained: (course * course > COURSE * noise * noise).then(|| 1.0 - (left / course).powi(2)),
        share,
        outcome: Outcome::of(&test, share),
        test,
    }
}

#[cfg(test)]
mod unit_tests {
    use super::*;

    fn difference(given: f64, value: f64) -> Difference {
        let own = Own { value, standard_error: 0.01 * value, half_width: 0.02 * value };
        Difference { parameter: Parameter::Ld, given, own: Some(own) }
    }

    #[test]
    fn a_value_in_millihenry_that_was_read_as_henry_is_noticed() {
        assert_eq!(difference(5.25, 5.3e-3).power_of_ten(), Some(-3));
        assert_eq!(difference(5.25e-6, 5.0e-3).power_of_ten(), Some(3));
        assert_eq!(difference(5.25e-3, 5.0e-3).power_of_ten(), None);
        assert_eq!(difference(5.25e-3, 2.0e-2).power_of_ten(), None);
        assert_eq!(Difference { own: None, ..difference(1.0, 1.0) }.power_of_ten(), None);
        let hint = difference(5.25, 5.3e-3).unit_hint().unwrap();
        assert_eq!(hint, "the given L_d is about 1000 times that of this log");
        assert_eq!(difference(5.25e-6, 5.0e-3).unit_hint().unwrap(), "the given L_d is about 1/1000 of that of this log");
    }
}
