//! Judgement: for each parameter a verdict, and the reason where it is not `identified`. Knows numbers only.

pub(crate) mod points_tell_more;
pub(crate) mod priors;
pub(crate) mod reason;
pub(crate) mod verdict;
