//! Verdicts: what may be said of a parameter now.

use crate::estimate::Estimate;
use fluxfit::motor::PARAMETERS;
use serde::{Deserialize, Serialize};

/// Normal quantile of a 95 % interval.
pub(crate) const HALF_WIDTH95: f64 = 1.959_964;

/// Largest half-width of an identified parameter, as a part of its value: the limit of `fluxfit identify`.
const IDENTIFIED: f64 = 0.05;

/// The same of a weakly identified one.
const WEAK: f64 = 0.5;

/// What may be said of a parameter now.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Verdict {
    /// Half of the 95 % interval is at most 5 % of the value.
    Identified,
    /// It is at most 50 %.
    Weak,
    /// Identified before; nothing has excited the parameters since this time, s, and the value is held.
    Holding {
        /// Time, s.
        since: f64,
    },
    /// The samples do not determine it.
    NotIdentifiable,
    /// A value without an error covariance.
    Unknown,
}

impl Verdict {
    /// Name in documents.
    pub fn key(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Weak => "weak",
            Self::Holding { .. } => "holding",
            Self::NotIdentifiable => "not-identifiable",
            Self::Unknown => "unknown",
        }
    }

    /// All names.
    pub const KEYS: [&str; 5] = ["identified", "weak", "holding", "not-identifiable", "unknown"];
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Identified => write!(f, "identified"),
            Self::Weak => write!(f, "weak"),
            Self::Holding { since } => write!(f, "holding since {since:.1} s: no excitation"),
            Self::NotIdentifiable => write!(f, "not identifiable now"),
            Self::Unknown => write!(f, "no error covariance"),
        }
    }
}

/// One parameter at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracked {
    /// Value, SI; none of a parameter that is not identifiable.
    pub value: Option<f64>,
    /// Standard error, SI; none without a value or without an error covariance.
    pub standard_error: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
}

impl Tracked {
    /// Half of the 95 % interval.
    pub fn half_width(&self) -> Option<f64> {
        self.standard_error.map(|error| HALF_WIDTH95 * error)
    }

    /// The 95 % interval.
    pub fn interval(&self) -> Option<[f64; 2]> {
        Some([self.value? - self.half_width()?, self.value? + self.half_width()?])
    }
}

/// Since when nothing has excited the parameters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Excitation {
    quiet_since: Option<f64>,
}

impl Excitation {
    /// Notes at a time, s, whether the parameters are excited.
    pub(crate) fn note(&mut self, t: f64, is_excited: Option<bool>) {
        if is_excited == Some(false) {
            self.quiet_since.get_or_insert(t);
        } else {
            self.quiet_since = None;
        }
    }

    /// What may be said of each parameter.
    pub(crate) fn judge(&self, estimate: &Estimate) -> [Tracked; PARAMETERS] {
        std::array::from_fn(|j| self.judge_one(estimate, j))
    }

    fn judge_one(&self, estimate: &Estimate, j: usize) -> Tracked {
        let nothing = Tracked { value: None, standard_error: None, verdict: Verdict::NotIdentifiable };
        let value = estimate.values[j];
        if !value.is_finite() {
            return nothing;
        }
        let Some(errors) = estimate.standard_errors else {
            return Tracked { value: Some(value), standard_error: None, verdict: Verdict::Unknown };
        };
        let relative = HALF_WIDTH95 * errors[j] / value.abs();
        let is_identifiable = estimate.identifiable.is_none_or(|identifiable| identifiable[j]);
        if !is_identifiable || value <= 0.0 || relative.is_nan() || relative > WEAK {
            return nothing;
        }
        let verdict = match self.quiet_since {
            Some(since) if errors[j] > 0.0 => Verdict::Holding { since },
            _ if relative <= IDENTIFIED => Verdict::Identified,
            _ => Verdict::Weak,
        };
        Tracked { value: Some(value), standard_error: Some(errors[j]), verdict }
    }
}
