//! The `coverage` program with few draws, and limits as wide as so few need. `./check --thorough` runs it; coverage.rs is a quick slice.

#![allow(clippy::unwrap_used)]

use fluxfit::{motor::Parameter, objective::acting_voltage::VoltageTiming};
use fluxfit_studies::coverage::Case;

const DRAWS: usize = 100;

/// Of 100 draws more than 13 miss a 95 % interval in less than one case of a thousand: the binomial distribution.
const MOST_MISSED: usize = 13;

/// Four standard errors, 1/sqrt(2 N), of a root-mean-square error.
const RATIO: f64 = 0.29;

/// The normal distribution's 95 %, in standard errors.
const TWO_SIDED: f64 = 1.96;

/// Intervals of a few thousand rows know their own width to a few percent.
const WIDTH: f64 = 0.1;

#[test]
fn errors_are_those_of_the_bound_and_intervals_hold() {
    for case in Case::all() {
        let tally = case.tally(Some(VoltageTiming::Centered), DRAWS).unwrap();
        assert_eq!(tally.with_fault, 0, "{}: faults of a perfect drive", case.name);
        for (parameter, figures) in Parameter::ALL.into_iter().zip(&tally.parameters) {
            let place = format!("{}, {}: {figures:?}", case.name, parameter.symbol());
            println!("{place}");
            assert!(DRAWS - figures.covered <= MOST_MISSED, "{place}");
            assert!((figures.ratio - 1.0).abs() < RATIO, "{place}");
            // A mean of so many errors is one of a standard normal variable over sqrt(N).
            assert!(figures.bias.abs() < 4.0 / (DRAWS as f64).sqrt(), "{place}");
            assert!((figures.half_width / TWO_SIDED - 1.0).abs() < WIDTH, "{place}");
        }
    }
}
