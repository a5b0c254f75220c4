//! Many runs: each by its own stream, in order, and only those that are finished.

use crate::{bowl, bowl_box};
use fluxfit_optimize::{Error, Method, Optimizer, SearchSettings, run_many};
use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicUsize, Ordering},
};

const RUNS: usize = 9;

fn settings() -> SearchSettings {
    SearchSettings { population: 8, iterations: 12, seed: 3, ..SearchSettings::default() }
}

#[test]
fn run_k_is_stream_k_in_its_place() {
    for method in Method::all() {
        let reports = run_many(method, RUNS, settings(), &bowl_box(), &bowl(), |report| report, || ControlFlow::Continue(())).unwrap();
        assert_eq!(reports.len(), RUNS);
        for (run, report) in reports.into_iter().enumerate() {
            let settings = SearchSettings { run: run as u64, ..settings() };
            assert_eq!(report, Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl()));
        }
    }
}

#[test]
fn interrupted_only_finished_runs_are_returned() {
    let whole = run_many(Method::default(), RUNS, settings(), &bowl_box(), &bowl(), |report| report.cost, || ControlFlow::Continue(()));
    let whole = whole.unwrap();
    let asked = AtomicUsize::new(0);
    // Half of all iterations are allowed.
    let go_on =
        || if asked.fetch_add(1, Ordering::Relaxed) + 1 < RUNS * 12 / 2 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let cut = run_many(Method::default(), RUNS, settings(), &bowl_box(), &bowl(), |report| report.cost, go_on).unwrap();
    assert!(cut.len() < RUNS, "{}", cut.len());
    assert!(cut.iter().all(|cost| whole.contains(cost)));
    let none = run_many(Method::default(), RUNS, settings(), &bowl_box(), &bowl(), |report| report.cost, || ControlFlow::Break(()));
    assert!(none.unwrap().is_empty());
}

#[test]
fn no_runs_is_an_error() {
    let none = run_many(Method::default(), 0, settings(), &bowl_box(), &bowl(), |report| report.cost, || ControlFlow::Continue(()));
    assert!(matches!(none.unwrap_err(), Error::Setting { setting: "the number of runs", .. }));
}
