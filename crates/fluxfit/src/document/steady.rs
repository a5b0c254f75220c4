//! `diagnostics.steady` of an identification: the fit of the steady operating points.

use super::{by_parameter::ByParameter, finite::finite};
use crate::evidence::{Direction, Misfit, SteadyFit};
use serde::Serialize;

/// The fit of the steady operating points.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SteadyEntry {
    /// The parameters by weighted least squares, SI units.
    pub raw: ByParameter<Option<f64>>,
    /// Which combinations of the parameters the operating points excite, the strongest first.
    pub excitation: Vec<ExcitationEntry>,
    /// Weighted sum of the squared residuals.
    pub chi_squared: Option<f64>,
    /// How far the operating points contradict each other; null where they do not.
    pub misfit: Option<MisfitEntry>,
    /// What dead time and device drops take from each operating point's voltage along its current, V; zero where no loss is seen.
    pub voltage_losses: Vec<f64>,
}

impl SteadyEntry {
    pub(super) fn of(fit: &SteadyFit) -> Self {
        Self {
            raw: fit.estimate.motor.to_array().map(finite).into(),
            excitation: fit.excitation.directions.iter().map(ExcitationEntry::of).collect(),
            chi_squared: finite(fit.estimate.chi_squared),
            misfit: fit.misfit.as_ref().map(MisfitEntry::of),
            voltage_losses: fit.voltage_losses.clone(),
        }
    }
}

/// A combination of the parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ExcitationEntry {
    /// Its components, each parameter in units of what the voltage allows; of length 1.
    pub direction: ByParameter<f64>,
    /// The voltage that the combination moves, over the noise of that voltage.
    pub signal_to_noise: Option<f64>,
    /// Whether that is enough to tell the combination.
    pub excited: bool,
}

impl ExcitationEntry {
    fn of(direction: &Direction) -> Self {
        Self { direction: direction.components.into(), signal_to_noise: finite(direction.signal_to_noise), excited: direction.excited }
    }
}

/// Contradiction between operating points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MisfitEntry {
    /// Root of chi squared per degree of freedom.
    pub ratio: f64,
    /// The fraction of the voltage to which the points agree.
    pub voltage_accuracy: f64,
}

impl MisfitEntry {
    fn of(misfit: &Misfit) -> Self {
        Self { ratio: misfit.ratio, voltage_accuracy: misfit.voltage_accuracy }
    }
}
