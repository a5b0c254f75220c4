//! The estimate: weighted least squares on the operating points' equations, in the directions that are excited.
//!
//! ```text
//! minimize  sum over points  r' W r,   r = b - A x,   W = (N / n + voltage accuracy²)^-1
//! ```
//!
//! `N` holds the long-run noise variances of `r`, pooled over the points, and `n` a point's rows. A point's own covariance has
//! few degrees of freedom: weighting by it would chase its luck and make the answer look better than it is. The uncertainty is
//! computed from the points' own covariances all the same, so it holds where the noise differs between them. The noise of
//! currents and speed counts in `N` as it moves `r`, at the motor found, so the weights follow from the answer and are iterated.
//! Parameters that are fixed move to the right-hand side; a prior is one more equation. The inverter's [losses](super::voltage_loss) are
//! unknowns with a prior each; they enter linearly and are eliminated.

use super::{
    super::request::{Known, Request},
    excitation::Excitation,
    part::Part,
    voltage_accuracy::VoltageAccuracy,
    voltage_loss::{self, Loss},
};
use crate::{
    least_squares::Equation,
    motor::{Motor, PARAMETERS},
    objective::voltage_error::VoltageError,
    singular_values::SingularValueDecomposition,
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2, Vector4};

/// Rounds of weighting. Weights move the answer by a fraction of its uncertainty, so the second round already changes nothing visible.
const ROUNDS: usize = 4;

/// Voltages are never trusted beyond this fraction of the largest, so that noise-free windows have finite weights, those without
/// voltage too.
const LEAST_ACCURACY: f64 = 1e-9;

/// A voltage, V, that no drive can tell from none.
const NO_VOLTAGE: f64 = 1e-30;

/// The solution of the operating points' equations.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The motor found. Of directions that are not excited it has nothing.
    pub motor: Motor,
    /// The weighted equations as a sum of squares of all four parameters, for a search: flat along directions that are not excited.
    pub objective: VoltageError,
    /// Per point, what an error of its two voltages (V) does to the parameters (SI).
    pub gains: Vec<[[f64; 2]; PARAMETERS]>,
    /// Per point, the residuals of its two equations, V.
    pub residuals: Vec<[f64; 2]>,
    /// Per point, the standard uncertainty of its voltages, V.
    pub accuracy: Vec<f64>,
    /// Per prior, what its standard error does to the parameters (SI).
    pub prior_gains: Vec<[f64; PARAMETERS]>,
    /// The voltage, V, that every point is found to lose along its current, with its standard error; none where no loss is possible.
    pub loss: Option<(f64, f64)>,
    /// Per unknown of the losses, what the standard error of its prior does to the parameters (SI).
    pub(crate) loss_gains: Vec<(Part, [f64; PARAMETERS])>,
    /// Each unknown of the losses, in its unit, and its standard error.
    pub(crate) found: Vec<(f64, f64)>,
    /// Their covariance.
    pub(crate) found_covariance: Vec<Vec<f64>>,
    /// Sum of squares at the motor in units of the points' own covariances and accuracies, priors included.
    pub chi_squared: f64,
    /// Equations and priors, less the directions found.
    pub degrees_of_freedom: usize,
    /// The same with operating points that repeat each other counted once.
    pub redundancy: usize,
}

impl Estimate {
    /// Solves the points.
    pub(crate) fn solve(points: &[OperatingPoint], excitation: &Excitation, request: &Request, losses: &[Loss]) -> Self {
        Self::solve_with(
            points,
            excitation,
            request,
            losses,
            VoltageAccuracy { fraction: request.voltage_accuracy, ..VoltageAccuracy::default() },
        )
    }

