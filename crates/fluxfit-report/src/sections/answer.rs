//! The result: the parameters with their intervals and verdicts, what no interval counts, and of a motor that saturates its flux.

use super::flux;
use crate::{
    judgement::{is_given, is_weak_though_narrow, relative_half_width},
    report::Report,
    section::Section,
    table,
    typography::{DASH, list, number, prose, symbol, unit},
};
use fluxfit::{
    Judgement, Verdict,
    evidence::{IDENTIFIED, Identification, WEAK},
    motor::Parameter,
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let content = html! {
        (parameters(found))
        p.small { (thresholds()) (in_spite_of_width(found)) }
        @if let Some(saturation) = &found.saturation {
            (flux::inductances(found, saturation))
            (flux::table(saturation, found.operating_points()))
        }
    };
    Some(Section { anchor: "answer", heading: "Parameters", content })
}

/// A verdict on its background colour.
pub(super) fn badge(verdict: Verdict) -> Markup {
    html! { span class={ "badge " (verdict.key()) } { (verdict.key().replace('-', " ")) } }
}

/// What the verdicts mean.
pub(super) fn thresholds() -> Markup {
    html! {
        "Half-width of the 95\u{a0}% interval: " (badge(Verdict::Identified)) " at most " (percent(IDENTIFIED)) " of the value; "
        (badge(Verdict::Weak)) " at most " (percent(WEAK)) "; "
        (badge(Verdict::NotIdentifiable)) " more, or the value is not positive: no value is shown."
    }
}

/// Which parameters are weak although their intervals are narrow.
fn in_spite_of_width(found: &Identification) -> Markup {
    let narrow: Vec<Markup> = found.parameters.iter().filter(|one| is_weak_though_narrow(one)).map(|one| symbol(one.parameter)).collect();
    html! { @if !narrow.is_empty() { " " (list(&narrow)) ": weak although narrower, for the reason below." } }
}

fn percent(fraction: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * fraction)
}

fn parameters(found: &Identification) -> Markup {
    html! {
        (table::scrolling("Parameters", &html! {
            table.parameters {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Value" } th scope="col" { "±\u{a0}95\u{a0}%" }
                    th scope="col" { "95\u{a0}% interval" } th.words scope="col" { "Main source of uncertainty" } th scope="col" { "Verdict" }
                } }
                tbody {
                    @for judgement in &found.parameters {
                        (parameter(judgement, found))
                        @if judgement.parameter == Parameter::Lq && let Some(saturation) = &found.saturation { (flux::apparent_row(saturation)) }
                    }
                    (not_counted(found))
                }
            }
        }))
    }
}

fn parameter(judgement: &Judgement, found: &Identification) -> Markup {
    let heading = html! { th scope="row" { (symbol(judgement.parameter)) } };
    let (Some(value), Some([low, high])) = (judgement.value(), judgement.interval()) else {
        return html! {
            tr {
                (heading) td.value { (DASH) } @for _ in 0..2 { td.none { (DASH) } } td.words.none { (DASH) }
                td { (badge(judgement.verdict)) }
            }
        };
    };
    let (scale, error) = (Scale::for_value(judgement.parameter, value), judgement.uncertainty.standard_error());
    let show = |value: f64| number(value, |value| scale.format(value, error));
    let unit = unit(judgement.parameter, &scale);
    let width = relative_half_width(judgement);
    html! {
        tr {
            (heading)
            td.value {
                strong { (show(value)) } " " (unit)
                @if let Some(when) = found.valid_at(judgement.parameter) { span.at { " " (when) } }
            }
            @if let Some(width) = width {
                td { "±" (significant(100.0 * width, 2)) " %" }
                td { (show(low)) " … " (show(high)) " " (unit) }
                td.words { (judgement.uncertainty.largest_part().label()) }
            } @else {
                // Given, not identified, as the reason says.
                @for _ in 0..2 { td.none { (DASH) } }
                td.words.none { (DASH) }
            }
            td { @if is_given(judgement) { span.badge { "given" } } @else if judgement.is_as_prior() { span.badge { "as its prior" } } @else { (badge(judgement.verdict)) } }
        }
    }
}

/// What no log shows: what the intervals count of it as stated, and what they do not.
fn not_counted(found: &Identification) -> Markup {
    let counted: Vec<String> = found.counted.iter().map(ToString::to_string).collect();
    let unseen: Vec<String> = found.unseen_in_values().iter().map(ToString::to_string).collect();
    let rows = [("In the intervals", "As stated:", counted), ("Not in the intervals", "No log shows these errors:", unseen)];
    html! {
        @for (what, why, errors) in rows.iter().filter(|(.., errors)| !errors.is_empty()) {
            tr.note {
                th scope="row" { (what) }
                td colspan="5" {
                    (why)
                    @for error in errors { br; (prose(error)) }
                }
            }
        }
    }
}
