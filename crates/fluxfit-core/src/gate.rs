//! Whether the blocks of the last half a second excite the parameters: only then may older ones be forgotten. Without excitation,
//! forgetting erases what is known and the estimate runs away.

use crate::real::Real;

/// Blocks of one of the two windows that the memory consists of: half of the 100 blocks after which 0.99 forgets.
const WINDOW: u32 = 50;

/// Part of the rating by which mean i_d or speed must vary.
const SPREAD: f64 = 0.05;

/// Least and largest value of i_d and speed in a window.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Extent<T> {
    least: [T; 2],
    most: [T; 2],
}

/// The variation of i_d and speed over the last one to two windows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gate<T> {
    now: Option<Extent<T>>,
    before: Option<Extent<T>>,
    count: u32,
    /// Rated current, A, and speed, electrical rad/s; the largest values seen, where they are not stated.
    rating: [T; 2],
    is_stated: bool,
}

impl<T: Real> Extent<T> {
    fn with(self, values: [T; 2]) -> Self {
        let both = |pick: fn(T, T) -> T, own: [T; 2]| [pick(own[0], values[0]), pick(own[1], values[1])];
        Self { least: both(T::smaller, self.least), most: both(T::larger, self.most) }
    }
}

impl<T: Real> Gate<T> {
    /// A gate for a motor with a rated current, A, and speed, electrical rad/s; without them the largest values seen stand for both.
    pub fn new(rating: Option<[T; 2]>) -> Self {
        Self { now: None, before: None, count: 0, rating: rating.unwrap_or([T::ZERO; 2]), is_stated: rating.is_some() }
    }

    /// Notes a block: mean i_d, A, magnitude of the current, A, and mean speed.
    pub fn note(&mut self, id: T, current: T, omega_e: T) {
        if !self.is_stated {
            self.rating = [self.rating[0].larger(current), self.rating[1].larger(omega_e.abs())];
        }
        let values = [id, omega_e];
        self.now = Some(self.now.map_or(Extent { least: values, most: values }, |extent| extent.with(values)));
        self.count += 1;
        if self.count == WINDOW {
            (self.before, self.now, self.count) = (self.now, None, 0);
        }
    }

    /// Whether i_d or the speed varied enough.
    pub fn is_open(&self) -> bool {
        let whole = match (self.now, self.before) {
            (Some(now), Some(before)) => now.with(before.least).with(before.most),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => return false,
        };
        (0..2).any(|c| whole.most[c] - whole.least[c] > T::of(SPREAD) * self.rating[c])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_closes_after_two_windows_without_variation() {
        let mut gate = Gate::<f32>::new(Some([10.0, 400.0]));
        (0..10).for_each(|_| gate.note(0.0, 9.0, 400.0));
        assert!(!gate.is_open());
        gate.note(-2.0, 9.0, 400.0);
        assert!(gate.is_open());
        (0..38).for_each(|_| gate.note(0.0, 9.0, 400.0));
        assert!(gate.is_open());
        (0..101).for_each(|_| gate.note(0.0, 9.0, 400.0));
        assert!(!gate.is_open());
        gate.note(0.0, 9.0, 425.0);
        assert!(gate.is_open());
    }
}
