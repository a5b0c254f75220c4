//! Judgement: for each parameter a verdict, and the reason where it is not `identified`. Knows numbers only.

pub mod reason;
pub mod verdict;
