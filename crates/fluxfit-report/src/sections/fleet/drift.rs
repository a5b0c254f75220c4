//! Parameters that drift from window to window.

use super::{Shown, percent, signed_percent};
use crate::{
    report::FleetReport,
    section::Section,
    table,
    typography::{grouped, list, symbol},
};
use fluxfit::{fleet::Drift, motor::Parameter};
use maud::{Markup, html};

/// Movements of each parameter that are listed: resistances move most, and say least.
const LISTED: usize = 5;

/// The section; none of results without windows.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let fleet = report.fleet;
    let followed = grouped(fleet.followed as u64);
    let of = |parameter: Parameter| fleet.drifts.iter().filter(move |drift| drift.parameter == parameter).take(LISTED);
    let listed: Vec<&Drift> = Parameter::ALL.into_iter().flat_map(of).collect();
    let more = fleet.drifts.len() - listed.len();
    let counted = Parameter::ALL.into_iter().filter_map(|parameter| {
        let motors = fleet.drifts.iter().filter(|drift| drift.parameter == parameter).count();
        (motors > 0).then(|| html! { (symbol(parameter)) " of " (grouped(motors as u64)) })
    });
    let content = html! {
        p {
            @if fleet.drifts.is_empty() {
                "Nothing moves by more than the intervals say; " (followed) " motors are known in two windows or more."
            } @else {
                "Of " (followed) " motors that are known in two windows or more, these move by more than their intervals say: "
                (list(&counted.collect::<Vec<Markup>>())) ". Of each parameter, those that move most stand first."
            }
        }
        @if !listed.is_empty() {
            (table::scrolling("Drifting parameters", &html! {
                table {
                    thead { tr {
                        th scope="col" { "Motor" } th scope="col" { "Parameter" } th scope="col" { "Windows" } th scope="col" { "First" }
                        th scope="col" { "Last" } th scope="col" { "Last less first" } th scope="col" { "Largest less smallest" }
                    } }
                    tbody { @for drift in &listed { (row(report, drift)) } }
                }
            }))
        }
        @if more > 0 { p { "And " (grouped(more as u64)) " more that move less." } }
        p.small {
            "Tested for each motor and parameter: whether one value suits all windows. Of twenty fleets that stay as they are one has a "
            "movement by chance. R" sub { "s" } " and ψ" sub { "f" } " move with the temperature: copper by +3.9 % for 10 K, magnets by −1 to −2 %."
        }
    };
    (fleet.followed > 0).then_some(Section { anchor: "drift", heading: "Drift", content })
}

fn row(report: &FleetReport, drift: &Drift) -> Markup {
    let (Some(member), Some(first), Some(last)) = (report.fleet.motors.get(drift.motor), drift.points.first(), drift.points.last()) else {
        return html! {};
    };
    let shown = Shown::of(report.fleet, drift.parameter);
    html! {
        tr {
            th.name scope="row" { (member.best.motor) }
            td { (symbol(drift.parameter)) }
            td { (grouped(drift.points.len() as u64)) }
            td { (shown.measured(first.value)) }
            td { (shown.measured(last.value)) }
            td { (signed_percent(drift.change)) }
            td { (percent(drift.range)) "\u{a0}%" }
        }
    }
}
