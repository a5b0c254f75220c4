//! Times of even rows that were written with few digits: 0, 0.00013, 0.00025, 0.00038. Some rows seem to be one digit further apart than
//! others, and the usual distance is not the mean. Where every time is what rounding makes of even ones, it is these that the drive had.

use super::{
    channels::Channels,
    rounded_time::{median, shortest},
};
use crate::channel::Channel;
use fluxfit::log::without_gaps;
use fluxfit_units::significant;
use std::ops::Range;

/// Fewest rows whose times are made even.
const FEWEST: usize = 30;

/// Digits smaller than this part of a period change no answer.
const SMALL: f64 = 1e-3;

/// Digits larger than this part of a period hide a missing row,
const LARGE: f64 = 0.25;

/// and are believed if at least this share of the steps is longer: fewer are rows that were lost.
const LONGER: f64 = 0.1;

/// Digits by which a written time may differ from the even one: half a digit, and what the line through all of them misses.
const OFF: f64 = 0.75;

/// Most digits behind the point, and most significant ones, that are looked for.
const MOST: i32 = 9;

/// By how much of its last digit a number may differ from a whole number of them.
const WHOLE: f64 = 1e-4;

/// By which part a number of single precision may differ from it after it was written as decimals.
const SINGLE: f64 = 1e-9;

/// Bits of a single behind the first.
const SINGLE_BITS: i32 = 23;

/// Makes such times even; returns a note.
pub(super) fn settle(channels: &mut Channels) -> Option<String> {
    let Even { t, period, digit } = Even::of(channels.get(Channel::T)?)?;
    let accuracy = 2.0 * digit / (period * t.len() as f64);
    let (digit, period) = (significant(1e6 * digit, 2), shortest(1e3 * period, accuracy));
    channels.set(Channel::T, t);
    Some(format!("t: times are rounded to {digit} us; rows {period} ms apart explain all of them, and are read in their place"))
}

/// Even times.
struct Even {
    t: Vec<f64>,
    /// s.
    period: f64,
    /// The largest last digit of those that were written, s.
    digit: f64,
}

impl Even {
    /// Nothing of times that are even as they are written, or that rounding does not explain.
    fn of(t: &[f64]) -> Option<Self> {
        let steps = || t.windows(2).map(|pair| pair[1] - pair[0]);
        // Those of most logs are even as they are.
        let first = steps().next()?;
        if t.len() < FEWEST || steps().all(|step| (step - first).abs() <= SMALL * first) || steps().any(|step| step.is_nan() || step <= 0.0)
        {
            return None;
        }
        let usual = median(steps().collect());
        LastDigit::all_of(t).find_map(|digit| Self::by(digit, t, usual))
    }

    /// The same if these are the digits, and rows usually so far apart, s.
    fn by(last: LastDigit, t: &[f64], usual: f64) -> Option<Self> {
        let digit = t.iter().map(|time| last.of(*time)).fold(0.0, f64::max);
        let longer = t.windows(2).filter(|pair| (pair[1] - pair[0] - usual).abs() > 0.5 * digit).count();
        let are_lost = digit > LARGE * usual && (longer as f64) < LONGER * t.len() as f64;
        if digit <= SMALL * usual || are_lost {
            return None;
        }
        let counted = |row: usize| if digit > LARGE * usual { 1.0 } else { ((t[row] - t[row - 1]) / usual).round() };
        let counts = |rows: &Range<usize>| -> Vec<f64> {
            let further = rows.clone().skip(1).scan(0.0, |count, row| {
                *count += counted(row);
                Some(*count)
            });
            std::iter::once(0.0).chain(further).collect()
        };
        let stretches = without_gaps(t);
        let lines: Vec<Line> = stretches.iter().map(|rows| Line::of(&counts(rows), &t[rows.clone()])).collect();
        let sum = |of: &dyn Fn(&Line) -> f64| lines.iter().map(of).sum::<f64>();
        let period = sum(&|line| line.covariance) / sum(&|line| line.variance);
        let of_stretch = |(rows, line): (&Range<usize>, &Line)| {
            let even = counts(rows).into_iter().map(|count| line.time + period * (count - line.count));
            even.collect::<Vec<f64>>()
        };
        let even: Vec<f64> = stretches.iter().zip(&lines).flat_map(of_stretch).collect();
        let is_rounded = |(even, time): (&f64, &f64)| (even - time).abs() <= OFF * last.of(*time).max(SMALL * usual);
        // Even times with a gap are so as they are.
        let moves = even.iter().zip(t).any(|(even, time)| (even - time).abs() > SMALL * usual);
        (moves && even.iter().zip(t).all(is_rounded)).then_some(Self { t: even, period, digit })
    }
}

/// Times over counts of rows, for a line by least squares.
struct Line {
    /// Means.
    count: f64,
    time: f64,
    /// Sums of products of what differs from them.
    covariance: f64,
    variance: f64,
}

