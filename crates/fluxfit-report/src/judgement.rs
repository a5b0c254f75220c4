//! What sections and figures need to know of a parameter's judgement.

use fluxfit::{
    Judgement, Verdict,
    evidence::{IDENTIFIED, Identification},
};

/// Whether the parameter was given instead of identified: it then has neither an uncertainty nor a verdict.
pub(crate) fn is_given(judgement: &Judgement) -> bool {
    judgement.value().is_some() && judgement.uncertainty.standard_error() == 0.0
}

/// Whether the parameter was identified from the log, so that its estimate has an error.
pub(crate) fn has_error(judgement: &Judgement) -> bool {
    judgement.value().is_some() && !is_given(judgement)
}

/// Half-width of the 95 % interval as a fraction of the value; `None` without a value or an uncertainty.
pub(crate) fn relative_half_width(judgement: &Judgement) -> Option<f64> {
    let width = judgement.uncertainty.half_width / judgement.value()?.abs();
    (width > 0.0 && width.is_finite()).then_some(width)
}

/// Whether the parameter is weak for another reason than the width of its interval.
pub(crate) fn is_weak_though_narrow(judgement: &Judgement) -> bool {
    judgement.verdict == Verdict::Weak && relative_half_width(judgement).is_some_and(|width| width <= IDENTIFIED)
}

/// The correlation of two parameters' errors.
pub(crate) fn correlation(found: &Identification, one: &Judgement, other: &Judgement) -> f64 {
    found.correlation[one.parameter as usize][other.parameter as usize]
}

/// The two parameters whose errors are correlated most; `None` if fewer than two have an error.
pub(crate) fn most_correlated(found: &Identification) -> Option<[&Judgement; 2]> {
    let shown: Vec<&Judgement> = found.parameters.iter().filter(|judgement| has_error(judgement)).collect();
    let pairs = shown.iter().enumerate().flat_map(|(k, one)| shown[..k].iter().map(move |other| [*other, *one]));
    let strength = |[one, other]: &[&Judgement; 2]| correlation(found, one, other).abs();
    pairs.max_by(|pair, other| strength(pair).total_cmp(&strength(other)))
}
