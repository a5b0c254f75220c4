//! The log: its size and rate, the rows that were used, the search box, and notes.

use crate::{
    report::Report,
    section::Section,
    table,
    typography::{decimals_of_span, grouped, minus, number, symbol, unit},
};
use fluxfit::{evidence::OutputFit, log::Log, motor::Parameter, steady::OperatingPoint};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let log = report.log;
    let of_search = report.identification.and_then(|(found, _)| found.search.as_ref()).map(|search| &search.bounds);
    let bounds = of_search.or(report.study.map(|(facts, _)| &facts.bounds));
    let content = html! {
        dl.facts {
            dt { "Rows" } dd { (grouped(log.rows() as u64)) (used(report)) }
            (facts(log))
            @if let Some(bounds) = bounds {
                dt { "Search box" }
                dd { @for (k, (parameter, ends)) in Parameter::ALL.into_iter().zip(bounds.iter()).enumerate() {
                    @if k > 0 { "; " } (bounds_of(parameter, ends))
                } }
            }
        }
        @if !report.notes.is_empty() { ul { @for note in report.notes { li { (note) } } } }
        @if let Some(fit) = output(report) { (stretches(report, fit)) }
        @if !report.operating_points.is_empty() { (windows(report.operating_points)) }
    };
    Some(Section { anchor: "log", heading: "Rows, columns and windows", content })
}

/// Rate, duration and segments.
pub(crate) fn facts(log: &Log) -> Markup {
    html! {
        dt { "Sample rate" } dd { (rate(log)) }
        dt { "Duration" } dd { (number(log.duration(), |seconds| significant(seconds, 3))) " s" }
        dt { "Segments between gaps" } dd { (log.segments().len()) }
    }
}

fn output<'a>(report: &Report<'a>) -> Option<&'a OutputFit> {
    report.identification.and_then(|(found, _)| found.output.as_ref())
}

/// How many rows were used, and for what.
fn used(report: &Report) -> Markup {
    let in_windows: usize = report.operating_points.iter().map(|point| point.rows.len()).sum();
    let in_windows = grouped(in_windows as u64);
    html! {
        @if let Some(fit) = output(report) {
            ", of which " (grouped((fit.residuals.len() / 2) as u64)) " were simulated"
            @if report.operating_points.is_empty() { "; the log has no operating point for a check" }
            @else { "; " (in_windows) " are in operating points, which are only a check" }
        } @else if !report.operating_points.is_empty() { ", of which " (in_windows) " in the windows below" }
    }
}

/// Largest number of stretches in the table.
const LISTED: usize = 20;

/// The stretches over which currents were simulated; nothing for a single one.
fn stretches(report: &Report, fit: &OutputFit) -> Markup {
    let t = &report.log.columns().t;
    let stretches = fit.stretches.len();
    html! {
        @if stretches > 1 {
            h3 { "Simulated stretches" }
            (table::scrolling("Simulated stretches", &html! {
                table {
                    thead { tr { th scope="col" { "Stretch" } th scope="col" { "From, s" } th scope="col" { "To, s" } th scope="col" { "Rows" } } }
                    tbody { @for (k, rows) in fit.stretches.iter().enumerate().take(LISTED) {
                        (span(k + 1, (t[rows.start], t[rows.end - 1]), rows.len()))
                    } }
                }
            }))
            @if stretches > LISTED { p.small { "And " (stretches - LISTED) " more." } }
        }
    }
}

/// A row of a table of times.
fn span(number_of: usize, (start, end): (f64, f64), rows: usize) -> Markup {
    let decimals = decimals_of_span(end - start);
    html! {
        tr {
            th scope="row" { (number_of) }
            td { (number(start, |t| format!("{t:.decimals$}"))) }
            td { (number(end, |t| format!("{t:.decimals$}"))) }
            td { (grouped(rows as u64)) }
        }
    }
}

/// The bounds of one parameter.
fn bounds_of(parameter: Parameter, (lower, upper): (f64, f64)) -> Markup {
    let scale = Scale::for_value(parameter, lower.abs().max(upper.abs()));
    let short = |value: f64| if value == 0.0 { "0".to_owned() } else { minus(scale.format(value, value.abs() * 0.05)) };
    html! { (symbol(parameter)) " " (short(lower)) " … " (short(upper)) " " (unit(parameter, &scale)) }
}

/// The sample rate, if it is the same in all segments.
fn rate(log: &Log) -> String {
    let periods = || log.segments().iter().map(|segment| segment.sample_period);
    let Some(period) = periods().next() else { return "unknown".to_owned() };
    if periods().any(|other| (other / period - 1.0).abs() > 0.01) {
        return "mixed".to_owned();
    }
    let hertz = 1.0 / period;
    if hertz >= 1e3 { format!("{} kHz", significant(hertz / 1e3, 3)) } else { format!("{} Hz", significant(hertz, 3)) }
}

fn windows(points: &[OperatingPoint]) -> Markup {
    html! {
        h3 { "Windows of the operating points" }
        div.slim { (table::scrolling("Windows of the operating points", &html! {
            table {
                thead { tr { th scope="col" { "Point" } th scope="col" { "From, s" } th scope="col" { "To, s" } th scope="col" { "Rows" } } }
                tbody { @for (k, point) in points.iter().enumerate() { (span(k + 1, point.time, point.rows.len())) } }
            }
        })) }
    }
}
