//! Explanation: what to do about a verdict, what to know of the whole, and whether a nameplate agrees. Facts; the sentences are in
//! [`words`](crate::words).

pub(crate) mod conventions;
pub(crate) mod judgement;
pub(crate) mod left_out;
pub(crate) mod measurement;
mod promising;
pub(crate) mod remedy;
mod shared_step;
pub(crate) mod summary;
pub(crate) mod temperature;
pub(crate) mod trial;
pub(crate) mod unseen;
pub(crate) mod warning;
