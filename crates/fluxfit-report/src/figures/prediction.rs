//! Measured against predicted: currents over time, or the voltages of operating points.

use super::{currents, voltage_residuals};
use crate::{
    current_comparison::CurrentComparison,
    figure::Figure,
    report::{Report, ValidationReport},
};
use fluxfit::{Validation, evidence::SteadyFit, log::Log, validation::prediction::Prediction};
use maud::html;

/// The figure of the held-out rows.
pub(crate) fn held_out<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (log, Some(validation)) = report.held_out? else { return None };
    figure("held-out", "held-out", log, validation)
}

/// The figure of a validation.
pub(crate) fn of_validation<'a>(report: &ValidationReport<'a>) -> Option<Figure<'a>> {
    figure("prediction", "prediction", report.log, report.found)
}

fn figure<'a>(name: &'static str, section: &'static str, log: &'a Log, validation: &'a Validation) -> Option<Figure<'a>> {
    match &validation.prediction {
        Prediction::Currents(stretches) => {
            let comparison = CurrentComparison::with_predicted(log, stretches);
            let caption = html! { " The mean of a correct prediction stays at zero." };
            Some(currents::of(name, section, comparison, &caption))
        }
        Prediction::Voltages(residuals) => {
            let fit = validation.own.steady.as_ref()?;
            let with_residuals = move || with_residuals(fit, residuals);
            Some(Figure {
                name,
                section,
                draw: Box::new(move |size| voltage_residuals::draw(&with_residuals(), size)),
                data: Some(Box::new(move || voltage_residuals::data(&with_residuals()))),
                caption: html! {
                    "Measured less predicted voltages (named fitted here), with error bars of two standard uncertainties. If an error bar does "
                    "not include zero, the prediction fails at that operating point."
                },
            })
        }
    }
}

/// The operating points of the log's own fit with the residuals of the prediction.
fn with_residuals(fit: &SteadyFit, residuals: &[[f64; 2]]) -> SteadyFit {
    let mut fit = fit.clone();
    fit.estimate.residuals = residuals.to_vec();
    fit
}
