//! The result: the parameters with their intervals and verdicts, what no interval counts, and of a motor that saturates its flux.

use super::flux;
use crate::{
    judgement::{is_given, relative_half_width},
    report::Report,
    section::Section,
    table,
    typography::{DASH, number, prose, symbol, unit},
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
        p.small { (thresholds()) }
        @if let Some(saturation) = &found.saturation { (flux::inductances(saturation)) }
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
        "Half-width of the 95 % interval: " (badge(Verdict::Identified)) " at most " (percent(IDENTIFIED)) " of the value; "
        (badge(Verdict::Weak)) " at most " (percent(WEAK)) "; "
        (badge(Verdict::NotIdentifiable)) " more, or the value is not positive: no value is shown."
    }
}

fn percent(fraction: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * fraction)
}

fn parameters(found: &Identification) -> Markup {
    html! {
        (table::scrolling("Parameters", &html! {
            table.parameters {
                thead { tr {
                    th scope="col" { "Parameter" } th scope="col" { "Value" } th scope="col" { "± 95 %" }
                    th scope="col" { "95 % interval" } th.words scope="col" { "Main source of uncertainty" } th scope="col" { "Verdict" }
                } }
                tbody {
                    @for judgement in &found.parameters {
                        (parameter(judgement))
                        @if judgement.parameter == Parameter::Lq && let Some(saturation) = &found.saturation { (flux::apparent_row(saturation)) }
                    }
                    (not_counted(found))
                }
            }
        }))
    }
}

fn parameter(judgement: &Judgement) -> Markup {
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
            td.value { strong { (show(value)) } " " (unit) }
            @if let Some(width) = width {
                td { "±" (significant(100.0 * width, 2)) " %" }
                td { (show(low)) " … " (show(high)) " " (unit) }
                td.words { (judgement.uncertainty.largest_part().label()) }
            } @else {
                // Given, not identified, as the reason says.
                @for _ in 0..2 { td.none { (DASH) } }
                td.words.none { (DASH) }
            }
            td { @if is_given(judgement) { span.badge { "given" } } @else { (badge(judgement.verdict)) } }
        }
    }
}

/// What no log shows: what the intervals count of it as stated, and what they do not.
fn not_counted(found: &Identification) -> Markup {
    let counted: Vec<String> = found.counted.iter().map(ToString::to_string).collect();
    let unseen: Vec<String> = found.unseen_in_values().iter().map(ToString::to_string).collect();
    let rows =
        [("Counted", "In the intervals, as stated:", counted), ("Not counted", "Not in the intervals, because no log shows it:", unseen)];
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
