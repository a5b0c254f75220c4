//! One parameter of one motor from window to window: whether it moves by more than its intervals say.
//!
//! With the mean weighted by the inverse squares of the standard errors, the sum of squares
//!
//! ```text
//! Q = sum ((x_k - mean) / standard error_k)^2
//! ```
//!
//! of a parameter that stays is chi-squared with one degree of freedom less than there are windows: W. G. Cochran, "The combination of
//! estimates from different experiments", Biometrics 10 (1954) 101, doi:10.2307/3001666. The parts of the intervals that all windows have
//! in common, such as the accuracy of the voltages, do not move a parameter: the probability is too large rather than too small.

use super::row::{FleetRow, FleetValue};
use crate::motor::Parameter;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// A parameter of a motor over its windows.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// The motor's place among the fleet's motors.
    pub motor: usize,
    /// The parameter.
    pub parameter: Parameter,
    /// The windows in which it has a value, in order of time.
    pub points: Vec<DriftPoint>,
    /// The largest value less the smallest, relative to their mean.
    pub range: f64,
    /// The last value less the first, relative to the mean.
    pub change: f64,
    /// Probability that a parameter that stays moves as much.
    pub probability: f64,
}

/// A parameter in a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriftPoint {
    /// Start of the window, s.
    pub start: f64,
    /// The value.
    pub value: FleetValue,
}

impl Drift {
    /// The parameter of a motor over its rows, which are in order of time; `None` with fewer than two windows that tell it.
    pub(super) fn of(parameter: Parameter, rows: &[FleetRow]) -> Option<Self> {
        let point = |row: &FleetRow| {
            let value = row.estimates[parameter as usize].found()?;
            Some(DriftPoint { start: row.window_start?, value })
        };
        let points: Vec<DriftPoint> = rows.iter().filter_map(point).collect();
        let ([first, .., last], degrees) = (points.as_slice(), points.len().saturating_sub(1)) else { return None };
        let weight = |point: &DriftPoint| point.value.standard_error().powi(-2);
        let weights: f64 = points.iter().map(weight).sum();
        let mean = points.iter().map(|point| weight(point) * point.value.value).sum::<f64>() / weights;
        let squares: f64 = points.iter().map(|point| weight(point) * (point.value.value - mean).powi(2)).sum();
        let probability = ChiSquared::new(degrees as f64).map_or(1.0, |distribution| distribution.sf(squares));
        let values = || points.iter().map(|point| point.value.value);
        let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
        let change = last.value.value - first.value.value;
        let (range, change) = (range / mean.abs(), change / mean.abs());
        let is_number = [range, change, probability].iter().all(|number| number.is_finite());
        is_number.then_some(Self { motor: 0, parameter, range, change, probability, points })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Verdict, fleet::row::FleetEstimate};

    fn windows(values: &[f64], half_width: f64) -> Vec<FleetRow> {
        let row = |(k, value): (usize, &f64)| {
            let found = FleetEstimate { verdict: Verdict::Identified, value: Some(FleetValue { value: *value, half_width }), reason: None };
            FleetRow {
                motor: "m".into(),
                source: "s".into(),
                window_start: Some(60.0 * k as f64),
                estimates: std::array::from_fn(|_| found.clone()),
                warnings: Vec::new(),
                error: None,
            }
        };
        values.iter().enumerate().map(row).collect()
    }

    #[test]
    fn the_probability_is_that_of_a_table_of_chi_squared() {
        // Three windows one standard error from each other: Q = 1 + 0 + 1 = 2 with two degrees of freedom, exp(-2 / 2).
        let drift = Drift::of(Parameter::Rs, &windows(&[0.99, 1.0, 1.01], 0.01 * 1.959_964)).unwrap();
        assert!((drift.probability - (-1.0_f64).exp()).abs() < 1e-6, "{}", drift.probability);
        assert!((drift.range - 0.02).abs() < 1e-12 && (drift.change - 0.02).abs() < 1e-12);
    }

    #[test]
    fn a_motor_with_one_window_does_not_drift() {
        assert_eq!(Drift::of(Parameter::Rs, &windows(&[1.0], 0.01)), None);
        assert_eq!(Drift::of(Parameter::Rs, &windows(&[1.0, 2.0], 0.0)), None, "given values");
    }
}
