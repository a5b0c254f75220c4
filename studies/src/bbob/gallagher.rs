//! The peaks of Gallagher's functions: places, heights and shapes drawn.

use super::random::{ascending, uniform};
use nalgebra::DMatrix;

/// Heights of the second highest and the lowest peak; the highest has ten.
const HEIGHTS: [f64; 2] = [9.1, 1.1];
const HIGHEST: f64 = 10.0;

/// Largest root of the condition of a peak's shape.
const CONDITION: f64 = 1000.0;

/// The optimum lies in this part of the box of the peaks.
const INNER: f64 = 0.8;

/// Seeds of the shapes of two peaks are so far apart.
const PER_PEAK: u64 = 1000;

/// The peaks.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Peaks {
    /// Where the highest is.
    pub(super) optimum: Vec<f64>,
    peaks: Vec<Peak>,
}

#[derive(Debug, Clone, PartialEq)]
struct Peak {
    height: f64,
    /// Its place, turned.
    place: Vec<f64>,
    /// Its steepness along each turned axis.
    steepness: Vec<f64>,
}

impl Peaks {
    /// 101 peaks in -5..5.
    pub(super) fn many(rotation: &DMatrix<f64>, seed: u64) -> Self {
        Self::drawn(rotation, seed, (101, 5.0, CONDITION.sqrt()))
    }

    /// 21 peaks in -4.9..4.9; the highest is as narrow as any.
    pub(super) fn few(rotation: &DMatrix<f64>, seed: u64) -> Self {
        Self::drawn(rotation, seed, (21, 4.9, CONDITION))
    }

    /// Number of peaks, half width of their box, root of the highest one's condition.
    fn drawn(rotation: &DMatrix<f64>, seed: u64, (count, half_width, of_highest): (usize, f64, f64)) -> Self {
        let d = rotation.nrows();
        let order = ascending(&uniform(count - 1, seed));
        let places = uniform(d * count, seed);
        let place = |peak: usize| -> Vec<f64> {
            let part = if peak == 0 { INNER } else { 1.0 };
            places[peak * d..(peak + 1) * d].iter().map(|r| part * half_width * (2.0 * r - 1.0)).collect()
        };
        let [second, lowest] = HEIGHTS;
        let last = (count - 2) as f64;
        let peak = |k: usize| {
            let (height, condition) = match k.checked_sub(1) {
                None => (HIGHEST, of_highest),
                Some(other) => (lowest + (second - lowest) * other as f64 / last, CONDITION.powf(order[other] as f64 / last)),
            };
            let axes = ascending(&uniform(d, seed + PER_PEAK * k as u64));
            let steepness = axes.iter().map(|axis| condition.powf(*axis as f64 / (d as f64 - 1.0) - 0.5)).collect();
            Peak { height, place: super::shape::turned(rotation, &place(k)), steepness }
        };
        Self { optimum: place(0), peaks: (0..count).map(peak).collect() }
    }

    /// The highest peak at a turned place.
    pub(super) fn highest(&self, x: &[f64]) -> f64 {
        let at = |peak: &Peak| {
            let squares = x.iter().zip(&peak.place).zip(&peak.steepness).map(|((x, place), steepness)| steepness * (x - place).powi(2));
            peak.height * (-0.5 / x.len() as f64 * squares.sum::<f64>()).exp()
        };
        self.peaks.iter().map(at).fold(0.0, f64::max)
    }
}
