//! Who asks for candidates and tells their costs walks the course of who hands the objective over.

use crate::{bowl, bowl_box};
use fluxfit_optimize::{Error, Method, Objective, Optimizer, SearchSettings};

fn costs_of(objective: &impl Objective, candidates: &[f64]) -> Vec<f64> {
    let mut costs = vec![0.0; candidates.len() / objective.dimension()];
    objective.evaluate(candidates, &mut costs);
    costs
}

#[test]
fn asking_and_telling_is_running_and_may_pause_between_them() {
    let settings = SearchSettings { population: 9, iterations: 12, ..SearchSettings::default() };
    for method in Method::all() {
        let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
        let mut search = Optimizer::asking(method, settings, bowl_box()).unwrap();
        loop {
            let asked = search.ask().to_vec();
            // Asked again, it is the same; saved and restored in between, too.
            assert_eq!(search.ask(), asked);
            search = serde_json::from_str(&serde_json::to_string(&search).unwrap()).unwrap();
            assert_eq!(search.ask(), asked);
            if asked.is_empty() {
                break;
            }
            search.tell(&costs_of(&bowl(), &asked)).unwrap();
        }
        assert_eq!(search.history(), &report.history[..], "{}", method.key());
        assert_eq!((search.population().evaluations(), search.stop_reason()), (report.evaluations, Some(report.stop_reason)));
    }
}

#[test]
fn what_was_asked_for_can_be_stepped_on() {
    let settings = SearchSettings { population: 9, iterations: 5, ..SearchSettings::default() };
    let mut whole = Optimizer::start(Method::default(), settings, bowl_box(), &bowl()).unwrap();
    let mut search = Optimizer::asking(Method::default(), settings, bowl_box()).unwrap();
    let first = search.ask().to_vec();
    search.tell(&costs_of(&bowl(), &first)).unwrap();
    search.ask();
    assert_eq!(search.run(&bowl()), whole.run(&bowl()));
}

#[test]
fn other_numbers_of_costs_and_starts_without_one_are_refused() {
    let mut search = Optimizer::asking(Method::default(), SearchSettings::default(), bowl_box()).unwrap();
    let asked = search.ask().len() / bowl_box().dimension();
    assert_eq!(search.tell(&[1.0]), Err(Error::Told { told: 1, asked }));
    assert_eq!(search.tell(&vec![f64::NAN; asked]), Err(Error::NonFiniteStart { population: asked }));
}
