//! Verdicts: for each parameter a plain word.
//!
//! A verdict follows from the interval alone, and from what no motor has: a resistance, inductance or flux that is not positive
//! is never an answer.

use super::{
    Known, Settings,
    advice::Advice,
    estimate::Estimate,
    excitation::Excitation,
    explain::{explain, explain_currents, explain_misses, explain_no_angle, explain_no_noise},
    uncertainty::{ParameterUncertainty, Uncertainty},
};
use crate::{
    motor::{Motor, PARAMETERS, Parameter},
    steady::OperatingPoint,
};

/// Largest half-width of the 95 % interval, as a fraction of the value, of a parameter that is identified.
pub const IDENTIFIED: f64 = 0.05;

/// The same of one that is weak.
pub const WEAK: f64 = 0.50;

/// A verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Good to 5 %.
    Identified,
    /// Good to 50 %.
    Weak,
    /// The log cannot tell.
    NotIdentifiable,
}

impl Verdict {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Weak => "weak",
            Self::NotIdentifiable => "not-identifiable",
        }
    }
}

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
    /// Why the verdict is not better, or what was given.
    pub reason: Option<String>,
    /// What to do for a better one.
    pub remedy: Option<String>,
}

impl Judgement {
    /// The value, where it means something.
    pub fn value(&self) -> Option<f64> {
        (self.verdict != Verdict::NotIdentifiable).then_some(self.raw)
    }

    /// The 95 % interval, where the value means something.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.value().map(|value| [value - self.uncertainty.half_width, value + self.uncertainty.half_width])
    }
}

/// Judges every parameter of the operating points' motor.
pub(super) fn judge(
    points: &[OperatingPoint],
    excitation: &Excitation,
    estimate: &Estimate,
    uncertainty: &Uncertainty,
    advice: &Advice,
    settings: &Settings,
) -> [Judgement; PARAMETERS] {
    let explained = |parameter: Parameter, raw: f64, uncertainty: &ParameterUncertainty| {
        explain(parameter, points, excitation, raw, uncertainty, advice)
    };
    beside_negative(judge_motor(&estimate.motor, uncertainty, settings, explained), settings)
}

/// Judges every parameter of the simulated currents' motor.
pub(super) fn judge_currents(
    motor: &Motor,
    uncertainty: &Uncertainty,
    advice: &Advice,
    trust: &Trust,
    settings: &Settings,
) -> [Judgement; PARAMETERS] {
    let mut judged =
        judge_motor(motor, uncertainty, settings, |parameter, raw, uncertainty| explain_currents(parameter, raw, uncertainty, advice));
    let why = if trust.correlation_of_neighbours > NO_NOISE {
        Some(explain_no_noise(trust.correlation_of_neighbours))
    } else {
        trust.disturbed_without_angle.then(explain_no_angle)
    };
    if let Some((reason, remedy)) = why {
        for judgement in judged.iter_mut().filter(|judgement| judgement.verdict == Verdict::Identified && judgement.reason.is_none()) {
            judgement.verdict = Verdict::Weak;
            // The interval says what the verdict says: an interval from noise alone would be as sharp as it is wrong.
            judgement.uncertainty = judgement.uncertainty.no_sharper_than(IDENTIFIED * judgement.raw.abs());
            (judgement.reason, judgement.remedy) = (Some(reason.clone()), Some(remedy.clone()));
        }
    }
    if trust.correlation_of_neighbours > NO_NOISE && trust.misses > MISSES {
        let (reason, remedy) = explain_misses(trust.misses);
        distrust(&mut judged, settings, &reason, &remedy);
    }
    beside_negative(judged, settings)
}

/// What no motor has is no accident of one parameter: the others come from the same fit.
fn beside_negative(mut judged: [Judgement; PARAMETERS], settings: &Settings) -> [Judgement; PARAMETERS] {
    let negative = judged.iter().find(|judgement| judgement.raw <= 0.0 && judgement.uncertainty.half_width < WEAK * judgement.raw.abs());
    let told = negative.map(|negative| (negative.parameter, negative.reason.clone(), negative.remedy.clone().unwrap_or_default()));
    if let Some((parameter, reason, remedy)) = told {
        let why = format!("{} came out negative, so nothing else of this fit is to be trusted", parameter.symbol());
        distrust(&mut judged, settings, &why, &remedy);
        judged[parameter as usize].reason = reason;
    }
    judged
}

/// Takes back every parameter that was not given.
fn distrust(judged: &mut [Judgement; PARAMETERS], settings: &Settings, reason: &str, remedy: &str) {
    for (judgement, known) in judged.iter_mut().zip(&settings.known) {
        if !matches!(known, Known::Fixed(_)) {
            judgement.verdict = Verdict::NotIdentifiable;
            (judgement.reason, judgement.remedy) = (Some(reason.to_owned()), Some(remedy.to_owned()));
        }
    }
}

/// What speaks against a fit of simulated currents, whatever its intervals say.
pub(super) struct Trust {
    /// Correlation of neighbouring residuals.
    pub(super) correlation_of_neighbours: f64,
    /// An observer follows disturbances that nobody could ask for dead time or faults of the sensors.
    pub(super) disturbed_without_angle: bool,
    /// What the simulated currents miss, root mean square, as a part of the largest current.
    pub(super) misses: f64,
}

/// Simulated currents that miss by more than this part of the largest, and not by noise, are no motor's: voltages and currents do not
/// belong together. Dead time that takes four times what R_s does leaves 0.005.
const MISSES: f64 = 0.15;

/// Correlation of neighbouring residuals from which on they are not noise: something is in the log that the model does not have, and
/// an interval that comes from noise says nothing of it.
const NO_NOISE: f64 = 0.3;

fn judge_motor(
    motor: &Motor,
    uncertainty: &Uncertainty,
    settings: &Settings,
    explain: impl Fn(Parameter, f64, &ParameterUncertainty) -> (String, String),
) -> [Judgement; PARAMETERS] {
    Parameter::ALL.map(|parameter| {
        let raw = motor.get(parameter);
        let uncertainty = uncertainty.parameters[parameter as usize];
        let width = uncertainty.half_width / raw.abs();
        let verdict = match width {
            _ if matches!(settings.known[parameter as usize], Known::Fixed(_)) => Verdict::Identified,
            _ if raw <= 0.0 => Verdict::NotIdentifiable,
            w if w <= IDENTIFIED => Verdict::Identified,
            w if w <= WEAK => Verdict::Weak,
            _ => Verdict::NotIdentifiable,
        };
        let (reason, remedy) = match (settings.known[parameter as usize], verdict) {
            (Known::Fixed(_), _) => (Some("given, not identified".to_owned()), None),
            (_, Verdict::Identified) => (None, None),
            _ => {
                let (reason, remedy) = explain(parameter, raw, &uncertainty);
                (Some(reason), Some(remedy))
            }
        };
        Judgement { parameter, raw, uncertainty, verdict, reason, remedy }
    })
}