    /// Solves the points with voltages trusted otherwise than the request has it.
    pub(crate) fn solve_with(
        points: &[OperatingPoint],
        excitation: &Excitation,
        request: &Request,
        losses: &[Loss],
        accuracy: VoltageAccuracy,
    ) -> Self {
        // Whoever states the steady model states its equations.
        let misshapen = if request.model.is_none() { voltage_loss::misshapen(points, losses) } else { 0.0 };
        let accuracy = voltage_uncertainty(points, accuracy.fraction, accuracy.volts.max(misshapen));
        let mut motor = Motor::from(request.known.map(|known| if let Known::Fixed(value) = known { value } else { 0.0 }));
        let mut system = System::of(points, &motor, &accuracy, request, losses);
        let mut solved = system.solve(excitation, request);
        for _ in 1..ROUNDS {
            motor = solved.motor;
            system = System::of(points, &motor, &accuracy, request, losses);
            solved = system.solve(excitation, request);
        }
        let Solved { motor, gain, losses: found, covariance: found_covariance } = solved;
        let x = motor.to_array();
        let of_points = gain.chunks_exact(2).zip(&system.whiteners);
        let gains = of_points.map(|(gain, whitener)| {
            std::array::from_fn(|p| [0, 1].map(|axis| gain[0][p] * whitener[(0, axis)] + gain[1][p] * whitener[(1, axis)]))
        });
        let residuals = points.iter().enumerate().map(|(w, point)| {
            let lost = |axis: usize| losses.iter().zip(&found).map(|(loss, (volts, _))| loss.voltages[w][axis] * volts).sum::<f64>();
            let [d, q] = point.equations().map(|equation| equation.residual(&x));
            [d - lost(0), q - lost(1)]
        });
        let residuals: Vec<[f64; 2]> = residuals.collect();
        let of_priors = losses.iter().zip(&found).map(|(loss, (volts, _))| ((volts - loss.expected) / loss.standard_error).powi(2));
        let chi_squared = chi_squared(points, excitation, &motor, &residuals, &accuracy, request) + of_priors.sum::<f64>();
        let kinds_count = kinds(points).into_iter().enumerate().filter(|(w, kind)| w == kind).count();
        // A loss that the points tell, rather than its prior, has used up an equation.
        let told = losses.iter().zip(&found).filter(|(loss, (_, error))| *error < TOLD * loss.standard_error).count();
        let unknowns = excitation.excited().count() + told;
        let (prior_gains, loss_gains) = gain[2 * points.len()..].split_at(gain.len() - 2 * points.len() - losses.len());
        Self {
            motor,
            gains: gains.collect(),
            residuals,
            accuracy,
            chi_squared,
            degrees_of_freedom: (2 * points.len() + prior_gains.len() + losses.len()).saturating_sub(unknowns),
            redundancy: (2 * kinds_count + prior_gains.len()).saturating_sub(unknowns),
            prior_gains: prior_gains.to_vec(),
            loss: losses.iter().zip(&found).find(|(loss, _)| loss.part == Part::DeadTime).map(|(_, found)| *found),
            loss_gains: losses.iter().map(|loss| loss.part).zip(loss_gains.iter().copied()).collect(),
            found,
            found_covariance,
            objective: VoltageError::of_equations(system.equations.into_iter().map(|equation| excitation.excited_equation(equation))),
        }
    }

    /// How far a motor's cost lies above the lowest that there is.
    pub fn cost_above_optimum(&self, motor: &Motor) -> f64 {
        self.objective.cost_above_optimum(motor)
    }
}

/// A loss is told by the points where they leave less than this part of its prior's standard error.
pub(super) const TOLD: f64 = 0.7;

/// Whitened equations: two per point, then one per prior, then one per prior of a loss; without their part along the losses. Their values'
/// errors have unit variance.
struct System {
    equations: Vec<Equation>,
    whiteners: Vec<Matrix2<f64>>,
    /// What a volt of each loss does to each value.
    by_loss: DMatrix<f64>,
    /// The losses, V, that least squares asks for, given what the motor leaves.
    losses: DMatrix<f64>,
    /// The equations with that part.
    with_losses: Vec<Equation>,
}

/// What comes out of a system.
struct Solved {
    motor: Motor,
    /// What a unit error of each whitened value does to the motor.
    gain: Vec<[f64; PARAMETERS]>,
    /// Each loss, V, and its standard error.
    losses: Vec<(f64, f64)>,
    /// Their covariance, V².
    covariance: Vec<Vec<f64>>,
}

