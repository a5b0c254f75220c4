//! Fits: a motor and its uncertainty, from steady operating points or from simulated currents.

mod coasting;
pub(crate) mod common_gains;
pub(crate) mod estimate;
pub(crate) mod excitation;
pub(crate) mod fault_search;
pub(crate) mod finding;
mod frame_free;
pub(crate) mod frame_lag;
pub(crate) mod incremental;
pub(crate) mod long_run;
pub(crate) mod misfit;
mod open_loop;
pub(crate) mod output;
mod output_choice;
pub(crate) mod output_errors;
pub(crate) mod output_excitation;
mod output_start;
pub(crate) mod part;
pub(crate) mod readings;
pub(crate) mod saturation;
mod saturation_equations;
pub(crate) mod steady;
pub(crate) mod swarm;
pub(crate) mod uncertainty;
mod undetected_loss;
mod voltage_accuracy;
pub(crate) mod voltage_loss;
