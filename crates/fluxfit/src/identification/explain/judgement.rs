//! A judged parameter with everything that is said of it.

use super::{
    super::{
        fit::{finding::Finding, uncertainty::ParameterUncertainty},
        judge::{
            reason::Reason,
            verdict::{Judged, Verdict},
        },
    },
    remedy::{self, Remedy},
};
use crate::motor::{PARAMETERS, Parameter};

/// One parameter, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// Which.
    pub parameter: Parameter,
    /// The number that came out, SI. An answer only unless the verdict is [`Verdict::NotIdentifiable`].
    pub raw: f64,
    /// Its uncertainty.
    pub uncertainty: ParameterUncertainty,
    /// The verdict.
    pub verdict: Verdict,
    /// Why the verdict is not better, or that the value was given.
    pub reason: Option<Reason>,
    /// What to do for a better one.
    pub remedy: Option<Remedy>,
}

impl Judgement {
    /// The value, SI, where it means something.
    pub fn value(&self) -> Option<f64> {
        (self.verdict != Verdict::NotIdentifiable).then_some(self.raw)
    }

    /// The 95 % interval, SI, where the value means something.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.value().map(|value| [value - self.uncertainty.half_width, value + self.uncertainty.half_width])
    }
}

/// Adds the remedies.
pub(crate) fn explained(judged: [Judged; PARAMETERS], finding: &Finding) -> [Judgement; PARAMETERS] {
    let remedy = |one: &Judged| {
        // What is wrong with one parameter of a fit is to be mended for all of them.
        let source = match one.reason {
            Some(Reason::OtherNegative { parameter }) => &judged[parameter as usize],
            _ => one,
        };
        source.reason.as_ref().and_then(|reason| remedy::of(reason, source.parameter, finding))
    };
    let remedies = judged.each_ref().map(remedy);
    let mut remedies = remedies.into_iter();
    judged.map(|Judged { parameter, raw, uncertainty, verdict, reason }| Judgement {
        parameter,
        raw,
        uncertainty,
        verdict,
        reason,
        remedy: remedies.next().flatten(),
    })
}
