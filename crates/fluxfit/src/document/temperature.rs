//! The winding's temperature, as the documents have it.

use crate::{AtTemperature, Referred};
use serde::Serialize;

/// The winding's temperature in the rows that were used, and parameters at 20 degC.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TemperatureEntry {
    /// Mean over the rows used, weighted by the squared current, degC.
    pub mean: f64,
    /// Lowest, degC.
    pub lowest: f64,
    /// Highest, degC.
    pub highest: f64,
    /// By which part of itself a copper winding's resistance grows from the lowest to the highest.
    pub copper_gain: f64,
    /// R_s at 20 degC, ohm; null where it is not identified.
    pub rs_at_20: Option<ReferredEntry>,
    /// psi_f at 20 degC, Wb; null where it is not identified, or the magnets' coefficient was not stated.
    pub psi_f_at_20: Option<ReferredEntry>,
}

/// A value at 20 degC.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ReferredEntry {
    /// The value, SI units.
    pub value: f64,
    /// The 95 % interval: lower and upper end.
    pub ci95: [f64; 2],
}

impl TemperatureEntry {
    pub(super) fn of(found: &AtTemperature) -> Self {
        let AtTemperature { mean, lowest, highest, copper_gain, rs, psi_f } = *found;
        let referred = |value: Referred| ReferredEntry { value: value.value, ci95: value.interval };
        Self { mean, lowest, highest, copper_gain, rs_at_20: rs.map(referred), psi_f_at_20: psi_f.map(referred) }
    }
}
