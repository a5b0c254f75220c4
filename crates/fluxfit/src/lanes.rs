//! Numbers of several candidates side by side, as the processor's wide instructions take them, and formulas that hold for one number and
//! for many.
//!
//! Every operation acts on each lane alone and rounds as it does on one number, the fused multiplication and addition too: a candidate has
//! the same bits in every lane, of any width.

use pulp::{NullaryFnOnce, Simd, cast};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number, or one number per lane.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The same constant in every lane.
    fn constant(self, value: f64) -> Self;

    /// `self * factor + sum`, rounded once.
    fn mul_add(self, factor: Self, sum: Self) -> Self;

    /// Without its sign.
    fn abs(self) -> Self;

    /// Where this is less than `other`: `then`, else `otherwise`. What is no number is not less.
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self;

    /// The lower of two numbers; the other's if one is no number.
    fn lower(self, other: Self) -> Self;

    /// The higher of two numbers; the other's if one is no number.
    fn higher(self, other: Self) -> Self;

    /// Whether any number is less than the other's.
    fn any_less(self, other: Self) -> bool;

    /// Writes the numbers of all lanes, as many as there are.
    fn store(self, numbers: &mut [f64]);

    /// Reads them again.
    fn load(self, numbers: &[f64]) -> Self;

    /// Calls what is compiled for the same instructions, but once and not in place: for large work that several callers share.
    fn call<F: NullaryFnOnce>(self, work: F) -> F::Output;

    /// The two constants of a vector.
    #[inline(always)]
    fn constants(self, [d, q]: [f64; 2]) -> [Self; 2] {
        [self.constant(d), self.constant(q)]
    }
}

impl Number for f64 {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, sum: Self) -> Self {
        self.mul_add(factor, sum)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self {
        if self < other { then } else { otherwise }
    }