impl System {
    fn of(points: &[OperatingPoint], motor: &Motor, accuracy: &[f64], request: &Request, losses: &[Loss]) -> Self {
        let mut equations = Vec::new();
        let mut whiteners = Vec::new();
        let mut columns: Vec<Vec<f64>> = vec![Vec::new(); losses.len()];
        let pooled = pooled_noise(points, motor);
        for (w, (point, accuracy)) in points.iter().zip(accuracy).enumerate() {
            let whitener = whitener(pooled / point.rows.len() as f64, *accuracy);
            let [d, q] = point.equations().map(|equation| move_fixed(equation, request));
            for row in 0..2 {
                let (a, b) = (whitener[(row, 0)], whitener[(row, 1)]);
                let (d, q) = (d.weighted(a), q.weighted(b));
                equations.push(Equation {
                    coefficients: std::array::from_fn(|p| d.coefficients[p] + q.coefficients[p]),
                    value: d.value + q.value,
                });
                columns.iter_mut().zip(losses).for_each(|(column, loss)| column.push(a * loss.voltages[w][0] + b * loss.voltages[w][1]));
            }
            whiteners.push(whitener);
        }
        equations.extend(priors(request));
        columns.iter_mut().for_each(|column| column.resize(equations.len(), 0.0));
        for (k, loss) in losses.iter().enumerate() {
            equations.push(Equation { coefficients: [0.0; PARAMETERS], value: loss.expected / loss.standard_error });
            columns.iter_mut().enumerate().for_each(|(l, column)| column.push(if k == l { 1.0 / loss.standard_error } else { 0.0 }));
        }
        let columns = DMatrix::from_fn(equations.len(), losses.len(), |row, loss| columns[loss][row]);
        // The priors make the columns independent.
        let inverse = SingularValueDecomposition::of(columns.clone()).pseudo_inverse(0.0);
        let (coefficients, values) = matrix(&equations);
        let coefficients = &coefficients - &columns * (&inverse * &coefficients);
        let values = &values - &columns * (&inverse * &values);
        let eliminated =
            (0..equations.len()).map(|row| Equation { coefficients: std::array::from_fn(|p| coefficients[(row, p)]), value: values[row] });
        Self { whiteners, equations: eliminated.collect(), with_losses: equations, losses: inverse, by_loss: columns }
    }

    fn solve(&self, excitation: &Excitation, request: &Request) -> Solved {
        let scale = Vector4::from(excitation.scale);
        let excited: Vec<Vector4<f64>> =
            excitation.excited().map(|direction| Vector4::from(direction.components).component_mul(&scale)).collect();
        let mut x = Vector4::from(request.known.map(|known| if let Known::Fixed(value) = known { value } else { 0.0 }));
        let mut product = DMatrix::zeros(PARAMETERS, self.equations.len());
        if !excited.is_empty() {
            let basis = DMatrix::from_fn(PARAMETERS, excited.len(), |p, direction| excited[direction][p]);
            let (coefficients, values) = matrix(&self.equations);
            // The columns are excited, so the pseudo-inverse needs no cut-off of its own.
            let inverse = SingularValueDecomposition::of(coefficients * &basis).pseudo_inverse(0.0);
            product = basis * inverse;
            x += Vector4::from_iterator((&product * values).iter().copied());
            product -= (&product * &self.by_loss) * &self.losses;
        }
        let (coefficients, values) = matrix(&self.with_losses);
        let of_losses = &self.losses - (&self.losses * coefficients) * &product;
        let found = &of_losses * values;
        let covariance = &of_losses * of_losses.transpose();
        Solved {
            motor: Motor::from(<[f64; PARAMETERS]>::from(x)),
            gain: product.column_iter().map(|column| std::array::from_fn(|p| column[p])).collect(),
            losses: found.iter().zip(of_losses.row_iter()).map(|(volts, gain)| (*volts, gain.norm())).collect(),
            covariance: covariance.row_iter().map(|row| row.iter().copied().collect()).collect(),
        }
    }
}

/// Coefficients and values of equations.
fn matrix(equations: &[Equation]) -> (DMatrix<f64>, DVector<f64>) {
    (
        DMatrix::from_fn(equations.len(), PARAMETERS, |row, p| equations[row].coefficients[p]),
        DVector::from_iterator(equations.len(), equations.iter().map(|equation| equation.value)),
    )
}

/// Long-run variances of the two residuals' noise, V² times rows, as a diagonal matrix: the points' own, weighted by what is
/// behind them. The covariance between the axes is left out: estimated, it costs more than it brings.
fn pooled_noise(points: &[OperatingPoint], motor: &Motor) -> Matrix2<f64> {
    let total: usize = points.iter().map(|point| point.degrees_of_freedom).sum();
    let share = |point: &OperatingPoint| (point.rows.len() * point.degrees_of_freedom) as f64 / total as f64;
    let pooled: Matrix2<f64> = points.iter().map(|point| Matrix2::from(point.residual_covariance(motor)) * share(point)).sum();
    Matrix2::from_diagonal(&pooled.diagonal())
}

