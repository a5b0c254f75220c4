//! The polish: from near a minimum of the output error into it.
//!
//! Levenberg's and Marquardt's method on the residuals, with derivatives by central differences (fits that are only compared with each
//! other take forward ones, which cost half); J. J. Moré, "The Levenberg-Marquardt algorithm: implementation and theory", 1978,
//! doi:10.1007/BFb0067700, as the crate of that name has it. Unknowns are counted in units of their usual size, so that ohms and henries
//! weigh alike; one that enters linearly is solved in one step.

use crate::{
    motor::{Motor, Parameter},
    objective::{
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};
use std::cell::Cell;

/// Step of the differences, in the unknowns' units: the cube root of rounding, at which the errors of a central difference are least.
const STEP: f64 = 6e-6;

/// The same of a forward difference: the square root of rounding, or somewhat more, because a simulation gathers some.
const FORWARD_STEP: f64 = 1e-7;

/// Residual of a motor that cannot be simulated, A: larger than of any that can, and still finite when squared and summed.
const HOPELESS: f64 = 1e100;

/// Steps that lower the cost, or move the unknowns, by less than this fraction end the iteration: a thousandth of the relative standard
/// error that noise causes over a million rows, and above the errors of differences and rounding.
const NO_STEP: f64 = 1e-9;

/// The same for fits that are only compared with each other: of ten thousand residuals a thousandth of what noise changes in a cost.
const NO_STEP_OF_CHOICE: f64 = 1e-7;

/// The same for a fit that ends after its first step: any step is small beside it.
const FIRST_STEP: f64 = 1.0;

/// Evaluations per unknown after which a polish gives up. From near a minimum it takes five to ten steps.
const PATIENCE: usize = 4;

/// Prior knowledge of an unknown: one more residual, `(value - x) weight`, A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorResidual {
    /// The unknown.
    pub unknown: Unknown,
    /// Its expected value, SI.
    pub value: f64,
    /// A per SI unit: the noise of a current over the standard error of the value.
    pub weight: f64,
}

/// Where a polish ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polished {
    /// The drive.
    pub drive: Adjustable,
    /// Its cost, A², prior residuals not counted.
    pub cost: f64,
    /// Whether this is a minimum.
    pub converged: bool,
}

/// All four parameters.
pub const MOTOR: [Unknown; 4] =
    [Unknown::Motor(Parameter::Rs), Unknown::Motor(Parameter::Ld), Unknown::Motor(Parameter::Lq), Unknown::Motor(Parameter::PsiF)];

/// Polishes a motor in a perfect drive. A start that has no finite cost is where it ends.
pub fn polish(objective: &OutputError, start: &Motor) -> Polished {
    polish_unknowns(objective, &Adjustable::from(*start), &MOTOR, &[])
}

/// Polishes these unknowns of a drive and leaves the others where they are.
pub fn polish_unknowns(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    polish_with_progress(objective, start, unknowns, priors, &|_| ())
}

/// [`polish_unknowns`] as far as a comparison of costs needs it.
pub(crate) fn polish_to_choose(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    minimize(objective, start, unknowns, priors, NO_STEP_OF_CHOICE, rough_jacobian, &|_| ())
}

/// The first step of a polish alone.
pub(crate) fn step(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    minimize(objective, start, unknowns, priors, FIRST_STEP, rough_jacobian, &|_| ())
}

/// [`polish_unknowns`], which calls `progress` after each step with the number of simulations so far.
pub fn polish_with_progress(
    objective: &OutputError,
    start: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    progress: &dyn Fn(usize),
) -> Polished {
    minimize(objective, start, unknowns, priors, NO_STEP, jacobian, progress)
}

fn minimize(
    objective: &OutputError,
    start: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    no_step: f64,
    derivatives: Derivatives,
    progress: &dyn Fn(usize),
) -> Polished {
    let scale: Vec<f64> = unknowns.iter().map(|unknown| start.step_unit(*unknown, objective.peak_current())).collect();
    let units = DVector::from_fn(unknowns.len(), |k, _| start.get(unknowns[k]) / scale[k]);
    let (problem, report) = LevenbergMarquardt::new().with_ftol(no_step).with_xtol(no_step).with_patience(PATIENCE).minimize(Problem {
        objective,
        start,
        unknowns,
        priors,
        scale,
        units,
        derivatives,
        simulations: Cell::new(0),
        progress,
    });
    let drive = problem.drive();
    Polished { drive, cost: objective.cost_of(&drive), converged: report.termination.was_successful() }
}

