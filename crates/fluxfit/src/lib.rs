//! Draft.
pub mod error;
pub mod frames;
pub mod log;
pub mod motor;
pub mod optimizer;
