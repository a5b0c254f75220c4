//! What sections and figures need to know of a parameter's judgement.

use fluxfit::Judgement;

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
