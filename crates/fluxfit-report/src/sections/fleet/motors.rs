//! The motors, the worst first: their values with verdicts, and why they are not better.

use super::Shown;
use crate::{
    report::FleetReport,
    section::Section,
    sections::answer::badge,
    table,
    typography::{grouped, prose, symbol},
};
use fluxfit::{
    Verdict,
    fleet::{FleetEstimate, FleetOverview, Member, Missing, Standing},
    motor::Parameter,
};
use maud::{Markup, html};
use std::collections::BTreeSet;

/// Motors that are listed.
const LISTED: usize = 40;

/// Of motors without an answer for one reason, so many are listed: the section on reasons counts them all.
const ALIKE: usize = 2;

/// The section.
pub(crate) fn section(report: &FleetReport) -> Option<Section> {
    let motors = &report.fleet.motors;
    let examples = examples(report.fleet);
    let is_wanted = |member: &&Member| member.standing != Standing::NoAnswer || examples.contains(&*member.best.motor);
    let (wanted, alike): (Vec<&Member>, Vec<&Member>) = motors.iter().partition(is_wanted);
    let listed = wanted.len().min(LISTED);
    let left: Vec<&Member> = alike.into_iter().chain(wanted[listed..].iter().copied()).collect();
    let shown = Parameter::ALL.map(|parameter| (parameter, Shown::of(report.fleet, parameter)));
    let content = html! {
        (table::scrolling("Motors, the worst first", &html! {
            table.fleet {
                thead { tr {
                    th scope="col" { "Motor" }
                    @for parameter in Parameter::ALL { th scope="col" { (symbol(parameter)) } }
                } }
                @for member in &wanted[..listed] { (motor(member, &shown)) }
            }
        }))
        @if !left.is_empty() { p { (left_out(&left)) } }
    };
    (!motors.is_empty()).then_some(Section { anchor: "motors", heading: "Motors, the worst first", content })
}

/// The first motors of each reason for no answer.
fn examples(fleet: &FleetOverview) -> BTreeSet<&str> {
    let causes = fleet.causes.iter().filter(|cause| cause.missing == Missing::Answer).take(LISTED / ALIKE);
    causes.flat_map(|cause| cause.names.iter().take(ALIKE).map(String::as_str)).collect()
}

/// How many motors are not listed, and how well they are known.
fn left_out(motors: &[&Member]) -> Markup {
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
fn motor(member: &Member, shown: &[(Parameter, Shown)]) -> Markup {
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
                    @for ((parameter, shown), estimate) in shown.iter().zip(&row.estimates) { (cell(*parameter, shown, estimate)) }
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

fn cell(parameter: Parameter, shown: &Shown, estimate: &FleetEstimate) -> Markup {
    html! {
        td {
            // Where the table is no table, on narrow screens.
            span.key { (symbol(parameter)) " " }
            @match (estimate.value, estimate.verdict) {
                (Some(value), Verdict::Identified) => (shown.measured(value)),
                (Some(value), verdict) => { (shown.measured(value)) " " (badge(verdict)) }
                (None, verdict) => (badge(verdict)),
            }
        }
    }
}
