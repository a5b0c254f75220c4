//! The answer in one sentence: how many parameters are identified, and the one thing to do next that helps most.

use super::{super::judge::verdict::IDENTIFIED, judgement::Judgement, measurement::Promised, remedy::Remedy, warning::Warning};
use crate::{
    identification::judge::{reason::Reason, verdict::Verdict},
    motor::{PARAMETERS, Parameter},
};
use std::cmp::Ordering;

/// How many parameters are identified, and what to do next. It prints as one or two sentences.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// Parameters whose verdict is [`Verdict::Identified`], and that were not given and are not [as their priors](Self::as_prior).
    pub identified: Vec<Parameter>,
    /// Parameters whose value was given.
    pub given: Vec<Parameter>,
    /// Parameters whose verdict is [`Verdict::Identified`] by their [prior](Judgement::is_as_prior) alone.
    pub as_prior: Vec<Parameter>,
    /// Parameters whose verdict is [`Verdict::Weak`] only because the motor [saturates](Reason::Saturates).
    pub estimated: Vec<Parameter>,
    /// The widest of their 95 % intervals to either side, as a fraction of the value.
    pub estimated_to: f64,
    /// Other parameters whose verdict is [`Verdict::Weak`].
    pub weak: Vec<Parameter>,
    /// The apparent `L_q`, H, at the smallest and the largest i_q of a motor that saturates: what it has in place of one number. `None`
    /// where it does not, or where the two do not differ by more than their uncertainty.
    pub apparent_lq: Option<[f64; 2]>,
    /// The one thing to do next; `None` where nothing is to be done, or nothing is known that would help.
    pub next: Option<NextStep>,
    /// The one thing to do next for the parameters that it leaves as they are; `None` beside columns in doubt, which may be behind
    /// everything, and where a motor saturates, which no single measurement mends.
    pub further: Option<NextStep>,
}

/// The remedy that helps most.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NextStep {
    /// What to do. Of several parameters that it helps, the remedy of the first, or that which does for all of them.
    pub remedy: Remedy,
    /// The parameters that it helps, in the order of [`Parameter::ALL`].
    pub parameters: Vec<Parameter>,
    /// The interval to expect, where it was computed: the widest of these parameters, as a fraction of the value.
    pub half_width: Option<f64>,
}

impl NextStep {
    /// Whether it is this remedy, for whatever parameter.
    pub fn is_same(&self, remedy: &Remedy) -> bool {
        match (&self.remedy, remedy) {
            (Remedy::Measure(next), Remedy::Measure(other)) => next.measurement == other.measurement,
            (next, other) => next == other,
        }
    }
}

impl Summary {
    /// The summary of these judgements, with what the warnings beside them say of saturation.
    pub fn of(parameters: &[Judgement; PARAMETERS], warnings: &[Warning]) -> Self {
        let is_given = |judgement: &Judgement| judgement.reason == Some(Reason::Given);
        let with = |is: &dyn Fn(&Judgement) -> bool| -> Vec<Parameter> {
            parameters.iter().filter(|judgement| is(judgement)).map(|judgement| judgement.parameter).collect()
        };
        let is_estimate = |judgement: &Judgement| judgement.verdict == Verdict::Weak && judgement.reason == Some(Reason::Saturates);
        let next = next_step(parameters);
        let further = next
            .as_ref()
            .filter(|next| !next.remedy.stands_alone())
            .and_then(|next| next_step(parameters.iter().filter(|judgement| !next.parameters.contains(&judgement.parameter))));
        let width = |judgement: &Judgement| judgement.uncertainty.half_width / judgement.raw.abs();
        Self {
            identified: with(&|judgement| judgement.verdict == Verdict::Identified && !is_given(judgement) && !judgement.is_as_prior()),
            given: with(&is_given),
            as_prior: with(&Judgement::is_as_prior),
            estimated: with(&is_estimate),
            estimated_to: parameters.iter().filter(|judgement| is_estimate(judgement)).map(width).fold(0.0, f64::max),
            weak: with(&|judgement| judgement.verdict == Verdict::Weak && !is_estimate(judgement)),
            apparent_lq: warnings.iter().find_map(|warning| match warning {
                Warning::Saturation { lq } => lq.as_ref().map(|ends| ends.each_ref().map(|end| end.inductance)),
                _ => None,
            }),
            next,
            further,
        }
    }
}

/// The remedy that helps most: what is wrong with the columns comes before any measurement, since it may be behind everything else;
/// then what was computed to identify most parameters; then what helps most of them; then what takes least of a log. Of equals, that of
/// the first parameter.
fn next_step<'a>(parameters: impl IntoIterator<Item = &'a Judgement>) -> Option<NextStep> {
    let mut steps: Vec<NextStep> = Vec::new();
    for judgement in parameters {
        let Some(remedy) = judgement.remedy.as_ref().map(Remedy::quickest) else { continue };
        let half_width = remedy.promised();
        match steps.iter_mut().find(|step| step.remedy.is_same_step(remedy)) {
            Some(step) => {
                step.parameters.push(judgement.parameter);
                step.half_width = step.half_width.zip(half_width).map(|(one, other)| one.max(other));
                if remedy.demands_more_than(&step.remedy) {
                    step.remedy = remedy.clone();
                }
            }
            None => steps.push(NextStep { remedy: remedy.clone(), parameters: vec![judgement.parameter], half_width }),
        }
    }
    let rank = |step: &NextStep| {
        let identifies = step.half_width.is_some_and(|width| width <= IDENTIFIED);
        (
            step.remedy.questions_columns(),
            if identifies { step.parameters.len() } else { 0 },
            step.half_width.is_some(),
            step.parameters.len(),
        )
    };
    // The last of equals is what `max_by` takes: from the back, the first.
    steps.into_iter().rev().max_by(|one, other| {
        let by_effort = other.remedy.effort().partial_cmp(&one.remedy.effort()).unwrap_or(Ordering::Equal);
        rank(one).cmp(&rank(other)).then(by_effort)
    })
}

