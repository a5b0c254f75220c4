//! Numbers of several filters side by side.
//!
//! Every operation acts on each lane alone and rounds as it does on one number. The loops over the lanes are plain ones, which the compiler
//! turns into the wide instructions of the processor that it compiles for.

use crate::real::{NEAR_ZERO, Number, exp_m1_by_series};
use core::{
    array::from_fn,
    ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign},
};

/// How many lanes: the widest vector of any processor.
pub const LANES: usize = 8;

/// A number per lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn each(mut self, function: impl Fn(f64) -> f64) -> Self {
        for lane in &mut self.0 {
            *lane = function(*lane);
        }
        self
    }

    #[inline(always)]
    fn both(mut self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        for k in 0..LANES {
            self.0[k] = function(self.0[k], other.0[k]);
        }
        self
    }

    /// For functions that take long: lanes with the number of the first one, as unused lanes have it, take its result.
    #[inline(always)]
    fn each_different(self, function: impl Fn(f64) -> f64) -> Self {
        let first = function(self.0[0]);
        self.each(|lane| if lane.to_bits() == self.0[0].to_bits() { first } else { function(lane) })
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident) => {
        impl $operator for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.both(other, |a, b| a.$method(b))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|lane| -lane)
    }
}

impl Number for Lanes {
    const ZERO: Self = Self([0.0; LANES]);
    const ONE: Self = Self([1.0; LANES]);

    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::all(value)
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        let mut largest = self.0[0];
        for lane in self.0 {
            largest = largest.larger(lane);
        }
        largest
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(Number::sqrt)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.each(|lane| lane.abs())
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let first = Number::sin_cos(self.0[0]);
        let both: [(f64, f64); LANES] =
            from_fn(|k| if self.0[k].to_bits() == self.0[0].to_bits() { first } else { Number::sin_cos(self.0[k]) });
        (Self(from_fn(|k| both[k].0)), Self(from_fn(|k| both[k].1)))
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.each_different(Number::ln)
    }

    #[inline(always)]
    fn exp_m1(self) -> Self {
        // A filter that has settled changes little with each measurement.
        if self.0.iter().all(|lane| lane.abs() <= NEAR_ZERO) { exp_m1_by_series(self) } else { self.each_different(Number::exp_m1) }
    }

    #[inline(always)]
    fn if_above(mut self, other: Self, then: Self, otherwise: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].if_above(other.0[k], then.0[k], otherwise.0[k]);
        }
        self
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.both(other, Number::larger)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.both(other, Number::smaller)
    }
}
