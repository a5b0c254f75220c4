//! The three frames in which a three-phase quantity is written, as types.
//!
//! The convention, stated once: **amplitude-invariant**. A balanced three-phase system of peak value `A` is a vector of
//! length `A` in [`AlphaBeta`] and in [`Dq`]; power is `3/2 (u_d i_d + u_q i_q)`. The alpha axis lies on phase a; the d axis lies on the
//! magnet, at the electrical angle `theta_e` from alpha; q leads d by 90 electrical degrees. The zero-sequence component
//! (the mean of the three phases) is not represented in the other two frames and is dropped.

use crate::lanes::Number;

/// Three phase quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Abc {
    /// Phase a.
    pub a: f64,
    /// Phase b.
    pub b: f64,
    /// Phase c.
    pub c: f64,
}

/// A vector in the stator frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AlphaBeta {
    /// Component along phase a.
    pub alpha: f64,
    /// Component 90 electrical degrees ahead.
    pub beta: f64,
}

/// A vector in the rotor frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dq {
    /// Component along the magnet.
    pub d: f64,
    /// Component 90 electrical degrees ahead of the magnet.
    pub q: f64,
}

impl Abc {
    /// Clarke transform, amplitude-invariant.
    pub fn to_alpha_beta(self) -> AlphaBeta {
        AlphaBeta { alpha: (2.0 * self.a - self.b - self.c) / 3.0, beta: (self.b - self.c) / 3.0_f64.sqrt() }
    }
}

impl AlphaBeta {
    /// Inverse Clarke transform; the three phases sum to zero.
    pub fn to_abc(self) -> Abc {
        let half_beta = 0.5 * 3.0_f64.sqrt() * self.beta;
        Abc { a: self.alpha, b: -0.5 * self.alpha + half_beta, c: -0.5 * self.alpha - half_beta }
    }

    /// Park transform: the same vector in the frame of a rotor at `theta_e` electrical radians.
    pub fn to_dq(self, theta_e: f64) -> Dq {
        let (sin, cos) = theta_e.sin_cos();
        Dq { d: cos * self.alpha + sin * self.beta, q: cos * self.beta - sin * self.alpha }
    }
}

impl Dq {
    /// Inverse Park transform.
    pub fn to_alpha_beta(self, theta_e: f64) -> AlphaBeta {
        let (sin, cos) = theta_e.sin_cos();
        AlphaBeta { alpha: cos * self.d - sin * self.q, beta: sin * self.d + cos * self.q }
    }

    /// Length of the vector: the peak value of the phase quantity.
    pub fn magnitude(self) -> f64 {
        self.d.hypot(self.q)
    }

    /// The vector turned forward by an angle, rad; the same bits where that is zero.
    #[inline]
    pub(crate) fn turned(self, by: f64) -> Self {
        if by == 0.0 {
            return self;
        }
        let AlphaBeta { alpha, beta } = self.to_alpha_beta(by);
        Self { d: alpha, q: beta }
    }
}

/// A turn by an angle: its cosine and sine, computed once for all vectors that it turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
}

impl Turn {
    /// By this angle, rad.
    pub(crate) fn by(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }

    /// A vector of the rotor's frame, in the stator's; or any vector, turned forward. `[d, q]` to `[alpha, beta]`.
    #[inline(always)]
    pub(crate) fn forward<V: Number>(self, [d, q]: [V; 2]) -> [V; 2] {
        turned([d, q], d.constant(self.cos), d.constant(self.sin))
    }

    /// A vector of the stator's frame, in the rotor's; or any vector, turned backward.
    #[inline(always)]
    pub(crate) fn backward<V: Number>(self, [alpha, beta]: [V; 2]) -> [V; 2] {
        turned([alpha, beta], alpha.constant(self.cos), alpha.constant(-self.sin))
    }

    /// Twice the turn.
    pub(crate) fn twice(self) -> Self {
        Self { cos: self.cos * self.cos - self.sin * self.sin, sin: 2.0 * self.sin * self.cos }
    }

