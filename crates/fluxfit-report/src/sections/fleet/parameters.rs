//! The parameters over all motors: how many are identified, the median, how the motors differ, and how well they are known.

use super::{Shown, percent};
use crate::{
    report::FleetReport,
    section::Section,
    sections::answer,
    table,
    typography::{DASH, grouped, symbol},
};
use fluxfit::fleet::{Distribution, FleetOverview, Typical};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let content = html! {
        (table::scrolling("Parameters of the fleet", &html! {
            table {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Identified" } th scope="col" { "Weak" } th scope="col" { "No value" }
                    th scope="col" { "Median" } th scope="col" { (range_of(report.fleet)) } th scope="col" { "± 95 % of one motor" }
                    th scope="col" { "Stand apart" }
                } }
                tbody { @for distribution in &report.fleet.distributions { (row(report.fleet, distribution)) } }
            }
        }))
        p.small {
            "Numbers of motors, without those that have no answer"
            @if report.fleet.rows > report.fleet.motors.len() { "; of a motor with several windows the one that tells most" }
            ". " (answer::thresholds())
        }
    };
    let has_answer = report.fleet.distributions.iter().any(|distribution| distribution.verdicts.iter().sum::<usize>() > 0);
    has_answer.then_some(Section { anchor: "parameters", heading: "Parameters", content })
}

/// What the range is of: of fewer motors than that, one in forty is none.
fn range_of(fleet: &FleetOverview) -> &'static str {
    const MANY: usize = 40;
    if fleet.distributions.iter().any(|one| one.values.len() >= MANY) { "Middle 95 % of the motors" } else { "Smallest … largest" }
}

fn row(fleet: &FleetOverview, distribution: &Distribution) -> Markup {
    let parameter = distribution.parameter;
    let shown = Shown::of(fleet, parameter);
    let [identified, weak, refused] = distribution.verdicts.map(|motors| grouped(motors as u64));
    html! {
        tr {
            th scope="row" { (symbol(parameter)) }
            td { (identified) } td { (weak) } td { (refused) }
            @if let Some(Typical { median, range: [low, high], half_width }) = distribution.typical {
                // The digits that tell the ends of the range apart.
                @let digit = (0.1 * (high - low)).max(half_width);
                td { strong { (shown.alone(median, digit)) } }
                td { (shown.alone(low, digit)) " … " (shown.alone(high, digit)) }
                td { "±" (percent(half_width / median.abs())) "\u{a0}%" }
                td { (grouped(distribution.outliers.len() as u64)) }
            } @else {
                @for _ in 0..4 { td { (DASH) } }
            }
        }
    }
}
