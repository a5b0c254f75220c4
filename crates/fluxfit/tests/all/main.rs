//! The integration tests of this crate, linked once; a file per topic.

mod current_loop;
mod identify_laws;
mod request;
mod saturation;
mod steady_statistics;