    /// Six times the turn.
    pub(crate) fn sixfold(self) -> Self {
        let two = self.twice();
        let four = two.twice();
        Self { cos: four.cos * two.cos - four.sin * two.sin, sin: four.sin * two.cos + four.cos * two.sin }
    }

    /// The turn from this to another.
    pub(crate) fn until(self, other: Self) -> Self {
        Self { cos: self.cos * other.cos + self.sin * other.sin, sin: self.cos * other.sin - self.sin * other.cos }
    }
}

/// A vector turned forward by an angle with this cosine and sine.
#[inline(always)]
pub(crate) fn turned<V: Number>([d, q]: [V; 2], cos: V, sin: V) -> [V; 2] {
    [cos.mul_add(d, -(sin * q)), sin.mul_add(d, cos * q)]
}

/// Clarke transform of vectors side by side, amplitude-invariant: as [`Abc::to_alpha_beta`].
#[inline(always)]
pub(crate) fn clarke<V: Number>([a, b, c]: [V; 3]) -> [V; 2] {
    let (third, two_thirds) = (a.constant(1.0 / 3.0), a.constant(2.0 / 3.0));
    [two_thirds.mul_add(a, -(third * (b + c))), a.constant(1.0 / 3.0_f64.sqrt()) * (b - c)]
}

/// Inverse Clarke transform of vectors side by side: as [`AlphaBeta::to_abc`].
#[inline(always)]
pub(crate) fn inverse_clarke<V: Number>([alpha, beta]: [V; 2]) -> [V; 3] {
    let along = alpha.constant(0.5 * 3.0_f64.sqrt());
    let minus_half = alpha.constant(-0.5) * alpha;
    [alpha, along.mul_add(beta, minus_half), (-along).mul_add(beta, minus_half)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_balanced_system_is_a_constant_vector_of_its_peak_value() {
        // Phase a is at its peak when the d axis lies on it: the vector is along d.
        let phases = |angle: f64| Abc { a: 5.0 * angle.cos(), b: 5.0 * (angle - TAU / 3.0).cos(), c: 5.0 * (angle + TAU / 3.0).cos() };
        for degrees in [0.0_f64, 17.0, 90.0, 200.0, 359.0] {
            let angle = degrees.to_radians();
            let dq = phases(angle).to_alpha_beta().to_dq(angle);
            assert!((dq.d - 5.0).abs() < 1e-14 && dq.q.abs() < 1e-14, "{degrees}: {dq:?}");
            let ahead = phases(angle + TAU / 4.0).to_alpha_beta().to_dq(angle);
            assert!(ahead.d.abs() < 1e-14 && (ahead.q - 5.0).abs() < 1e-14, "{degrees}: {ahead:?}");
        }
    }

    proptest! {
        #[test]
        fn inverse_transforms_restore_the_vector(d in -1e3..1e3, q in -1e3..1e3, theta in -10.0..10.0) {
            let there = Dq { d, q }.to_alpha_beta(theta).to_abc();
            prop_assert!((there.a + there.b + there.c).abs() < 1e-10);
            let back = there.to_alpha_beta().to_dq(theta);
            prop_assert!((back.d - d).abs() < 1e-10 && (back.q - q).abs() < 1e-10);
        }

        #[test]
        fn power_is_three_halves_of_the_dot_product(ud in -1e2..1e2, uq in -1e2..1e2, id in -1e2..1e2, iq in -1e2..1e2, theta in -10.0..10.0) {
            let u = Dq { d: ud, q: uq }.to_alpha_beta(theta).to_abc();
            let i = Dq { d: id, q: iq }.to_alpha_beta(theta).to_abc();
            let phases = u.a * i.a + u.b * i.b + u.c * i.c;
            prop_assert!((phases - 1.5 * (ud * id + uq * iq)).abs() < 1e-9);
        }
    }
}
