//! The parameters that a validation is given.

use crate::{
    identification::{explain::judgement::Judgement, solve::Identification},
    motor::{Motor, PARAMETERS, Parameter},
};

/// Parameters to be validated: from a [`Motor`] by `into()` where they are taken as exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given {
    /// The motor.
    pub motor: Motor,
    /// Covariance of its errors, SI, in the order of [`Parameter::ALL`]; zero: taken as exact.
    pub covariance: [[f64; PARAMETERS]; PARAMETERS],
}

impl From<Motor> for Given {
    fn from(motor: Motor) -> Self {
        Self { motor, covariance: [[0.0; PARAMETERS]; PARAMETERS] }
    }
}

impl Given {
    /// What another log told ([`Answer::identification`](crate::Answer::identification)), with its covariance; `None` where it could not
    /// tell a parameter.
    pub fn of(found: &Identification) -> Option<Self> {
        let values = found.parameters.each_ref().map(Judgement::value);
        let errors = found.parameters.each_ref().map(|judgement| judgement.uncertainty.standard_error());
        let [Some(rs), Some(ld), Some(lq), Some(psi_f)] = values else { return None };
        Some(Self::with_errors(Motor { rs, ld, lq, psi_f }, errors, &found.correlation))
    }

    /// A motor with standard errors, SI, and their correlation (its diagonal is taken as 1), in the order of [`Parameter::ALL`].
    pub fn with_errors(motor: Motor, errors: [f64; PARAMETERS], correlation: &[[f64; PARAMETERS]; PARAMETERS]) -> Self {
        let correlation = |p: usize, q: usize| if p == q { 1.0 } else { correlation[p][q] };
        Self { motor, covariance: std::array::from_fn(|p| std::array::from_fn(|q| errors[p] * errors[q] * correlation(p, q))) }
    }

    /// One parameter's standard error, SI.
    pub fn standard_error(&self, parameter: Parameter) -> f64 {
        self.covariance[parameter as usize][parameter as usize].max(0.0).sqrt()
    }
}
