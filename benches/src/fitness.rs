//! Fitness (11) alone, through the triangular factor.

use crate::timing::median_seconds;
use fluxfit::{
    objective::voltage_error::VoltageError,
    optimizer::{Bounds, Objective},
};
use std::hint::black_box;

/// Candidates per call: the population of a run.
const CANDIDATES: usize = 50;

/// Calls per reading of the clock, which alone takes as long as a few evaluations.
const CALLS: usize = 1000;

/// Readings.
const REPEATS: usize = 201;

/// Median time of one evaluation, ns.
pub(crate) fn nanoseconds_per_evaluation(objective: &VoltageError, bounds: &Bounds) -> f64 {
    // Candidates along the box's diagonal: the time does not depend on where they are.
    let along = |i: usize| bounds.iter().map(move |(lower, upper)| lower + (upper - lower) * i as f64 / CANDIDATES as f64);
    let candidates: Vec<f64> = (0..CANDIDATES).flat_map(along).collect();
    let mut costs = vec![0.0; CANDIDATES];
    let seconds = median_seconds(REPEATS, |_| {
        for _ in 0..CALLS {
            objective.evaluate(black_box(&candidates), black_box(&mut costs));
        }
    });
    1e9 * seconds / (CALLS * CANDIDATES) as f64
}
