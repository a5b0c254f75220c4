//! What an answer rests on: the fits behind it, their uncertainty, and what was tried.

pub use crate::identification::{
    explain::{
        conventions::{Candidate, Convention, Ratio, TOLERANCE, compare_with_nameplate, patterns::Pattern},
        left_out::{LeftOut, LeftOutReason},
    },
    fit::{
        estimate::Estimate,
        excitation::{Direction, Excitation},
        fault_trial::{FaultOutcome, FaultTrial},
        finding::{Finding, Trust},
        frame_lag::FrameLag,
        incremental::Incremental,
        misfit::Misfit,
        output::OutputFit,
        output_errors::FaultEstimate,
        part::Part,
        readings::{TimingTrial, VERY_STRONG},
        saturation::{Apparent, Flux, SaturationFinding},
        steady::{SteadyFit, operating_points},
        swarm::Search,
        uncertainty::{ParameterUncertainty, Systematic, Uncertainty},
        warming::Warming,
    },
    judge::verdict::{IDENTIFIED, WEAK},
    prepare::model::{ModelChoice, ModelReason, SLOWEST_CONTROL, choose as choose_model},
    request::{Provenance, Resolved, VOLTAGE_ACCURACY},
    solve::Identification,
};
