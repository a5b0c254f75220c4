//! Flux linkage at the operating points of a motor with saturation.

use crate::{
    table,
    typography::{DASH, decimals, number, prose},
};
use fluxfit::evidence::{Flux, SaturationFinding};
use fluxfit_units::significant;
use maud::{Markup, html};

/// The table, with an explanation.
pub(crate) fn table(found: &SaturationFinding) -> Markup {
    let least = |error: fn(&Flux) -> f64| 1e3 * found.fluxes.iter().flatten().map(error).fold(f64::INFINITY, f64::min);
    let digits = [decimals(least(|flux| flux.uncertainty.d), 1), decimals(least(|flux| flux.uncertainty.q), 1)];
    html! {
        h3 { "Flux linkage" }
        p {
            "The motor saturates: its inductances depend on the current. The flux linkages below follow from the voltage of each operating point "
            "with "
            (prose("R_s")) " = " (number(found.rs, |rs| significant(rs, 4)))
            @if found.rs_uncertainty > 0.0 { " ± " (number(2.0 * found.rs_uncertainty, |error| significant(error, 2))) }
            " ohm; ± is two standard uncertainties. Apparent inductances are flux linkage divided by current, and differ from the incremental ones."
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

fn row(k: usize, flux: &Flux, digits: [usize; 2]) -> Markup {
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    html! {
        tr {
            th scope="row" { (k) }
            td { (fixed(flux.current.d, 3)) } td { (fixed(flux.current.q, 3)) }
            td { (fixed(1e3 * flux.psi.d, digits[0])) " ± " (fixed(2e3 * flux.uncertainty.d, digits[0])) }
            td { (fixed(1e3 * flux.psi.q, digits[1])) " ± " (fixed(2e3 * flux.uncertainty.q, digits[1])) }
            @for apparent in [flux.apparent_ld, flux.apparent_lq] {
                td { @match apparent { Some(henries) => (number(1e3 * henries, |value| significant(value, 4))), None => (DASH) } }
            }
        }
    }
}
