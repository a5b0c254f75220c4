//! What an estimator says.

use fluxfit::motor::PARAMETERS;
use serde::{Deserialize, Serialize};

/// Largest relative standard error of block least squares with which the last samples determine a parameter. With a larger one, only
/// model errors and chance tell the parameter, and the interval of a Kalman filter is too narrow.
pub(crate) const IDENTIFIABLE: f64 = 0.1;

/// What an estimator knows after a sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Values of rs, ld, lq and psi_f, SI.
    pub values: [f64; PARAMETERS],
    /// Their standard errors, SI; none of an estimator without an error covariance.
    pub standard_errors: Option<[f64; PARAMETERS]>,
    /// Whether the samples that are remembered determine each parameter; none of an estimator that cannot tell.
    pub identifiable: Option<[bool; PARAMETERS]>,
    /// Whether the last half second excited the parameters; none of an estimator that cannot tell.
    pub excited: Option<bool>,
}

impl Estimate {
    /// Values of an estimator that cannot tell how good they are.
    pub(crate) fn without_covariance(values: [f64; PARAMETERS]) -> Self {
        Self { values, standard_errors: None, identifiable: None, excited: None }
    }
}
