//! Draft.
pub mod error;
pub mod frames;
pub mod identify;
pub mod least_squares;
pub mod log;
pub mod motor;
pub mod objective;
pub mod optimizer;
pub mod steady;
pub mod study;
