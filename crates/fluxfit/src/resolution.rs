//! Resolution: what the last digit of a channel leaves open.
//!
//! A converter or a file with few digits writes multiples of a step `q`. Where noise moves the value across several steps the
//! mean does not care; where it stays on one step, no length of log tells where within the step it was: a standard uncertainty of
//! `q / sqrt(12)` (GUM F.2.2.1). In between, noise of standard deviation `sigma` leaves the fraction `exp(-2 pi² sigma² / q²)` of
//! it: B. Widrow and I. Kollár, Quantization Noise, 2008, chapter 6.

use std::collections::BTreeSet;

/// Levels that a channel must visit before its smallest step is believed to be its resolution: a few set points are no converter.
const MIN_LEVELS: usize = 8;

/// A step is a multiple of the smallest one if it is this near to one, as a fraction of the smallest: files round.
const MULTIPLE_TOLERANCE: f64 = 1e-3;

/// Steps larger than this many of the smallest are not looked at: rounding would hide whether they are multiples.
const MAX_MULTIPLE: f64 = 1e6;

/// The step of a quantized channel; zero if it is not quantized.
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

/// Standard uncertainty of a mean of values with this standard deviation on a grid of this step.
pub(crate) fn uncertainty(step: f64, deviation: f64) -> f64 {
    if step == 0.0 {
        return 0.0;
    }
    // The grid itself adds step²/12 to the variance of what moves across it.
    let dither = (deviation.powi(2) - step.powi(2) / 12.0).max(0.0);
    step / 12.0_f64.sqrt() * (-2.0 * std::f64::consts::PI.powi(2) * dither / step.powi(2)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::draws::Draws;

    #[test]
    fn a_grid_is_found_and_nothing_else_is() {
        let mut draws = Draws::seeded(2, 0);
        let smooth: Vec<f64> = (0..1000).map(|_| 9.0 + 0.1 * draws.normal()).collect();
        assert_eq!(step(&smooth), 0.0);
        let written: Vec<f64> = smooth.iter().map(|x| (x / 0.01).round() * 0.01).collect();
        assert!((step(&written) - 0.01).abs() < 1e-9);
        // Set points of a simulated drive without noise are no converter.
        assert_eq!(step(&[[0.0; 50], [-2.0; 50]].concat()), 0.0);
        assert_eq!(step(&[3.0; 50]), 0.0);
    }

    #[test]
    fn noise_takes_the_grid_away() {
        assert!((uncertainty(0.1, 0.0) - 0.1 / 12.0_f64.sqrt()).abs() < 1e-15);
        assert!(uncertainty(0.1, 0.1) < 1e-6);
        assert_eq!(uncertainty(0.0, 1.0), 0.0);
    }
}
