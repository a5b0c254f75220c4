//! The motors that stand apart from the others: one row for each, with the distances of all its parameters.

use super::{Shown, signed_percent};
use crate::{
    report::FleetReport,
    section::Section,
    table,
    typography::{DASH, grouped, symbol},
};
use fluxfit::{
    fleet::{FleetOverview, LEAST_MOTORS, Member},
    motor::Parameter,
};
use maud::{Markup, html};

/// Motors that are listed.
const LISTED: usize = 15;

/// The section; none of a fleet of which no motor stands apart.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let fleet = report.fleet;
    let motors = fleet.apart();
    let (listed, more) = (motors.len().min(LISTED), motors.len().saturating_sub(LISTED));
    let content = html! {
        (table::scrolling("Motors that stand apart", &html! {
            table {
                thead { tr { th scope="col" { "Motor" } @for parameter in Parameter::ALL { th scope="col" { (symbol(parameter)) " from the median" } } } }
                tbody { @for member in &motors[..listed] {
                    tr { th.name scope="row" { (member.best.motor) } @for parameter in Parameter::ALL { (cell(fleet, member, parameter)) } }
                } }
            }
        }))
        @if more > 0 { p { "And " (grouped(more as u64)) " more motors that are nearer to the others." } }
        p.small {
            "A motor stands apart, in red, if it is farther from the median than its own interval and the spread of the motors explain together. "
            "Of twenty fleets of equal motors one has a motor that does so by chance. Fewer than " (LEAST_MOTORS) " motors are not compared. "
            "If several parameters of a motor are off by one factor, look for a wrong unit, number of pole pairs or scale in its log."
        }
    };
    (!motors.is_empty()).then_some(Section { anchor: "apart", heading: "Motors that stand apart", content })
}

/// The distance from the median, and the value.
fn cell(fleet: &FleetOverview, member: &Member, parameter: Parameter) -> Markup {
    let distribution = fleet.distributions.iter().find(|one| one.parameter == parameter);
    let value = member.best.estimates.get(parameter as usize).and_then(|estimate| estimate.found());
    let (Some(distribution), Some(value)) = (distribution, value) else { return html! { td { (DASH) } } };
    let Some(typical) = distribution.typical else { return html! { td { (DASH) } } };
    let is_apart = |motor: usize| fleet.motors.get(motor).is_some_and(|other| other.best.motor == member.best.motor);
    let is_apart = distribution.outliers.iter().any(|outlier| is_apart(outlier.motor));
    html! {
        td.apart[is_apart] {
            (signed_percent((value.value - typical.median) / typical.median.abs()))
            br; span.basis { (Shown::of(fleet, parameter).measured(value)) }
        }
    }
}
