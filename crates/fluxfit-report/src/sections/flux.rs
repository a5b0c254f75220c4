//! Flux linkage and inductances of a motor with saturation.

use crate::{
    table,
    typography::{DASH, decimals, number, prose},
};
use fluxfit::evidence::{Apparent, Flux, Incremental, SaturationFinding};
use fluxfit_units::significant;
use maud::{Markup, html};

/// Millihenries in a henry.
const MILLI: f64 = 1e3;

/// An inductance, mH, with an uncertainty, or with three digits without one.
fn millihenries(henries: f64, uncertainty: Option<f64>) -> String {
    match uncertainty.filter(|uncertainty| *uncertainty > 0.0 && uncertainty.is_finite()) {
        Some(uncertainty) => {
            let digits = decimals(MILLI * uncertainty, 1);
            number(MILLI * henries, |value| format!("{value:.digits$}"))
        }
        None => number(MILLI * henries, |value| significant(value, 3)),
    }
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
    html! { strong { (millihenries(one.inductance, None)) } " mH at " (prose("i_q")) " = " (amperes(one.current)) " A" }
}

fn incremental(one: &Incremental) -> Markup {
    html! {
        strong { (millihenries(one.inductance, Some(2.0 * one.uncertainty))) }
        " ± " (number(2.0 * MILLI * one.uncertainty, |value| significant(value, 2))) " mH at " (prose("i_d")) " = " (amperes(one.current.d))
        " A, " (prose("i_q")) " = " (amperes(one.current.q)) " A, between operating points " (one.points[0] + 1) " and " (one.points[1] + 1)
    }
}

/// What the apparent inductance is, and what it is not good for.
pub(crate) fn inductances(found: &SaturationFinding) -> Markup {
    let has_q = found.incremental().iter().any(|one| one.axis == 1);
    html! {
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

/// The table, with an explanation.
pub(crate) fn table(found: &SaturationFinding) -> Markup {
    let least = |error: fn(&Flux) -> f64| 1e3 * found.fluxes.iter().flatten().map(error).fold(f64::INFINITY, f64::min);
    let digits = [decimals(least(|flux| flux.uncertainty.d), 1), decimals(least(|flux| flux.uncertainty.q), 1)];
    html! {
        h3 { "Flux linkage" }
        p {
            "The motor saturates: its inductances depend on the current. The flux linkages below follow from the voltage of each operating point "
            "with "
            (prose("R_s")) " = " (resistance(found)) " ohm; ± is two standard uncertainties."
        }
        (table::scrolling("Flux at the operating points", &html! {
            table {
                thead { tr {
                    th scope="col" { "Point" }
                    th scope="col" { (prose("i_d")) ", A" } th scope="col" { (prose("i_q")) ", A" }
                    th scope="col" { (prose("psi_d")) ", mWb" } th scope="col" { (prose("psi_q")) ", mWb" }
                    th scope="col" { "apparent " (prose("L_d")) ", mH" } th scope="col" { "apparent " (prose("L_q")) ", mH" }
                } }
                tbody {
                    @for (k, flux) in found.fluxes.iter().enumerate() { @if let Some(flux) = flux { (row(k + 1, flux, digits)) } }
                }
            }
        }))
    }
}

/// The resistance, rounded to its uncertainty.
fn resistance(found: &SaturationFinding) -> String {
    let half_width = 2.0 * found.rs_uncertainty;
    if half_width > 0.0 && half_width.is_finite() {
        let digits = decimals(half_width, 4);
        format!("{} ± {half_width:.digits$}", number(found.rs, |rs| format!("{rs:.digits$}")))
    } else {
        number(found.rs, |rs| significant(rs, 4))
    }
}

fn row(k: usize, flux: &Flux, digits: [usize; 2]) -> Markup {
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    html! {
        tr {
            th scope="row" { (k) }
            td { (fixed(flux.current.d, 3)) } td { (fixed(flux.current.q, 3)) }
            td { (fixed(1e3 * flux.psi.d, digits[0])) " ± " (fixed(2e3 * flux.uncertainty.d, digits[0])) }
            td { (fixed(1e3 * flux.psi.q, digits[1])) " ± " (fixed(2e3 * flux.uncertainty.q, digits[1])) }
            @let of_axes = [(flux.apparent_ld, flux.uncertainty.d / flux.current.d), (flux.apparent_lq, flux.uncertainty.q / flux.current.q)];
            @for (apparent, uncertainty) in of_axes {
                td { @match apparent { Some(henries) => (millihenries(henries, Some(2.0 * uncertainty.abs()))), None => (DASH) } }
            }
        }
    }
}
