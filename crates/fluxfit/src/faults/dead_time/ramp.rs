//! The loss of an edge or of a device against the current: a ramp that stands in for the current's sign.

use crate::lanes::Number;

/// `i / width`, but at most one and at least minus one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ramp<V> {
    width: V,
    per_width: V,
}

/// Width, A, of a ramp that has none: one over it is a number, and so is zero times that.
pub(super) const NARROWEST: f64 = 1e-100;

/// A way this short, as a fraction of its ends, leaves no digits in a difference of integrals.
const SHORT: f64 = 1e-6;

/// The same, A: shorter than any current, and the product of four such ways is still a number.
const SHORTEST: f64 = 1e-60;

/// A quotient that is not yet divided: a division takes as long as many products, and a sum of quotients needs only one.
#[derive(Clone, Copy)]
pub(super) struct Fraction<V> {
    above: V,
    below: V,
}

impl<V: Number> Fraction<V> {
    #[inline(always)]
    pub(super) fn times(self, factor: V) -> Self {
        Self { above: self.above * factor, ..self }
    }

    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        Self { above: self.above.mul_add(other.below, other.above * self.below), below: self.below * other.below }
    }

    #[inline(always)]
    pub(super) fn value(self) -> V {
        self.above / self.below
    }
}

impl<V> Ramp<V> {
    /// Of the widths, A, of which `lanes` has one a lane: divided once, and not in every row.
    #[inline(always)]
    pub(super) fn of(lanes: impl Fn(&dyn Fn(f64) -> f64) -> V) -> Self {
        Self { width: lanes(&|width| width.max(NARROWEST)), per_width: lanes(&|width| 1.0 / width.max(NARROWEST)) }
    }
}

impl<V: Number> Ramp<V> {
    #[inline(always)]
    pub(super) fn at(self, i: V) -> V {
        let one = i.constant(1.0);
        (i * self.per_width).lower(one).higher(-one)
    }

    /// One where a current flows out of its leg, zero where it flows in.
    #[inline(always)]
    pub(super) fn out(self, i: [V; 3]) -> [V; 3] {
        let (zero, half, one) = (self.width.constant(0.0), self.width.constant(0.5), self.width.constant(1.0));
        let slope = half * self.per_width;
        let mut out = i;
        for one_out in &mut out {
            *one_out = slope.mul_add(*one_out, half).lower(one).higher(zero);
        }
        out
    }

    /// Its mean while its argument goes from one value to the next and on to the last, each way with a weight of its own.
    #[inline(always)]
    pub(super) fn means(self, [from, between, to]: [V; 3], weights: [V; 2]) -> Fraction<V> {
        self.mean(from, between).times(weights[0]).plus(self.mean(between, to).times(weights[1]))
    }

    /// Its mean while its argument goes from one value to another.
    #[inline(always)]
    fn mean(self, from: V, to: V) -> Fraction<V> {
        // Over a short way the ramp is straight, or about to be.
        let straight = self.at(from.constant(0.5) * (from + to));
        let way = to - from;
        let long = from.constant(SHORT).mul_add(from.abs() + to.abs(), from.constant(SHORTEST));
        let integrals = self.integral(to) - self.integral(from);
        Fraction { above: long.if_less(way.abs(), integrals, straight), below: long.if_less(way.abs(), way, way.constant(1.0)) }
    }

    /// Its integral: a parabola up to the width, straight from there on.
    #[inline(always)]
    fn integral(self, i: V) -> V {
        // Half the square of the part that lies within the width, over the width, and all that lies beyond.
        let (half, way) = (i.constant(0.5), i.abs());
        let within = way.lower(self.width);
        (half * self.per_width * within).mul_add(within, way - within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_mean_is_that_of_many_points(from in -3.0..3.0f64, to in -3.0..3.0f64, width in 0.01..2.0f64) {
            const POINTS: u32 = 20_000;
            let point = |k: u32| ((from + (to - from) * (f64::from(k) + 0.5) / f64::from(POINTS)) / width).clamp(-1.0, 1.0);
            let expected = (0..POINTS).map(point).sum::<f64>() / f64::from(POINTS);
            prop_assert!((Ramp::of(|of_width| of_width(width)).mean(from, to).value() - expected).abs() < 1e-4);
        }
    }
}
