//! The answer in one sentence: how many parameters are identified, and the one thing to do next that helps most.

use super::{super::judge::verdict::IDENTIFIED, judgement::Judgement, measurement::Promised, remedy::Remedy};
use crate::{
    identification::judge::{reason::Reason, verdict::Verdict},
    motor::{PARAMETERS, Parameter},
};

/// How many parameters are identified, and what to do next. It prints as one or two sentences.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// Parameters whose verdict is [`Verdict::Identified`] and that were not given.
    pub identified: Vec<Parameter>,
    /// Parameters whose value was given.
    pub given: Vec<Parameter>,
    /// Parameters whose verdict is [`Verdict::Weak`] only because the motor [saturates](Reason::Saturates).
    pub estimated: Vec<Parameter>,
    /// The widest of their 95 % intervals to either side, as a fraction of the value.
    pub estimated_to: f64,
    /// Other parameters whose verdict is [`Verdict::Weak`].
    pub weak: Vec<Parameter>,
    /// The one thing to do next; `None` where nothing is to be done, or nothing is known that would help.
    pub next: Option<NextStep>,
}

/// The remedy that helps most.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NextStep {
    /// What to do. Of several parameters that it helps, the remedy of the first.
    pub remedy: Remedy,
    /// The parameters that it helps, in the order of [`Parameter::ALL`].
    pub parameters: Vec<Parameter>,
    /// The interval to expect, where it was computed: the widest of these parameters, as a fraction of the value.
    pub half_width: Option<f64>,
}

impl Summary {
    /// The summary of these judgements.
    pub fn of(parameters: &[Judgement; PARAMETERS]) -> Self {
        let is_given = |judgement: &Judgement| judgement.reason == Some(Reason::Given);
        let with = |is: &dyn Fn(&Judgement) -> bool| -> Vec<Parameter> {
            parameters.iter().filter(|judgement| is(judgement)).map(|judgement| judgement.parameter).collect()
        };
        let is_estimate = |judgement: &Judgement| judgement.verdict == Verdict::Weak && judgement.reason == Some(Reason::Saturates);
        let width = |judgement: &Judgement| judgement.uncertainty.half_width / judgement.raw.abs();
        Self {
            identified: with(&|judgement| judgement.verdict == Verdict::Identified && !is_given(judgement)),
            given: with(&is_given),
            estimated: with(&is_estimate),
            estimated_to: parameters.iter().filter(|judgement| is_estimate(judgement)).map(width).fold(0.0, f64::max),
            weak: with(&|judgement| judgement.verdict == Verdict::Weak && !is_estimate(judgement)),
            next: next_step(parameters),
        }
    }
}

/// The remedy that helps most: what is wrong with the columns comes before any measurement, since it may be behind everything else;
/// then what was computed to identify most parameters; then what helps most of them. Of equals, that of the first parameter.
fn next_step(parameters: &[Judgement; PARAMETERS]) -> Option<NextStep> {
    let mut steps: Vec<NextStep> = Vec::new();
    for judgement in parameters {
        let Some(remedy) = judgement.remedy.as_ref().map(Remedy::quickest) else { continue };
        let half_width = remedy.promised();
        match steps.iter_mut().find(|step| step.remedy.is_same_step(remedy)) {
            Some(step) => {
                step.parameters.push(judgement.parameter);
                step.half_width = step.half_width.zip(half_width).map(|(one, other)| one.max(other));
            }
            None => steps.push(NextStep { remedy: remedy.clone(), parameters: vec![judgement.parameter], half_width }),
        }
    }
    // The last of equals is what `max_by_key` takes: from the back, the first.
    steps.into_iter().rev().max_by_key(|step| {
        let identifies = step.half_width.is_some_and(|width| width <= IDENTIFIED);
        (
            step.remedy.questions_columns(),
            if identifies { step.parameters.len() } else { 0 },
            step.half_width.is_some(),
            step.parameters.len(),
        )
    })
}

impl Remedy {
    /// Of a remedy with an alternative the one that promises more: holding every operating point longer is seldom the shorter way.
    fn quickest(&self) -> &Self {
        match self {
            Self::HoldLonger { half_width, or, .. } if or.promised().is_some_and(|promised| promised <= *half_width) => or,
            _ => self,
        }
    }

    /// Half of the 95 % interval that was computed for it, as a fraction of the value.
    fn promised(&self) -> Option<f64> {
        match self {
            Self::Measure(Promised { half_width, .. }) | Self::HoldLonger { half_width, .. } => Some(*half_width),
            _ => None,
        }
    }

    /// Whether it doubts the columns themselves.
    fn questions_columns(&self) -> bool {
        matches!(self, Self::CheckSigns { .. } | Self::CheckFrame { .. })
    }

    /// Whether doing one does the other.
    fn is_same_step(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Measure(one), Self::Measure(other)) => one.measurement == other.measurement,
            (Self::HoldLonger { or: one, .. }, Self::HoldLonger { or: other, .. }) => one.is_same_step(other),
            _ => self == other,
        }
    }
}