impl Line {
    fn of(counts: &[f64], t: &[f64]) -> Self {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (count, time) = (mean(counts), mean(t));
        let both = || counts.iter().map(|other| other - count).zip(t.iter().map(|other| other - time));
        Self { count, time, covariance: both().map(|(k, t)| k * t).sum(), variance: both().map(|(k, _)| k * k).sum() }
    }
}

/// Where times end.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LastDigit {
    /// So many digits behind the point.
    Decimals(i32),
    /// So many digits from the first one that is not zero on.
    Significant(i32),
    /// The last bit of a number of single precision.
    Single,
}

impl LastDigit {
    /// The digit, s, with which a time ends.
    fn of(self, time: f64) -> f64 {
        let size = time.abs();
        match self {
            Self::Decimals(digits) => 10.0_f64.powi(-digits),
            _ if size == 0.0 => 0.0,
            Self::Significant(digits) => 10.0_f64.powi(size.log10().floor() as i32 + 1 - digits),
            Self::Single => 2.0_f64.powi(size.log2().floor() as i32 - SINGLE_BITS),
        }
    }

    /// Whether a time has no more digits than this.
    fn holds(self, time: f64) -> bool {
        if self == Self::Single {
            return (time - f64::from(time as f32)).abs() <= SINGLE * time.abs();
        }
        let digit = self.of(time);
        let digits = if digit > 0.0 { time / digit } else { 0.0 };
        (digits - digits.round()).abs() <= WHOLE
    }

    /// Those with which all of these times may have been written.
    fn all_of(t: &[f64]) -> impl Iterator<Item = Self> {
        let fewest = |kind: fn(i32) -> Self| (0..=MOST).map(kind).find(|last| t.iter().all(|time| last.holds(*time)));
        let single = t.iter().all(|time| Self::Single.holds(*time)).then_some(Self::Single);
        fewest(Self::Decimals).into_iter().chain(fewest(Self::Significant)).chain(single)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even times 1/8000 s apart, of which row 1000 is missing, with a gap of 1 s behind row 3000; written so.
    fn written(with: impl Fn(f64) -> f64) -> Vec<f64> {
        let rows = (0..6000).filter(|row| *row != 1000);
        rows.map(|row| with(f64::from(row) / 8000.0 + if row > 3000 { 1.0 } else { 0.0 })).collect()
    }

    /// All within 1 us of the right distance from the first.
    fn assert_even(t: &[f64]) {
        let even = Even::of(t).expect("rounding explains them");
        assert!((even.period * 8000.0 - 1.0).abs() < 1e-5, "{}", even.period);
        let is_right = |(even_time, exact): (&f64, &f64)| (even_time - even.t[0] - exact).abs() < 1e-6;
        assert!(even.t.iter().zip(&written(|time| time)).all(is_right));
    }

    #[test]
    fn rounded_times_are_made_even() {
        let text = |text: String| text.parse::<f64>().expect("a number");
        assert_even(&written(|time| text(format!("{time:.5}"))));
        assert_even(&written(|time| (time * 1e5).floor() / 1e5));
        // Six significant digits: the last is 1 us from 0.1 s on, and 10 us from 1 s on.
        assert_even(&written(|time| text(format!("{time:.5e}"))));
        assert_even(&written(|time| f64::from((time + 100.0) as f32)));
    }

    #[test]
    fn times_that_rounding_does_not_explain_are_left_alone() {
        // Even as they are, with all their digits; and rows that came late.
        assert!(Even::of(&(0..6000).map(|row| f64::from(row) / 8000.0).collect::<Vec<f64>>()).is_none());
        let late = |row: i32| (1e5 * (f64::from(row) / 8000.0 + if row % 7 == 0 { 3e-5 } else { 0.0 })).round() / 1e5;
        assert!(Even::of(&(0..6000).map(late).collect::<Vec<f64>>()).is_none());
        // Even ones with a missing row and a gap.
        assert!(Even::of(&written(|time| (time * 1e6).round() / 1e6)).is_none());
        // Milliseconds of which some are missing, or every twentieth; and a digit nearly as large as the period with a missing row.
        let kept = |is_lost: fn(i32) -> bool| (0..1000).filter(|row| !is_lost(*row)).map(|row| f64::from(row) / 1e3).collect::<Vec<f64>>();
        assert!(Even::of(&kept(|row| row == 500)).is_none());
        assert!(Even::of(&kept(|row| [250, 251, 750].contains(&row))).is_none());
        assert!(Even::of(&kept(|row| row % 20 == 10)).is_none());
        assert!(Even::of(&written(|time| (time * 1e4).round() / 1e4)).is_none());
    }

    /// 8 kHz in tenths of a millisecond: every fourth step is two digits.
    #[test]
    fn digits_as_long_as_a_period_are_made_even_where_none_is_missing() {
        let t: Vec<f64> = (0..4000).map(|row| (f64::from(row) / 8000.0 * 1e4).round() / 1e4).collect();
        let even = Even::of(&t).expect("rounding explains them");
        assert!((even.period * 8000.0 - 1.0).abs() < 1e-4, "{}", even.period);
    }
}
