//! What every page keeps: nothing is loaded, what runs asks for nothing, the markup is sound, no number without a meaning is on it.
//!
//! All integration tests of this crate, linked once; a file per topic.

mod figures;
mod fleet;
mod identification;
mod interactive;
mod logs;
mod markup;
mod online;
mod study;
mod validation;
