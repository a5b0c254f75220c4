//! A judged parameter with everything that is said of it.

use super::{
    super::{
        fit::{finding::Finding, saturation::SaturationFinding, uncertainty::ParameterUncertainty},
        judge::{
            reason::Reason,
            verdict::{Judged, Verdict},
        },
        request::{Known, Request},
    },
    remedy::{self, Beside, Remedy},
    shared_step,
    trial::Trials,
};
use crate::motor::{PARAMETERS, Parameter};

/// One parameter: value, interval, verdict, and what could be done better.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Judgement {
    /// Which parameter this is.
    pub parameter: Parameter,
    /// The number that the fit gave, SI. It means nothing where the verdict is [`Verdict::NotIdentifiable`]: use
    /// [`value`](Self::value), which is `None` then.
    pub raw: f64,
    /// Its uncertainty, SI, by cause.
    pub uncertainty: ParameterUncertainty,
    /// The verdict.
    pub verdict: Verdict,
    /// Why the verdict is not better, or that the value was given; `None` for a parameter identified from the log.
    pub reason: Option<Reason>,
    /// What to do for a better one; `None` for a parameter that is identified or was given.
    pub remedy: Option<Remedy>,
    /// Whether a prior was given for it.
    pub has_prior: bool,
}

impl Judgement {
    /// The value, SI; `None` where the parameter is not identifiable.
    pub fn value(&self) -> Option<f64> {
        (self.verdict != Verdict::NotIdentifiable).then_some(self.raw)
    }

    /// Lower and upper end of the 95 % interval, SI; `None` where the parameter is not identifiable.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.value().map(|value| [value - self.uncertainty.half_width, value + self.uncertainty.half_width])
    }

    /// Whether it is identified by the prior that was given alone: the log tells next to nothing beyond it.
    pub fn is_as_prior(&self) -> bool {
        let of_prior = self.uncertainty.systematic.prior.abs();
        self.verdict == Verdict::Identified && self.has_prior && of_prior >= AS_PRIOR * self.uncertainty.standard_error()
    }
}

/// A prior's part of the standard error from which on a value is only its prior: that part squared is the variance that is left, as a
/// fraction of the prior's. At 0.95 the interval is that of the prior within 5 %.
const AS_PRIOR: f64 = 0.95;

/// Adds the remedies. Measurements are tried on the log before they are proposed, if there is one to try them on.
pub(crate) fn explained(
    judged: [Judged; PARAMETERS],
    finding: &Finding,
    saturation: Option<&SaturationFinding>,
    request: &Request,
    mut trials: Option<Trials>,
) -> [Judgement; PARAMETERS] {
    let beside = Beside { knows_rs: request.known[Parameter::Rs as usize] != Known::Nothing, saturation };
    let mut remedy = |one: &Judged| {
        // What is wrong with one parameter of a fit is to be mended for all of them.
        let source = match one.reason {
            Some(Reason::OtherImpossible { parameter }) => &judged[parameter as usize],
            _ => one,
        };
        let parameter = source.parameter;
        let of_gains = finding.uncertainty.parameters[parameter as usize].systematic.common_gains();
        let now = if source.verdict == Verdict::NotIdentifiable { f64::INFINITY } else { source.relative_half_width() };
        let measure = || trials.as_mut().and_then(|trials| trials.best(of_gains, now, parameter));
        source.reason.as_ref().and_then(|reason| remedy::of(reason, parameter, finding, beside, measure))
    };
    let mut remedies: Vec<Option<Remedy>> = judged.iter().map(&mut remedy).collect();
    let tried: Vec<_> = trials.iter().flat_map(Trials::outcomes).collect();
    shared_step::share(&mut remedies, &tried);
    let mut remedies = remedies.into_iter();
    judged.map(|Judged { parameter, raw, uncertainty, verdict, reason }| Judgement {
        parameter,
        raw,
        uncertainty,
        verdict,
        reason,
        remedy: remedies.next().flatten(),
        has_prior: matches!(request.known[parameter as usize], Known::Prior { .. }),
    })
}
