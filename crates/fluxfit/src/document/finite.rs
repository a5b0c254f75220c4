//! Numbers that JSON can hold.

/// A number of a computation that may end infinite or undefined: null then, which is what JSON has for it.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
