//! Explanation: what to do about a verdict, what to know of the whole, and whether a nameplate agrees. Facts; the sentences are in
//! [`words`](crate::words).

pub mod conventions;
pub mod judgement;
pub mod measurement;
pub mod remedy;
pub mod warning;
