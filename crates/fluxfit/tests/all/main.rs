//! The integration tests of this crate, linked once; a file per topic.

mod any_log;
mod current_loop;
mod identify_laws;
mod lagging_voltages;
mod readings;
mod request;
mod saturation;
mod short_circuit;
mod standstill;
mod steady_statistics;
mod temperature;
