//! What is minimized: the error between the real motor and the adjustable one.
//!
//! A fitness is one file here and implements [`Objective`](crate::optimizer::Objective).

pub mod acting_voltage;
pub mod adjustable;
pub mod output_error;
mod simulated_segment;
pub mod transition;
mod transition_table;
pub mod voltage_error;