    #[inline(always)]
    fn lower(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn higher(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn any_less(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn store(self, numbers: &mut [f64]) {
        numbers[0] = self;
    }

    #[inline(always)]
    fn load(self, numbers: &[f64]) -> Self {
        numbers[0]
    }

    #[inline(always)]
    fn call<F: NullaryFnOnce>(self, work: F) -> F::Output {
        work.call()
    }
}

/// A formula for both axes, or for both ends: `both!(axis => a[axis] + b[axis])`. Not a closure: the compiler does not put those in place
/// without optimization across crates, and then calls them for each instruction. A log with dead time took three times as long.
macro_rules! both {
    ($place:ident => $formula:expr) => {
        [
            {
                let $place = 0;
                $formula
            },
            {
                let $place = 1;
                $formula
            },
        ]
    };
}
pub(crate) use both;

/// Numbers in `K` of the processor's vectors: several keep it busy while one waits for its result.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: Simd, const K: usize> {
    set: S,
    vectors: [S::f64s; K],
}

/// Most numbers in a vector of any processor.
const WIDEST: usize = 8;

impl<S: Simd, const K: usize> Lanes<S, K> {
    /// How many numbers these are.
    pub(crate) const COUNT: usize = K * S::F64_LANES;

    /// A number per lane.
    #[inline(always)]
    pub(crate) fn of(set: S, number: impl Fn(usize) -> f64) -> Self {
        let mut numbers = [0.0; WIDEST];
        let mut vectors = [set.splat_f64s(0.0); K];
        for (k, vector) in vectors.iter_mut().enumerate() {
            for (lane, one) in numbers[..S::F64_LANES].iter_mut().enumerate() {
                *one = number(k * S::F64_LANES + lane);
            }
            *vector = S::as_simd_f64s(&numbers[..S::F64_LANES]).0[0];
        }
        Self { set, vectors }
    }

    /// The number of one lane.
    #[inline(always)]
    pub(crate) fn lane(self, lane: usize) -> f64 {
        let mut numbers = [0.0; WIDEST];
        S::as_mut_simd_f64s(&mut numbers[..S::F64_LANES]).0[0] = self.vectors[lane / S::F64_LANES];
        numbers[lane % S::F64_LANES]
    }
}

// The wide instructions of a processor may be used only in functions that are compiled for it: everything between them and the call that
// chose them is compiled in place. Closures and the standard library's functions over arrays are not, except by luck; hence the loops.
impl<S: Simd, const K: usize> Number for Lanes<S, K> {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self { set: self.set, vectors: [self.set.splat_f64s(value); K] }
    }

    #[inline(always)]
    fn mul_add(mut self, factor: Self, sum: Self) -> Self {
        for k in 0..K {
            self.vectors[k] = self.set.mul_add_f64s(self.vectors[k], factor.vectors[k], sum.vectors[k]);
        }
        self
    }

    #[inline(always)]
    fn abs(mut self) -> Self {
        let sign = self.set.splat_f64s(-0.0);
        for k in 0..K {
            let own = self.set.and_f64s(self.vectors[k], sign);
            self.vectors[k] = self.set.xor_f64s(self.vectors[k], own);
        }
        self
    }

    #[inline(always)]
    fn if_less(mut self, other: Self, then: Self, otherwise: Self) -> Self {
        for k in 0..K {
            let less = self.set.less_than_f64s(self.vectors[k], other.vectors[k]);
            // The same on 64 bits of any meaning, which is always compiled in place. `select_f64s` is not: without optimization across
            // crates, AVX2 took five times as long.
            self.vectors[k] = cast(self.set.select_u64s(less, cast(then.vectors[k]), cast(otherwise.vectors[k])));
        }
        self
    }

    #[inline(always)]
    fn lower(mut self, other: Self) -> Self {
        for k in 0..K {
            self.vectors[k] = self.set.min_f64s(self.vectors[k], other.vectors[k]);
        }
        self
    }

    #[inline(always)]
    fn higher(mut self, other: Self) -> Self {
        for k in 0..K {
            self.vectors[k] = self.set.max_f64s(self.vectors[k], other.vectors[k]);
        }
        self
    }

    #[inline(always)]
    fn any_less(self, other: Self) -> bool {
        let counts = self.if_less(other, self.constant(1.0), self.constant(0.0));
        let mut any = false;
        for k in 0..K {
            any |= self.set.reduce_sum_f64s(counts.vectors[k]) > 0.0;
        }
        any
    }

    #[inline(always)]
    fn store(self, numbers: &mut [f64]) {
        for k in 0..K {
            // Whole vectors: what stores a part of one is not compiled in place.
            S::as_mut_simd_f64s(&mut numbers[k * S::F64_LANES..(k + 1) * S::F64_LANES]).0[0] = self.vectors[k];
        }
    }

    #[inline(always)]
    fn load(mut self, numbers: &[f64]) -> Self {
        for k in 0..K {
            self.vectors[k] = S::as_simd_f64s(&numbers[k * S::F64_LANES..(k + 1) * S::F64_LANES]).0[0];
        }
        self
    }

    #[inline(always)]
    fn call<F: NullaryFnOnce>(self, work: F) -> F::Output {
        self.set.vectorize(work)
    }
}

impl<S: Simd, const K: usize> Neg for Lanes<S, K> {
    type Output = Self;

    #[inline(always)]
    fn neg(mut self) -> Self {
        let sign = self.set.splat_f64s(-0.0);
        for k in 0..K {
            self.vectors[k] = self.set.xor_f64s(self.vectors[k], sign);
        }
        self
    }
}

/// An operator on two numbers, lane by lane.
macro_rules! operator {
    ($operator:ident, $method:ident, $instruction:ident) => {
        impl<S: Simd, const K: usize> $operator for Lanes<S, K> {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for k in 0..K {
                    self.vectors[k] = self.set.$instruction(self.vectors[k], other.vectors[k]);
                }
                self
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);
