//! Measured against fitted: what each operating point was, and what the motor found makes of it.

use crate::{
    figure::{plane, residuals},
    flux, frame,
    typography::{decimals, number, prose},
};
use fluxfit::{
    evidence::{Saturation, SteadyFit},
    steady::OperatingPoint,
};
use fluxfit_units::significant;
use maud::{Markup, html};

/// Digits of a voltage without uncertainty.
const DECIMALS: usize = 3;

/// The section; `answered` where the operating points are the answer, and not only held beside it.
pub(crate) fn section(found: &SteadyFit, saturation: Option<&Saturation>, answered: bool) -> Markup {
    let redundancy = found.estimate.redundancy;
    html! {
        @if !answered {
            p {
                "The answer above is that of the simulated currents. Where the log holds still, a second and simpler model can be held beside it: "
                "fitted here is the motor that the operating points alone ask for, not the one above."
            }
        }
        p {
            "At each operating point the steady voltage equations hold for the means of a window. "
            "Fitted is what they give for the motor that suits them best; the residual is measured less fitted."
            @if redundancy == 0 {
                " " strong { "There are no more equations than unknowns that the log excites" }
                ", so the fit must be perfect here, and proves nothing."
            } @else {
                " There " (if redundancy == 1 { "is one equation" } else { "are several equations" })
                " more than the unknowns need (redundancy " (redundancy) ")"
                @if found.misfit.is_none() { ", so residuals within their bars speak for the model." }
                @else { ", and " strong { "they contradict each other" } " beyond noise and accuracy: see the warning “misfit” above." }
            }
        }
        (points(found))
        @if let Some(saturation) = saturation { (flux::table(saturation)) }
        (frame::live_figure(|size| residuals::draw(found, size), &residuals::live(found), &html! {
            "Residuals of both voltage equations with bars of two standard uncertainties, from the noise of the means and "
            @if let Some(misfit) = found.misfit {
                "the accuracy to which the points agree, " (percent(misfit.voltage_accuracy)) " % of the voltage. A pattern over the points, "
                "such as one along the current, tells what the model lacks."
            } @else { "the accuracy of the voltages. " }
            @if found.misfit.is_some() {}
            @else if redundancy == 0 { "Without redundancy they are zero by construction." }
            @else { "Bars that miss zero mean that this point contradicts the others." }
        }))
        (frame::live_figure(|size| plane::draw(&found.operating_points, size), &plane::live(found), &prose(
            "The operating points by their currents, numbered as in the table. The farther apart they lie, the better the parameters can be told apart: \
             L_d needs points that differ in i_d."
        )))
    }
}

fn percent(fraction: f64) -> String {
    number(100.0 * fraction, |percent| significant(percent, 2))
}

fn points(found: &SteadyFit) -> Markup {
    let uncertainties = residuals::uncertainties(found);
    // The same digits down a column: those of its best value.
    let least: [f64; 2] = [0, 1].map(|axis| uncertainties.iter().map(|both| both[axis]).fold(f64::INFINITY, f64::min));
    let rows = found.operating_points.iter().zip(&found.estimate.residuals).zip(uncertainties);
    html! {
        (frame::scrolling("Operating points, measured and fitted", &html! {
            table {
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Point" }
                        th scope="col" rowspan="2" { (prose("i_d")) ", A" } th scope="col" rowspan="2" { (prose("i_q")) ", A" }
                        th scope="col" rowspan="2" { (prose("omega_e")) ", rad/s" }
                        @for axis in ["u_d", "u_q"] { th scope="colgroup" colspan="3" { (prose(axis)) } }
                    }
                    tr { @for _ in 0..2 {
                        th scope="col" { "measured, V" } th scope="col" { "fitted, V" } th scope="col" { "residual, mV" }
                    } }
                }
                tbody { @for (k, ((point, residual), uncertainty)) in rows.enumerate() { (row(k + 1, point, residual, uncertainty, least)) } }
            }
        }))
    }
}

fn row(k: usize, point: &OperatingPoint, residual: &[f64; 2], uncertainty: [f64; 2], least: [f64; 2]) -> Markup {
    let (u, i) = (point.voltage(), point.current());
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    html! {
        tr {
            th scope="row" { (k) }
            @for value in [i.d, i.q, point.omega_e()] { td { (fixed(value, DECIMALS)) } }
            @for (axis, measured) in [u.d, u.q].into_iter().enumerate() {
                @let digits = decimals(least[axis], DECIMALS).max(DECIMALS);
                @let tenths = decimals(1e3 * least[axis], 1);
                td { (fixed(measured, digits)) }
                td { (fixed(measured - residual[axis], digits)) }
                td { (fixed(1e3 * residual[axis], tenths)) " ± " (fixed(1e3 * uncertainty[axis], tenths)) }
            }
        }
    }
}
