//! The polish: from near a minimum of the output error into it.
//!
//! Levenberg's and Marquardt's method on the residuals, with derivatives by central differences; J. J. Moré, "The Levenberg-Marquardt
//! algorithm: implementation and theory", 1978, doi:10.1007/BFb0067700, as the crate of that name has it. Parameters are counted in
//! units of the start, so that ohms and henries weigh alike.

use crate::{
    motor::{Motor, PARAMETERS},
    objective::output_error::OutputError,
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DVector, Dyn, OMatrix, Owned, U4, Vector4};

/// Step of the differences, relative: the cube root of rounding, at which the errors of a central difference are least.
const STEP: f64 = 6e-6;

/// Where a polish ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polished {
    /// The motor.
    pub motor: Motor,
    /// Its cost, A².
    pub cost: f64,
    /// Whether this is a minimum.
    pub converged: bool,
}

/// Polishes a motor. A start that has no finite cost is where it ends.
pub fn polish(objective: &OutputError, start: &Motor) -> Polished {
    let scale = Vector4::from(start.to_array().map(|value| if value == 0.0 { 1.0 } else { value.abs() }));
    let units = Vector4::from(start.to_array()).component_div(&scale);
    let (problem, report) = LevenbergMarquardt::new().minimize(Problem { objective, scale, units });
    let motor = problem.motor();
    Polished { motor, cost: objective.cost(&motor), converged: report.termination.was_successful() }
}

/// Derivatives of the residuals by each parameter, A per SI unit: columns in the order of the parameters.
pub fn jacobian(objective: &OutputError, motor: &Motor) -> [Vec<f64>; PARAMETERS] {
    std::array::from_fn(|p| {
        let moved = |by: f64| {
            let mut values = motor.to_array();
            values[p] += by;
            objective.residuals(&Motor::from(values))
        };
        let step = STEP * if motor.to_array()[p] == 0.0 { 1.0 } else { motor.to_array()[p].abs() };
        moved(step).iter().zip(moved(-step)).map(|(above, below)| (above - below) / (2.0 * step)).collect()
    })
}

struct Problem<'a> {
    objective: &'a OutputError,
    scale: Vector4<f64>,
    units: Vector4<f64>,
}

impl Problem<'_> {
    fn motor(&self) -> Motor {
        Motor::from(<[f64; PARAMETERS]>::from(self.units.component_mul(&self.scale)))
    }
}

impl LeastSquaresProblem<f64, Dyn, U4> for Problem<'_> {
    type ParameterStorage = Owned<f64, U4>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U4>;

    fn set_params(&mut self, units: &Vector4<f64>) {
        self.units = *units;
    }

    fn params(&self) -> Vector4<f64> {
        self.units
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let residuals = self.objective.residuals(&self.motor());
        residuals.iter().all(|residual| residual.is_finite()).then(|| DVector::from_vec(residuals))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U4>> {
        let columns = jacobian(self.objective, &self.motor());
        let matrix = OMatrix::<f64, Dyn, U4>::from_fn(columns[0].len(), |row, column| columns[column][row] * self.scale[column]);
        matrix.iter().all(|entry| entry.is_finite()).then_some(matrix)
    }
}
