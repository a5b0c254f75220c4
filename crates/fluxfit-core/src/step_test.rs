//! A test for steps of one parameter, as where iron saturates: the generalized likelihood ratio (Willsky and Jones 1976, doi
//! 10.1109/TAC.1976.1101146) over windows of 128 periods.
//!
//! A step of a parameter moves the innovations along its sensitivity `G`. The step that explains a window best has the size `n/g` and
//! the likelihood ratio `n²/(g r)`, with `n = sum G·nu`, `g = sum |G|²` and the variance `r` of the innovations. The gain of the filter
//! on the current is left out.

use crate::{PARAMETERS, real::Real};

/// Periods of a window. A shorter one tells inductances and resistance apart too badly.
const WINDOW: u32 = 128;

/// Least ratio: of 300 s of constant parameters no window comes near it, and saturation exceeds it by far.
const RATIO: f64 = 40.0;

/// Largest part of a parameter by which it is thought to step.
const LARGEST: f64 = 0.3;

/// The test.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepTest<T> {
    count: u32,
    /// Sensitivity of the current to each scaled parameter since the window's beginning, A.
    g: [[T; 2]; PARAMETERS],
    along: [T; PARAMETERS],
    squared: [T; PARAMETERS],
}

impl<T: Real> StepTest<T> {
    /// At the beginning of a window.
    pub fn new() -> Self {
        Self { count: 0, g: [[T::ZERO; 2]; PARAMETERS], along: [T::ZERO; PARAMETERS], squared: [T::ZERO; PARAMETERS] }
    }

    /// Notes a period: derivatives of its current, those to the scaled parameters as columns, its innovations, A, and their variance, A².
    /// At the end of a window with a step: which parameter, and its squared size.
    pub fn note(
        &mut self,
        by_current: &[[T; 2]; 2],
        by_scaled: &[[T; 2]; PARAMETERS],
        innovation: [T; 2],
        variance: T,
    ) -> Option<(usize, T)> {
        for j in 0..PARAMETERS {
            let [d, q] = self.g[j];
            let moved = |c: usize| by_current[0][c] * d + by_current[1][c] * q + by_scaled[j][c];
            let g = [moved(0), moved(1)];
            self.g[j] = g;
            self.along[j] += g[0] * innovation[0] + g[1] * innovation[1];
            self.squared[j] += g[0] * g[0] + g[1] * g[1];
        }
        self.count += 1;
        if self.count < WINDOW {
            return None;
        }
        let found = self.step(variance);
        *self = Self::new();
        found
    }

    fn step(&self, variance: T) -> Option<(usize, T)> {
        let mut largest = (0, T::ZERO);
        for j in (0..PARAMETERS).filter(|j| self.squared[*j] > T::ZERO) {
            let ratio = self.along[j] * self.along[j] / self.squared[j];
            if ratio > largest.1 {
                largest = (j, ratio);
            }
        }
        let (j, ratio) = largest;
        (ratio > T::of(RATIO) * variance).then(|| {
            let size = (self.along[j] / self.squared[j]).abs().smaller(T::of(LARGEST));
            (j, size * size)
        })
    }
}

impl<T: Real> Default for StepTest<T> {
    fn default() -> Self {
        Self::new()
    }
}
