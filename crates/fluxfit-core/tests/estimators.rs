//! The estimators against `oracles/estimators.py`, which computes the same with matrix exponentials, complex steps, a full covariance and
//! a solver for all equations at once.

#![allow(clippy::unwrap_used)]

use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings, Period};
use serde_json::Value;

fn numbers() -> Value {
    serde_json::from_str(include_str!("estimators.json")).unwrap()
}

fn list<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|place| value[place].as_f64().unwrap())
}

/// Each period with the current at its end.
fn periods(numbers: &Value) -> Vec<(Period<f64>, [f64; 2])> {
    let rows = numbers["rows"].as_array().unwrap().iter().map(list::<5>);
    rows.map(|[ud, uq, omega_e, id, iq]| (Period { u: [ud, uq], omega_e, length: 1e-4 }, [id, iq])).collect()
}

fn assert_near(found: [f64; 4], expected: [f64; 4], part: f64) {
    assert!(found.iter().zip(expected).all(|(found, expected)| (found / expected - 1.0).abs() < part), "{found:?} {expected:?}");
}

/// The library's series of order 5 leaves out (1200/s 0.1 ms)^6/720 = 4e-9 of each period.
#[test]
fn the_kalman_filter_is_that_of_the_textbook() {
    let numbers = numbers();
    let settings = EkfSettings { unknown_voltage: 0.3, steps: false, ..EkfSettings::tracking(list(&numbers["nominal"]), 10.0) };
    let mut ekf = Ekf::new(settings, [1.0; 4]);
    ekf.begin(list(&numbers["start"]));
    periods(&numbers).iter().for_each(|(period, i)| ekf.advance(period, *i));
    let expected = &numbers["filter"];
    assert_near(ekf.values(), list(&expected["values"]), 1e-6);
    assert_near(ekf.standard_errors(), list(&expected["standard_errors"]), 1e-6);
    assert!((ekf.noise() / expected["noise"].as_f64().unwrap() - 1.0).abs() < 1e-6);
}

#[test]
fn block_least_squares_solves_all_equations() {
    let numbers = numbers();
    let settings = BlockRlsSettings { forgetting: 0.98, gated: false, ..BlockRlsSettings::new(list(&numbers["nominal"])) };
    let mut rls = BlockRls::new(settings);
    rls.begin(list(&numbers["start"]));
    periods(&numbers).iter().for_each(|(period, i)| {
        rls.advance(period, *i);
    });
    assert_near(rls.estimate().value, list(&numbers["least_squares"]), 1e-7);
}
