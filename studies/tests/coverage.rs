//! A slice of the `coverage` program that takes no time: everyday mistakes would move its numbers. The statistics are in
//! coverage_statistics.rs.

#![allow(clippy::unwrap_used)]

use fluxfit::{motor::Parameter, objective::acting_voltage::VoltageTiming};
use fluxfit_studies::coverage::{Case, Tally};

const DRAWS: usize = 16;

/// Of 16 draws more than 5 miss a 95 % interval in less than one case of a thousand: the binomial distribution.
const MOST_MISSED: usize = 5;

/// Four standard errors, 1/sqrt(2 N), of a root-mean-square error.
const RATIO: f64 = 0.71;

/// The case that is quickest.
fn acceleration(threads: usize) -> Tally {
    let [_, acceleration, ..] = Case::all();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| acceleration.tally(Some(VoltageTiming::Centered), DRAWS).unwrap())
}

#[test]
fn a_few_errors_are_near_the_bound() {
    let tally = acceleration(2);
    assert_eq!(tally.with_fault, 0, "faults of a perfect drive");
    for (parameter, figures) in Parameter::ALL.into_iter().zip(&tally.parameters) {
        assert!(DRAWS - figures.covered <= MOST_MISSED, "{}: {figures:?}", parameter.symbol());
        assert!((figures.ratio - 1.0).abs() < RATIO, "{}: {figures:?}", parameter.symbol());
    }
}

/// Results come in index order and sums in theirs, whatever the threads do.
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    assert_eq!(format!("{:?}", acceleration(1)), format!("{:?}", acceleration(3)));
}
