//! The exact minimum, for honesty: fitness (11) is linear least squares, and needs no swarm.

use crate::timing::median_seconds;
use fluxfit::{
    frames::Dq,
    least_squares::TriangularFactor,
    log::Log,
    objective::voltage_error::{IdZero, VoltageError, steady_equations},
    steady::zero_order_hold::ZeroOrderHold,
};
use serde::Serialize;
use std::{hint::black_box, ops::Range};

const REPEATS: usize = 201;

/// Exact least squares.
#[derive(Serialize)]
pub(crate) struct Figures {
    /// All rows to the triangular factor, and its solution.
    microseconds_from_rows: f64,
    /// The solution of a factor at hand.
    microseconds_solve: f64,
}

/// Times both.
pub(crate) fn measure(log: &Log, modes: &[(Range<usize>, ZeroOrderHold)]) -> Figures {
    let columns = log.columns();
    let equations = modes.iter().flat_map(|(rows, _)| rows.clone()).flat_map(|k| {
        let (u, i) = (Dq { d: columns.ud[k], q: columns.uq[k] }, Dq { d: columns.id[k], q: columns.iq[k] });
        steady_equations(u, i, i, columns.omega_e[k])
    });
    let factor: TriangularFactor = equations.collect();
    Figures {
        microseconds_from_rows: 1e6 * median_seconds(REPEATS, |_| VoltageError::of_samples(black_box(log), modes, IdZero::Measured)),
        microseconds_solve: 1e6 * median_seconds(REPEATS, |_| black_box(&factor).solve()),
    }
}
