//! Where the page comes from: what was read, and the command that makes it again.

use crate::{
    Origin, Report, frame,
    typography::{grouped, minus, number, prose, symbol, unit},
};
use fluxfit::{log::Log, motor::Parameter, steady::OperatingPoint};
use fluxfit_files::number::{Scale, significant};
use maud::{Markup, html};

/// What was read.
pub(crate) fn read(report: &Report) -> Markup {
    let log = report.log;
    let used: usize = report.operating_points.iter().map(|point| point.rows.len()).sum();
    let of_search = report.identification.and_then(|(found, _)| found.search.as_ref()).map(|search| &search.bounds);
    let bounds = of_search.or(report.study.map(|(facts, _)| facts.bounds));
    html! {
        dl.facts {
            dt { "Rows" } dd { (grouped(log.rows() as u64)) ", of which " (grouped(used as u64)) " in the windows below" }
            dt { "Rate" } dd { (rate(report.log)) }
            dt { "Duration" } dd { (number(log.duration(), |seconds| significant(seconds, 3))) " s" }
            dt { "Segments between gaps" } dd { (log.segments().len()) }
            @if let Some(bounds) = bounds {
                dt { "Search box" }
                dd { @for (k, (parameter, ends)) in Parameter::ALL.into_iter().zip(bounds.iter()).enumerate() {
                    @if k > 0 { "; " } (side(parameter, ends))
                } }
            }
        }
        @if !report.notes.is_empty() { ul { @for note in report.notes { li { (prose(note)) } } } }
        (windows(report.operating_points))
    }
}

/// One side of a search box.
fn side(parameter: Parameter, (lower, upper): (f64, f64)) -> Markup {
    let scale = Scale::for_value(parameter, lower.abs().max(upper.abs()));
    let short = |value: f64| if value == 0.0 { "0".to_owned() } else { minus(scale.format(value, value.abs() * 0.05)) };
    html! { (symbol(parameter)) " " (short(lower)) " … " (short(upper)) " " (unit(parameter, &scale)) }
}

pub(crate) fn rate(log: &Log) -> String {
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
        (frame::scrolling("Windows used", &html! {
            table {
                thead { tr { th scope="col" { "Point" } th scope="col" { "From, s" } th scope="col" { "To, s" } th scope="col" { "Rows" } } }
                tbody { @for (k, point) in points.iter().enumerate() {
                    @let (start, end) = point.time;
                    // Digits that tell the window's length to a hundredth of it.
                    @let decimals = (2.0 - (end - start).log10().floor()).clamp(0.0, 9.0) as usize;
                    tr {
                        th scope="row" { (k + 1) }
                        td { (number(start, |t| format!("{t:.decimals$}"))) }
                        td { (number(end, |t| format!("{t:.decimals$}"))) }
                        td { (grouped(point.rows.len() as u64)) }
                    }
                } }
            }
        }))
    }
}

/// The command and what else decides the result.
pub(crate) fn reproduce(origin: &Origin) -> Markup {
    html! {
        // Lines break between words, not behind the hyphens of an option.
        pre { code { @for (k, word) in origin.command.split(' ').enumerate() { @if k > 0 { " " } span { (word) } } } }
        p { "With fluxfit " (origin.version) " and seed " (origin.seed) ", the same log gives the same numbers to the bit, on any number of cores." }
    }
}
