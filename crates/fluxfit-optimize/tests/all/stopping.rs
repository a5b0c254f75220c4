//! When a search ends, and what it reports then.

use crate::{bowl, bowl_box};
use fluxfit_optimize::{CloseTo, Method, Optimizer, SearchSettings, StopReason};
use std::ops::ControlFlow;

#[test]
fn the_target_cost_stops_as_soon_as_it_is_reached() {
    for method in Method::all() {
        let target = 0.51;
        let settings = SearchSettings { target_cost: Some(target), ..SearchSettings::default() };
        let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
        assert_eq!(report.stop_reason, StopReason::TargetCost, "{}", method.label());
        assert!(report.cost <= target);
        let (last, before) = report.history.split_last().unwrap();
        assert!(last.iteration < settings.iterations);
        assert!(before.iter().all(|record| record.cost > target), "{}", method.label());
    }
}

#[test]
fn closeness_to_the_optimum_stops_as_soon_as_it_is_reached() {
    for method in Method::all() {
        let close = CloseTo { optimum: 0.5, tolerance: 1e-2 };
        let settings = SearchSettings { close_to_optimum: Some(close), ..SearchSettings::default() };
        let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
        assert_eq!(report.stop_reason, StopReason::CloseToOptimum, "{}", method.label());
        assert!(report.cost - close.optimum <= close.tolerance);
        let (last, before) = report.history.split_last().unwrap();
        assert!(last.iteration < settings.iterations);
        assert!(before.iter().all(|record| record.cost - close.optimum > close.tolerance), "{}", method.label());
    }
}

#[test]
fn what_is_interrupted_and_run_on_ends_at_the_same_bits() {
    for method in Method::all() {
        let start =
            || Optimizer::start(method, SearchSettings { iterations: 20, ..SearchSettings::default() }, bowl_box(), &bowl()).unwrap();
        let mut optimizer = start();
        let mut asked = 0;
        let cut = optimizer.run_while(&bowl(), || {
            asked += 1;
            if asked == 7 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!((cut.stop_reason, cut.history.len()), (StopReason::Interrupted, 8), "{}", method.label());
        assert_eq!(optimizer.run(&bowl()), start().run(&bowl()), "{}", method.label());
        // A criterion that holds at the same time is the reason.
        let last = Optimizer::start(method, SearchSettings { iterations: 1, ..SearchSettings::default() }, bowl_box(), &bowl())
            .unwrap()
            .run_while(&bowl(), || ControlFlow::Break(()));
        assert_eq!(last.stop_reason, StopReason::IterationLimit, "{}", method.label());
    }
}

#[test]
fn the_iteration_limit_stops_otherwise() {
    for method in Method::all() {
        for iterations in [0, 1, 7] {
            // Neither criterion can be met.
            let close_to_optimum = Some(CloseTo { optimum: 0.0, tolerance: 0.0 });
            let settings = SearchSettings { iterations, target_cost: Some(0.0), close_to_optimum, ..SearchSettings::default() };
            let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
            assert_eq!(report.stop_reason, StopReason::IterationLimit, "{}", method.label());
            assert_eq!(report.history.len(), 1 + iterations);
            assert_eq!(report.evaluations, (settings.population * (1 + iterations)) as u64);
        }
    }
}
