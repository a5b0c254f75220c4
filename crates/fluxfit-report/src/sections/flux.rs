//! Flux linkage and inductances of a motor with saturation.

use crate::{
    table::{self, key, named},
    typography::{DASH, decimals, number, prose, unit},
};
use fluxfit::{
    Judgement,
    evidence::{Apparent, Flux, Identification, Incremental, SaturationFinding},
    motor::Parameter,
};
use fluxfit_units::{Scale, significant};
use maud::{Markup, html};

/// The prefix of an inductance.
fn scale(henries: f64) -> Scale {
    Scale::for_value(Parameter::Lq, henries)
}

/// The unit of an inductance.
fn henry(scale: &Scale) -> String {
    unit(Parameter::Lq, scale)
}

fn amperes(current: f64) -> String {
    number(current, |current| significant(current, 3))
}

/// The row of the answer that takes the place of a constant L_q: the apparent one at the smallest and the largest current.
pub(crate) fn apparent_row(found: &SaturationFinding) -> Markup {
    let ends = found.lq.filter(|[least, most]| least.current != most.current);
    html! {
        @if let Some([least, most]) = &ends {
            tr.flux {
                th scope="row" { (prose("L_q")) "(" (prose("i_q")) ")" }
                td colspan="4" { (apparent(least)) ", " (apparent(most)) }
                td { span.badge { "apparent" } }
            }
        }
        @for one in found.incremental() {
            tr.flux {
                th scope="row" { "d" (prose(["psi_d", "psi_q"][one.axis])) " / d" (prose(["i_d", "i_q"][one.axis])) }
                td colspan="4" { (incremental(&one)) }
                td { span.badge { "incremental" } }
            }
        }
    }
}

/// The same as a sentence; nothing if there is no such row.
pub(crate) fn saturated(found: &SaturationFinding) -> Markup {
    html! {
        @if let Some([least, most]) = found.lq.as_ref().filter(|[least, most]| least.current != most.current) {
            " The motor saturates: apparent " (prose("L_q")) " is " (apparent(least)) " and " (apparent(most)) "."
        }
    }
}

fn apparent(one: &Apparent) -> Markup {
    let scale = scale(one.inductance);
    // Three digits.
    let value = number(one.inductance, |henries| scale.format(henries, 0.1 * henries.abs()));
    html! { strong { (value) } " " (henry(&scale)) " at " (prose("i_q")) " = " (amperes(one.current)) " A" }
}

fn incremental(one: &Incremental) -> Markup {
    let (scale, half_width) = (scale(one.inductance), 2.0 * one.uncertainty);
    let show = |henries: f64| number(henries, |henries| scale.format(henries, half_width));
    html! {
        strong { (show(one.inductance)) } " ± " (show(half_width)) " " (henry(&scale)) " (95 %) at " (prose("i_d")) " = " (amperes(one.current.d))
        " A, " (prose("i_q")) " = " (amperes(one.current.q)) " A, between operating points " (one.points[0] + 1) " and " (one.points[1] + 1)
    }
}

/// What the apparent inductance is, and what it is not good for.
pub(crate) fn inductances(answer: &Identification, found: &SaturationFinding) -> Markup {
    let has_q = found.incremental().iter().any(|one| one.axis == 1);
    html! {
        (beside_apparent(answer.parameter(Parameter::Lq), found))
        p {
            "The motor saturates, so no single number is its inductance. The apparent " (prose("L_q")) "(" (prose("i_q")) ") = " (prose("psi_q")) " / " (prose("i_q"))
            " says how much flux a current makes. A current controller needs the incremental d" (prose("psi_q")) " / d" (prose("i_q"))
            ", the slope of that curve, which is smaller. "
            @if !has_q {
                "This log does not tell it: no two operating points lie close enough, with the same " (prose("i_d")) " and slightly different "
                (prose("i_q")) "."
            }
        }
    }
}

/// Why the one L_q of the answer is another number than the apparent ones; nothing without both.
fn beside_apparent(lq: &Judgement, found: &SaturationFinding) -> Markup {
    let of_points = found.fluxes.iter().flatten().filter_map(|flux| flux.apparent_lq);
    let apparent = of_points.chain(found.lq.iter().flatten().map(|one| one.inductance));
    let [least, most] = apparent.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], lq| [least.min(lq), most.max(lq)]);
    let (Some(value), Some([low, high])) = (lq.value().filter(|_| least <= most), lq.interval()) else { return html! {} };
    let scale = scale(value);
    let show = |henries: f64| number(henries, |henries| scale.format(henries, 0.1 * value.abs()));
    html! {
        p {
            "The " (prose("L_q")) " of the table, " (show(value)) " " (henry(&scale)) ", is "
            @if is_of_small_currents(lq, found) { "that at small currents; what iron takes away at larger ones is fitted beside it" }
            @else { "the one number that fits all operating points best" }
            ". The apparent " (prose("L_q")) " at the currents of this log is " (show(least)) " … " (show(most)) " " (henry(&scale)) ". "
            @if low <= least && most <= high { "The 95 % interval holds all of these." }
            @else { strong { "The 95 % interval does not hold all of these" } ": take the apparent " (prose("L_q")) " at your current." }
        }
    }
}

