//! The sections of a fleet's page. A list of motors has a bounded length, and says how many it leaves out.

pub(super) mod apart;
pub(super) mod causes;
pub(super) mod drift;
pub(super) mod motors;
pub(super) mod parameters;

use crate::typography::{number, unit};
use fluxfit::{
    fleet::{FleetOverview, FleetValue},
    motor::Parameter,
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// How values of a parameter are written on a page: all with the unit of the fleet's median, so that they can be compared.
struct Shown {
    scale: Scale,
    unit: String,
}

impl Shown {
    fn of(fleet: &FleetOverview, parameter: Parameter) -> Self {
        let typical = fleet.distributions.iter().find(|one| one.parameter == parameter).and_then(|one| one.typical);
        // Given values have no distribution; the motor with the first one stands for all.
        let given = || fleet.motors.iter().find_map(|motor| motor.best.estimates.get(parameter as usize)?.value);
        let usual = typical.map(|typical| typical.median).or_else(|| Some(given()?.value));
        let scale = Scale::for_value(parameter, usual.unwrap_or_default());
        Self { unit: unit(parameter, &scale), scale }
    }

    /// A value with its unit, and the digits that it is known to.
    fn alone(&self, value: f64, half_width: f64) -> Markup {
        html! { (number(value, |value| self.scale.format(value, half_width))) "\u{a0}" (self.unit) }
    }

    /// The same with half of its 95 % interval in percent.
    fn measured(&self, value: FleetValue) -> Markup {
        html! {
            (self.alone(value.value, value.half_width))
            @if value.is_found() { " ±" (percent(value.relative_half_width())) "\u{a0}%" } @else { " (given)" }
        }
    }
}

/// A fraction in percent, two digits.
fn percent(fraction: f64) -> String {
    number(100.0 * fraction, |percent| significant(percent, 2))
}

/// A fraction in percent with its sign.
fn signed_percent(fraction: f64) -> String {
    let digits = number(100.0 * fraction.abs(), |percent| if percent < 1.0 { format!("{percent:.2}") } else { format!("{percent:.1}") });
    format!("{}{digits}\u{a0}%", if fraction < 0.0 { "\u{2212}" } else { "+" })
}
