//! The motors that stand apart from the others.

use super::{measured, signed_percent};
use crate::{
    report::FleetReport,
    section::Section,
    table,
    typography::{grouped, minus, symbol},
};
use fluxfit::{
    fleet::{LEAST_MOTORS, Outlier},
    motor::Parameter,
};
use maud::html;

/// Motors that are listed.
const LISTED: usize = 20;

/// The section; none of a fleet of which no motor stands apart.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let fleet = report.fleet;
    let of = |distribution: &fluxfit::fleet::Distribution| {
        let parameter = distribution.parameter;
        distribution.outliers.iter().map(move |outlier| (parameter, *outlier)).collect::<Vec<_>>()
    };
    let mut outliers: Vec<(Parameter, Outlier)> = fleet.distributions.iter().flat_map(of).collect();
    outliers.sort_by(|(_, one), (_, other)| other.deviations.abs().total_cmp(&one.deviations.abs()));
    let (listed, more) = (outliers.len().min(LISTED), outliers.len().saturating_sub(LISTED));
    let content = html! {
        (table::scrolling("Motors that stand apart", &html! {
            table {
                thead { tr {
                    th scope="col" { "Motor" } th scope="col" { "Parameter" } th scope="col" { "Value" } th scope="col" { "From the median" }
                    th scope="col" { "In standard deviations" }
                } }
                tbody { @for (parameter, outlier) in &outliers[..listed] {
                    @if let Some(member) = fleet.motors.get(outlier.motor) {
                        tr {
                            th.name scope="row" { (member.best.motor) }
                            td { (symbol(*parameter)) }
                            td { (measured(*parameter, outlier.value)) }
                            td { (signed_percent(outlier.distance)) }
                            td { (minus(format!("{:+.1}", outlier.deviations))) }
                        }
                    }
                } }
            }
        }))
        @if more > 0 { p { "And " (grouped(more as u64)) " more, which are nearer to the others." } }
        p.small {
            "A motor stands apart if it is farther from the median than its own interval and the spread of the motors explain together. Of "
            "twenty fleets of equal motors one has a motor that does so by chance. Fewer than " (LEAST_MOTORS) " motors are not compared. "
            "Where several parameters of a motor are off by one factor, look for a wrong unit, number of pole pairs or scale in its log."
        }
    };
    (!outliers.is_empty()).then_some(Section { anchor: "apart", heading: "Motors that stand apart", content })
}
