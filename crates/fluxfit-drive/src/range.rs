//! Ranges of single settings. `key` is that of the scenario file.

use crate::error::Error;

/// The error of a setting out of its range.
pub(crate) fn setting(key: &'static str, value: f64, range: &'static str) -> Error {
    Error::Setting { key, value, range }
}

/// Refuses what is not a finite number above zero.
pub(crate) fn positive(key: &'static str, value: f64) -> Result<(), Error> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(setting(key, value, "a finite number above zero")) }
}

/// Refuses what is not a finite number, zero or more.
pub(crate) fn not_negative(key: &'static str, value: f64) -> Result<(), Error> {
    if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(setting(key, value, "a finite number, zero or more")) }
}

/// Refuses what is not a finite number.
pub(crate) fn finite(key: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() { Ok(()) } else { Err(setting(key, value, "a finite number")) }
}
