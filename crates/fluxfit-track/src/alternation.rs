//! The error of voltages that are computed from means of two periods.
//!
//! A row of centred voltages has the mean of the vectors before and after it, so each vector follows from the one before it:
//! `u[k] = 2 mean[k] - u[k-1]`. An error of the first vector stays in all vectors, with its sign changing from period to period, in the
//! stator's frame; each rounding of the log adds to it. Left in, it made L_d 6 % wrong where a noisy log began in the middle of a drive,
//! and thirteen times too large in a log without noise.
//!
//! No mean shows a voltage that alternates from period to period, so the log cannot tell it; a drive makes none. The mean of what
//! alternates in the computed vectors is therefore the error, and is subtracted. It is found by second differences in the rotor's frame,
//! where the voltage itself is smooth. Later periods have more weight, so that a step of the voltage soon matters no more. The first
//! periods serve for this mean alone.
//!
//! How long a mean should be depends on the log: roundings to 0.01 V add up to 0.1 V in 300 periods, so that a short one is better, while
//! a short one of exact voltages takes their noise for the error. So means of several lengths run, and that is used which has predicted the
//! next second differences best.

use serde::{Deserialize, Serialize};

/// Periods of the means. Of the noise of the voltages a third is left in the shortest, and a thirtieth in the longest.
const MEMORIES: [f64; 3] = [10.0, 100.0, 1e3];

/// Periods until a mean is used: a fifth of the noise of the voltages is left in it, and a thousandth of a step at the beginning.
const KNOWN: f64 = 30.0;

/// Periods between a mean and the second difference that it predicts: so many that they have no voltage in common.
const AHEAD: usize = 3;

/// Periods over which the errors of the predictions are averaged: as long as the longest mean.
const JUDGED: f64 = 1e3;

/// Least part of the alternating vector in a second difference: where the rotor turns by 90 degrees in a period.
const LEAST_SEEN: f64 = 0.5;

/// A mean of what alternates.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Mean {
    /// In the stator's frame, V, with the sign of the first period; the newest first.
    vectors: [[f64; 2]; AHEAD + 1],
    /// Mean square of the errors of its predictions, V².
    error: f64,
}

/// The part that alternates.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Alternation {
    means: [Mean; MEMORIES.len()],
    /// Which of them is used.
    best: usize,
    /// Periods that they rest on.
    periods: f64,
    sign: f64,
    /// The last two vectors in the rotor's frame, newest first, V; how many there are; and the angle of the newest.
    last: [[f64; 2]; 2],
    count: u8,
    angle: f64,
}

pub(crate) fn turned(v: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]]
}

impl Mean {
    /// Takes what was seen, with this weight, and judges its prediction of that with another.
    fn take(&mut self, seen: [f64; 2], part: f64, judged: f64) {
        let [now, .., before] = self.vectors;
        let error = (seen[0] - before[0]).powi(2) + (seen[1] - before[1]).powi(2);
        self.error += judged * (error - self.error);
        self.vectors.rotate_right(1);
        self.vectors[0] = [0, 1].map(|c| now[c] + part * (seen[c] - now[c]));
    }
}

impl Alternation {
    /// From a first row on: a drive that was off before it makes the first vector right.
    pub(crate) fn new(first: [f64; 2]) -> Self {
        let is_at_rest = first == [0.0; 2];
        let longest = MEMORIES.len() - 1;
        Self { best: longest, periods: if is_at_rest { MEMORIES[longest] } else { 0.0 }, sign: -1.0, ..Self::default() }
    }

    /// Whether the vectors can be used.
    pub(crate) fn is_known(&self) -> bool {
        self.periods >= KNOWN
    }

    /// The vector of the next period, in the rotor's frame at this angle, without the part that alternates.
    pub(crate) fn without(&mut self, u: [f64; 2], angle: f64) -> [f64; 2] {
        if self.count == 2 {
            let [newest, older] = self.last;
            // The difference of an alternating vector is four times the vector, or less where the rotor turns between the three periods.
            let part_seen = (0.5 * (1.0 + (angle - self.angle).cos())).max(LEAST_SEEN);
            let change = [0, 1].map(|c| (2.0 * newest[c] - older[c] - u[c]) / (4.0 * part_seen));
            let seen = turned(change, self.angle);
            self.periods += 1.0;
            // The weight of a period is its number, until the memory is full. The first predictions are none.
            let part = |memory: f64| 2.0 / (memory.min(self.periods) + 1.0);
            let judged = if self.is_known() { part(JUDGED) } else { 0.0 };
            for (mean, memory) in self.means.iter_mut().zip(MEMORIES) {
                mean.take(seen.map(|seen| self.sign * seen), part(memory), judged);
            }
            if self.is_known() {
                let error = |place: &usize| self.means[*place].error;
                // Of equal ones the longest.
                self.best = (0..MEMORIES.len()).rev().min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or(self.best);
            }
        }
        self.sign = -self.sign;
        self.last = [u, self.last[0]];
        self.count = 2.min(self.count + 1);
        self.angle = angle;
        let wrong = turned(self.means[self.best].vectors[0], -angle);
        [u[0] - self.sign * wrong[0], u[1] - self.sign * wrong[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vector of 40 V that turns with the rotor and steps to 50 V and back at first, wrong by 3 V and -2 V in turn.
    #[test]
    fn what_alternates_is_taken_out() {
        let mut alternation = Alternation::new([40.0, 0.0]);
        let mut left: f64 = 0.0;
        for k in 0..2000 {
            let (angle, sign) = (0.4 * f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 });
            let right = [1e-3 * f64::from(k), if k == 5 { 50.0 } else { 40.0 }];
            let wrong = turned([3.0 * sign, -2.0 * sign], -angle);
            let [d, q] = alternation.without([right[0] + wrong[0], right[1] + wrong[1]], angle);
            assert_eq!(alternation.is_known(), k > 30);
            if k > 1000 {
                left = left.max((d - right[0]).hypot(q - right[1]));
            }
        }
        // A quarter, a half and a quarter of the 10 V are in the fourth to sixth of a thousand periods, whose weights are their numbers.
        assert!(left < 10.0 * (0.25 * 4.0 + 0.5 * 5.0 + 0.25 * 6.0) / (1000.0 * 1001.0 / 2.0) * 1.05, "{left}");
    }

    #[test]
    fn a_drive_that_was_off_leaves_nothing_to_take_out() {
        let mut alternation = Alternation::new([0.0; 2]);
        for k in 0..5000 {
            let right = [10.0, 1e-2 * f64::from(k)];
            let [d, q] = alternation.without(right, 0.04 * f64::from(k));
            assert!((d - right[0]).hypot(q - right[1]) < 1e-9, "{d} {q}");
        }
    }
}
