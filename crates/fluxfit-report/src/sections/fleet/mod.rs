//! The sections of a fleet's page. A list of motors has a bounded length, and says how many it leaves out.

pub(super) mod apart;
pub(super) mod causes;
pub(super) mod drift;
pub(super) mod motors;
pub(super) mod parameters;

use crate::typography::{number, unit};
use fluxfit::{fleet::FleetValue, motor::Parameter};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// A value with its unit and, in percent, half of its 95 % interval.
fn measured(parameter: Parameter, value: FleetValue) -> Markup {
    html! {
        (alone(parameter, value))
        @if value.is_found() { " ±" (percent(value.relative_half_width())) "\u{a0}%" }
    }
}

/// A value with its unit, and the digits that it is known to.
fn alone(parameter: Parameter, value: FleetValue) -> Markup {
    let scale = Scale::for_value(parameter, value.value);
    html! { (number(value.value, |value_| scale.format(value_, value.half_width))) "\u{a0}" (unit(parameter, &scale)) }
}

/// A fraction in percent, two digits.
fn percent(fraction: f64) -> String {
    number(100.0 * fraction, |percent| significant(percent, 2))
}

/// A fraction in percent with its sign.
fn signed_percent(fraction: f64) -> String {
    let digits = number(100.0 * fraction.abs(), |percent| significant(percent, 3));
    format!("{}{digits}\u{a0}%", if fraction < 0.0 { "\u{2212}" } else { "+" })
}
