//! One parameter over all motors of a fleet: median, spread, and the motors that stand apart.
//!
//! A motor stands apart if it is farther from the median than the spread of the motors and its own interval explain together:
//!
//! ```text
//! |x - median| > k sqrt(spread^2 + standard error^2),   spread = 1.4826 median |x - median|
//! ```
//!
//! so that a value that is hardly known is no outlier. The median absolute deviation does not grow with the outliers; B. Iglewicz and D. C.
//! Hoaglin, "How to detect and handle outliers", ASQC Quality Press, 1993, whose limit is 3.5. Of many motors some are beyond it by
//! chance: the limit then is that which one of twenty fleets of normal motors exceeds.

use super::{member::Member, row::FleetValue};
use crate::{Verdict, motor::Parameter};
use statrs::distribution::{ContinuousCDF, Normal};

/// Fewer motors than these have no spread from which one could stand apart: that of ten is uncertain by a quarter.
pub const LEAST_MOTORS: usize = 10;

/// Standard deviation of normal values with a median absolute deviation of one.
const NORMAL: f64 = 1.4826;

/// Smallest distance of an outlier, in standard deviations: Iglewicz and Hoaglin.
const LIMIT: f64 = 3.5;

/// Probability that one motor or more of a fleet stands apart by chance.
pub(super) const CHANCE: f64 = 0.05;

/// Part of the motors within the middle range, and how many there must be for one to lie outside of it on either side.
const MIDDLE: f64 = 0.95;
const WITH_MIDDLE: usize = 40;

/// A parameter over all motors.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// The parameter.
    pub parameter: Parameter,
    /// Motors with an answer by verdict, in the order identified, weak, not identifiable.
    pub verdicts: [usize; 3],
    /// The motors that have a value found from their log, by their place among the fleet's motors, in order of the value.
    pub values: Vec<(usize, FleetValue)>,
    /// What is typical; `None` without any value.
    pub typical: Option<Typical>,
    /// The motors that stand apart, the farthest first.
    pub outliers: Vec<Outlier>,
}

/// What is typical of the motors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Typical {
    /// Median of the values.
    pub median: f64,
    /// The range of the middle 95 % of the motors; of fewer than forty that of all.
    pub range: [f64; 2],
    /// Median of the half-widths of the 95 % intervals.
    pub half_width: f64,
}

/// A motor that stands apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlier {
    /// Its place among the fleet's motors.
    pub motor: usize,
    /// Its value.
    pub value: FleetValue,
    /// Its distance from the median relative to that.
    pub distance: f64,
    /// The same in standard deviations.
    pub deviations: f64,
}

impl Distribution {
    pub(super) fn of(parameter: Parameter, motors: &[Member]) -> Self {
        let estimates = motors.iter().map(|motor| (&motor.best, &motor.best.estimates[parameter as usize]));
        let answered = || estimates.clone().filter(|(row, _)| row.error.is_none());
        let verdicts = [Verdict::Identified, Verdict::Weak, Verdict::NotIdentifiable]
            .map(|verdict| answered().filter(|(_, estimate)| estimate.verdict == verdict).count());
        let found = estimates.clone().enumerate().filter_map(|(motor, (_, estimate))| Some((motor, estimate.found()?)));
        let mut values: Vec<(usize, FleetValue)> = found.collect();
        values.sort_by(|(_, one), (_, other)| one.value.total_cmp(&other.value));
        let typical = Typical::of(&values);
        let outliers = typical.map(|typical| outliers(&values, typical.median)).unwrap_or_default();
        Self { parameter, verdicts, values, typical, outliers }
    }
}

impl Typical {
    /// Of values in their order.
    fn of(values: &[(usize, FleetValue)]) -> Option<Self> {
        let sorted: Vec<f64> = values.iter().map(|(_, value)| value.value).collect();
        let part = |part: f64| quantile(&sorted, part);
        let outside = if sorted.len() < WITH_MIDDLE { 0.0 } else { 0.5 * (1.0 - MIDDLE) };
        Some(Self {
            median: part(0.5)?,
            range: [part(outside)?, part(1.0 - outside)?],
            half_width: median_of(values.iter().map(|(_, value)| value.half_width))?,
        })
    }
}

fn outliers(values: &[(usize, FleetValue)], median: f64) -> Vec<Outlier> {
    let absolute = median_of(values.iter().map(|(_, value)| (value.value - median).abs()));
    let Some(spread) = absolute.map(|absolute| NORMAL * absolute).filter(|_| values.len() >= LEAST_MOTORS) else { return Vec::new() };
    let limit = limit(values.len());
    let outlier = |(motor, value): &(usize, FleetValue)| {
        let distance = value.value - median;
        let deviations = distance / spread.hypot(value.standard_error());
        (deviations.abs() > limit).then_some(Outlier { motor: *motor, value: *value, distance: distance / median.abs(), deviations })
    };
    let mut outliers: Vec<Outlier> = values.iter().filter_map(outlier).collect();
    outliers.sort_by(|one, other| other.deviations.abs().total_cmp(&one.deviations.abs()).then(one.motor.cmp(&other.motor)));
    outliers
}

/// How many standard deviations are too many, of so many normal motors.
fn limit(motors: usize) -> f64 {
    let quantile = Normal::standard().inverse_cdf(1.0 - CHANCE / (2.0 * motors as f64));
    quantile.max(LIMIT)
}

/// A quantile of sorted values, interpolated between neighbours.
fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let place = part * sorted.len().saturating_sub(1) as f64;
    let (low, high) = (sorted.get(place.floor() as usize), sorted.get(place.ceil() as usize));
    low.zip(high).map(|(low, high)| low + (high - low) * place.fract())
}

fn median_of(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_a_textbook() {
        let sorted = [1.0, 2.0, 4.0, 8.0];
        assert_eq!([0.0, 0.5, 1.0].map(|part| quantile(&sorted, part)), [Some(1.0), Some(3.0), Some(8.0)]);
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn the_limit_grows_with_the_fleet() {
        // Tables of the normal distribution: 2.807 for 0.05 / 20 on both sides, 4.565 for 0.05 / 10 000.
        assert_eq!(limit(10), LIMIT);
        assert!((limit(10_000) - 4.565).abs() < 1e-3, "{}", limit(10_000));
    }
}
