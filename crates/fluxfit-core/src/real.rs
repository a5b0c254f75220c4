//! The numbers that the estimators compute with: `f32` in firmware, `f64` on a desktop.

use core::{
    fmt::Debug,
    ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign},
};

/// What the equations need of a number. It is a trait because they run in `f32` in firmware, in `f64` elsewhere, and for several filters
/// at once on [`Lanes`](crate::Lanes).
pub trait Number:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// The nearest number to a constant.
    fn of(value: f64) -> Self;
    /// The largest of its lanes in double precision; of a single number, itself.
    fn largest(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Exponential function less one, with all digits near zero.
    fn exp_m1(self) -> Self;
    /// Where it is above another number `then`, else `otherwise`.
    fn if_above(self, other: Self, then: Self, otherwise: Self) -> Self;
    /// The larger of two numbers; the other one, if one is NaN.
    fn larger(self, other: Self) -> Self;
    /// The smaller of two numbers; the other one, if one is NaN.
    fn smaller(self, other: Self) -> Self;
}

/// Largest size of a number at which [`exp_m1_by_series`] has all digits: the first term left out is `x^7 / 5040`.
pub(crate) const NEAR_ZERO: f64 = 1.0 / 128.0;

/// The exponential function less one by its Taylor series: without a table or a branch, for several numbers at once.
#[inline(always)]
pub(crate) fn exp_m1_by_series<T: Number>(x: T) -> T {
    let term = |n: f64, rest: T| T::of(1.0 / n) + x * rest;
    let rest = term(2.0, term(6.0, term(24.0, term(120.0, T::of(1.0 / 720.0)))));
    x + x * x * rest
}

/// A single floating-point number.
pub trait Real: Number + PartialOrd {
    /// The same number in double precision.
    fn to_f64(self) -> f64;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

macro_rules! real {
    ($number:ty, $sqrt:path, $abs:path, $sincos:path, $ln:path, $exp_m1:path) => {
        impl Number for $number {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn largest(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $abs(self)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $sincos(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline(always)]
            fn exp_m1(self) -> Self {
                if $abs(self) <= Self::of(NEAR_ZERO) { exp_m1_by_series(self) } else { $exp_m1(self) }
            }
            #[inline(always)]
            fn if_above(self, other: Self, then: Self, otherwise: Self) -> Self {
                if self > other { then } else { otherwise }
            }
            #[inline(always)]
            fn larger(self, other: Self) -> Self {
                if self > other || other.is_nan() { self } else { other }
            }
            #[inline(always)]
            fn smaller(self, other: Self) -> Self {
                if self < other || other.is_nan() { self } else { other }
            }
        }

        impl Real for $number {
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                <$number>::is_finite(self)
            }
        }
    };
}

real!(f32, libm::sqrtf, libm::fabsf, libm::sincosf, libm::logf, libm::expm1f);
real!(f64, libm::sqrt, libm::fabs, libm::sincos, libm::log, libm::expm1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_and_the_function_agree_up_to_the_last_digit() {
        for k in 0..=1000 {
            let x = NEAR_ZERO * (f64::from(k) / 500.0 - 1.0);
            let expected = libm::expm1(x);
            assert!((Number::exp_m1(x) - expected).abs() <= f64::EPSILON * expected.abs(), "{x}");
        }
    }
}
