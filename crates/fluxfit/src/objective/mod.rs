//! What is minimized: the error between the real motor and the adjustable one.
//!
//! A fitness is one file here and implements [`Objective`](crate::optimizer::Objective).

pub mod acting_voltage;
pub mod adjustable;
mod angles;
mod batch;
pub mod output_error;
mod simulated_segment;
mod simulation;
pub mod transition;
mod transition_lanes;
mod transition_polynomials;
pub mod voltage_error;
