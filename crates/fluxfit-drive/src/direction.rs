//! A direction: cosine and sine of an angle, computed once for all vectors that it turns. Computing them anew for each vector would
//! take a tenth of the time of a simulation.

use fluxfit::frames::{AlphaBeta, Dq};

/// Cosine and sine of an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Cosine.
    pub cos: f64,
    /// Sine.
    pub sin: f64,
}

impl Direction {
    /// Of the angle zero.
    pub(crate) const ZERO: Self = Self { cos: 1.0, sin: 0.0 };

    /// Of an angle, rad.
    pub(crate) fn of(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }

    /// Of an angle, rad, which is usually small.
    #[inline(always)]
    pub(crate) fn of_small(angle: f64) -> Self {
        if angle.abs() >= SMALL_ANGLE {
            return Self::of(angle);
        }
        // In an order that lets the processor compute several products at once: a step of the integration waits for these.
        let a2 = angle * angle;
        let cos = (1.0 - 0.5 * a2) + a2 * a2 * (1.0 / 24.0 - a2 * (1.0 / 720.0));
        Self { cos, sin: angle - angle * a2 * (1.0 / 6.0 - a2 * (1.0 / 120.0)) }
    }

    /// Of the sum of both angles.
    #[inline(always)]
    pub(crate) fn turned(self, by: Self) -> Self {
        Self { cos: self.cos * by.cos - self.sin * by.sin, sin: self.sin * by.cos + self.cos * by.sin }
    }

    /// A vector of the rotor frame at this angle, in the stator frame.
    #[inline(always)]
    pub(crate) fn to_stator(self, Dq { d, q }: Dq) -> AlphaBeta {
        AlphaBeta { alpha: self.cos * d - self.sin * q, beta: self.sin * d + self.cos * q }
    }

    /// A vector of the stator frame, in the rotor frame at this angle.
    #[inline(always)]
    pub(crate) fn to_rotor(self, AlphaBeta { alpha, beta }: AlphaBeta) -> Dq {
        Dq { d: self.cos * alpha + self.sin * beta, q: self.cos * beta - self.sin * alpha }
    }
}

/// Below this angle, rad, the truncated series of [`Direction::of_small`] are exact to rounding: 0.02⁷/7! is 3e-16. It exceeds
/// [`MAX_STEP`](crate::plant::MAX_STEP), through which the rotor turns in an integration step at most.
const SMALL_ANGLE: f64 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn series_are_the_standard_librarys_functions(angle in -2.0 * SMALL_ANGLE..2.0 * SMALL_ANGLE) {
            let found = Direction::of_small(angle);
            prop_assert!((found.cos - angle.cos()).abs() < 4e-16 && (found.sin - angle.sin()).abs() < 4e-16);
        }

        #[test]
        fn turns_add_up_and_frames_are_those_of_the_library(a in -7.0..7.0, b in -7.0..7.0, d in -9.0..9.0, q in -9.0..9.0) {
            let (sum, u) = (Direction::of(a).turned(Direction::of(b)), Dq { d, q });
            prop_assert!((sum.cos - (a + b).cos()).abs() < 2e-15 && (sum.sin - (a + b).sin()).abs() < 2e-15);
            let there = Direction::of(a).to_stator(u);
            prop_assert_eq!(there, u.to_alpha_beta(a));
            prop_assert_eq!(Direction::of(a).to_rotor(there), there.to_dq(a));
        }
    }
}
