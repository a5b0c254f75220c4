//! The search box.

use crate::error::Error;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Largest magnitude of a bound: steps and their squares stay finite.
const MAX_BOUND: f64 = 1e150;

/// A box of finite, non-empty intervals, one per dimension.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(try_from = "Unchecked"))]
pub struct Bounds {
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Bounds {
    /// # Errors
    /// If there is no dimension, the lengths differ, a bound is not finite (or beyond 1e150) or a lower one is not below its upper one.
    pub fn new(lower: Vec<f64>, upper: Vec<f64>) -> Result<Self, Error> {
        if lower.is_empty() || lower.len() != upper.len() {
            return Err(Error::BoundsShape { lower: lower.len(), upper: upper.len() });
        }
        for (dimension, (&lower, &upper)) in lower.iter().zip(&upper).enumerate() {
            if !(lower < upper && lower.abs() <= MAX_BOUND && upper.abs() <= MAX_BOUND) {
                return Err(Error::Bounds { dimension, lower, upper });
            }
        }
        Ok(Self { lower, upper })
    }

    /// Number of dimensions.
    pub fn dimension(&self) -> usize {
        self.lower.len()
    }

    /// `(lower, upper)` of each dimension.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.lower.iter().copied().zip(self.upper.iter().copied())
    }

    /// Moves each coordinate outside the box to the nearest face; one that is not a number, to the lower face.
    pub fn clamp(&self, position: &mut [f64]) {
        for (x, (lower, upper)) in position.iter_mut().zip(self.iter()) {
            *x = x.max(lower).min(upper);
        }
    }

    /// Whether a position lies in the box, faces included.
    pub fn contains(&self, position: &[f64]) -> bool {
        position.iter().zip(self.iter()).all(|(x, (lower, upper))| (lower..=upper).contains(x))
    }
}

/// Bounds as they are read back, before they are checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct Unchecked {
    lower: Vec<f64>,
    upper: Vec<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<Unchecked> for Bounds {
    type Error = Error;

    fn try_from(Unchecked { lower, upper }: Unchecked) -> Result<Self, Error> {
        Self::new(lower, upper)
    }
}
