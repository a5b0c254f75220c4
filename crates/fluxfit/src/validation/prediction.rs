//! What given parameters predict: the currents from the logged voltages, or the voltages of steady operating points.
//!
//! Currents are simulated, not followed: an observer that the identification may need would hide what the parameters miss. The drive's
//! faults that the log's own answer found are found again for the given motor: they are the drive's, not the motor's.

use super::given::Given;
use crate::{
    error::{Error, ErrorKind},
    faults::{Fault, Faults, disturbance::Disturbance},
    frames::Dq,
    identification::{
        fit::{output::OutputFit, steady::SteadyFit},
        prepare::stretches,
        request::Request,
        solve::Identification,
    },
    levenberg_marquardt::{MOTOR, jacobian, polish_unknowns},
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::{
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use std::ops::Range;

/// Measured and predicted.
#[derive(Debug, Clone, PartialEq)]
pub enum Prediction {
    /// Simulated currents, stretch after stretch.
    Currents(Vec<PredictedStretch>),
    /// Residuals, V, of both voltage equations at each operating point of the log's own answer.
    Voltages(Vec<[f64; 2]>),
}

/// A stretch of the log without a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedStretch {
    /// Its rows in the log.
    pub rows: Range<usize>,
    /// Measured current, A, the sensors' faults undone where some were found.
    pub measured: Vec<Dq>,
    /// Predicted current, A.
    pub predicted: Vec<Dq>,
}

/// Both axes of a row, or of an operating point; A or V.
pub(super) struct Value {
    pub(super) measured: [f64; 2],
    /// Measured less predicted.
    pub(super) left: [f64; 2],
    /// The same with the log's own parameters.
    pub(super) left_by_own: [f64; 2],
    pub(super) noise: [f64; 2],
}

/// All that is predicted.
pub(super) struct Predicted {
    /// Column and unit.
    pub(super) channels: [(&'static str, &'static str); 2],
    pub(super) values: Vec<Value>,
    /// Per axis: sums of products of the derivatives by two parameters.
    pub(super) sensitivity: [[[f64; PARAMETERS]; PARAMETERS]; 2],
    pub(super) prediction: Prediction,
}

impl Predicted {
    /// By the model of the log's own answer.
    pub(super) fn of(log: &Log, own: &Identification, given: &Given, request: &Request) -> Result<Self, Error> {
        let motor = Motor::from(own.parameters.each_ref().map(|judgement| judgement.raw));
        match (&own.output, &own.steady) {
            (Some(fit), _) => currents(log, fit, &motor, given, request),
            (None, Some(fit)) => Ok(voltages(fit, given)),
            (None, None) => Err(ErrorKind::TooShort { rows: log.rows(), least: 2 }.into()),
        }
    }

    /// How far the squared residuals lie above those of the log's own answer, as a fraction of the noise's.
    pub(super) fn excess_cost(&self) -> f64 {
        let sum = |of: &dyn Fn(&Value) -> [f64; 2]| self.values.iter().flat_map(of).map(|value| value * value).sum::<f64>();
        let noise = sum(&|value| value.noise);
        if noise > 0.0 { (sum(&|value| value.left) - sum(&|value| value.left_by_own)) / noise } else { 0.0 }
    }
}

fn currents(log: &Log, fit: &OutputFit, own: &Motor, given: &Given, request: &Request) -> Result<Predicted, Error> {
    let stretches = stretches::all(log, &request.windows)?;
    let objective = OutputError::of_rows(log, &stretches, fit.voltage_timing.value)?;
    let own = drive(&objective, fit, own);
    let predicting = drive(&objective, fit, &given.motor);
    let (left, left_by_own) = (objective.residuals(&predicting), objective.residuals(&own));
    let predicted = objective.simulated(&predicting);

    let (left, _) = left.as_chunks::<2>();
    let (left_by_own, _) = left_by_own.as_chunks::<2>();
    let measured: Vec<Dq> = predicted.iter().zip(left).map(|(i, left)| Dq { d: i.d + left[0], q: i.q + left[1] }).collect();
    let values = measured.iter().zip(left).zip(left_by_own).map(|((measured, left), left_by_own)| Value {
        measured: [measured.d, measured.q],
        left: *left,
        left_by_own: *left_by_own,
        noise: *left_by_own,
    });
    let slopes = jacobian(&objective, &own, &MOTOR);
    let product = |axis: usize, p: usize, q: usize| {
        let of = |p: usize| slopes[p].iter().skip(axis).step_by(2);
        of(p).zip(of(q)).map(|(a, b)| a * b).sum()
    };
    let mut start = 0;
    let stretches_of = objective.stretches().map(|rows| {
        let own = start..start + rows.len();
        start = own.end;
        PredictedStretch { rows, measured: measured[own.clone()].to_vec(), predicted: predicted[own].to_vec() }
    });
    Ok(Predicted {
        channels: [("id", "A"), ("iq", "A")],
        sensitivity: [0, 1].map(|axis| std::array::from_fn(|p| std::array::from_fn(|q| product(axis, p, q)))),
        prediction: Prediction::Currents(stretches_of.collect()),
        values: values.collect(),
    })
}

/// A motor in the log's drive: faults as they fit it best, without an observer.
fn drive(objective: &OutputError, fit: &OutputFit, motor: &Motor) -> Adjustable {
    let start = Adjustable { motor: *motor, faults: Faults { disturbance: Disturbance::default(), ..fit.drive.faults } };
    let found = fit.fault_estimates.iter().map(|nuisance| nuisance.unknown);
    let faults: Vec<Unknown> = found.filter(|unknown| unknown.fault() != Some(Fault::Disturbance)).collect();
    if faults.is_empty() { start } else { polish_unknowns(objective, &start, &faults, &[]).drive }
}

fn voltages(fit: &SteadyFit, given: &Given) -> Predicted {
    let points = &fit.operating_points;
    let x = given.motor.to_array();
    let residuals: Vec<[f64; 2]> = points.iter().map(|point| point.equations().map(|equation| equation.residual(&x))).collect();
    let values = points.iter().zip(&residuals).enumerate().map(|(w, (point, left))| {
        let (u, noise) = (point.voltage(), point.residual_covariance(&fit.estimate.motor));
        Value {
            measured: [u.d, u.q],
            left: *left,
            left_by_own: fit.estimate.residuals[w],
            noise: [0, 1].map(|axis| (noise[axis][axis].max(0.0) + fit.estimate.accuracy[w].powi(2)).sqrt()),
        }
    });
    let product = |axis: usize, p: Parameter, q: Parameter| {
        let coefficients = points.iter().map(|point| point.equations()[axis].coefficients);
        coefficients.map(|coefficients| coefficients[p as usize] * coefficients[q as usize]).sum()
    };
    Predicted {
        channels: [("ud", "V"), ("uq", "V")],
        sensitivity: [0, 1].map(|axis| Parameter::ALL.map(|p| Parameter::ALL.map(|q| product(axis, p, q)))),
        values: values.collect(),
        prediction: Prediction::Voltages(residuals),
    }
}
