//! Values under the four parameters' names: `{ "rs": .., "ld": .., "lq": .., "psi_f": .. }`.

use crate::{
    motor::{Motor, PARAMETERS, Parameter},
    optimizer::Bounds,
};
use serde::Serialize;

/// One value for each parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "ByParameterOf_{T}"))]
#[non_exhaustive]
pub struct ByParameter<T> {
    /// Stator resistance R_s; its unit is ohm.
    pub rs: T,
    /// Inductance L_d along the magnet; its unit is H.
    pub ld: T,
    /// Inductance L_q across the magnet; its unit is H.
    pub lq: T,
    /// Flux linkage psi_f of the magnet, peak per phase; its unit is Wb.
    pub psi_f: T,
}

impl<T> From<[T; PARAMETERS]> for ByParameter<T> {
    /// From values in the order of [`Parameter::ALL`].
    fn from([rs, ld, lq, psi_f]: [T; PARAMETERS]) -> Self {
        Self { rs, ld, lq, psi_f }
    }
}

impl<T> ByParameter<T> {
    /// Computes the value of each parameter.
    pub fn each(value: impl FnMut(Parameter) -> T) -> Self {
        Self::from(Parameter::ALL.map(value))
    }
}

impl From<&Motor> for ByParameter<f64> {
    fn from(motor: &Motor) -> Self {
        Self::from(motor.to_array())
    }
}

impl ByParameter<[f64; 2]> {
    /// The lower and the upper side of a search box of the four parameters.
    pub(super) fn of_box(bounds: &Bounds) -> Self {
        let mut sides = [[0.0; 2]; PARAMETERS];
        sides.iter_mut().zip(bounds.iter()).for_each(|(side, (lower, upper))| *side = [lower, upper]);
        Self::from(sides)
    }
}

/// A motor and its cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "CostOf_{T}"))]
#[non_exhaustive]
pub struct MotorWithCost<T> {
    /// The parameters, SI units.
    #[serde(flatten)]
    pub motor: ByParameter<T>,
    /// The value of the function that was minimized.
    pub cost: f64,
}