/// What turns two residuals with this noise and accuracy into independent ones of unit variance.
fn whitener(noise: Matrix2<f64>, accuracy: f64) -> Matrix2<f64> {
    let covariance = noise + Matrix2::identity() * accuracy.powi(2);
    // Positive definite by the accuracy; if rounding says otherwise, the diagonal alone will do.
    let lower = covariance.cholesky().map_or_else(|| Matrix2::from_diagonal(&covariance.diagonal().map(f64::sqrt)), |factor| factor.l());
    lower.try_inverse().unwrap_or_else(Matrix2::zeros)
}

/// One whitened equation per prior.
fn priors(request: &Request) -> impl Iterator<Item = Equation> + '_ {
    request.known.iter().enumerate().filter_map(|(p, known)| match known {
        Known::Prior { value, standard_error } => {
            let coefficients = std::array::from_fn(|q| f64::from(u8::from(p == q)));
            Some(Equation { coefficients, value: *value }.weighted(1.0 / standard_error))
        }
        Known::Nothing | Known::Fixed(_) => None,
    })
}

/// What directions that are not excited could do to the residuals is no contradiction: it counts as noise here.
fn chi_squared(
    points: &[OperatingPoint],
    excitation: &Excitation,
    motor: &Motor,
    residuals: &[[f64; 2]],
    accuracy: &[f64],
    request: &Request,
) -> f64 {
    let x = motor.to_array();
    let of_points = points.iter().zip(residuals).zip(accuracy).map(|((point, residual), accuracy)| {
        let residual = Vector2::from(*residual);
        let noise = Matrix2::from(point.residual_covariance(motor)) + Matrix2::from(excitation.unexcited_covariance(&point.equations()));
        (whitener(noise, *accuracy) * residual).norm_squared()
    });
    of_points.sum::<f64>() + priors(request).map(|equation| equation.residual(&x).powi(2)).sum::<f64>()
}

/// An equation with the fixed parameters on its right-hand side.
fn move_fixed(mut equation: Equation, request: &Request) -> Equation {
    for (p, known) in request.known.iter().enumerate() {
        if let Known::Fixed(value) = known {
            equation.value -= equation.coefficients[p] * value;
            equation.coefficients[p] = 0.0;
        }
    }
    equation
}

/// Operating points closer than this, as a fraction of the largest current and speed, are one: a repetition proves repeatability,
/// not the model.
const DISTINCT: f64 = 0.02;

/// For each point the number of the first point that it repeats: its own, if it is the first of its kind.
fn kinds(points: &[OperatingPoint]) -> Vec<usize> {
    let current = points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
    let speed = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let same = |one: &OperatingPoint, other: &OperatingPoint| {
        let (i, j) = (one.current(), other.current());
        (i.d - j.d).hypot(i.q - j.q) <= DISTINCT * current && (one.omega_e() - other.omega_e()).abs() <= DISTINCT * speed
    };
    let mut kinds: Vec<usize> = Vec::new();
    for (w, point) in points.iter().enumerate() {
        let first = (0..w).find(|first| kinds[*first] == *first && same(point, &points[*first]));
        kinds.push(first.unwrap_or(w));
    }
    kinds
}

/// Uncertainty of each point's voltages, V: a fraction of the voltage, and so many volts at any. It is the same error in every repetition
/// of a point, so that no repetition may shrink it.
fn voltage_uncertainty(points: &[OperatingPoint], fraction: f64, volts: f64) -> Vec<f64> {
    // At least a fraction of the largest voltage: a window without any has no exact one either.
    let least = LEAST_ACCURACY * points.iter().map(|point| point.voltage().magnitude()).fold(NO_VOLTAGE, f64::max);
    let kinds = kinds(points);
    let repetitions = |kind: usize| kinds.iter().filter(|other| **other == kind).count() as f64;
    let of_one = |point: &OperatingPoint| (fraction * point.voltage().magnitude()).max(least).hypot(volts);
    points.iter().zip(&kinds).map(|(point, kind)| of_one(point) * repetitions(*kind).sqrt()).collect()
}
