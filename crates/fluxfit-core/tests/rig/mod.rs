//! The motor of the tests, and the noise of its currents.

pub(crate) const TRUTH: [f64; 4] = [0.958, 5.25e-3, 12e-3, 0.1827];

/// Standard deviation of the noise of each current, A.
pub(crate) const NOISE: f64 = 0.04;

/// The noise: normal numbers, about, each the sum of twelve uniform ones of a linear congruential generator (Numerical Recipes' constants).
pub(crate) struct Noise(pub(crate) u32);

impl Noise {
    /// The next one, A.
    pub(crate) fn next(&mut self) -> f64 {
        let mut uniform = || {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(self.0) / f64::from(u32::MAX)
        };
        NOISE * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0)
    }
}
