//! Fitness (11): the error of the steady voltage equations.
//!
//! ```text
//! f(x) = sum_k 1/4 [ (u_d0 - û_d0)² + (u_q0 - û_q0)² + (u_d - û_d)² + (u_q - û_q)² ],   x = (R_s, L_d, L_q, psi_f)
//! ```
//!
//! over the samples of the two modes `i_d = 0` (index 0) and `i_d < 0`, with `û` from equation (2); for any number of operating
//! points the same sum over all of them. It is linear in `x`: one valley, solved exactly by
//! [`least_squares`](crate::least_squares), and evaluated through the same triangular factor in a few nanoseconds.
//!
//! The paper takes its samples as the voltages that acted. Those of a log differ slightly from them: each window comes with the
//! [zero-order-hold](crate::steady::zero_order_hold) correction, without which L_q is 0.02 % off on an exact log.
//!
//! Gao, Wang, Jiang and Hu, 2023, equations (2), (3) and (11).

use crate::{
    frames::Dq,
    least_squares::{Equation, Solution, TriangularFactor},
    log::Log,
    motor::{Motor, PARAMETERS},
    optimizer::Objective,
    parallel,
    steady::zero_order_hold::ZeroOrderHold,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The weights omega_1 to omega_4 of (11).
const WEIGHT: f64 = 0.25;

/// What stands for `i_d` in the mode `i_d = 0`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum IdZero {
    /// The current that was measured. Equation (3)'s zero moves R_s by 0.1 % and L_d by 0.2 % on a noisy log.
    #[default]
    Measured,
    /// Zero, as in equation (3), wherever the window's mean is within [`ID_ZERO_FRACTION`] of its current.
    AsPaper,
}

/// A window whose mean `i_d` is below this fraction of its mean current is a mode `i_d = 0`: well above a sensor's offset, well
/// below the paper's -2 A of 10 A.
pub const ID_ZERO_FRACTION: f64 = 0.02;

/// The squared error of the steady voltage equations.
#[derive(Debug, Clone, PartialEq)]
pub struct VoltageError {
    factor: TriangularFactor,
    solution: Solution,
}

impl VoltageError {
    /// Fitness (11) over every row of the windows, each with its zero-order-hold correction: a triangular factor per window, on all
    /// cores, merged in order.
    pub fn of_samples(log: &Log, windows: &[(Range<usize>, ZeroOrderHold)], id_zero: IdZero) -> Self {
        let factors = parallel::map(windows, |(rows, held)| factor_of(log, rows, held, id_zero));
        let empty = TriangularFactor::from_iter([]);
        Self::of_factor(factors.iter().fold(empty, TriangularFactor::merge))
    }

    /// The sum of squares of any equations of the four parameters.
    pub fn of_equations(equations: impl IntoIterator<Item = Equation>) -> Self {
        Self::of_factor(equations.into_iter().collect())
    }

    fn of_factor(factor: TriangularFactor) -> Self {
        Self { solution: factor.solve(), factor }
    }

    /// The exact minimum.
    pub fn least_squares(&self) -> &Solution {
        &self.solution
    }

    /// Cost of one motor.
    pub fn cost(&self, motor: &Motor) -> f64 {
        self.factor.cost(&motor.to_array())
    }

    /// `F - F_LS`, without cancellation.
    pub fn cost_above_optimum(&self, motor: &Motor) -> f64 {
        self.factor.excess(&motor.to_array(), &self.solution.motor.to_array())
    }
}

impl Objective for VoltageError {
    fn dimension(&self) -> usize {
        PARAMETERS
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        let (candidates, _) = candidates.as_chunks::<PARAMETERS>();
        for (candidate, cost) in candidates.iter().zip(costs) {
            *cost = self.factor.cost(candidate);
        }
    }
}

/// Equation (2) of one sample as two equations of the parameters. V, A, electrical rad/s; `[d, q]`. The resistance sees `mean`, the
/// current's mean over the sample's period; the fluxes are those of the sampled current `i`.
pub fn steady_equations(u: Dq, mean: Dq, i: Dq, omega_e: f64) -> [Equation; 2] {
    [
        Equation { coefficients: [mean.d, 0.0, -omega_e * i.q, 0.0], value: u.d },
        Equation { coefficients: [mean.q, omega_e * i.d, 0.0, omega_e], value: u.q },
    ]
}

/// The factor of one window's samples.
fn factor_of(log: &Log, window: &Range<usize>, held: &ZeroOrderHold, id_zero: IdZero) -> TriangularFactor {
    let columns = log.columns();
    let zeroed = id_zero == IdZero::AsPaper && is_id_zero(&columns.id[window.clone()], &columns.iq[window.clone()]);
    let equations = window.clone().flat_map(|k| {
        let (u, i, omega_e) = (Dq { d: columns.ud[k], q: columns.uq[k] }, Dq { d: columns.id[k], q: columns.iq[k] }, columns.omega_e[k]);
        let (u, mean) = held.correct(u, i, omega_e);
        let zero_d = |i: Dq| if zeroed { Dq { d: 0.0, ..i } } else { i };
        steady_equations(u, zero_d(mean), zero_d(i), omega_e)
    });
    equations.map(|equation| equation.weighted(WEIGHT.sqrt())).collect()
}

fn is_id_zero(id: &[f64], iq: &[f64]) -> bool {
    let sum = |column: &[f64]| column.iter().sum::<f64>();
    sum(id).abs() < ID_ZERO_FRACTION * sum(id).hypot(sum(iq))
}
