//! What the comparison of all search methods is made of.
// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used)]

use fluxfit::optimizer::Method;
use fluxfit_studies::swarms::{
    invariance::{Sensitivity, sensitivity},
    on_bbob::{BbobRun, EXACT, ROUGH, TARGETS, expected_running_time, runs, share_reached, solved, target},
};

fn run(reached: impl Fn(usize) -> Option<u64>, evaluations: u64) -> BbobRun {
    BbobRun { function: 1, dimension: 2, instance: 1, reached: (0..TARGETS).map(reached).collect(), evaluations }
}

#[test]
fn running_times_and_shares_are_those_of_a_calculation_by_hand() {
    assert!((target(0) - 100.0).abs() < 1e-12 && (target(ROUGH) - 0.1).abs() < 1e-15 && (target(EXACT) - 1e-8).abs() < 1e-22);
    // One run reaches every target after 100 evaluations, one the first 17 (1/3) after 400 of its 1000, one none of its 1000.
    let three = [run(|_| Some(100), 100), run(|k| (k < 17).then_some(400), 1000), run(|_| None, 1000)];
    assert_eq!((solved(&three, ROUGH), solved(&three, EXACT)), (2, 1));
    assert_eq!(expected_running_time(&three, ROUGH), Some((100.0 + 400.0 + 1000.0) / 2.0));
    assert_eq!(expected_running_time(&three, EXACT), Some(100.0 + 1000.0 + 1000.0));
    assert_eq!(expected_running_time(&three[2..], EXACT), None);
    assert!((share_reached(&three, 399) - 1.0 / 3.0).abs() < 1e-15);
    assert!((share_reached(&three, 400) - (1.0 + 1.0 / 3.0) / 3.0).abs() < 1e-15);
}

#[test]
fn covariance_adaptation_solves_the_sphere_and_the_turned_ellipsoid() {
    let runs = runs(Method::named("cma-es").unwrap(), &[2], 1).unwrap();
    assert_eq!(runs.len(), 24);
    for function in [1, 10] {
        let run = &runs[function - 1];
        assert_eq!((run.function, run.reached[EXACT], run.reached[EXACT].is_some()), (function as u64, Some(run.evaluations), true));
    }
}

#[test]
fn a_shifted_box_changes_the_runs_of_whales_and_not_those_of_differential_evolution() {
    let of = |key: &str| sensitivity(Method::named(key).unwrap()).unwrap();
    assert_eq!(of("de"), Sensitivity { shift: false, scale: false, offset: false });
    assert_eq!(of("woa"), Sensitivity { shift: true, scale: false, offset: false });
    assert!(of("so").offset && of("ssa").shift);
}
