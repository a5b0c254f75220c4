//! A test for steps of one parameter, as where iron saturates: the generalized likelihood ratio (Willsky and Jones 1976, doi
//! 10.1109/TAC.1976.1101146) over windows of 128 periods.
//!
//! A step of a parameter at the beginning of a window makes the state wrong by `e`, which the filter moves on and corrects like any other
//! error, and moves the innovation of the measured current `c` by `e_c`:
//!
//! ```text
//! e <- Phi e              with each period
//! e <- e - K e_c          with each measurement, of the gain K
//! n += e_c nu/w           g += e_c²/s     with its innovation nu of variance s; w: the same with the weight that an outlier has
//! ```
//!
//! The likelihood ratio of a step is `n²/g`. Without a step the innovations are white, and it is that of chance, `chi²` with one degree of
//! freedom: what the filter does not know well is in `s`, and does not look like a step where it is corrected.

use crate::{
    PARAMETERS,
    real::{Number, Real},
    ud::STATES,
};

/// Periods of a window. A shorter one tells inductances and resistance apart too badly.
const WINDOW: u32 = 128;

/// Periods at the end of a window that tell how large the step was: when in the window it happened is not known, and before it they
/// would make it too small.
const LATE: u32 = 16;

/// Least ratio. Chance exceeds it in one of 4e9 tests: at 10 kHz, with four tests a window, once in 3500 hours.
const RATIO: f64 = 40.0;

/// Largest part of a parameter by which it is thought to step.
const LARGEST: f64 = 0.3;

/// The test.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepTest<T> {
    count: u32,
    /// `e`: of each state, for a step of each parameter by one at the window's beginning.
    wrong: [[T; PARAMETERS]; STATES],
    /// `n` and `g`.
    along: [T; PARAMETERS],
    squared: [T; PARAMETERS],
    /// `n`, and `g` with the weights of outliers, of the last periods alone.
    late: [[T; 2]; PARAMETERS],
}

/// A step that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<T> {
    /// Place of the parameter.
    pub parameter: usize,
    /// By how much its state changed.
    pub size: T,
}

impl<T: Number> StepTest<T> {
    /// At the beginning of a window.
    pub fn new() -> Self {
        let mut wrong = [[T::ZERO; PARAMETERS]; STATES];
        (0..PARAMETERS).for_each(|j| wrong[STATES - PARAMETERS + j][j] = T::ONE);
        Self { count: 0, wrong, along: [T::ZERO; PARAMETERS], squared: [T::ZERO; PARAMETERS], late: [[T::ZERO; 2]; PARAMETERS] }
    }

    /// Calls `with` for each sum and that of another test.
    #[inline(always)]
    pub(crate) fn with<U>(&mut self, other: &mut StepTest<U>, with: impl Fn(&mut T, &mut U)) {
        for state in 0..STATES {
            for j in 0..PARAMETERS {
                with(&mut self.wrong[state][j], &mut other.wrong[state][j]);
            }
        }
        for j in 0..PARAMETERS {
            with(&mut self.along[j], &mut other.along[j]);
            with(&mut self.squared[j], &mut other.squared[j]);
            with(&mut self.late[j][0], &mut other.late[j][0]);
            with(&mut self.late[j][1], &mut other.late[j][1]);
        }
    }

    /// Whether a window begins.
    pub fn is_new(&self) -> bool {
        self.count == 0
    }

    /// Whether the window is in its last periods: one, else zero.
    pub fn late(&self) -> T {
        if self.count >= WINDOW - LATE { T::ONE } else { T::ZERO }
    }

    /// Notes that the states moved on: the first two rows of the transition, as in [`Ud::propagate`](crate::ud::Ud::propagate).
    #[inline(always)]
    pub fn propagate(&mut self, phi: &[[T; STATES]; 2]) {
        let mut moved = [[T::ZERO; PARAMETERS]; 2];
        for (sums, row) in moved.iter_mut().zip(phi) {
            for (phi, wrong) in row.iter().zip(&self.wrong) {
                for j in 0..PARAMETERS {
                    sums[j] += *phi * wrong[j];
                }
            }
        }
        [self.wrong[0], self.wrong[1]] = moved;
    }

    /// Notes a measurement of a state: its innovation and the variance of that, then what [`Ud::measure`](crate::ud::Ud::measure) gave.
    /// `late` is [`Self::late`].
    #[inline(always)]
    pub fn note(&mut self, state: usize, innovation: T, variance: T, (gain, weighted): &([T; STATES], T), late: T) {
        let (per_variance, per_weighted) = (T::ONE / variance, T::ONE / *weighted);
        let own = self.wrong[state];
        let mut share = own;
        for share in &mut share {
            *share = *share * per_weighted;
        }
        for j in 0..PARAMETERS {
            self.along[j] += share[j] * innovation;
            self.squared[j] += own[j] * own[j] * per_variance;
        }
        for j in 0..PARAMETERS {
            self.late[j][0] += late.if_above(T::ZERO, share[j] * innovation, T::ZERO);
            self.late[j][1] += late.if_above(T::ZERO, share[j] * own[j], T::ZERO);
        }
        for (wrong, gain) in self.wrong.iter_mut().zip(gain) {
            for j in 0..PARAMETERS {
                wrong[j] -= *gain * share[j];
            }
        }
    }

    /// Notes that the filter goes on from a measured current: what the step did to the current before is no longer in it.
    pub fn forget_current(&mut self) {
        [self.wrong[0], self.wrong[1]] = [[T::ZERO; PARAMETERS]; 2];
    }
}

impl<T: Real> StepTest<T> {
    /// Ends a period. At the end of a window: the step of a parameter that may change, if there was one.
    pub fn end_period(&mut self, may_change: [bool; PARAMETERS]) -> Option<Step<T>> {
        self.count += 1;
        if self.count < WINDOW {
            return None;
        }
        let found = self.step(may_change);
        *self = Self::new();
        found
    }

    fn step(&self, may_change: [bool; PARAMETERS]) -> Option<Step<T>> {
        let mut largest = (0, T::ZERO);
        for j in (0..PARAMETERS).filter(|j| may_change[*j] && self.squared[*j] > T::ZERO) {
            let ratio = self.along[j] * self.along[j] / self.squared[j];
            if ratio > largest.1 {
                largest = (j, ratio);
            }
        }
        let (parameter, ratio) = largest;
        let [along, weighted] = self.late[parameter];
        (ratio > T::of(RATIO) && weighted > T::ZERO).then(|| {
            let size = (along / weighted).smaller(T::of(LARGEST)).larger(T::of(-LARGEST));
            Step { parameter, size }
        })
    }
}

impl<T: Number> Default for StepTest<T> {
    fn default() -> Self {
        Self::new()
    }
}
