//! How the errors of the parameters hang together: their correlation, and the joint region of the two that flux and resistance share.

use crate::{
    answer::is_given,
    figure::ellipse::{self, Pair},
    frame,
    typography::{list, minus, number, prose, symbol},
};
use fluxfit::{Judgement, evidence::Identification, motor::Parameter};
use maud::{Markup, html};

/// Correlations from which on two parameters are hard to tell apart.
const STRONG: f64 = 0.9;

/// Shades of the table.
const SHADES: f64 = 5.0;

/// The section; none where fewer than two parameters have an error.
pub(crate) fn section(found: &Identification) -> Option<Markup> {
    let shown: Vec<&Judgement> = found.parameters.iter().filter(|judgement| has_error(judgement)).collect();
    (shown.len() > 1).then(|| {
        html! {
            p {
                "An error of one parameter brings an error of another with it. Near ±1 the log hardly tells the two apart, and knowing one of "
                "them (" code { "--prior" } ") sharpens the other. " (strongest(found, &shown))
            }
            (matrix(found, &shown))
            (joint(found))
        }
    })
}

fn has_error(judgement: &Judgement) -> bool {
    judgement.value().is_some() && !is_given(judgement)
}

fn of(found: &Identification, one: &Judgement, other: &Judgement) -> f64 {
    found.correlation[one.parameter as usize][other.parameter as usize]
}

fn strongest(found: &Identification, shown: &[&Judgement]) -> Markup {
    let pairs = shown.iter().enumerate().flat_map(|(k, one)| shown[..k].iter().map(move |other| (*other, *one)));
    let most = pairs.max_by(|(a, b), (c, d)| of(found, a, b).abs().total_cmp(&of(found, c, d).abs()));
    html! {
        @if let Some((one, other)) = most {
            @let correlation = of(found, one, other);
            "Here it is strongest between " (list(&[symbol(one.parameter), symbol(other.parameter)])) ", " (digits(correlation))
            @if correlation.abs() < STRONG { ": all can be told apart." } @else { "." }
        }
    }
}

fn digits(correlation: f64) -> String {
    number(correlation, |value| format!("{value:.2}"))
}

fn matrix(found: &Identification, shown: &[&Judgement]) -> Markup {
    html! {
        (frame::scrolling("Correlation of the parameters’ errors", &html! {
            table.heat {
                thead { tr { th scope="col" { "Correlation" } @for judgement in shown { th scope="col" { (symbol(judgement.parameter)) } } } }
                tbody { @for one in shown { tr {
                    th scope="row" { (symbol(one.parameter)) }
                    @for other in shown {
                        @let correlation = of(found, one, other);
                        @if one.parameter == other.parameter { td.own { "1" } }
                        @else { td class={ "heat-" (shade(correlation)) } { (digits(correlation)) } }
                    }
                } } }
            }
        }))
    }
}

/// From 0 to 4, the stronger the darker.
fn shade(correlation: f64) -> u8 {
    (correlation.abs() * SHADES).clamp(0.0, SHADES - 1.0) as u8
}

/// The two whose joint region is drawn; none where the section is not there, or one of them has no error.
pub(crate) fn pair(found: &Identification) -> Option<Pair<'_>> {
    let [x, y] = [Parameter::Rs, Parameter::PsiF].map(|parameter| found.parameter(parameter));
    (has_error(x) && has_error(y)).then(|| Pair { x, y, correlation: of(found, x, y) })
}

/// The ellipse, or why there is none.
fn joint(found: &Identification) -> Markup {
    let [x, y] = [Parameter::Rs, Parameter::PsiF].map(|parameter| found.parameter(parameter));
    let missing: Vec<Markup> =
        [x, y].into_iter().filter(|judgement| judgement.value().is_none()).map(|one| symbol(one.parameter)).collect();
    let given = [x, y].into_iter().find(|judgement| is_given(judgement));
    html! {
        h3 { (symbol(Parameter::Rs)) " with " (symbol(Parameter::PsiF)) }
        @if !missing.is_empty() {
            p { "There is no joint region: " (list(&missing)) " cannot be identified from this log." }
        } @else if let Some(given) = given {
            p { "There is no joint region: " (symbol(given.parameter)) " was given." }
        } @else if let Some(pair) = pair(found) {
            (frame::figure(|size| ellipse::draw(&pair, size), &html! {
                "The joint 95 % region about the value (dot), in percent of it, from the standard errors and their correlation, "
                (minus(format!("{:.2}", pair.correlation))) " (of noise, accuracy and priors alone). The box is made of the two single 95 % intervals. Where the ellipse is narrow and "
                "slanted, a pair in a corner of the box is not believable, though each of its two numbers alone is. " (prose("R_s and psi_f"))
                " share the voltage along q: points at different speeds part them."
            }))
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
