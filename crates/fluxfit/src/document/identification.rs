//! The document of `identify`: schema `fluxfit.identification/1`.

use super::{
    by_parameter::{ByParameter, MotorWithCost},
    channel::PerChannel,
    convention::ConventionEntry,
    current_loop::CurrentLoopEntry,
    diagnostics::Diagnostics,
    finite::finite,
    log::LogDocument,
    nuisance::NuisanceEntries,
    temperature::TemperatureEntry,
    validation::ValidationDocument,
    warning::{CountedEntry, UnseenEntry, WarningEntry},
};
use crate::{
    Answer, Judgement,
    evidence::{Identification, Search},
    frames::Dq,
    motor::Motor,
    optimizer::StopReason,
};
use serde::{Serialize, Serializer};

/// The name of this document.
pub const IDENTIFICATION: &str = "fluxfit.identification/1";

/// What was found by the exact answer alone, without a swarm.
const LEAST_SQUARES: &str = "least-squares";

/// The document that `fluxfit identify --json` prints: the electrical parameters of a motor, each with interval and verdict. Fields are
/// added in later versions, never renamed. What is not known is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = IDENTIFICATION))]
#[non_exhaustive]
pub struct IdentificationDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = IDENTIFICATION)))]
    pub schema: &'static str,
    /// The log.
    pub log: LogDocument,
    /// The model that answered: the equations at steady operating points, or the output error of simulated currents.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::models())))]
    pub model: &'static str,
    /// Why this model answered.
    pub model_reason: String,
    /// The optimizer that searched beside the exact answer, or `least-squares` if none did.
    pub method: &'static str,
    /// The answer.
    pub parameters: ByParameter<ParameterEntry>,
    /// The winding's temperature, and parameters at 20 degC; null where the log has none.
    pub temperature: Option<TemperatureEntry>,
    /// The voltage timing and the faults of the drive.
    pub nuisance: NuisanceEntries,
    /// The exact answer of the steady operating points, and its cost, V²; null where there is no operating point. A parameter is null if
    /// its verdict is `not-identifiable`.
    pub least_squares: Option<MotorWithCost<Option<f64>>>,
    /// The optimizer's own answer, not polished; null if none searched.
    pub search: Option<SearchEntry>,
    /// What the fit leaves over.
    pub fit: FitEntry,
    /// What limits the whole answer, whatever the verdicts.
    pub warnings: Vec<WarningEntry>,
    /// Errors that no log shows, and that no interval counts; empty where nothing was identified.
    pub not_counted: Vec<UnseenEntry>,
    /// Errors that no log shows either, and that the intervals count, because their size was stated; empty where nothing was identified.
    pub counted: Vec<CountedEntry>,
    /// Raw numbers, whatever the verdicts.
    pub diagnostics: Diagnostics,
    /// Gains of the current controllers; absent unless asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(with = "CurrentLoopEntry"))]
    pub current_loop: Option<CurrentLoopEntry>,
    /// The answer validated on the part of the log that was held out; absent unless asked for, null where the answer lacks a parameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation: Option<Option<ValidationDocument>>,
}

impl IdentificationDocument {
    /// The document of an answer.
    pub fn of(whole: &Answer) -> Self {
        let Answer { log, identification: answer, convention, current_loop, held_out } = whole;
        Self {
            schema: IDENTIFICATION,
            log: LogDocument::of(log, answer.operating_points()),
            model: answer.model.model.key(),
            model_reason: answer.model.reason.to_string(),
            method: answer.method.map_or(LEAST_SQUARES, |method| method.key()),
            parameters: answer.parameters.each_ref().map(ParameterEntry::of).into(),
            temperature: answer.temperature.as_ref().map(TemperatureEntry::of),
            nuisance: NuisanceEntries::of(answer),
            least_squares: answer.steady.as_ref().map(|fit| {
                let (motor, objective) = (&fit.estimate.motor, &fit.estimate.objective);
                MotorWithCost { motor: identifiable(motor, answer), cost: objective.cost(motor) }
            }),
            search: answer.search.as_ref().map(|search| SearchEntry::of(search, answer)),
            fit: FitEntry::of(answer),
            warnings: answer.warnings.iter().map(WarningEntry::of).collect(),
            not_counted: answer.unseen.iter().map(UnseenEntry::of).collect(),
            counted: answer.counted.iter().map(CountedEntry::of).collect(),
            diagnostics: Diagnostics::of(answer, ConventionEntry::of(convention)),
            current_loop: current_loop.as_ref().map(CurrentLoopEntry::of),
            validation: held_out
                .as_ref()
                .map(|held_out| held_out.validation.as_ref().map(|validation| ValidationDocument::of(&held_out.log, validation))),
        }
    }
}

