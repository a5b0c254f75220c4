//! Wald's test: whether given parameters lie as near to a log's own as the covariance of both allows.
//!
//! ```text
//! W = d' C^-1 d,   d = own - given,   C = covariance of own + covariance of given
//! W (n - k + 1) / (n k)   is F-distributed with k and n - k + 1 degrees of freedom
//! ```
//!
//! A. Wald, "Tests of statistical hypotheses concerning several parameters when the number of observations is large", Trans. Am. Math.
//! Soc. 54 (1943) 426, doi:10.2307/1990256. F instead of chi squared, as the covariance is an estimate of n degrees of freedom: H.
//! Hotelling, "The generalization of Student's ratio", Ann. Math. Stat. 2 (1931) 360, doi:10.1214/aoms/1177732979. What a
//! difference does to one channel, `d' A d`, is a sum of squares with unequal weights, and is taken as one with as many equal ones
//! as have its mean and variance: F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110, doi:10.2307/3002019.

use super::given::Given;
use crate::{
    identification::solve::Identification,
    motor::{PARAMETERS, Parameter},
};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Nothing is known of a parameter beyond this fraction of it: what simulation and differences leave of a double's digits.
const ROUNDING: f64 = 1e-9;

/// Added to the diagonal of a correlation matrix, so that one of perfect correlation can be inverted.
const RIDGE: f64 = 1e-9;

/// What a test found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Test {
    /// The statistic per degree of freedom: about one where nothing differs.
    pub statistic: f64,
    /// Its degrees of freedom; for all parameters together, how many were tested.
    pub degrees_of_freedom: f64,
    /// Degrees of freedom of the covariance behind it.
    pub behind: f64,
    /// How many parameters were tested.
    pub tested: usize,
    /// Probability that noise and inaccuracy alone give as large a statistic.
    pub probability: f64,
}

/// The difference of the parameters that are tested, each in its standard errors, and the correlation of these.
pub(super) struct Covariance {
    tested: Vec<Parameter>,
    standard_errors: DVector<f64>,
    difference: DVector<f64>,
    correlation: DMatrix<f64>,
    behind: f64,
}

impl Covariance {
    pub(super) fn of(own: &Identification, given: &Given, tested: &[Parameter]) -> Self {
        let size = tested.len();
        // What noise, voltages, priors and common gains do is correlated between parameters; of the other parts nobody knows, and they are
        // taken apart.
        let correlated = |p: usize| own.parameters[p].uncertainty.correlated();
        let covariance = DMatrix::from_fn(size, size, |k, l| {
            let (p, q) = (tested[k] as usize, tested[l] as usize);
            if k == l {
                let least = ROUNDING * given.motor.get(tested[k]).abs();
                return own.parameters[p].uncertainty.standard_error().powi(2) + given.covariance[p][p].max(0.0) + least * least;
            }
            own.correlation[p][q] * correlated(p) * correlated(q) + given.covariance[p][q]
        });
        let standard_errors = covariance.diagonal().map(f64::sqrt);
        let difference = DVector::from_fn(size, |k, _| {
            (own.parameter(tested[k]).raw - given.motor.get(tested[k])) / standard_errors[k].max(f64::MIN_POSITIVE)
        });
        let correlation = DMatrix::from_fn(size, size, |k, l| {
            if k == l { 1.0 + RIDGE } else { covariance[(k, l)] / (standard_errors[k] * standard_errors[l]).max(f64::MIN_POSITIVE) }
        });
        let degrees = tested.iter().map(|parameter| own.parameter(*parameter).uncertainty.degrees_of_freedom);
        Self { tested: tested.to_vec(), standard_errors, difference, correlation, behind: degrees.fold(f64::INFINITY, f64::min) }
    }

    /// All tested parameters at once.
    pub(super) fn joint(&self) -> Test {
        let size = self.tested.len();
        // If rounding says that the correlation is none, each parameter speaks for itself.
        let factor = self.correlation.clone().cholesky().or_else(|| DMatrix::identity(size, size).cholesky());
        let squares = factor.map_or(0.0, |factor| self.difference.dot(&factor.solve(&self.difference)));
        // Hotelling: of an estimated covariance of several parameters fewer degrees of freedom are left.
        let behind = (self.behind - size as f64 + 1.0).max(1.0);
        self.test(squares * behind / self.behind, size as f64, behind)
    }

    /// What the difference does to a channel; `sensitivity` holds sums of products of its derivatives.
    pub(super) fn effect(&self, sensitivity: &[[f64; PARAMETERS]; PARAMETERS]) -> Test {
        let size = self.tested.len();
        let in_units = DMatrix::from_fn(size, size, |k, l| {
            let (p, q) = (self.tested[k] as usize, self.tested[l] as usize);
            sensitivity[p][q] * self.standard_errors[k] * self.standard_errors[l]
        });
        let weights = &in_units * &self.correlation;
        let (mean, half_variance) = (weights.trace(), (&weights * &weights).trace());
        if !(mean > 0.0 && half_variance > 0.0) {
            return Test { tested: 0, ..self.test(0.0, 1.0, self.behind) };
        }
        let degrees = (mean * mean / half_variance).clamp(1.0, size as f64);
        self.test(self.difference.dot(&(&in_units * &self.difference)) / mean * degrees, degrees, self.behind)
    }

    fn test(&self, squares: f64, degrees_of_freedom: f64, behind: f64) -> Test {
        let statistic = if degrees_of_freedom > 0.0 { (squares / degrees_of_freedom).clamp(0.0, f64::MAX) } else { 0.0 };
        let distribution = FisherSnedecor::new(degrees_of_freedom, behind);
        let probability = distribution.map_or(1.0, |distribution| distribution.sf(statistic)).clamp(0.0, 1.0);
        let behind = if behind.is_finite() { behind } else { 0.0 };
        Test { statistic, degrees_of_freedom, behind, tested: self.tested.len(), probability }
    }
}
