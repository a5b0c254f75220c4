//! Are the residuals of the simulated currents white noise?

use super::currents::part_of_current;
use crate::{
    report::Report,
    residual_correlation::ResidualCorrelation,
    section::Section,
    typography::{number, percent, prose},
};
use fluxfit::faults::Fault;
use fluxfit_units::significant;
use maud::{Markup, html};

/// Fraction of the correlations of white noise that lie outside the band of ±2 standard errors.
const OUTSIDE: f64 = 0.0455;

/// Allowed excess of correlations outside the band, in standard deviations of their number.
const EXCESS: f64 = 3.0;

/// Smaller correlations explain less than a hundredth of a residual's variance.
const SLIGHT: f64 = 0.1;

/// Residuals below this part of the largest current are called small: a fiftieth of what an identified parameter may be off by.
const SMALL: f64 = 1e-3;

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (found, _) = report.identification?;
    let fit = found.output.as_ref()?;
    let correlation = ResidualCorrelation::of(fit);
    let content = html! {
        p {
            @if fit.has(Fault::Disturbance) {
                "Each row is predicted from the row before, which removes the correlation that unknown voltages (process noise) make over many rows. "
                "What is tested here is what that leaves. "
            }
            (verdict(&correlation, fit.leaves_something(), part_of_current(report.log, fit)))
        }
    };
    Some(Section { anchor: "residuals", heading: "Are the residuals white noise?", content })
}

/// The result of the test.
fn verdict(correlation: &ResidualCorrelation, is_relevant: bool, part: f64) -> Markup {
    let ResidualCorrelation { axes, band } = correlation;
    let lags = correlation.lags() as f64;
    let allowed = OUTSIDE * lags + EXCESS * (lags * OUTSIDE * (1.0 - OUTSIDE)).sqrt();
    let outside = |axis: usize| axes[axis].iter().filter(|value| value.abs() > *band).count();
    let white = [0, 1].map(|axis| outside(axis) as f64 <= allowed);
    let all = || axes.iter().flatten().copied();
    let largest = all().fold(0.0, |most: f64, value| if value.abs() > most.abs() { value } else { most });
    let largest = number(largest, |value| significant(value, 2));
    let expected = format!("{:.0}", OUTSIDE * lags);
    let slight = all().all(|value| value.abs() < SLIGHT);
    html! {
        @if white == [true, true] {
            strong { "White: " }
            "of " (lags) " correlations for each axis, " (outside(0)) " (d) and " (outside(1)) " (q) are outside the band; about "
            (expected) " are expected by chance. The model explains everything in the currents but noise."
        } @else if !is_relevant {
            strong { "Too small to matter: " }
            (residuals_of(white)) " are correlated, but smaller than 0.1 % of the largest current, as the ripple of an inverter or rounding."
        } @else if slight {
            strong { "Not white, but hardly correlated: " }
            (outside(0)) " (d) and " (outside(1)) " (q) of " (lags) " correlations are outside the band, where " (expected) " are expected by "
            "chance; none is farther from zero than " (largest.trim_start_matches('\u{2212}')) ". The error of the model is small compared with "
            "the noise; the intervals account for it."
        } @else if part < SMALL {
            strong { "Not white, but small: " }
            (residuals_of(white)) " are correlated from row to row (largest correlation " (largest) "), but they are only " (percent(part))
            "\u{a0}% of the largest current. The intervals account for the correlation."
        } @else {
            strong { "Not white: " }
            (residuals_of(white)) " are correlated from row to row; the largest correlation is " (largest)
            ", and they are " (percent(part)) "\u{a0}% of the largest current. "
            "The model lacks an effect that lasts longer than a row, such as a fault of the drive, saturation or heating. "
            "The intervals account for the correlation, but not for a bias from that effect."
        }
    }
}

fn residuals_of(white: [bool; 2]) -> Markup {
    match white {
        [false, true] => html! { "the residuals of " (prose("i_d")) },
        [true, false] => html! { "the residuals of " (prose("i_q")) },
        _ => html! { "the residuals of both currents" },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 50 correlations, 2.3 are expected outside the band, with a standard deviation of 1.5: six are chance, seven are not.
    #[test]
    fn each_kind_of_residual_has_its_verdict() {
        let with = |outside: usize, value: f64| -> Vec<f64> { (0..50).map(|lag| if lag < outside { value } else { 0.01 }).collect() };
        let small = |d: Vec<f64>, q: Vec<f64>, part| verdict(&ResidualCorrelation { axes: [d, q], band: 0.02 }, true, part).into_string();
        let of = |d: Vec<f64>, q: Vec<f64>| small(d, q, 0.01);
        assert!(of(with(6, 0.9), with(0, 0.0)).contains("White: "));
        let text = of(with(7, -0.05), with(0, 0.0));
        assert!(text.contains("Not white, but hardly correlated: ") && text.contains("7 (d) and 0 (q) of 50"), "{text}");
        assert!(text.contains("none is farther from zero than 0.050"), "{text}");
        let text = of(with(0, 0.0), with(7, 0.9));
        assert!(text.contains("Not white: ") && text.contains("<i>i</i><sub>q</sub>") && text.contains("is 0.90"), "{text}");
        let text = small(with(0, 0.0), with(7, 0.9), 1.8e-4);
        assert!(text.contains("Not white, but small") && text.contains("only 0.018"), "{text}");
    }
}
