//! Measured against simulated: the currents over time, what the simulation misses, and whether that is noise.

use crate::{
    figure::{autocorrelation, currents},
    frame,
    measured::Measured,
    typography::{grouped, number, prose},
};
use fluxfit::{evidence::OutputFit, faults::Fault, log::Log};
use fluxfit_units::significant;
use maud::{Markup, html};

/// Rows across which residuals are compared with each other.
const LAGS: usize = 50;

/// As many rows per lag at least.
const ROWS_PER_LAG: usize = 4;

/// Standard errors of a correlation of white noise that the band reaches, and the part of all lags beyond it all the same.
const BAND: f64 = 2.0;
const BEYOND: f64 = 0.0455;

/// Standard deviations by which the number of lags beyond the band may exceed what chance puts there.
const CHANCE: f64 = 3.0;

/// Below this a correlation is there, but explains less than a hundredth of a residual.
const SLIGHT: f64 = 0.1;

/// The section.
pub(crate) fn section(log: &Log, fit: &OutputFit) -> Markup {
    let rms = fit.residual_rms();
    let peak = peak(log, fit);
    html! {
        p {
            @if fit.has(Fault::Disturbance) {
                "From each measured row the next one was predicted, with the motor found, the logged voltage and speed, because voltages that are "
                "not in the log disturb this motor. "
            } @else {
                "The motor found was driven with the logged voltages and speeds from the first row of a stretch to its last; measured currents were "
                "not fed back, only where each stretch starts is fitted. "
            }
            "Root mean square, the simulated currents miss the measured ones by " (amperes(rms.d)) " (" (prose("i_d")) ") and "
            (amperes(rms.q)) " (" (prose("i_q")) "), "
            (number(100.0 * rms.d.max(rms.q) / peak, |percent| significant(percent, 2))) " % of the largest current."
        }
        @let both = Measured::and_simulated(log, fit);
        (frame::live_figure(|size| currents::draw(both, size), &currents::live(both), &caption(fit, both)))
        (whiteness(fit))
    }
}

/// The largest measured current, A; never zero.
fn peak(log: &Log, fit: &OutputFit) -> f64 {
    let columns = log.columns();
    let all = fit.stretches.iter().flat_map(Clone::clone).map(|row| columns.id[row].hypot(columns.iq[row]));
    all.fold(f64::MIN_POSITIVE, f64::max)
}

/// A current in the unit that suits it.
pub(crate) fn amperes(current: f64) -> String {
    let (factor, unit) = match current {
        c if c >= 1.0 => (1.0, "A"),
        c if c >= 1e-3 => (1e3, "mA"),
        _ => (1e6, "µA"),
    };
    format!("{} {unit}", number(current, |current| significant(factor * current, 2)))
}

fn caption(fit: &OutputFit, both: Measured) -> Markup {
    html! {
        "Measured currents, grey, and the simulated ones over them; below each, measured less simulated on a scale of its own. Of many rows in "
        "a column of pixels the least and the largest are drawn, so a band is noise or ripple, and a peak that lies outside of it is real. "
        "The bold line is the mean over short spans: it shows what lasts below the noise."
        (currents::thinning(&both))
        @if fit.stretches.len() > 1 { " Gaps of the log are not bridged." }
        @if Fault::ALL.into_iter().any(|fault| fault.alters_measured_current() && fit.has(fault)) {
            " The measured current is the logged one; the simulated one is shown as the faulty sensors found would read it."
        }
    }
}

/// Autocorrelation of the residuals along both axes, and half of the band in which that of noise stays.
pub(crate) fn correlations(fit: &OutputFit) -> ([Vec<f64>; 2], f64) {
    let rows = fit.residuals.len() / 2;
    let lags = LAGS.min(rows / ROWS_PER_LAG).max(1);
    (fit.autocorrelation(lags), BAND / (rows.max(1) as f64).sqrt())
}

fn whiteness(fit: &OutputFit) -> Markup {
    let (correlations, band) = correlations(fit);
    let (rows, lags) = (fit.residuals.len() / 2, correlations[0].len());
    html! {
        h3 { "Is what is left noise?" }
        p { (verdict(&correlations, band, fit.leaves_something())) }
        (frame::figure(|size| autocorrelation::draw(&correlations, band, size), &html! {
            "Autocorrelation of the residuals at " (lags) " lags. Of white noise 95 in 100 stay within the grey band, ±2/√n = ±"
            (number(band, |band| significant(band, 2))) " for " (grouped(rows as u64)) " rows. Each figure has its own scale."
        }))
    }
}

/// What a statistician would say of these correlations.
fn verdict(correlations: &[Vec<f64>; 2], band: f64, leaves_something: bool) -> Markup {
    let lags = correlations[0].len() as f64;
    let allowed = BEYOND * lags + CHANCE * (lags * BEYOND * (1.0 - BEYOND)).sqrt();
    let beyond = |axis: usize| correlations[axis].iter().filter(|value| value.abs() > band).count();
    let white = [0, 1].map(|axis| beyond(axis) as f64 <= allowed);
    let all = || correlations.iter().flatten().copied();
    let largest = all().fold(0.0, |most: f64, value| if value.abs() > most.abs() { value } else { most });
    let largest = number(largest, |value| significant(value, 2));
    let slight = all().all(|value| value.abs() < SLIGHT);
    html! {
        @if white == [true, true] {
            strong { "White, as noise is: " }
            "of " (lags) " lags each, " (beyond(0)) " (d) and " (beyond(1)) " (q) lie beyond the band, where chance alone puts about "
            (format!("{:.0}", BEYOND * lags)) ". Nothing is left in the currents that lasts from row to row."
        } @else if !leaves_something {
            strong { "Too small to matter: " }
            (residuals_of(white)) " are correlated, but less than 0.01 % of the largest current is missed: an inverter’s ripple, or rounding."
        } @else if slight {
            strong { "Almost white: " }
            (beyond(0)) " (d) and " (beyond(1)) " (q) of " (lags) " lags lie beyond the band, but none of the correlations is larger than "
            (largest) ". What the model lacks is small against the noise; the intervals count it."
        } @else {
            strong { "Not white: " }
            (residuals_of(white)) " remember what went before; the largest correlation is " (largest)
            ". The model lacks something that lasts longer than a row, such as a fault of the drive, saturation or heating. "
            "The intervals count this correlation as noise that averages out more slowly, but not a bias that it may bring."
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

    /// Of 50 lags chance puts 2.3 beyond the band, with a standard deviation of 1.5: six are chance, seven are not.
    #[test]
    fn a_verdict_for_every_kind_of_residual() {
        let with = |beyond: usize, value: f64| -> Vec<f64> { (0..50).map(|lag| if lag < beyond { value } else { 0.01 }).collect() };
        let of = |d: Vec<f64>, q: Vec<f64>| verdict(&[d, q], 0.02, true).into_string();
        assert!(of(with(6, 0.9), with(0, 0.0)).contains("White, as noise is"));
        assert!(of(with(7, -0.05), with(0, 0.0)).contains("none of the correlations is larger than \u{2212}0.050"));
        let text = of(with(0, 0.0), with(7, 0.9));
        assert!(text.contains("Not white") && text.contains("<i>i</i><sub>q</sub>") && text.contains("is 0.90"), "{text}");
    }

    #[test]
    fn currents_get_their_unit() {
        assert_eq!([2.5, 0.0404, 1.9e-5].map(amperes), ["2.5 A", "40 mA", "19 µA"]);
    }
}
