//! `diagnostics` of an identification: raw numbers, whatever the verdicts.

use super::{
    by_parameter::ByParameter, convention::ConventionEntry, finite::finite, output_error::OutputErrorEntry, saturation::SaturationEntry,
    steady::SteadyEntry,
};
use crate::{
    evidence::{Identification, Systematic},
    motor::PARAMETERS,
};
use serde::Serialize;

/// Raw numbers of an identification, whatever the verdicts.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Diagnostics {
    /// What the fit gave, SI units; no answer where the verdict is `not-identifiable`.
    pub raw: ByParameter<Option<f64>>,
    /// Its standard error, SI units.
    pub raw_standard_error: ByParameter<Option<f64>>,
    /// What the optimizer found, SI units; null if none searched.
    pub raw_search: Option<ByParameter<f64>>,
    /// The parts of the systematic standard error, SI units.
    pub systematic: ByParameter<SystematicEntry>,
    /// Degrees of freedom of the standard error, by which the interval follows from Student's t.
    pub degrees_of_freedom: ByParameter<f64>,
    /// Correlation of the parameters' errors, in the order R_s, L_d, L_q, psi_f.
    pub correlation: [[Option<f64>; PARAMETERS]; PARAMETERS],
    /// Lower and upper bound of the optimizer's search, SI units; null if none searched.
    pub search_box: Option<ByParameter<[f64; 2]>>,
    /// Flux at the operating points of a motor that saturates; null where nothing shows saturation.
    pub saturation: Option<SaturationEntry>,
    /// The fit of the steady operating points; null where there is none.
    pub steady: Option<SteadyEntry>,
    /// The fit of the simulated currents; null where the steady model answered.
    pub output_error: Option<OutputErrorEntry>,
    /// The comparison with the nameplate; null where nothing could be compared.
    pub convention: Option<ConventionEntry>,
}

impl Diagnostics {
    pub(super) fn of(answer: &Identification, convention: Option<ConventionEntry>) -> Self {
        Self {
            raw: ByParameter::each(|parameter| finite(answer.parameter(parameter).raw)),
            raw_standard_error: ByParameter::each(|parameter| finite(answer.parameter(parameter).uncertainty.standard_error())),
            raw_search: answer.search.as_ref().map(|search| (&search.motor).into()),
            systematic: ByParameter::each(|parameter| SystematicEntry::of(&answer.parameter(parameter).uncertainty.systematic)),
            degrees_of_freedom: ByParameter::each(|parameter| answer.parameter(parameter).uncertainty.degrees_of_freedom),
            correlation: answer.correlation.map(|row| row.map(finite)),
            search_box: answer.search.as_ref().map(|search| ByParameter::of_box(&search.bounds)),
            saturation: answer.saturation.as_ref().map(SaturationEntry::of),
            steady: answer.steady.as_ref().map(SteadyEntry::of),
            output_error: answer.output.as_ref().map(OutputErrorEntry::of),
            convention,
        }
    }
}

/// The parts of a systematic standard error, in the parameter's unit; they add in quadrature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SystematicEntry {
    /// From the standard errors of parameters that were known beforehand.
    pub prior: Option<f64>,
    /// From the timing of the voltage columns.
    pub timing: Option<f64>,
    /// From dead time and device drops.
    pub dead_time: Option<f64>,
    /// From a recorder's voltages that may turn with speed against its currents.
    pub frame_lag: Option<f64>,
    /// From what goes on within rows that each span several of the drive's periods.
    pub within_rows: Option<f64>,
    /// From unknown voltages that disturb the motor.
    pub process_noise: Option<f64>,
    /// From faults of the drive that the log neither proves nor rules out.
    pub faults_in_doubt: Option<f64>,
    /// From current sensors whose gains differ.
    pub sensors: Option<f64>,
    /// From the stated accuracy of a gain common to all current sensors.
    pub current_gain: Option<f64>,
    /// From the stated accuracy of the DC voltage.
    pub bus_voltage: Option<f64>,
    /// From inductances that depend on the current.
    pub saturation: Option<f64>,
    /// From combinations of the parameters that the log does not excite.
    pub excitation: Option<f64>,
    /// From operating points that contradict each other; then in the place of `accuracy`.
    pub misfit: Option<f64>,
    /// From the accuracy of the voltages.
    pub accuracy: Option<f64>,
}

impl SystematicEntry {
    fn of(parts: &Systematic) -> Self {
        Self {
            prior: finite(parts.prior),
            timing: finite(parts.timing),
            dead_time: finite(parts.dead_time.hypot(parts.loss_shape)),
            frame_lag: finite(parts.frame_lag),
            within_rows: finite(parts.within_rows),
            process_noise: finite(parts.process_noise),
            faults_in_doubt: finite(parts.faults_in_doubt),
            sensors: finite(parts.sensors),
            current_gain: finite(parts.current_gain),
            bus_voltage: finite(parts.bus_voltage),
            saturation: finite(parts.saturation),
            excitation: finite(parts.excitation),
            misfit: finite(parts.misfit),
            accuracy: finite(parts.accuracy),
        }
    }
}
