//! What a program of this crate shares with its test.

pub mod coverage;
