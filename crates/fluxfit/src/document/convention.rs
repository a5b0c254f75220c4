//! `diagnostics.convention` of an identification: the log compared with the nameplate.

use super::by_parameter::ByParameter;
use crate::{
    evidence::{Candidate, Convention, Pattern},
    motor::Parameter,
};
use serde::Serialize;

/// The comparison of the log with the nameplate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConventionEntry {
    /// Whether everything that can be compared agrees.
    pub agrees: bool,
    /// Whether u_q and the speed have opposite signs, so that the flux is negative.
    pub reversed: bool,
    /// The log's value over the nameplate's; null for a parameter that one of them lacks.
    pub ratio: ByParameter<Option<f64>>,
    /// Whether the ratio of psi_f is that of the apparent flux of the rows, not of an identified one.
    pub apparent_flux: bool,
    /// The confusion of units or conventions that explains the ratios best; null where they agree, or no known confusion explains them.
    pub best: Option<CandidateEntry>,
    /// Confusions that explain as many of the ratios, the next best first.
    pub alternatives: Vec<CandidateEntry>,
}

impl ConventionEntry {
    /// None where nothing could be compared.
    pub(super) fn of(convention: &Convention) -> Option<Self> {
        let of = |parameter| convention.ratios.iter().find(|ratio| ratio.parameter == parameter);
        (!convention.ratios.is_empty()).then(|| Self {
            agrees: convention.agrees(),
            reversed: convention.reversed,
            ratio: ByParameter::each(|parameter| of(parameter).map(|ratio| ratio.ratio)),
            apparent_flux: of(Parameter::PsiF).is_some_and(|ratio| ratio.apparent),
            best: convention.best.as_ref().map(CandidateEntry::of),
            alternatives: convention.alternatives.iter().map(CandidateEntry::of).collect(),
        })
    }
}

/// One confusion of units or conventions, or two together.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CandidateEntry {
    /// The confusions.
    pub patterns: Vec<PatternEntry>,
    /// How many times the nameplate's they make the log's parameters.
    pub factors: ByParameter<f64>,
    /// The keys of the parameters that they bring or leave within tolerance.
    pub explains: Vec<&'static str>,
}

impl CandidateEntry {
    fn of(candidate: &Candidate) -> Self {
        Self {
            patterns: candidate.patterns.iter().map(PatternEntry::of).collect(),
            factors: candidate.factors.into(),
            explains: candidate.explained.iter().map(|parameter| parameter.key()).collect(),
        }
    }
}

/// A confusion of units or conventions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PatternEntry {
    /// Its name.
    pub name: &'static str,
    /// What would have happened.
    pub sentence: String,
    /// How many times too large it makes the columns of the log; null if the nameplate is what differs.
    pub columns: Option<ColumnFactors>,
}

impl PatternEntry {
    fn of(pattern: &Pattern) -> Self {
        let columns = pattern.columns.map(|[u, i, omega]| ColumnFactors { u, i, omega });
        Self { name: pattern.name, sentence: pattern.sentence.to_string(), columns }
    }
}

/// How many times too large the columns of a log are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ColumnFactors {
    /// The voltages.
    pub u: f64,
    /// The currents.
    pub i: f64,
    /// The speed.
    pub omega: f64,
}
