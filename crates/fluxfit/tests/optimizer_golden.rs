//! The steps of the four methods against an independent program fed the same random numbers: `oracles/optimizer_steps.py`.
#![allow(clippy::panic, clippy::unwrap_used)]

use fluxfit::optimizer::apso::Apso;
use fluxfit::optimizer::bounds::Bounds;
use fluxfit::optimizer::draws::Draws;
use fluxfit::optimizer::fpa::Fpa;
use fluxfit::optimizer::lpso::Lpso;
use fluxfit::optimizer::particles::Flight;
use fluxfit::optimizer::tgfpa::{Start, Tgfpa};
use fluxfit::optimizer::{Method, Objective, Optimizer, Settings, objective_from};
use serde::Deserialize;

/// Fraction of the box's width that a coordinate may differ by, and of the start's largest cost that a cost may.
///
/// Both programs compute the same formulas in another order of operations, so each move differs by a few roundings (1e-16) times the
/// factors in it, Lévy and t steps of up to some tens, and four iterations build on each other. Measured, no difference exceeds 1e-15;
/// 1e-12 leaves room for larger factors and other mathematical libraries, and is far below what a wrong formula does.
const TOLERANCE: f64 = 1e-12;

#[derive(Deserialize)]
struct Oracle {
    objective: Quartic,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Quartic {
    coupling: Vec<Vec<f64>>,
    quartic: Vec<f64>,
    centre: Vec<f64>,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    method: String,
    settings: serde_json::Value,
    dimension: usize,
    lower: Vec<f64>,
    upper: Vec<f64>,
    population: usize,
    iterations: usize,
    draws: Vec<f64>,
    states: Vec<State>,
}

#[derive(Deserialize)]
struct State {
    positions: Vec<f64>,
    costs: Vec<f64>,
    best: Vec<f64>,
    best_cost: f64,
}

impl Quartic {
    /// `z' A z + (c . z)^4` with `z` the position in the unit box, from the centre.
    fn cost(&self, case: &Case, x: &[f64]) -> f64 {
        let z: Vec<f64> = (0..case.dimension).map(|d| (x[d] - case.lower[d]) / (case.upper[d] - case.lower[d]) - self.centre[d]).collect();
        let dot = |row: &[f64]| row.iter().zip(&z).map(|(factor, z)| factor * z).sum::<f64>();
        self.coupling.iter().zip(&z).map(|(row, z)| z * dot(row)).sum::<f64>() + dot(&self.quartic).powi(4)
    }
}

impl Case {
    fn method(&self) -> Method {
        let number = |name: &str| self.settings[name].as_f64().unwrap();
        let flight = || Flight { cognitive: number("cognitive"), social: number("social"), velocity_limit: number("velocity_limit") };
        let pollination = || Fpa {
            switch_probability: number("switch_probability"),
            gamma: number("gamma"),
            local_base: serde_json::from_value(self.settings["local_base"].clone()).unwrap(),
        };
        match self.method.as_str() {
            "tgfpa" => Method::Tgfpa(Tgfpa {
                pollination: pollination(),
                plain_global: number("plain_global"),
                plain_local: number("plain_local"),
                start: if self.settings["start"] == "logistic" { Start::Logistic } else { Start::Uniform },
            }),
            "fpa" => Method::Fpa(pollination()),
            "lpso" => Method::Lpso(Lpso { flight: flight(), inertia_start: number("inertia_start"), inertia_end: number("inertia_end") }),
            "apso" => Method::Apso(Apso { flight: flight(), inertia_min: number("inertia_min"), inertia_max: number("inertia_max") }),
            other => panic!("no method {other}"),
        }
    }

    fn start(&self, objective: &impl Objective) -> Optimizer {
        let settings = Settings { population: self.population, iterations: self.iterations, ..Settings::default() };
        let bounds = Bounds::new(self.lower.clone(), self.upper.clone()).unwrap();
        Optimizer::start_from(self.method(), settings, bounds, Draws::replay(self.draws.clone()), objective).unwrap()
    }

    fn compare(&self, iteration: usize, optimizer: &Optimizer) {
        let (expected, got) = (&self.states[iteration], optimizer.population());
        let whose = format!("{}, iteration {iteration}", self.name);
        self.compare_rows(&whose, "positions", got.positions(), &expected.positions);
        self.compare_rows(&whose, "best", got.best(), &expected.best);
        // The start's largest cost stands for the height of the function over the box.
        let height = self.states[0].costs.iter().copied().fold(0.0, f64::max);
        let close = |got: f64, expected: f64| (got - expected).abs() <= TOLERANCE * height;
        assert!(close(got.best_cost(), expected.best_cost), "{whose}: best cost is {}, not {}", got.best_cost(), expected.best_cost);
        assert_eq!(got.costs().len(), expected.costs.len(), "{whose}: costs");
        for (index, (&got, &expected)) in got.costs().iter().zip(&expected.costs).enumerate() {
            assert!(close(got, expected), "{whose}: cost {index} is {got}, not {expected}");
        }
    }

    fn compare_rows(&self, whose: &str, what: &str, got: &[f64], expected: &[f64]) {
        assert_eq!(got.len(), expected.len(), "{whose}: {what}");
        for (index, (got, expected)) in got.iter().zip(expected).enumerate() {
            let d = index % self.dimension;
            let width = self.upper[d] - self.lower[d];
            assert!((got - expected).abs() <= TOLERANCE * width, "{whose}: {what}[{index}] is {got}, not {expected}");
        }
    }
}

fn oracle() -> Oracle {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/optimizer_steps.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn every_step_is_the_oracles() {
    let oracle = oracle();
    assert_eq!(oracle.cases.len(), 9);
    for case in &oracle.cases {
        let objective = objective_from(case.dimension, |x| oracle.objective.cost(case, x));
        let mut optimizer = case.start(&objective);
        assert_eq!(case.states.len(), 1 + case.iterations, "{}", case.name);
        case.compare(0, &optimizer);
        for iteration in 1..=case.iterations {
            optimizer.step(&objective);
            case.compare(iteration, &optimizer);
        }
        // The replay goes round: only when each number was asked for exactly once does its list stand as it did at first.
        let saved = serde_json::to_value(&optimizer).unwrap();
        let left: Vec<f64> = serde_json::from_value(saved["draws"]["Recorded"].clone()).unwrap();
        assert!(left == case.draws, "{}: not all draws were used, or some twice", case.name);
    }
}

#[test]
fn the_default_settings_are_the_oracles() {
    let oracle = oracle();
    for method in Method::all() {
        let case = oracle.cases.iter().find(|case| case.name == format!("{} defaults", method.key())).unwrap();
        assert_eq!(case.method(), method);
    }
}
