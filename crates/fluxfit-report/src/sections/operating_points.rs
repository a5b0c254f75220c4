//! Operating points: measured against fitted voltages.

use crate::{
    operating_point_uncertainty::{residual_uncertainties, residual_unit},
    report::Report,
    section::Section,
    table::{self, key, named},
    typography::{NO_BREAK, decimals, number, percent, prose},
};
use fluxfit::{
    Warning,
    evidence::{Identification, Part, SteadyFit},
    steady::OperatingPoint,
};
use maud::{Markup, html};

/// Decimals of a voltage without uncertainty.
const DECIMALS: usize = 3;

/// Half of a 95 % interval, in standard uncertainties; the bars of the figure are as long.
const BAR: f64 = 2.0;

/// Names of the table's columns in a file of comma-separated values, with residuals in this unit.
fn header(unit: &str) -> String {
    let of_axis = ["ud", "uq"].map(|u| format!("{u},{u}_fitted,{u}_residual_{unit},{u}_residual_95_{unit}"));
    format!("point,id,iq,omega_e,{}", of_axis.join(","))
}

/// Places of the currents and the speed among the channels of an operating point.
const ID: usize = 2;
const IQ: usize = 3;
const OMEGA: usize = 6;

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let fit = found.steady.as_ref()?;
    let is_check = found.output.is_some();
    let content = html! {
        @if is_check {
            p {
                "The parameters above are identified from the simulated currents. The operating points of the log allow a check with a second, "
                "simpler model: the values here are fitted to the operating points alone."
            }
        }
        (description(fit, found))
        (points(fit))
    };
    let heading = if is_check { "Operating points, as a check" } else { "Operating points, measured against fitted" };
    Some(Section { anchor: "operating-points", heading, content })
}

fn description(fit: &SteadyFit, found: &Identification) -> Markup {
    let redundancy = fit.estimate.redundancy;
    let is_widened = found.output.is_none() && found.parameters.iter().any(|judgement| judgement.uncertainty.systematic.misfit > 0.0);
    let terms: Vec<&str> = fit.terms().into_iter().map(Part::cause).collect();
    let is_turned = found.warnings.iter().any(|warning| matches!(warning, Warning::FrameLag { .. }));
    let is_warned = found.warnings.iter().any(|warning| matches!(warning, Warning::Misfit { .. }));
    html! {
        p {
            "At each operating point the steady voltage equations hold for the means over a window. "
            "The fitted voltages are those of the parameters that fit all points best; the residual is measured less fitted."
            @if is_turned { " Measured voltages are those of the log, turned by the lag of the warning “frame-lag”." }
            @if !terms.is_empty() {
                " Beside the four parameters they contain " (terms.join("; ")) ", so the parameters alone give somewhat other voltages."
            }
            @if redundancy == 0 {
                " " strong { "There are no more equations than unknown parameters" }
                ", so the fit is perfect by construction and does not test the model."
            } @else {
                " There " @if redundancy == 1 { "is one more equation" } @else { "are " (redundancy) " more equations" }
                " than unknown parameters"
                @if let Some(misfit) = fit.misfit {
                    ", and constant parameters do not fit all points: " strong { "they contradict each other" } " beyond noise and accuracy and "
                    "agree only to " (percent(misfit.voltage_accuracy)) " % of the voltage. The uncertainties of the residuals below are widened "
                    "to that, so a residual within them only says that its point fits as well as the others."
                    @if found.saturation.is_some() { " The cause is saturation: see the fluxes at the currents of the log, above." }
                    @else if is_warned { " See the warning “misfit” above." }
                } @else if is_widened {
                    ". The points scatter by more than their noise; what they contradict each other by is part of the intervals (misfit)."
                } @else { ", so small residuals confirm the model." }
            }
        }
    }
}

fn points(found: &SteadyFit) -> Markup {
    let uncertainties = residual_uncertainties(found);
    // All values of a column have the decimals of its smallest uncertainty.
    let least: [f64; 2] = [0, 1].map(|axis| uncertainties.iter().map(|both| both[axis]).fold(f64::INFINITY, f64::min));
    let rows = found.operating_points.iter().zip(&found.estimate.residuals).zip(uncertainties);
    let unit = residual_unit(found);
    html! {
        div data-values { (table::scrolling("Operating points, measured and fitted", &html! {
            table.stacked data-header=(header(unit.0)) {
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Point" }
                        th scope="col" rowspan="2" { (prose("i_d")) ", A" } th scope="col" rowspan="2" { (prose("i_q")) ", A" }
                        th scope="col" rowspan="2" { (prose("omega_e")) ", rad/s" }
                        @for axis in ["u_d", "u_q"] { th scope="colgroup" colspan="3" { (prose(axis)) } }
                    }
                    tr { @for _ in 0..2 {
                        th scope="col" { "measured, V" } th scope="col" { "fitted, V" } th scope="col" { "residual ±\u{a0}95\u{a0}%, " (unit.0) }
                    } }
                }
                tbody { @for (k, ((point, residual), uncertainty)) in rows.enumerate() { (row(k + 1, point, (residual, uncertainty), least, unit)) } }
            }
        })) }
    }
}

fn row(
    k: usize,
    point: &OperatingPoint,
    (residual, uncertainty): (&[f64; 2], [f64; 2]),
    least: [f64; 2],
    (unit, per_volt): (&str, f64),
) -> Markup {
    let (u, i) = (point.voltage(), point.current());
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    html! {
        tr {
            th scope="row" { (key("Point ")) (k) }
            @for (name, value, channel, of_value) in [("i_d", i.d, ID, " A"), ("i_q", i.q, IQ, " A"), ("omega_e", point.omega_e(), OMEGA, " rad/s")] {
                @let digits = decimals(point.covariance[channel][channel].sqrt(), DECIMALS).min(DECIMALS);
                td { (named(name)) (fixed(value, digits)) (key(of_value)) }
            }
            @for (axis, (name, measured)) in [("u_d", u.d), ("u_q", u.q)].into_iter().enumerate() {
                @let digits = decimals(least[axis], DECIMALS);
                @let tenths = decimals(per_volt * least[axis], 1);
                td.group { (named(name)) (fixed(measured, digits)) (key(" V")) }
                td { (key("fitted ")) (fixed(measured - residual[axis], digits)) (key(" V")) }
                td {
                    (key("residual ")) (fixed(per_volt * residual[axis], tenths)) (NO_BREAK) "±" (NO_BREAK) (fixed(per_volt * BAR * uncertainty[axis], tenths)) (key(&format!(" {unit}")))
                }
            }
        }
    }
}
