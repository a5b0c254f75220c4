//! What is known of the motor without the log.

use crate::motor::{PARAMETERS, Parameter};

/// Values of a nameplate or data sheet: any subset, SI units. Of `values`, what is not a finite number above zero counts as not known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Nameplate {
    /// Values in the order of [`Parameter::ALL`].
    pub values: [Option<f64>; PARAMETERS],
    /// Pole pairs; with them, a speed logged as mechanical instead of electrical can be recognized.
    pub pole_pairs: Option<u32>,
    /// Rated voltage, current and speed.
    pub rating: Option<Rating>,
}

/// A motor's rating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rating {
    /// Rated voltage, V: peak per phase, not line-to-line RMS.
    pub voltage: f64,
    /// Rated current, A: peak per phase, not RMS.
    pub current: f64,
    /// Rated speed, electrical rad/s.
    pub omega_e: f64,
}

impl Nameplate {
    /// One value, if it is known.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        self.values[parameter as usize].filter(|value| value.is_finite() && *value > 0.0)
    }
}
