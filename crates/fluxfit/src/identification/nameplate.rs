//! What is known of the motor without the log.

use crate::motor::{PARAMETERS, Parameter};

/// Values of a nameplate or data sheet: any subset, SI units. What is not a finite number above zero counts as not known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Nameplate {
    /// Values in the order of [`Parameter::ALL`].
    pub values: [Option<f64>; PARAMETERS],
    /// Pole pairs.
    pub pole_pairs: Option<u32>,
    /// Rated voltage and current.
    pub rating: Option<Rating>,
}

/// A motor's rating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rating {
    /// Phase peak, V.
    pub voltage: f64,
    /// Phase peak, A.
    pub current: f64,
    /// Electrical, rad/s.
    pub omega_e: f64,
}

impl Nameplate {
    /// One value, if it is known.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        self.values[parameter as usize].filter(|value| value.is_finite() && *value > 0.0)
    }
}
