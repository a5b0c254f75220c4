//! `diagnostics.saturation` of an identification: flux at the operating points of a motor that saturates.

use super::by_parameter::ByParameter;
use crate::evidence::{Apparent, Flux, Incremental, SaturationFinding};
use serde::Serialize;

/// Flux at the operating points, where inductances depend on the current.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SaturationEntry {
    /// Resistance that the fluxes were computed with, ohm.
    pub rs: f64,
    /// Its standard uncertainty, ohm; zero where it was given.
    pub rs_standard_uncertainty: f64,
    /// Whether points of one current at several speeds tell it, however the flux depends on the current: then it is the answer.
    pub tells_rs: bool,
    /// The apparent L_q at the smallest and at the largest i_q at which it could be computed; null where it could not.
    pub apparent_lq: Option<[ApparentEntry; 2]>,
    /// The parameters at small currents: the constants beside the terms of saturation, SI units.
    pub small_currents: ByParameter<f64>,
    /// The flux at each operating point, in their order; null at a point without speed.
    pub flux: Vec<Option<FluxEntry>>,
    /// The incremental inductances between operating points close to each other; of pairs at the same currents the surest.
    pub incremental: Vec<IncrementalEntry>,
}

impl SaturationEntry {
    pub(super) fn of(found: &SaturationFinding) -> Self {
        Self {
            rs: found.rs,
            rs_standard_uncertainty: found.rs_uncertainty,
            tells_rs: found.tells_rs,
            apparent_lq: found.lq.as_ref().map(|ends| ends.each_ref().map(ApparentEntry::of)),
            small_currents: (&found.small_currents).into(),
            flux: found.fluxes.iter().map(|flux| flux.as_ref().map(FluxEntry::of)).collect(),
            incremental: found.incremental().iter().map(IncrementalEntry::of).collect(),
        }
    }
}

/// An apparent inductance along q: flux over current.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ApparentEntry {
    /// Current along q, A.
    pub iq: f64,
    /// `psi_q / i_q`, H.
    pub value: f64,
}

impl ApparentEntry {
    fn of(apparent: &Apparent) -> Self {
        Self { iq: apparent.current, value: apparent.inductance }
    }
}

/// The flux at an operating point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FluxEntry {
    /// Current along d, A.
    pub id: f64,
    /// Current along q, A.
    pub iq: f64,
    /// Flux linkage along d, Wb.
    pub psi_d: f64,
    /// Flux linkage along q, Wb.
    pub psi_q: f64,
    /// Standard uncertainty of `psi_d`, Wb.
    pub psi_d_standard_uncertainty: f64,
    /// Standard uncertainty of `psi_q`, Wb.
    pub psi_q_standard_uncertainty: f64,
    /// `(psi_d - psi_f) / i_d`, H; null where i_d is too small, or psi_f is not known beforehand.
    pub apparent_ld: Option<f64>,
    /// `psi_q / i_q`, H; null where i_q is too small, or psi_q is not known to half of its size.
    pub apparent_lq: Option<f64>,
}

impl FluxEntry {
    fn of(flux: &Flux) -> Self {
        Self {
            id: flux.current.d,
            iq: flux.current.q,
            psi_d: flux.psi.d,
            psi_q: flux.psi.q,
            psi_d_standard_uncertainty: flux.uncertainty.d,
            psi_q_standard_uncertainty: flux.uncertainty.q,
            apparent_ld: flux.apparent_ld,
            apparent_lq: flux.apparent_lq,
        }
    }
}

/// An incremental inductance, `d psi / d i` along one axis, between two operating points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IncrementalEntry {
    /// `d` or `q`.
    pub axis: &'static str,
    /// The two operating points, counted from 0.
    pub points: [usize; 2],
    /// Current along d halfway between them, A.
    pub id: f64,
    /// Current along q halfway between them, A.
    pub iq: f64,
    /// H.
    pub value: f64,
    /// Its standard uncertainty, H.
    pub standard_uncertainty: f64,
}

impl IncrementalEntry {
    fn of(one: &Incremental) -> Self {
        Self {
            axis: ["d", "q"][one.axis],
            points: one.points,
            id: one.current.d,
            iq: one.current.q,
            value: one.inductance,
            standard_uncertainty: one.uncertainty,
        }
    }
}
