//! The optimizers as others use them: against an independent program, by their laws, where they stop and what they refuse.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used)]

mod asking;
mod golden;
mod laws;
mod many_runs;
mod refusals;
mod saving;
mod stopping;

use fluxfit_optimize::{Bounds, Objective, objective_from};

/// Lowest at (0, 1), where it costs 0.5.
fn bowl() -> impl Objective {
    objective_from(2, |x| 0.5 + x[0] * x[0] + (x[1] - 1.0) * (x[1] - 1.0))
}

/// A box around the bowl's minimum.
fn bowl_box() -> Bounds {
    Bounds::new(vec![-2.0; 2], vec![2.0; 2]).unwrap()
}