/// Derivatives of the residuals by each unknown, A per SI unit: a column each.
pub fn jacobian(objective: &OutputError, drive: &Adjustable, unknowns: &[Unknown]) -> Vec<Vec<f64>> {
    let steps: Vec<f64> = unknowns.iter().map(|unknown| STEP * drive.step_unit(*unknown, objective.peak_current())).collect();
    let moved =
        unknowns.iter().zip(&steps).flat_map(|(unknown, step)| [*step, -step].map(|by| drive.with(*unknown, drive.get(*unknown) + by)));
    let residuals = objective.residuals_of_all(&moved.collect::<Vec<_>>());
    let columns = residuals
        .chunks_exact(2)
        .zip(&steps)
        .map(|(both, step)| both[0].iter().zip(&both[1]).map(|(above, below)| (above - below) / (2.0 * step)).collect());
    columns.collect()
}

/// The same by forward differences, for what is only compared.
pub(crate) fn rough_jacobian(objective: &OutputError, drive: &Adjustable, unknowns: &[Unknown]) -> Vec<Vec<f64>> {
    let steps: Vec<f64> = unknowns.iter().map(|unknown| FORWARD_STEP * drive.step_unit(*unknown, objective.peak_current())).collect();
    let moved = unknowns.iter().zip(&steps).map(|(unknown, step)| drive.with(*unknown, drive.get(*unknown) + step));
    let mut residuals = objective.residuals_of_all(&moved.chain([*drive]).collect::<Vec<_>>());
    let here = residuals.pop().unwrap_or_default();
    let slopes = |(moved, step): (&Vec<f64>, &f64)| moved.iter().zip(&here).map(|(moved, here)| (moved - here) / step).collect();
    residuals.iter().zip(&steps).map(slopes).collect()
}

/// How derivatives of the residuals are found.
type Derivatives = fn(&OutputError, &Adjustable, &[Unknown]) -> Vec<Vec<f64>>;

struct Problem<'a> {
    objective: &'a OutputError,
    start: &'a Adjustable,
    unknowns: &'a [Unknown],
    priors: &'a [PriorResidual],
    scale: Vec<f64>,
    units: DVector<f64>,
    derivatives: Derivatives,
    simulations: Cell<usize>,
    progress: &'a dyn Fn(usize),
}

impl Problem<'_> {
    fn simulated(&self, times: usize) {
        self.simulations.update(|simulations| simulations + times);
        (self.progress)(self.simulations.get());
    }

    fn drive(&self) -> Adjustable {
        let values = self.units.iter().zip(&self.scale).map(|(units, scale)| units * scale);
        self.unknowns.iter().zip(values).fold(*self.start, |drive, (unknown, value)| drive.with(*unknown, value))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, units: &DVector<f64>) {
        self.units = units.clone();
    }

    fn params(&self) -> DVector<f64> {
        self.units.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let drive = self.drive();
        let mut residuals = self.objective.residuals(&drive);
        self.simulated(1);
        // A bad candidate is no failure: the next step is shorter.
        residuals.iter_mut().filter(|residual| residual.abs() > HOPELESS || residual.is_nan()).for_each(|residual| *residual = HOPELESS);
        residuals.extend(self.priors.iter().map(|prior| prior.weight * (prior.value - drive.get(prior.unknown))));
        Some(DVector::from_vec(residuals))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let columns = (self.derivatives)(self.objective, &self.drive(), self.unknowns);
        self.simulated(2 * self.unknowns.len());
        let rows = columns.first().map_or(0, Vec::len);
        let mut matrix = DMatrix::zeros(rows + self.priors.len(), self.unknowns.len());
        for (k, column) in columns.iter().enumerate() {
            for (row, slope) in column.iter().enumerate() {
                matrix[(row, k)] = slope * self.scale[k];
            }
            for (row, prior) in self.priors.iter().enumerate().filter(|(_, prior)| prior.unknown == self.unknowns[k]) {
                matrix[(rows + row, k)] = -prior.weight * self.scale[k];
            }
        }
        matrix.iter().all(|entry| entry.is_finite()).then_some(matrix)
    }
}
