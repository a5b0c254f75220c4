//! The estimators, as one choice.

use crate::{
    adaline::Adaline,
    bias_compensated::BiasCompensated,
    ekf::WatchedEkf,
    estimate::Estimate,
    forgetting::{Forgetting, Kind},
    instrumental_variable::InstrumentalVariable,
    mras::{Gain, Mras},
    rls::{Form, Rls},
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
    /// The same with exponential forgetting, excited or not.
    RlsExponential,
    /// The same with Fortescue's forgetting.
    RlsFortescue,
    /// The same with fuzzy forgetting.
    RlsFuzzy,
    /// The same with directional forgetting.
    RlsDirectional,
    /// Least squares on single periods.
    RlsSample,
    /// The same without the derivative.
    RlsSteady,
    /// Instrumental variables on single periods.
    InstrumentalVariable,
    /// Block least squares with the bias by noise subtracted.
    BiasCompensated,
    /// Model reference adaptive system with a matrix gain.
    Mras,
    /// The same with scalar gains.
    MrasScalar,
    /// Adaline network.
    Adaline,
}

impl Method {
    /// All of them; the recommended one first.
    pub const ALL: [Self; 14] = [
        Self::EkfTracking,
        Self::Ekf,
        Self::Rls,
        Self::RlsExponential,
        Self::RlsFortescue,
        Self::RlsFuzzy,
        Self::RlsDirectional,
        Self::RlsSample,
        Self::RlsSteady,
        Self::InstrumentalVariable,
        Self::BiasCompensated,
        Self::Mras,
        Self::MrasScalar,
        Self::Adaline,
    ];

    /// Name on the command line and in documents.
    pub fn key(self) -> &'static str {
        match self {
            Self::EkfTracking => "ekf-tracking",
            Self::Ekf => "ekf",
            Self::Rls => "rls",
            Self::RlsExponential => "rls-exponential",
            Self::RlsFortescue => "rls-fortescue",
            Self::RlsFuzzy => "rls-fuzzy",
            Self::RlsDirectional => "rls-directional",
            Self::RlsSample => "rls-sample",
            Self::RlsSteady => "rls-steady",
            Self::InstrumentalVariable => "iv",
            Self::BiasCompensated => "bias-compensated",
            Self::Mras => "mras",
            Self::MrasScalar => "mras-scalar",
            Self::Adaline => "adaline",
        }
    }

    /// In prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::EkfTracking => "Kalman filter, tracking, with block least squares",
            Self::Ekf => "Kalman filter, constant parameters, with block least squares",
            Self::Rls => "least squares over blocks of 50 periods, gated",
            Self::RlsExponential => "least squares over blocks, exponential forgetting",
            Self::RlsFortescue => "least squares over blocks, Fortescue's forgetting",
            Self::RlsFuzzy => "least squares over blocks, fuzzy forgetting",
            Self::RlsDirectional => "least squares over blocks, directional forgetting",
            Self::RlsSample => "least squares on single periods",
            Self::RlsSteady => "least squares on single periods without derivative",
            Self::InstrumentalVariable => "instrumental variables on single periods",
            Self::BiasCompensated => "block least squares, bias compensated",
            Self::Mras => "model reference adaptive system, matrix gain",
            Self::MrasScalar => "model reference adaptive system, scalar gains",
            Self::Adaline => "Adaline network, four stages",
        }
    }

    /// Whether it tells how likely its currents are.
    pub(crate) fn has_likelihood(self) -> bool {
        matches!(self, Self::EkfTracking | Self::Ekf)
    }

    /// Whether it tells how uncertain its values are.
    pub fn has_covariance(self) -> bool {
        matches!(self, Self::EkfTracking | Self::Ekf | Self::Rls | Self::RlsExponential | Self::RlsSample | Self::RlsSteady)
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
    /// Usual current, A, voltage, V, and noise of each current, A.
    pub scale: [f64; 3],
}

/// A running estimator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Estimator {
    /// A Kalman filter.
    Ekf(Box<WatchedEkf>),
    /// Least squares.
    Rls(Box<Rls>),
    /// Least squares with another kind of forgetting.
    Forgetting(Box<Forgetting>),
    /// Instrumental variables.
    InstrumentalVariable(Box<InstrumentalVariable>),
    /// Bias-compensated least squares.
    BiasCompensated(Box<BiasCompensated>),
    /// A model reference adaptive system.
    Mras(Box<Mras>),
    /// An Adaline network.
    Adaline(Box<Adaline>),
}

/// Does the same with every kind of estimator.
macro_rules! each {
    ($estimator:expr, $inner:ident => $do:expr) => {
        match $estimator {
            Estimator::Ekf($inner) => $do,
            Estimator::Rls($inner) => $do,
            Estimator::Forgetting($inner) => $do,
            Estimator::InstrumentalVariable($inner) => $do,
            Estimator::BiasCompensated($inner) => $do,
            Estimator::Mras($inner) => $do,
            Estimator::Adaline($inner) => $do,
        }
    };
}

impl Estimator {
    /// An estimator at its beginning.
    pub fn new(method: Method, beginning: &Beginning) -> Self {
        let Beginning { start, nominal, seed, is_guessed, scale } = *beginning;
        let filter = |is_tracking| Self::Ekf(Box::new(WatchedEkf::new(&start, seed, is_guessed, scale, is_tracking)));
        let rls = |form| Self::Rls(Box::new(Rls::new(&start, nominal, form)));
        let forgetting = |kind| Self::Forgetting(Box::new(Forgetting::new(kind, nominal)));
        match method {
            Method::EkfTracking => filter(true),
            Method::Ekf => filter(false),
            Method::Rls => rls(Form::Gated),
            Method::RlsExponential => rls(Form::Exponential),
            Method::RlsSample => rls(Form::Sample),
            Method::RlsSteady => rls(Form::Steady),
            Method::RlsFortescue => forgetting(Kind::Fortescue),
            Method::RlsFuzzy => forgetting(Kind::Fuzzy),
            Method::RlsDirectional => forgetting(Kind::Directional),
            Method::InstrumentalVariable => Self::InstrumentalVariable(Box::new(InstrumentalVariable::new(nominal))),
            Method::BiasCompensated => Self::BiasCompensated(Box::new(BiasCompensated::new(nominal))),
            Method::Mras => Self::Mras(Box::new(Mras::new(nominal, Gain::Matrix, scale[1]))),
            Method::MrasScalar => Self::Mras(Box::new(Mras::new(nominal, Gain::Scalar, scale[1]))),
            Method::Adaline => Self::Adaline(Box::new(Adaline::new(nominal))),
        }
    }

    /// Takes what a row brought.
    pub fn take(&mut self, event: &Event) {
        match event {
            Event::Begin(i) => each!(self, inner => inner.begin(*i)),
            Event::Period(period, i) => each!(self, inner => { inner.advance(period, *i); }),
        }
    }

    /// Whether the last half second excited the parameters; none of an estimator that cannot tell.
    pub fn is_excited(&self) -> Option<bool> {
        match self {
            Self::Ekf(estimator) => Some(estimator.is_excited()),
            Self::Rls(estimator) => Some(estimator.is_excited()),
            _ => None,
        }
    }

    /// What it knows.
    pub fn estimate(&self) -> Estimate {
        each!(self, inner => inner.estimate())
    }
}
