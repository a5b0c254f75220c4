//! Remedies that are carried out: the log as it was with what the remedy says, identified again, against what was promised.
//!
//! | file | concept |
//! |---|---|
//! | `situation.rs` | the judged situations of `known`, for any motor, by this project's simulator |
//! | `carry_out.rs` | a drive with a remedy |
//! | `table.rs` | promises kept, by kind of remedy |

mod carry_out;
pub mod situation;
pub mod table;

pub use carry_out::Case;

use crate::{drives::Drawn, rated::Rated};
use fluxfit::{Answer, Known, Measurement, Place, Remedy, Request, Verdict, motor::Parameter};
use rayon::prelude::*;
use situation::Situation;

/// A promise is kept if the half-width comes out at most this many times as wide.
pub const FACTOR: f64 = 1.5;

/// Standard error of the prior in the situation that has one, as a fraction.
const PRIOR: f64 = 0.1;

/// A remedy that was carried out; widths and errors as fractions of the value.
#[derive(Debug, Clone, PartialEq)]
pub struct Carried {
    /// Of which case.
    pub name: String,
    /// For which parameter.
    pub parameter: Parameter,
    /// As printed.
    pub sentence: String,
    /// What kind it is.
    pub kind: &'static str,
    /// Half-width that was promised, if one was.
    pub promised: Option<f64>,
    /// Half-width before.
    pub before: f64,
    /// What came after it; or why there is no answer.
    pub after: Result<After, String>,
}

/// What came after a remedy.
#[derive(Debug, Clone, PartialEq)]
pub struct After {
    /// Half-width.
    pub half_width: f64,
    /// Error against the truth.
    pub error: f64,
    /// Verdict.
    pub verdict: Verdict,
    /// Why it is no better.
    pub why: String,
}

impl Carried {
    /// Reached over promised, if something was promised.
    pub fn ratio(&self) -> Option<f64> {
        let reached = self.after.as_ref().map_or(f64::INFINITY, |after| after.half_width);
        self.promised.map(|promised| reached / promised)
    }

    /// Whether the new interval holds the truth; true where there is no new number.
    pub fn holds(&self) -> bool {
        self.after.as_ref().map_or(true, |after| after.verdict == Verdict::NotIdentifiable || after.error.abs() <= after.half_width)
    }
}

/// The cases of the `drives` study, number 0 to `count`.
pub fn drawn(count: u64, motors: &[Rated]) -> Vec<Case> {
    let case = |index: u64| {
        let Drawn { scenario, .. } = Drawn::new(index, motors)?;
        Some(Case { name: format!("drawn {index}"), scenario, unlogged: 0.0, draw: index, request: Request::default() })
    };
    (0..count).filter_map(case).collect()
}

/// The judged situations of a motor.
pub fn judged(rated: &Rated) -> Vec<Case> {
    let case = |situation: &Situation| {
        let scenario = situation.scenario(rated);
        let mut request = Request::default();
        if situation.name.ends_with("prior") {
            let value = rated.motor.rs;
            request.known[Parameter::Rs as usize] = Known::Prior { value, standard_error: PRIOR * value };
        }
        Case {
            name: format!("{}, motor {}", situation.name, rated.row),
            unlogged: situation.unlogged(&scenario),
            scenario,
            draw: 0,
            request,
        }
    };
    situation::ALL.iter().map(case).collect()
}

/// What each remedy of these cases brings, on as many threads as there are.
pub fn survey(cases: &[Case]) -> Vec<Carried> {
    cases.par_iter().flat_map(|case| case.answer().map_or_else(|_| Vec::new(), |answer| carried(case, &answer))).collect()
}

/// Carries out every remedy of an answer.
fn carried(case: &Case, answer: &Answer) -> Vec<Carried> {
    let mut done: Vec<(Case, Result<Answer, String>)> = Vec::new();
    let mut all = Vec::new();
    for parameter in Parameter::ALL {
        for remedy in answer.parameter(parameter).remedy.iter().flat_map(alternatives) {
            let Some(with) = case.with(remedy, answer) else { continue };
            // Two parameters often share a remedy.
            let index = done.iter().position(|(other, _)| *other == with).unwrap_or_else(|| {
                let after = with.answer();
                done.push((with, after));
                done.len() - 1
            });
            let after = done[index].1.as_ref().map(|after| result(case, after, parameter)).map_err(Clone::clone);
            let before = answer.parameter(parameter);
            all.push(Carried {
                name: case.name.clone(),
                parameter,
                sentence: remedy.to_string(),
                kind: kind(remedy),
                promised: promised(remedy),
                before: before.uncertainty.half_width / before.raw.abs(),
                after,
            });
        }
    }
    all
}

/// A remedy, and the one that it names instead.
fn alternatives(remedy: &Remedy) -> Vec<&Remedy> {
    match remedy {
        Remedy::HoldLonger { or, .. } => vec![remedy, or],
        _ => vec![remedy],
    }
}

fn result(case: &Case, after: &Answer, parameter: Parameter) -> After {
    let judgement = after.parameter(parameter);
    let truth = case.scenario.motor.unsaturated().get(parameter);
    let drift = if parameter == Parameter::Rs { case.scenario.motor.rs_drift } else { 0.0 };
    let value = judgement.raw / truth;
    After {
        half_width: judgement.uncertainty.half_width / judgement.raw.abs(),
        error: value - value.clamp(1.0, 1.0 + drift),
        verdict: judgement.verdict,
        why: judgement.reason.as_ref().map(ToString::to_string).unwrap_or_default(),
    }
}

fn promised(remedy: &Remedy) -> Option<f64> {
    match remedy {
        Remedy::Measure(promised) => Some(promised.half_width),
        Remedy::HoldLonger { half_width, .. } => Some(*half_width),
        _ => None,
    }
}

fn kind(remedy: &Remedy) -> &'static str {
    match remedy {
        Remedy::Measure(promised) => match promised.measurement {
            Measurement::Resistance { .. } => "R_s by a multimeter",
            Measurement::Stretch { place: Place::Id(_), .. } => "stretch at another i_d",
            Measurement::Stretch { place: Place::HalfLoad { .. }, .. } => "stretch at half the load",
            Measurement::Stretch { .. } => "stretch at half the speed",
            _ => "another measurement",
        },
        Remedy::AddStretch { .. } => "add a stretch (no width)",
        Remedy::HoldLonger { .. } => "hold longer",
        Remedy::SpreadPoints { .. } => "spread the points (no width)",
        Remedy::StateVoltageTiming => "state the timing (no width)",
        Remedy::CompensateDeadTime { .. } => "compensate dead time (no width)",
        Remedy::RemoveDisturbances => "stretch for the steady model (no width)",
        Remedy::CalibrateSensors => "calibrate the sensors (no width)",
        Remedy::SharperPrior => "sharper prior (no width)",
        _ => "another (no width)",
    }
}
