//! A value that is told, as text: with its unit, and half of its interval.

use fluxfit::Parameter;
use fluxfit_track::Tracked;
use fluxfit_units::{Scale, significant};

/// A value with its unit.
pub(super) fn shown(parameter: Parameter, tracked: &Tracked) -> (String, String) {
    let Some(value) = tracked.value else { return ("-".to_owned(), String::new()) };
    let scale = Scale::for_value(parameter, value);
    let error = tracked.standard_error.unwrap_or(value.abs() * 1e-3);
    (scale.format(value, error), scale.unit(parameter.unit()))
}

/// Half of the 95 % interval as a part of the value.
pub(super) fn margin(tracked: &Tracked) -> String {
    match (tracked.half_width(), tracked.value) {
        (Some(half_width), Some(value)) => format!("±{} %", significant(100.0 * half_width / value.abs(), 2)),
        _ => String::new(),
    }
}
