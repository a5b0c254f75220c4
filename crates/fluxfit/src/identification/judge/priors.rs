//! Priors that the log contradicts: of two numbers that differ by far more than their uncertainties one is wrong, the answer is a
//! compromise between them, and so is what follows it.

use super::{
    super::request::{Known, Request},
    reason::Reason,
    verdict::{Judged, Verdict},
};
use crate::motor::{PARAMETERS, Parameter};

/// Standard errors of both together by which a log contradicts a prior.
const CONTRADICTION: f64 = 3.0;

/// A prior, and what the log says against it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Contradiction {
    pub(crate) parameter: Parameter,
    /// What was given, and its standard error, SI.
    pub(crate) prior: (f64, f64),
    /// What the log tells, and its standard error, SI.
    pub(crate) log: (f64, f64),
}

/// What the log alone tells of a parameter with a prior, against that; else the answer, if the prior did not hold it: what else was fitted
/// beside it tells the parameter in its own way.
pub(crate) fn contradiction(answer: &Judged, alone: Option<&[Judged; PARAMETERS]>, request: &Request) -> Option<Contradiction> {
    let parameter = answer.parameter;
    let Known::Prior { value, standard_error } = request.known[parameter as usize] else { return None };
    let told = |one: &Judged| (one.raw, one.uncertainty.standard_error());
    let alone = alone.map(|alone| &alone[parameter as usize]).filter(|one| one.verdict != Verdict::NotIdentifiable);
    let contradicts = |log: &(f64, f64)| (log.0 - value).abs() > CONTRADICTION * standard_error.hypot(log.1);
    let log = alone.into_iter().chain([answer]).map(told).find(contradicts)?;
    Some(Contradiction { parameter, prior: (value, standard_error), log })
}

/// Takes the word "identified" back from the parameter of a contradicted prior, and from each other that the log alone does not identify
/// or puts outside the interval.
pub(crate) fn doubt(answers: &mut [Judged; PARAMETERS], contradiction: &Contradiction, alone: Option<&[Judged; PARAMETERS]>) {
    for answer in answers.iter_mut().filter(|answer| answer.verdict == Verdict::Identified && answer.reason != Some(Reason::Given)) {
        let stays = |alone: &[Judged; PARAMETERS]| {
            let same = &alone[answer.parameter as usize];
            same.verdict == Verdict::Identified && (same.raw - answer.raw).abs() <= answer.uncertainty.half_width
        };
        if answer.parameter == contradiction.parameter || !alone.is_some_and(stays) {
            (answer.verdict, answer.reason) = (Verdict::Weak, Some(Reason::PriorContradicted { parameter: contradiction.parameter }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identification::fit::uncertainty::ParameterUncertainty;

    fn judged(raw: [f64; PARAMETERS], standard_error: f64) -> [Judged; PARAMETERS] {
        Parameter::ALL.map(|parameter| {
            let uncertainty =
                ParameterUncertainty { statistical: standard_error, half_width: 2.0 * standard_error, ..ParameterUncertainty::default() };
            Judged { parameter, raw: raw[parameter as usize], uncertainty, verdict: Verdict::Identified, reason: None }
        })
    }

    fn request() -> Request {
        Request::default().with_known(Parameter::Rs, Known::Prior { value: 60.0, standard_error: 0.6 })
    }

    /// 60 ± 0.6 was given. By itself the log says nothing, 60 ± 40, or 66 ± 1; the answer is 60 ± 0.6, or 66 ± 0.9.
    #[test]
    fn an_answer_that_leaves_its_prior_is_told() {
        let told = |answer: (f64, f64), alone: Option<(f64, f64)>| {
            let of = |(raw, error): (f64, f64)| judged([raw; PARAMETERS], error);
            contradiction(&of(answer)[0], alone.map(of).as_ref(), &request()).map(|found| found.log)
        };
        assert_eq!(told((60.0, 0.6), None), None);
        assert_eq!(told((60.0, 0.6), Some((60.0, 40.0))), None);
        assert_eq!(told((61.7, 0.5), Some((66.0, 1.0))), Some((66.0, 1.0)));
        assert_eq!(told((66.0, 0.9), Some((60.0, 40.0))), Some((66.0, 0.9)));
    }

    /// R_s was 60, the log says 66: psi_f moved from 100 to 90 with it, and L_q stayed.
    #[test]
    fn what_a_contradicted_prior_moves_is_not_identified() {
        let (mut answers, alone) = (judged([61.7, 40.0, 50.0, 90.0], 0.5), judged([66.0, 40.0, 50.2, 100.0], 0.5));
        let found = contradiction(&answers[0], Some(&alone), &request()).unwrap();
        doubt(&mut answers, &found, Some(&alone));
        let verdicts = answers.each_ref().map(|one| one.verdict);
        assert_eq!(verdicts, [Verdict::Weak, Verdict::Identified, Verdict::Identified, Verdict::Weak]);
        assert_eq!(answers[3].reason, Some(Reason::PriorContradicted { parameter: Parameter::Rs }));
        doubt(&mut answers, &found, None);
        assert!(answers.iter().all(|one| one.verdict == Verdict::Weak));
    }
}
