//! The parameters over all motors: how many are identified, the median, how the motors differ, and how well they are known.

use super::{alone, percent};
use crate::{
    report::FleetReport,
    section::Section,
    sections::answer,
    table,
    typography::{DASH, grouped, symbol},
};
use fluxfit::fleet::{Distribution, FleetValue, Typical};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let content = html! {
        (table::scrolling("Parameters of the fleet", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Identified" } th scope="col" { "Weak" } th scope="col" { "No value" }
                    th scope="col" { "Median" } th scope="col" { "Middle 95 % of the motors" } th scope="col" { "± 95 % of one motor" }
                    th scope="col" { "Stand apart" }
                } }
                tbody { @for distribution in &report.fleet.distributions { (row(distribution)) } }
            }
        }))
        p.small {
            "Numbers of motors, without those that have no answer"
            @if report.fleet.rows > report.fleet.motors.len() { "; of a motor with several windows the one that tells most" }
            ". " (answer::thresholds())
        }
    };
    (!report.fleet.motors.is_empty()).then_some(Section { anchor: "parameters", heading: "Parameters", content })
}

fn row(distribution: &Distribution) -> Markup {
    let parameter = distribution.parameter;
    let [identified, weak, refused] = distribution.verdicts.map(|motors| grouped(motors as u64));
    html! {
        tr {
            th scope="row" { (symbol(parameter)) }
            td { (identified) } td { (weak) } td { (refused) }
            @if let Some(Typical { median, middle: [low, high], half_width }) = distribution.typical {
                // The digits that tell the ends of the range apart.
                @let shown = |value: f64| alone(parameter, FleetValue { value, half_width: (0.1 * (high - low)).max(half_width) });
                td { strong { (shown(median)) } }
                td { (shown(low)) " … " (shown(high)) }
                td { "±" (percent(half_width / median.abs())) "\u{a0}%" }
                td { (grouped(distribution.outliers.len() as u64)) }
            } @else {
                @for _ in 0..4 { td { (DASH) } }
            }
        }
    }
}
