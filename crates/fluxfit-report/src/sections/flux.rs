//! Flux linkage and inductances of a motor with saturation.

use crate::{
    table::{self, key, named},
    typography::{DASH, NO_BREAK, decimals, number, prose, unit},
};
use fluxfit::{
    evidence::{Apparent, Flux, Identification, Incremental, SaturationFinding},
    motor::Parameter,
    steady::OperatingPoint,
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
                td colspan="4" { (apparent(least, found)) ", " (apparent(most, found)) }
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

fn apparent(one: &Apparent, found: &SaturationFinding) -> Markup {
    let scale = scale(one.inductance);
    let half_width = found.half_width_of(one);
    // Three digits, where no operating point tells how sure it is.
    let show = |henries: f64| number(henries, |henries| scale.format(henries, half_width.unwrap_or(0.1 * one.inductance.abs())));
    html! {
        strong { (show(one.inductance)) } @if let Some(half_width) = half_width { (plus_minus(&show(half_width))) } (NO_BREAK) (henry(&scale))
        " at " (equals("i_q", one.current))
    }
}

/// Half of the 95 % interval of a point's apparent L_q, H.
fn half_width_of_lq(flux: &Flux) -> f64 {
    2.0 * (flux.uncertainty.q / flux.current.q).abs()
}

/// The same of its apparent L_d.
fn half_width_of_ld(flux: &Flux) -> f64 {
    2.0 * (flux.uncertainty.d / flux.current.d).abs()
}

/// A half-width, on the line of its value.
fn plus_minus(half_width: &str) -> String {
    format!("{NO_BREAK}±{NO_BREAK}{half_width}")
}

/// A current with its symbol, on one line.
fn equals(symbol: &str, current: f64) -> Markup {
    html! { (prose(symbol)) (NO_BREAK) "=" (NO_BREAK) (amperes(current)) (NO_BREAK) "A" }
}

fn incremental(one: &Incremental) -> Markup {
    let (scale, half_width) = (scale(one.inductance), 2.0 * one.uncertainty);
    let show = |henries: f64| number(henries, |henries| scale.format(henries, half_width));
    html! {
        strong { (show(one.inductance)) } (plus_minus(&show(half_width))) (NO_BREAK) (henry(&scale)) " (95\u{a0}%) at "
        (equals("i_d", one.current.d)) ", " (equals("i_q", one.current.q))
    }
}

/// What the apparent inductance is, and what it is not good for.
pub(crate) fn inductances(answer: &Identification, found: &SaturationFinding) -> Markup {
    let has_q = found.incremental().iter().any(|one| one.axis == 1);
    html! {
        (beside_apparent(answer, found))
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
fn beside_apparent(answer: &Identification, found: &SaturationFinding) -> Markup {
    let lq = answer.parameter(Parameter::Lq);
    let of_points = found.fluxes.iter().flatten().filter_map(|flux| flux.apparent_lq);
    let apparent = of_points.chain(found.lq.iter().flatten().map(|one| one.inductance));
    let [least, most] = apparent.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], lq| [least.min(lq), most.max(lq)]);
    let (Some(value), Some([low, high])) = (lq.value().filter(|_| least <= most), lq.interval()) else { return html! {} };
    let scale = scale(value);
    let show = |henries: f64| number(henries, |henries| scale.format(henries, 0.1 * value.abs()));
    html! {
        p {
            "The " (prose("L_q")) " of the table, " (show(value)) " " (henry(&scale)) ", is "
            @if answer.valid_at(Parameter::Lq).is_some() { "that at small currents; by how much it falls at larger currents is fitted too (saturation)" }
            @else { "the one number that fits all operating points best" }
            ". The apparent " (prose("L_q")) " at the currents of this log is " (show(least)) " … " (show(most)) " " (henry(&scale)) ". "
            @if low <= least && most <= high { "The 95\u{a0}% interval holds all of these." }
            @else { strong { "The 95\u{a0}% interval does not hold all of these" } ": take the apparent " (prose("L_q")) " at your current." }
        }
    }
}

/// Where the table stands on the page.
pub(crate) const TABLE: &str = "fluxes";

/// The table, with an explanation; with the speed of each point, as a current may be held at several.
pub(crate) fn table(found: &SaturationFinding, points: &[OperatingPoint]) -> Markup {
    if fluxes_of(found).next().is_none() {
        return html! {};
    }
    let speed = |k: usize| points.get(k).filter(|_| points.len() == found.fluxes.len()).map(OperatingPoint::omega_e);
    let has_speed = speed(0).is_some();
    let fluxes = || fluxes_of(found);
    let least = |error: fn(&Flux) -> f64| 1e3 * fluxes().map(error).fold(f64::INFINITY, f64::min);
    let digits = [decimals(least(|flux| flux.uncertainty.d), 1), decimals(least(|flux| flux.uncertainty.q), 1)];
    let inductances = fluxes().flat_map(|flux| [flux.apparent_ld, flux.apparent_lq]).flatten();
    let scale = scale(inductances.map(f64::abs).fold(0.0, f64::max));
    let unit = format!(" {}", henry(&scale));
    // The same decimals down a column: those of its smallest half-width.
    let of_ld = fluxes().filter(|flux| flux.apparent_ld.is_some()).map(half_width_of_ld).fold(f64::INFINITY, f64::min);
    let of_lq = fluxes().filter(|flux| flux.apparent_lq.is_some()).map(half_width_of_lq).fold(f64::INFINITY, f64::min);
    let has_ld = fluxes().any(|flux| flux.apparent_ld.is_some());
    html! {
        h3 id=(TABLE) { "Fluxes at the currents of the log" }
        p {
            "The motor saturates: its inductances depend on the current. The flux linkages of this table follow from the voltage of each operating point "
            "with "
            (prose("R_s")) " = " (resistance(found)) "; ± is 95\u{a0}% (two standard uncertainties)."
        }
        (table::scrolling("Flux at the operating points", &html! {
            table.stacked {
                thead { tr {
                    th scope="col" { "Point" }
                    th scope="col" { (prose("i_d")) ", A" } th scope="col" { (prose("i_q")) ", A" }
                    @if has_speed { th scope="col" { (prose("omega_e")) ", rad/s" } }
                    th scope="col" { (prose("psi_d")) " ±\u{a0}95\u{a0}%, mWb" } th scope="col" { (prose("psi_q")) " ±\u{a0}95\u{a0}%, mWb" }
                    @if has_ld { th scope="col" { "apparent " (prose("L_d")) " ±\u{a0}95\u{a0}%, " (henry(&scale)) } }
                    th scope="col" { "apparent " (prose("L_q")) " ±\u{a0}95\u{a0}%, " (henry(&scale)) }
                } }
                tbody {
                    @for (k, flux) in found.fluxes.iter().enumerate() {
                        @if let Some(flux) = flux {
                            tr {
                                th scope="row" { (key("Point ")) (k + 1) }
                                (row(flux, speed(k), digits))
                                @if has_ld { td { (key("apparent ")) (named("L_d")) (quotient(flux.apparent_ld, (half_width_of_ld(flux), of_ld), &scale)) (key(&unit)) } }
                                td { (key("apparent ")) (named("L_q")) (quotient(flux.apparent_lq, (half_width_of_lq(flux), of_lq), &scale)) (key(&unit)) }
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

/// The fluxes of the points that have one.
fn fluxes_of(found: &SaturationFinding) -> impl Iterator<Item = &Flux> {
    found.fluxes.iter().flatten()
}

/// Currents, speed and fluxes of a point.
fn row(flux: &Flux, omega_e: Option<f64>, digits: [usize; 2]) -> Markup {
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    html! {
        td { (named("i_d")) (fixed(flux.current.d, 3)) (key(" A")) } td { (named("i_q")) (fixed(flux.current.q, 3)) (key(" A")) }
        @if let Some(omega_e) = omega_e { td { (named("omega_e")) (fixed(omega_e, 1)) (key(" rad/s")) } }
        td { (named("psi_d")) (fixed(1e3 * flux.psi.d, digits[0])) " ± " (fixed(2e3 * flux.uncertainty.d, digits[0])) (key(" mWb")) }
        td { (named("psi_q")) (fixed(1e3 * flux.psi.q, digits[1])) " ± " (fixed(2e3 * flux.uncertainty.q, digits[1])) (key(" mWb")) }
    }
}

/// An apparent inductance with half of its 95 % interval, rounded to the least of its column.
fn quotient(henries: Option<f64>, (half_width, least): (f64, f64), scale: &Scale) -> String {
    let show = |henries: f64| number(henries, |henries| scale.format(henries, least));
    henries.map_or_else(|| DASH.to_owned(), |henries| show(henries) + &plus_minus(&show(half_width)))
}
