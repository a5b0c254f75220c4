//! Quantization of a channel: its step, and the uncertainty that it leaves in a mean.
//!
//! A converter, or a file with few digits, gives multiples of a step `q`. Noise across several steps acts as dither, and the mean has
//! no quantization error. A value that stays on one step lies anywhere within it, however long the log: a standard uncertainty of
//! `q / sqrt(12)` (GUM F.2.2.1). In between, noise of standard deviation `sigma` leaves the fraction `exp(-2 pi² sigma² / q²)` of
//! that uncertainty: B. Widrow and I. Kollár, Quantization Noise, 2008, chapter 6.

use std::collections::BTreeSet;

/// Fewest levels from which a channel counts as quantized: a few set points are not a quantizer's levels.
const MIN_LEVELS: usize = 8;

/// Largest deviation of a change from a multiple of the smallest one, as a fraction of the smallest: files round.
const MULTIPLE_TOLERANCE: f64 = 1e-3;

/// Changes larger than this many times the smallest are not examined: rounding hides whether they are multiples.
const MAX_MULTIPLE: f64 = 1e6;

/// The quantization step of a channel; zero if it is not quantized.
pub(crate) fn step(column: &[f64]) -> f64 {
    let changes = || column.windows(2).map(|pair| (pair[1], (pair[1] - pair[0]).abs())).filter(|(_, change)| *change > 0.0);
    let smallest = changes().map(|(_, change)| change).fold(f64::INFINITY, f64::min);
    if !smallest.is_finite() {
        return 0.0;
    }
    let mut levels = BTreeSet::new();
    for (value, change) in changes() {
        let steps = change / smallest;
        if steps < MAX_MULTIPLE && (steps - steps.round()).abs() > MULTIPLE_TOLERANCE * steps.max(1.0) {
            return 0.0;
        }
        if levels.len() < MIN_LEVELS {
            levels.insert((value / smallest).round() as i64);
        }
    }
    if levels.len() < MIN_LEVELS { 0.0 } else { smallest }
}

/// Standard uncertainty from quantization of a mean of values with this standard deviation.
pub(crate) fn standard_uncertainty(step: f64, deviation: f64) -> f64 {
    if step == 0.0 {
        return 0.0;
    }
    // Quantization itself adds step²/12 to the variance of a value that moves across steps.
    let dither = (deviation.powi(2) - step.powi(2) / 12.0).max(0.0);
    step / 12.0_f64.sqrt() * (-2.0 * std::f64::consts::PI.powi(2) * dither / step.powi(2)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::Draws;

    #[test]
    fn only_quantized_channels_have_a_step() {
        let mut draws = Draws::seeded(2, 0);
        let smooth: Vec<f64> = (0..1000).map(|_| 9.0 + 0.1 * draws.normal()).collect();
        assert_eq!(step(&smooth), 0.0);
        let written: Vec<f64> = smooth.iter().map(|x| (x / 0.01).round() * 0.01).collect();
        assert!((step(&written) - 0.01).abs() < 1e-9);
        // Set points of a simulated drive without noise.
        assert_eq!(step(&[[0.0; 50], [-2.0; 50]].concat()), 0.0);
        assert_eq!(step(&[3.0; 50]), 0.0);
    }

    #[test]
    fn noise_removes_the_quantization_error() {
        assert!((standard_uncertainty(0.1, 0.0) - 0.1 / 12.0_f64.sqrt()).abs() < 1e-15);
        assert!(standard_uncertainty(0.1, 0.1) < 1e-6);
        assert_eq!(standard_uncertainty(0.0, 1.0), 0.0);
    }
}
