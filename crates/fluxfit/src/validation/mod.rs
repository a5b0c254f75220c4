//! Validation: given parameters against a log that they were not found from.

pub mod given;
pub mod prediction;
pub mod validate;
pub mod wald;