impl Serialize for Answer {
    /// As its document.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        IdentificationDocument::of(self).serialize(serializer)
    }
}

/// A motor's parameters, null where the verdict is `not-identifiable`.
fn identifiable(motor: &Motor, answer: &Identification) -> ByParameter<Option<f64>> {
    ByParameter::each(|parameter| answer.parameter(parameter).value().map(|_| motor.get(parameter)))
}

/// One parameter of the answer. Its numbers are null if the verdict is `not-identifiable`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ParameterEntry {
    /// The value, SI units.
    pub value: Option<f64>,
    /// Its unit: ohm, H or Wb.
    pub unit: &'static str,
    /// Standard error: `statistical` and `systematic` in quadrature.
    pub standard_error: Option<f64>,
    /// Standard error from the noise of the log.
    pub statistical: Option<f64>,
    /// Standard error from everything else, such as the accuracy of the voltages.
    pub systematic: Option<f64>,
    /// The 95 % interval: lower and upper end.
    pub ci95: Option<[f64; 2]>,
    /// `identified`: half of the interval is at most 5 % of the value; `weak`: at most 50 %; else `not-identifiable`.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::verdicts())))]
    pub verdict: &'static str,
    /// Why the verdict is not better, or that the value was given.
    pub reason: Option<String>,
    /// What to measure or to state for a better verdict.
    pub remedy: Option<String>,
}

impl ParameterEntry {
    fn of(judgement: &Judgement) -> Self {
        let uncertainty = judgement.value().map(|_| &judgement.uncertainty);
        Self {
            value: judgement.value(),
            unit: judgement.parameter.unit(),
            standard_error: uncertainty.map(|uncertainty| uncertainty.standard_error()),
            statistical: uncertainty.map(|uncertainty| uncertainty.statistical),
            systematic: uncertainty.map(|uncertainty| uncertainty.systematic.total()),
            ci95: judgement.interval(),
            verdict: judgement.verdict.key(),
            reason: judgement.reason.as_ref().map(ToString::to_string),
            remedy: judgement.remedy.as_ref().map(ToString::to_string),
        }
    }
}

/// What an optimizer found by itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SearchEntry {
    /// The best parameters and their cost, V² or A² by the model. A parameter is null if its verdict is `not-identifiable`.
    #[serde(flatten)]
    pub best: MotorWithCost<Option<f64>>,
    /// Cost above that of the exact answer.
    pub cost_above_optimum: Option<f64>,
    /// How often the function was evaluated.
    pub evaluations: u64,
    /// Why the search ended: `iteration-limit`, `close-to-optimum`, `target-cost` or `interrupted`.
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub stop_reason: StopReason,
}

impl SearchEntry {
    fn of(search: &Search, answer: &Identification) -> Self {
        Self {
            best: MotorWithCost { motor: identifiable(&search.motor, answer), cost: search.report.cost },
            cost_above_optimum: finite(search.cost_above_optimum),
            evaluations: search.report.evaluations,
            stop_reason: search.report.stop_reason,
        }
    }
}

/// What a fit leaves over.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FitEntry {
    /// Root mean square of the residuals: of the currents, A, or of the voltage equations over the operating points, V.
    pub residual_rms: PerChannel<Option<f64>>,
    /// Equations less unknowns.
    pub redundancy: Option<usize>,
}

impl FitEntry {
    fn of(answer: &Identification) -> Self {
        let redundancy = match (&answer.output, &answer.steady) {
            (Some(fit), _) => Some(fit.redundancy),
            (None, Some(fit)) => Some(fit.estimate.redundancy),
            (None, None) => None,
        };
        Self { residual_rms: residual_rms(answer), redundancy }
    }
}

fn residual_rms(answer: &Identification) -> PerChannel<Option<f64>> {
    if let Some(fit) = &answer.output {
        let Dq { d, q } = fit.residual_rms();
        return PerChannel::Currents { id: finite(d), iq: finite(q) };
    }
    let residuals = answer.steady.as_ref().map_or(&[][..], |fit| &fit.estimate.residuals);
    let rms = |axis: usize| (residuals.iter().map(|residual| residual[axis].powi(2)).sum::<f64>() / residuals.len() as f64).sqrt();
    PerChannel::Voltages { ud: finite(rms(0)), uq: finite(rms(1)) }
}
