//! Every integration test of this crate, linked once; a file per topic.
//!
//! `cargo test -p fluxfit-drive --test all faults -- --nocapture` runs one topic and prints what it found.

mod changes;
mod common_gains;
mod control;
mod conventions;
mod dead_time;
mod drive;
mod faults;
mod harmonics;
mod independent_simulator;
mod inverter;
mod laws;
mod logging;
mod ode_oracle;
mod output_error;
mod refusals;
mod rows_far_apart;
mod saturation;
mod sensors;
mod standstill;
mod study;
mod temperature;
mod validate;
