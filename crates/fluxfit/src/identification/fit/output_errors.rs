//! Errors of everything that is fitted to simulated currents.
//!
//! The statistical uncertainty is that of the scores, the products of derivatives and residuals: `(J'J)^-1 S (J'J)^-1` with their
//! [long-run covariance](super::long_run) `S`. The [voltages' accuracy](super::voltage_accuracy) comes through the adjoint equations,
//! which give the effect of a volt at any row on each parameter.

use super::{
    long_run,
    uncertainty::{ParameterUncertainty, Systematic, Uncertainty},
    voltage_accuracy::{self, VoltageAccuracy},
};
use crate::{
    faults::{Fault, Faults, disturbance::Disturbance},
    frames::Dq,
    levenberg_marquardt::{MOTOR, PriorResidual, jacobian, polish_for_distance, with_priors},
    motor::{Motor, PARAMETERS},
    normal_matrix::NormalMatrix,
    objective::{
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use nalgebra::DMatrix;
use std::iter::zip;

/// A number of the drive beside the motor.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FaultEstimate {
    /// Which.
    pub unknown: Unknown,
    /// SI.
    pub value: f64,
    /// Statistical standard error, SI.
    pub standard_error: f64,
}

/// How far each parameter moves with what is not certain, SI.
pub(super) struct OutputShifts {
    pub(super) timing: [f64; PARAMETERS],
    pub(super) within_rows: [f64; PARAMETERS],
    pub(super) process_noise: [f64; PARAMETERS],
    pub(super) faults_in_doubt: [f64; PARAMETERS],
    pub(super) sensors: [f64; PARAMETERS],
    pub(super) dead_time: [f64; PARAMETERS],
}

/// Gain from which an observer is fitted where none was found.
const GAIN: f64 = 0.3;

/// How far the motor lies from that of the other kind of fit, with an observer or without: if one was found, either may be right, and if
/// what is left is not noise, their difference is what the model lacks.
pub(super) fn other_kind_of_fit(
    objective: &OutputError,
    drive: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    is_noise: bool,
) -> [f64; PARAMETERS] {
    let has_observer = unknowns.iter().any(|unknown| unknown.is_observer_gain());
    let (gain, unknowns): (Dq, Vec<Unknown>) = match (has_observer, is_noise) {
        (true, _) => (Dq::default(), unknowns.iter().copied().filter(|unknown| !unknown.is_observer_gain()).collect()),
        (false, false) => (Dq { d: GAIN, q: GAIN }, unknowns.iter().copied().chain(Unknown::of_fault(Fault::Disturbance)).collect()),
        (false, true) => return [0.0; PARAMETERS],
    };
    let start = Adjustable { faults: Faults { disturbance: Disturbance { gain }, ..drive.faults }, ..*drive };
    let other = polish_for_distance(objective, &start, &unknowns, priors).drive.motor.to_array();
    std::array::from_fn(|p| (drive.motor.to_array()[p] - other[p]).abs())
}

/// Where gains of sensors differ, nobody knows which of them is right: a gain common to all would scale every impedance.
pub(super) fn sensors(drive: &Adjustable) -> [f64; PARAMETERS] {
    let common = drive.faults.current_gains.magnitude();
    let Motor { rs, ld, lq, .. } = drive.motor;
    [common * rs, common * ld, common * lq, 0.0]
}

/// Correlation of neighbouring residuals from which on they are not noise: something is in the log that the model does not have.
pub(crate) const CORRELATED: f64 = 0.3;

/// Correlation of neighbouring residuals, `d, q` of each row in turn; the larger of both axes.
pub(super) fn correlation_of_neighbours(residuals: &[f64], lengths: &[usize]) -> f64 {
    let (rows, _) = residuals.as_chunks::<2>();
    let axis = |axis: usize| rows.iter().map(|row| row[axis]).collect::<Vec<_>>();
    [0, 1].map(|k| long_run::first_correlation(&axis(k), lengths)).into_iter().fold(f64::MIN, f64::max)
}

/// One covariance, made as large as the variances of another: each unknown with the larger of both, and its correlations kept.
fn larger(one: DMatrix<f64>, other: DMatrix<f64>) -> DMatrix<f64> {
    let scale: Vec<f64> =
        (0..one.nrows()).map(|k| if one[(k, k)] > 0.0 { (other[(k, k)] / one[(k, k)]).sqrt().max(1.0) } else { 1.0 }).collect();
    DMatrix::from_fn(one.nrows(), one.ncols(), |p, q| one[(p, q)] * scale[p] * scale[q])
}

/// A parameter of which white noise leaves a standard error of this part is told by a few rows, if at all: too few for the scatter of
/// their scores to say how well.
const BARELY: f64 = 0.3;

/// Errors of everything that was fitted.
pub(super) struct Errors {
    /// Of the unknowns, from noise.
    covariance: DMatrix<f64>,
    degrees_of_freedom: f64,
    /// Of the unknowns, from the voltages' accuracy.
    accuracy: DMatrix<f64>,
    /// Of the unknowns, from voltages that an observer corrects and that may be a part of the loss.
    loss_shape: DMatrix<f64>,
    /// Of the unknowns, per prior.
    priors: Vec<Vec<f64>>,
    /// How far what the rows do not tell at all could move each unknown.
    open: Vec<f64>,
    pub(super) correlation_of_neighbours: f64,
}

impl Errors {
    pub(super) fn of(
        objective: &OutputError,
        drive: &Adjustable,
        unknowns: &[Unknown],
        priors: &[PriorResidual],
        residuals: &[f64],
        accuracies: [VoltageAccuracy; 2],
        scale: &[f64; PARAMETERS],
    ) -> Self {
        let slopes = jacobian(objective, drive, unknowns);
        let with_priors = with_priors(slopes.clone(), unknowns, priors);
        let inverse = NormalMatrix::of(&with_priors).inverse();
        let lengths: Vec<usize> = objective.stretches().map(|rows| rows.len()).collect();
        let (rows, _) = residuals.as_chunks::<2>();
        // A score per row: both axes together.
        let scores = slopes.iter().map(|slope| {
            let (slope, _) = slope.as_chunks::<2>();
            slope.iter().zip(rows).map(|(slope, residual)| slope[0] * residual[0] + slope[1] * residual[1]).collect()
        });
        let scores: Vec<Vec<f64>> = scores.collect();
        let correlation_of_neighbours = correlation_of_neighbours(residuals, &lengths);
        let noise = long_run::covariance(&scores, &lengths);
        let (noise, mut degrees_of_freedom) = (&inverse * noise.covariance * &inverse, noise.degrees_of_freedom);
        let mut covariance = noise;
        if correlation_of_neighbours > CORRELATED {
            let blocks = long_run::covariance_of_blocks(&scores);
            degrees_of_freedom = degrees_of_freedom.min(blocks.degrees_of_freedom);
            covariance = larger(covariance, &inverse * blocks.covariance * &inverse);
        }
        let white = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64 * &inverse;
        let is_barely_told =
            |k: usize| matches!(unknowns[k], Unknown::Motor(_)) && white[(k, k)] > (BARELY * drive.get(unknowns[k])).powi(2);
        let of_few = DMatrix::from_fn(white.nrows(), white.ncols(), |p, q| if p == q && is_barely_told(p) { white[(p, p)] } else { 0.0 });
        covariance = larger(covariance, of_few);
        let [accuracy, loss_shape] = voltage_accuracy::covariances(objective, drive, &inverse, &slopes, accuracies);
        Self {
            covariance,
            degrees_of_freedom,
            accuracy,
            loss_shape,
            priors: priors
                .iter()
                .map(|belief| {
                    let column = unknowns.iter().position(|unknown| *unknown == belief.unknown);
                    let noise = (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt();
                    // A belief's own error is one standard error, which is the noise of a current over its weight.
                    column.map_or(vec![0.0; unknowns.len()], |q| {
                        (0..unknowns.len()).map(|p| inverse[(p, q)] * belief.weight * noise).collect()
                    })
                })
                .collect(),
            open: open(&with_priors, &inverse, unknowns, scale),
            correlation_of_neighbours,
        }
    }

    /// Whether the motor comes out sharper than the same noise would allow if nothing but the motor were unknown, and nothing stood between
    /// it and the log: then the simulated currents depend on the unknowns as chaos does, and their slopes mean nothing.
    /// Priors count in both.
    pub(super) fn are_too_small(
        &self,
        objective: &OutputError,
        drive: &Adjustable,
        unknowns: &[Unknown],
        priors: &[PriorResidual],
        residuals: &[f64],
    ) -> bool {
        let of_motor: Vec<usize> = (0..unknowns.len()).filter(|k| matches!(unknowns[*k], Unknown::Motor(_))).collect();
        let motor: Vec<Unknown> = of_motor.iter().map(|k| unknowns[*k]).collect();
        let alone = Adjustable { faults: Faults::default(), ..*drive };
        let inverse = NormalMatrix::of(&with_priors(jacobian(objective, &alone, &motor), &motor, priors)).inverse();
        let noise = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64;
        let variance = |k: usize| self.covariance[(k, k)] + self.priors.iter().map(|prior| prior[k].powi(2)).sum::<f64>();
        zip(&of_motor, 0..).any(|(k, p)| variance(*k) < TOO_SHARP * TOO_SHARP * noise * inverse[(p, p)])
    }

    /// How far each parameter could be moved by what puts two kinds of fit apart, given their distance, SI: by that distance, or by as many
    /// standard errors as all parameters lie apart, in the root mean square. That one parameter of two fits that contradict each other
    /// agrees is chance. R. T. Birge, Physical Review 40, 1932, p. 207, doi:10.1103/PhysRev.40.207, widens errors by such a ratio.
    pub(super) fn by_contradiction(&self, unknowns: &[Unknown], distance: &[f64; PARAMETERS]) -> [f64; PARAMETERS] {
        let standard_error = |parameter: &Unknown| {
            unknowns.iter().position(|unknown| unknown == parameter).map_or(0.0, |k| self.covariance[(k, k)].max(0.0).sqrt())
        };
        let errors = MOTOR.each_ref().map(standard_error);
        let squares: Vec<f64> = zip(distance, &errors).filter(|(_, error)| **error > 0.0).map(|(d, error)| (d / error).powi(2)).collect();
        let apart = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
        std::array::from_fn(|p| distance[p].max(apart * errors[p]))
    }

    pub(super) fn nuisance(&self, drive: &Adjustable, unknowns: &[Unknown]) -> Vec<FaultEstimate> {
        let beside = unknowns.iter().enumerate().filter(|(_, unknown)| !matches!(unknown, Unknown::Motor(_)));
        beside
            .map(|(k, unknown)| FaultEstimate {
                unknown: *unknown,
                value: drive.get(*unknown),
                standard_error: (self.covariance[(k, k)].max(0.0) + self.accuracy[(k, k)].max(0.0)).sqrt(),
            })
            .collect()
    }

    pub(super) fn uncertainty(&self, unknowns: &[Unknown], shifts: &OutputShifts) -> Uncertainty {
        let place: Vec<Option<usize>> = MOTOR.iter().map(|parameter| unknowns.iter().position(|unknown| unknown == parameter)).collect();
        let parameters = std::array::from_fn(|p| {
            let Some(k) = place[p] else { return ParameterUncertainty::default() };
            let systematic = Systematic {
                accuracy: self.accuracy[(k, k)].max(0.0).sqrt(),
                prior: self.priors.iter().map(|prior| prior[k].powi(2)).sum::<f64>().sqrt(),
                timing: shifts.timing[p],
                within_rows: shifts.within_rows[p],
                process_noise: shifts.process_noise[p],
                faults_in_doubt: shifts.faults_in_doubt[p],
                sensors: shifts.sensors[p],
                dead_time: shifts.dead_time[p],
                loss_shape: self.loss_shape[(k, k)].max(0.0).sqrt(),
                excitation: self.open[k],
                ..Systematic::default()
            };
            ParameterUncertainty::of(self.covariance[(k, k)].max(0.0).sqrt(), self.degrees_of_freedom, systematic)
        });
        let both = |p: usize, q: usize| match (place[p], place[q]) {
            (Some(k), Some(l)) => {
                self.covariance[(k, l)] + self.accuracy[(k, l)] + self.priors.iter().map(|prior| prior[k] * prior[l]).sum::<f64>()
            }
            _ => 0.0,
        };
        let correlation = std::array::from_fn(|p| {
            std::array::from_fn(|q| {
                let scale = (both(p, p) * both(q, q)).sqrt();
                if scale > 0.0 { both(p, q) / scale } else { 0.0 }
            })
        });
        Uncertainty { parameters, correlation }
    }
}

/// Standard errors below this part of what the motor alone would have are no standard errors: residuals that change their sign from row to
/// row leave about half.
const TOO_SHARP: f64 = 0.25;

/// A parameter is open if the rows tell less than all but this part of it.
const OPEN_PART: f64 = 0.01;

/// Per unknown: the range of a parameter that is open, as a standard deviation; zero for others.
fn open(columns: &[Vec<f64>], inverse: &DMatrix<f64>, unknowns: &[Unknown], scale: &[f64; PARAMETERS]) -> Vec<f64> {
    let dot = |p: usize, q: usize| columns[p].iter().zip(&columns[q]).map(|(a, b)| a * b).sum::<f64>();
    let told = |k: usize| (0..columns.len()).map(|l| inverse[(k, l)] * dot(l, k)).sum::<f64>();
    let range = |(k, unknown): (usize, &Unknown)| match unknown {
        Unknown::Motor(parameter) if (told(k) - 1.0).abs() > OPEN_PART || told(k).is_nan() => scale[*parameter as usize] / 3.0_f64.sqrt(),
        _ => 0.0,
    };
    unknowns.iter().enumerate().map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Parameter;

    /// Standard errors of 1 and 2; the first moves by three of its own, the second not at all: by sqrt(9 / 2) in the root mean square.
    #[test]
    fn parameters_that_agree_are_as_uncertain_as_those_that_contradict_each_other() {
        let errors = Errors {
            covariance: DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 4.0]),
            degrees_of_freedom: 100.0,
            accuracy: DMatrix::zeros(2, 2),
            loss_shape: DMatrix::zeros(2, 2),
            priors: Vec::new(),
            open: vec![0.0; 2],
            correlation_of_neighbours: 0.0,
        };
        let unknowns = [Parameter::Rs, Parameter::Lq].map(Unknown::Motor);
        let moved = errors.by_contradiction(&unknowns, &[3.0, 0.0, 0.0, 0.0]);
        let expected = [3.0, 0.0, 2.0 * 4.5_f64.sqrt(), 0.0];
        assert!(moved.iter().zip(expected).all(|(moved, expected)| (moved - expected).abs() < 1e-12), "{moved:?}");
        assert_eq!(errors.by_contradiction(&unknowns, &[0.0; PARAMETERS]), [0.0; PARAMETERS]);
    }
}
