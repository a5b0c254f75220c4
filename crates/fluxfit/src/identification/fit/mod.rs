//! Fits: a motor and its uncertainty, from steady operating points or from simulated currents.

pub mod dead_time;
pub mod estimate;
pub mod excitation;
pub(crate) mod finding;
pub(crate) mod long_run;
pub mod misfit;
pub mod output;
mod output_choice;
pub mod output_errors;
mod output_start;
pub mod readings;
pub mod saturation;
mod saturation_equations;
pub mod steady;
pub(crate) mod swarm;
pub mod terms;
pub mod uncertainty;
mod voltage_accuracy;