/// Promises that differ by less than this factor are equal: each is computed from one record of the noise.
const LIKE: f64 = 1.1;

impl Remedy {
    /// Of a remedy with an alternative the alternative, where it promises about as much: it takes as long as the log at most, and holding
    /// every operating point longer takes a multiple of that.
    fn quickest(&self) -> &Self {
        match self {
            Self::HoldLonger { half_width, or, .. } if or.promised().is_some_and(|promised| promised <= LIKE * half_width) => or,
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

    /// What it takes of a log, to be compared; the same of all that no time was computed for.
    fn effort(&self) -> (u8, f64) {
        match self {
            Self::Measure(Promised { measurement, .. }) => measurement.effort(),
            Self::HoldLonger { times, .. } => (u8::MAX, *times),
            _ => (u8::MAX, 0.0),
        }
    }

    /// Whether nothing else is to be said beside it at first.
    fn stands_alone(&self) -> bool {
        self.questions_columns()
            || matches!(self, Self::CheckSpeed | Self::CheckPrior { .. } | Self::SmallSteps | Self::TakeIncremental { .. })
    }

    /// Whether it doubts the columns themselves.
    fn questions_columns(&self) -> bool {
        matches!(self, Self::CheckSigns { .. } | Self::CheckFrame { .. })
    }

    /// Whether doing one does the other, or doing the more [demanding](Self::demands_more_than) one does both.
    fn is_same_step(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Measure(one), Self::Measure(other)) => one.measurement == other.measurement,
            (Self::HoldLonger { .. }, Self::HoldLonger { .. }) | (Self::SpreadPoints { .. }, Self::SpreadPoints { .. }) => true,
            (Self::CompensateDeadTime { .. }, Self::CompensateDeadTime { .. }) => true,
            _ => self == other,
        }
    }

    /// Whether of two remedies that are the same step this one does what the other does, and more.
    fn demands_more_than(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::HoldLonger { times, .. }, Self::HoldLonger { times: others, .. }) => times > others,
            // A resistance that is given does not do for all, here and where points are too similar.
            (Self::SpreadPoints { parameter }, Self::SpreadPoints { parameter: Parameter::Rs }) => *parameter != Parameter::Rs,
            (Self::CompensateDeadTime { or_resistance: false }, Self::CompensateDeadTime { or_resistance: true }) => true,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::measurement::Measurement, *};
    use crate::identification::fit::uncertainty::ParameterUncertainty;

    /// The step that follows from the remedies of the four parameters.
    fn next(remedies: [Option<Remedy>; PARAMETERS]) -> NextStep {
        let mut remedies = remedies.into_iter();
        let judgements = Parameter::ALL.map(|parameter| {
            let uncertainty = ParameterUncertainty::default();
            let remedy = remedies.next().flatten();
            Judgement { parameter, raw: 1.0, uncertainty, verdict: Verdict::Weak, reason: None, remedy, has_prior: false }
        });
        next_step(&judgements).unwrap()
    }

    fn measure(measurement: Measurement, half_width: f64) -> Remedy {
        Remedy::Measure(Promised { measurement, parameter: Parameter::Ld, half_width })
    }

    #[test]
    fn points_are_not_held_many_times_as_long_where_something_else_is_about_as_good() {
        let faster = |half_width| measure(Measurement::AllPoints { times: 2.0 }, half_width);
        let longer = |of_faster| {
            let or = Box::new(faster(of_faster));
            Remedy::HoldLonger { times: 50.0, parameter: Parameter::Ld, half_width: 0.05, or }
        };
        assert_eq!(next([None, Some(longer(0.051)), None, None]).remedy, faster(0.051));
        assert_eq!(next([None, Some(longer(0.08)), None, None]).remedy, longer(0.08));
    }

    #[test]
    fn of_steps_that_help_as_many_parameters_the_one_that_takes_least_is_next() {
        let faster = measure(Measurement::AllPoints { times: 2.0 }, 0.01);
        let multimeter = measure(Measurement::Resistance { accuracy: 0.01 }, 0.03);
        assert_eq!(next([None, Some(faster.clone()), None, Some(multimeter.clone())]).remedy, multimeter);
        let both = next([None, Some(faster.clone()), Some(faster.clone()), Some(multimeter)]);
        assert_eq!((both.remedy, both.parameters), (faster, vec![Parameter::Ld, Parameter::Lq]));
    }

    #[test]
    fn the_more_demanding_of_two_remedies_does_for_both() {
        let compensate = |or_resistance| Remedy::CompensateDeadTime { or_resistance };
        let step = next([Some(compensate(true)), Some(compensate(false)), None, None]);
        assert_eq!((step.remedy, step.parameters), (compensate(false), vec![Parameter::Rs, Parameter::Ld]));
    }
}
