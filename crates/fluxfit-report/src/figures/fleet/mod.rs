//! The figures of a fleet.

mod distributions;
mod drifts;

pub(crate) use distributions::figure as distributions;
pub(crate) use drifts::figure as drifts;
