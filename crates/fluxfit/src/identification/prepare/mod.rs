//! What is fitted: which model suits the log, which stretches of it, and the box in which a swarm searches.

pub(crate) mod model;
pub(crate) mod search_box;
pub(crate) mod standstill;
pub(crate) mod stretches;