/// Whether a parameter of the answer is that at small currents, beside terms of saturation, and not one number for all currents.
pub(super) fn is_of_small_currents(judgement: &Judgement, found: &SaturationFinding) -> bool {
    matches!(judgement.parameter, Parameter::Ld | Parameter::Lq) && judgement.raw == found.small_currents.get(judgement.parameter)
}

/// The table, with an explanation.
pub(crate) fn table(found: &SaturationFinding) -> Markup {
    let fluxes = || found.fluxes.iter().flatten();
    let least = |error: fn(&Flux) -> f64| 1e3 * fluxes().map(error).fold(f64::INFINITY, f64::min);
    let digits = [decimals(least(|flux| flux.uncertainty.d), 1), decimals(least(|flux| flux.uncertainty.q), 1)];
    let inductances = fluxes().flat_map(|flux| [flux.apparent_ld, flux.apparent_lq]).flatten();
    let scale = scale(inductances.map(f64::abs).fold(0.0, f64::max));
    let unit = format!(" {}", henry(&scale));
    let has_ld = fluxes().any(|flux| flux.apparent_ld.is_some());
    html! {
        h3 { "Flux linkage" }
        p {
            "The motor saturates: its inductances depend on the current. The flux linkages below follow from the voltage of each operating point "
            "with "
            (prose("R_s")) " = " (resistance(found)) "; ± is 95 % (two standard uncertainties)."
        }
        (table::scrolling("Flux at the operating points", &html! {
            table.stacked {
                thead { tr {
                    th scope="col" { "Point" }
                    th scope="col" { (prose("i_d")) ", A" } th scope="col" { (prose("i_q")) ", A" }
                    th scope="col" { (prose("psi_d")) " ± 95 %, mWb" } th scope="col" { (prose("psi_q")) " ± 95 %, mWb" }
                    @if has_ld { th scope="col" { "apparent " (prose("L_d")) ", " (henry(&scale)) } }
                    th scope="col" { "apparent " (prose("L_q")) ", " (henry(&scale)) }
                } }
                tbody {
                    @for (k, flux) in found.fluxes.iter().enumerate() {
                        @if let Some(flux) = flux {
                            tr {
                                th scope="row" { (key("Point ")) (k + 1) }
                                (row(flux, digits))
                                @if has_ld { td { (key("apparent ")) (named("L_d")) (quotient(flux.apparent_ld, &scale)) (key(&unit)) } }
                                td { (key("apparent ")) (named("L_q")) (quotient(flux.apparent_lq, &scale)) (key(&unit)) }
                            }
                        }
                    }
                }
            }
        }))
    }
}

/// The resistance, rounded to its uncertainty.
fn resistance(found: &SaturationFinding) -> Markup {
    let (scale, half_width) = (Scale::for_value(Parameter::Rs, found.rs), 2.0 * found.rs_uncertainty);
    let show = |ohms: f64| number(ohms, |ohms| scale.format(ohms, half_width));
    html! {
        (show(found.rs)) @if half_width > 0.0 && half_width.is_finite() { " ± " (show(half_width)) } " " (unit(Parameter::Rs, &scale))
    }
}

/// Currents and fluxes of a point.
fn row(flux: &Flux, digits: [usize; 2]) -> Markup {
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    html! {
        td { (named("i_d")) (fixed(flux.current.d, 3)) (key(" A")) } td { (named("i_q")) (fixed(flux.current.q, 3)) (key(" A")) }
        td { (named("psi_d")) (fixed(1e3 * flux.psi.d, digits[0])) " ± " (fixed(2e3 * flux.uncertainty.d, digits[0])) (key(" mWb")) }
        td { (named("psi_q")) (fixed(1e3 * flux.psi.q, digits[1])) " ± " (fixed(2e3 * flux.uncertainty.q, digits[1])) (key(" mWb")) }
    }
}

/// An apparent inductance in four digits, as the terminal prints it.
fn quotient(henries: Option<f64>, scale: &Scale) -> String {
    henries.map_or_else(|| DASH.to_owned(), |henries| number(henries, |henries| scale.format(henries, 0.0)))
}
