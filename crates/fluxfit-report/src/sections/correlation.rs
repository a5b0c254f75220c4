//! Correlation of the parameters' errors.

use crate::{
    judgement::{correlation, has_error, most_correlated},
    report::Report,
    section::Section,
    table,
    typography::{list, number, symbol},
};
use fluxfit::{Judgement, evidence::Identification};
use maud::{Markup, html};

/// Correlations above this make two parameters hard to distinguish.
const STRONG: f64 = 0.9;

/// Number of background shades of the table.
const SHADES: f64 = 5.0;

/// The section; `None` if fewer than two parameters have an error.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let shown: Vec<&Judgement> = found.parameters.iter().filter(|judgement| has_error(judgement)).collect();
    (shown.len() > 1).then(|| {
        let content = html! {
            p {
                "The errors of the parameters are correlated. If a correlation is close to ±1, the log can hardly distinguish the two parameters, "
                "and prior knowledge of one of them narrows the interval of the other. " (strongest(found))
            }
            (matrix(found, &shown))
            (joint_region(found))
        };
        Section { anchor: "correlation", heading: "Correlation of the errors", content }
    })
}

fn strongest(found: &Identification) -> Markup {
    html! {
        @if let Some([one, other]) = most_correlated(found) {
            @let correlation = correlation(found, one, other);
            "The strongest correlation is that of " (list(&[symbol(one.parameter), symbol(other.parameter)])) ", " (digits(correlation))
            @if correlation.abs() < STRONG { ": all parameters can be distinguished." } @else { "." }
        }
    }
}

fn digits(correlation: f64) -> String {
    number(correlation, |value| format!("{value:.2}"))
}

fn matrix(found: &Identification, shown: &[&Judgement]) -> Markup {
    html! {
        (table::scrolling("Correlation of the parameters’ errors", &html! {
            table.heat {
                thead { tr { th scope="col" { "Correlation" } @for judgement in shown { th scope="col" { (symbol(judgement.parameter)) } } } }
                tbody { @for one in shown { tr {
                    th scope="row" { (symbol(one.parameter)) }
                    @for other in shown {
                        @let correlation = correlation(found, one, other);
                        @if one.parameter == other.parameter { td.own { "1" } }
                        @else { td class={ "heat-" (shade(correlation)) } { (digits(correlation)) } }
                    }
                } } }
            }
        }))
    }
}

/// Background shade, from 0 to 4; darker for stronger correlations.
fn shade(correlation: f64) -> u8 {
    (correlation.abs() * SHADES).clamp(0.0, SHADES - 1.0) as u8
}

/// The heading of the figure of the joint region.
fn joint_region(found: &Identification) -> Markup {
    html! {
        @if let Some(both) = most_correlated(found) {
            h3 { "Joint confidence region of " (list(&both.map(|judgement| symbol(judgement.parameter)))) }
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn shades_grow_with_the_correlation_of_either_sign() {
        assert_eq!([0.0, -0.19, 0.3, -0.55, 0.79, 0.95, -1.0, f64::NAN].map(super::shade), [0, 0, 1, 2, 3, 4, 4, 0]);
    }
}
