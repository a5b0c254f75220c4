//! Counts of many numbers: how many are wrong, how many intervals hold the truth, and how wide they are.

use fluxfit::{
    Verdict,
    motor::{PARAMETERS, Parameter},
};
use statrs::distribution::{Beta, ContinuousCDF};

/// A number is wrong beyond this many of its half-widths, and this fraction of the truth.
const HALF_WIDTHS: f64 = 1.5;
const FRACTION: f64 = 5e-4;

/// Probability on either side of the binomial limits.
const TAIL: f64 = 0.025;

/// What was found for a parameter; fractions of the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// The parameter.
    pub parameter: Parameter,
    /// Its verdict; nothing is printed if it is not identifiable.
    pub verdict: Verdict,
    /// Its error; zero if nothing is printed.
    pub error: f64,
    /// Half-width of its 95 % interval; infinite if nothing is printed.
    pub half_width: f64,
}

impl Number {
    /// No number.
    pub fn none(parameter: Parameter) -> Self {
        Self { parameter, verdict: Verdict::NotIdentifiable, error: 0.0, half_width: f64::INFINITY }
    }

    /// Whether there is a number.
    pub fn is_printed(&self) -> bool {
        self.verdict != Verdict::NotIdentifiable
    }

    /// Whether it is printed and far outside of its interval.
    pub fn is_wrong(&self) -> bool {
        self.is_printed() && self.error.abs() > HALF_WIDTHS * self.half_width + FRACTION
    }

    /// Whether its interval holds the truth.
    pub fn holds(&self) -> bool {
        self.error.abs() <= self.half_width
    }
}

/// Counts of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    /// Numbers that were asked for.
    pub asked: usize,
    /// Of them, printed ones.
    pub printed: usize,
    /// Of these, wrong ones.
    pub wrong: usize,
    /// Of the printed ones, those whose interval holds the truth.
    pub held: usize,
    /// Half-widths of the printed ones, for each parameter.
    half_widths: [Vec<f64>; PARAMETERS],
}

impl Tally {
    /// Counts one more.
    pub fn add(&mut self, number: &Number) {
        self.asked += 1;
        if !number.is_printed() {
            return;
        }
        self.printed += 1;
        self.wrong += usize::from(number.is_wrong());
        self.held += usize::from(number.holds());
        self.half_widths[number.parameter as usize].push(number.half_width);
    }

    /// Median half-width of a parameter, if there is any.
    pub fn median_half_width(&self, parameter: Parameter) -> Option<f64> {
        let mut sorted = self.half_widths[parameter as usize].clone();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.len() / 2;
        let upper = *sorted.get(middle)?;
        Some(if sorted.len().is_multiple_of(2) { 0.5 * (upper + sorted[middle - 1]) } else { upper })
    }
}

/// Limits of a probability, 95 %, of which an event came `k` times in `n` independent trials: Clopper and Pearson, "The use of confidence
/// or fiducial limits illustrated in the case of the binomial", 1934, doi 10.1093/biomet/26.4.404.
pub fn binomial_limits(k: usize, n: usize) -> [f64; 2] {
    let (k, n) = (k as f64, n as f64);
    let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).ok().map(|beta| beta.inverse_cdf(p));
    // Without a case on one side there is no such distribution, and the limit is the end of the range.
    [quantile(k, n - k + 1.0, TAIL).unwrap_or(0.0), quantile(k + 1.0, n - k, 1.0 - TAIL).unwrap_or(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(parameter: Parameter, verdict: Verdict, error: f64, half_width: f64) -> Number {
        Number { parameter, verdict, error, half_width }
    }

    /// Textbook values: none of 10 gives up to 1 - 0.025^(1/10); 8 of 10 gives 44.39 to 97.48 %.
    #[test]
    fn limits_are_those_of_clopper_and_pearson() {
        let [low, high] = binomial_limits(0, 10);
        assert!(low == 0.0 && (high - (1.0 - 0.025_f64.powf(0.1))).abs() < 1e-6, "{low} {high}");
        let [low, high] = binomial_limits(8, 10);
        assert!((low - 0.4439).abs() < 1e-4 && (high - 0.9748).abs() < 1e-4, "{low} {high}");
        let [low, high] = binomial_limits(10, 10);
        assert!((low - 0.025_f64.powf(0.1)).abs() < 1e-6 && high == 1.0, "{low} {high}");
    }

    #[test]
    fn numbers_are_counted() {
        let mut tally = Tally::default();
        for number in [
            // Inside its interval; outside of it but not wrong; wrong; not wrong for the 0.05 %; not printed.
            number(Parameter::Rs, Verdict::Identified, -0.009, 0.01),
            number(Parameter::Rs, Verdict::Identified, 0.0154, 0.01),
            number(Parameter::Rs, Verdict::Weak, 0.0156, 0.01),
            number(Parameter::Ld, Verdict::Identified, 4.9e-4, 0.0),
            Number::none(Parameter::Lq),
        ] {
            tally.add(&number);
        }
        assert_eq!((tally.asked, tally.printed, tally.wrong, tally.held), (5, 4, 1, 1));
        assert_eq!(tally.median_half_width(Parameter::Rs), Some(0.01));
        assert_eq!(tally.median_half_width(Parameter::Lq), None);
    }

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two() {
        let mut tally = Tally::default();
        for half_width in [0.04, 0.01, 0.02, 0.03] {
            tally.add(&number(Parameter::PsiF, Verdict::Identified, 0.0, half_width));
        }
        assert!((tally.median_half_width(Parameter::PsiF).unwrap() - 0.025).abs() < 1e-15);
    }
}
