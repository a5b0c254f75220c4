//! The motors, the worst first: their values with verdicts, and why they are not better.

use super::measured;
use crate::{
    report::FleetReport,
    section::Section,
    sections::answer::badge,
    table,
    typography::{grouped, prose, symbol},
};
use fluxfit::{
    Verdict,
    fleet::{FleetEstimate, Member, Standing},
    motor::Parameter,
};
use maud::{Markup, html};

/// Motors that are listed.
const LISTED: usize = 40;

/// The section.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let motors = &report.fleet.motors;
    let listed = motors.len().min(LISTED);
    let content = html! {
        (table::scrolling("Motors, the worst first", &html! {
            table.fleet {
                thead { tr {
                    th scope="col" { "Motor" }
                    @for parameter in Parameter::ALL { th scope="col" { (symbol(parameter)) } }
                } }
                @for member in &motors[..listed] { (motor(member)) }
            }
        }))
        @if motors.len() > listed { p { (left_out(&motors[listed..])) } }
    };
    (!motors.is_empty()).then_some(Section { anchor: "motors", heading: "Motors, the worst first", content })
}

/// How many motors are not listed, and how well they are known.
fn left_out(motors: &[Member]) -> Markup {
    let count = |standing: Standing| motors.iter().filter(|motor| motor.standing == standing).count() as u64;
    let parts = [
        (Standing::NoAnswer, "without an answer"),
        (Standing::Refused, "without the value of a parameter"),
        (Standing::Weak, "with a weak parameter"),
        (Standing::Identified, "with all parameters identified"),
    ];
    html! {
        (grouped(motors.len() as u64)) " more motors are in the results and not listed here: "
        @for (k, (standing, what)) in parts.into_iter().filter(|(standing, _)| count(*standing) > 0).enumerate() {
            @if k > 0 { ", " } (grouped(count(standing))) " " (what)
        }
        "."
    }
}

/// A motor: its values, and below them the reasons.
fn motor(member: &Member) -> Markup {
    let row = &member.best;
    let reasons = Parameter::ALL.into_iter().zip(&row.estimates).filter_map(|(parameter, estimate)| {
        let reason = estimate.reason.as_deref().filter(|_| estimate.verdict != Verdict::Identified)?;
        Some(html! { (symbol(parameter)) ": " (prose(reason)) ". " })
    });
    html! {
        tbody {
            tr {
                th.name scope="row" { (row.motor) (windows(member)) }
                @if let Some(error) = &row.error {
                    td.words colspan="4" { span.badge.not-identifiable { "no answer" } " " (prose(error)) }
                } @else {
                    @for (parameter, estimate) in Parameter::ALL.into_iter().zip(&row.estimates) { (cell(parameter, estimate)) }
                }
            }
            @for reason in reasons.filter(|_| row.error.is_none()) { tr.note { td colspan="5" { (reason) } } }
        }
    }
}

/// How many windows the motor has, and how many of them fail.
fn windows(member: &Member) -> Markup {
    html! {
        @if member.rows > 1 {
            span.basis {
                " " (grouped(member.rows as u64)) " windows"
                @if member.failed > 0 { ", " (grouped(member.failed as u64)) " without an answer" }
            }
        }
    }
}

fn cell(parameter: Parameter, estimate: &FleetEstimate) -> Markup {
    html! {
        td {
            @match (estimate.value, estimate.verdict) {
                (Some(value), Verdict::Identified) => (measured(parameter, value)),
                (Some(value), verdict) => { (measured(parameter, value)) " " (badge(verdict)) }
                (None, verdict) => (badge(verdict)),
            }
        }
    }
}
