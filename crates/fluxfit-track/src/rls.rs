//! Recursive least squares over blocks of periods.
//!
//! When to use it: it needs no start values and no tuning, and tells which parameters the samples determine. Its errors are about twice
//! those of the Kalman filter.
//!
//! The gated form is that of `fluxfit-core`; here it also has the forms of the literature.

use crate::{
    estimate::{Estimate, IDENTIFIABLE},
    start::Start,
};
use fluxfit::motor::PARAMETERS;
use fluxfit_core::{BlockRls, BlockRlsSettings, Period};
use serde::{Deserialize, Serialize};

/// Which form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Form {
    /// Blocks of 50 periods; older ones are forgotten only while the parameters are excited.
    Gated,
    /// Blocks of 50 periods; older ones are always forgotten.
    Exponential,
    /// Blocks of 50 periods; nothing is forgotten.
    Constant,
    /// Single periods: the "dynamic" regression of the literature.
    Sample,
    /// Single periods without the derivative: the "steady" regression of the literature.
    Steady,
}

/// Least squares.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rls {
    inner: BlockRls<f64>,
}

impl Rls {
    /// Begins with what is known; `nominal` are the values that are taken as one.
    pub fn new(start: &Start, nominal: [f64; PARAMETERS], form: Form) -> Self {
        let usual = BlockRlsSettings { known: start.known(&nominal), rating: start.rating, ..BlockRlsSettings::new(nominal) };
        // The last two keep about as many seconds as 0.99 of a block.
        let settings = match form {
            Form::Gated => usual,
            Form::Exponential => BlockRlsSettings { gated: false, ..usual },
            Form::Constant => BlockRlsSettings { forgetting: 1.0, ..usual },
            Form::Sample => BlockRlsSettings { gated: false, periods: 1, forgetting: 0.9999, ..usual },
            Form::Steady => BlockRlsSettings { gated: false, periods: 1, forgetting: 0.9995, has_derivative: false, ..usual },
        };
        Self { inner: BlockRls::new(settings) }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        self.inner.begin(i);
    }

    /// Goes on by a period to a current, A. True if the estimate changed.
    pub fn advance(&mut self, period: &Period<f64>, i: [f64; 2]) -> bool {
        self.inner.advance(period, i)
    }

    /// An upper triangular `W` whose `W W'` is the covariance, SI.
    pub(crate) fn root(&self) -> [[f64; PARAMETERS]; PARAMETERS] {
        self.inner.root()
    }

    /// Whether the last half second excited the parameters.
    pub fn is_excited(&self) -> bool {
        self.inner.is_excited()
    }

    /// Values, standard errors, and which parameters are identifiable.
    pub fn estimate(&self) -> Estimate {
        let fluxfit_core::Estimate { value, standard_error } = self.inner.estimate();
        Estimate {
            values: value,
            standard_errors: Some(standard_error),
            identifiable: Some(std::array::from_fn(|j| standard_error[j] < IDENTIFIABLE * value[j].abs())),
            excited: Some(self.inner.is_excited()),
        }
    }
}
