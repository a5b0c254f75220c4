//! The estimators, as one choice.

use crate::{
    ekf::WatchedEkf,
    estimate::Estimate,
    rls::Rls,
    start::Start,
    stream::Event,
};
use fluxfit::motor::PARAMETERS;
use serde::{Deserialize, Serialize};

/// Which estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Method {
    /// Kalman filter for drifting parameters, started and watched by block least squares.
    EkfTracking,
    /// The same for constant parameters.
    Ekf,
    /// Least squares over blocks of 50 periods with gated forgetting.
    Rls,
}

impl Method {
    /// All of them; the recommended one first.
    pub const ALL: [Self; 3] = [Self::EkfTracking, Self::Ekf, Self::Rls];

    /// Name on the command line and in documents.
    pub fn key(self) -> &'static str {
        match self {
            Self::EkfTracking => "ekf-tracking",
            Self::Ekf => "ekf",
            Self::Rls => "rls",
        }
    }

    /// In prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::EkfTracking => "Kalman filter, tracking, with block least squares",
            Self::Ekf => "Kalman filter, constant parameters, with block least squares",
            Self::Rls => "least squares over blocks of 50 periods, gated",
        }
    }

    /// Whether it tells how likely its currents are.
    pub(crate) fn has_likelihood(self) -> bool {
        matches!(self, Self::EkfTracking | Self::Ekf)
    }

    /// The method of this name.
    pub fn named(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.key() == key)
    }
}

/// With what an estimator begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beginning {
    /// What was known before.
    pub start: Start,
    /// Values that are taken as one: given ones, or about those of the motor.
    pub nominal: [f64; PARAMETERS],
    /// The same with what block least squares found in the first samples: a Kalman filter must begin near the motor.
    pub seed: [f64; PARAMETERS],
    /// Which of these are guesses.
    pub is_guessed: [bool; PARAMETERS],
    /// Usual current, A, and voltage, V.
    pub scale: [f64; 2],
}

/// A running estimator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Estimator {
    /// A Kalman filter.
    Ekf(Box<WatchedEkf>),
    /// Least squares.
    Rls(Box<Rls>),
}

impl Estimator {
    /// An estimator at its beginning.
    pub fn new(method: Method, beginning: &Beginning) -> Self {
        let Beginning { start, nominal, seed, is_guessed, scale } = *beginning;
        let filter = |is_tracking| Self::Ekf(Box::new(WatchedEkf::new(&start, seed, is_guessed, scale, is_tracking)));
        match method {
            Method::EkfTracking => filter(true),
            Method::Ekf => filter(false),
            Method::Rls => Self::Rls(Box::new(Rls::new(&start, nominal, 0.99))),
        }
    }

    /// Takes what a row brought.
    pub fn take(&mut self, event: &Event) {
        match event {
            Event::Begin(i) => self.begin(*i),
            Event::Period(period, i) => match self {
                Self::Ekf(estimator) => estimator.advance(period, *i),
                Self::Rls(estimator) => {
                    estimator.advance(period, *i);
                }
            },
        }
    }

    fn begin(&mut self, i: [f64; 2]) {
        match self {
            Self::Ekf(estimator) => estimator.begin(i),
            Self::Rls(estimator) => estimator.begin(i),
        }
    }

    /// Whether the last half second excited the parameters; none of an estimator that cannot tell.
    pub fn is_excited(&self) -> Option<bool> {
        match self {
            Self::Ekf(estimator) => Some(estimator.is_excited()),
            Self::Rls(estimator) => Some(estimator.is_excited()),
        }
    }

    /// What it knows.
    pub fn estimate(&self) -> Estimate {
        match self {
            Self::Ekf(estimator) => estimator.estimate(),
            Self::Rls(estimator) => estimator.estimate(),
        }
    }
}
