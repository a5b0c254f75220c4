//! The steps of the methods against an independent program fed the same random numbers: `oracles/optimizer_steps.py`.

use fluxfit_optimize::{Bounds, Draws, Method, Objective, Optimizer, SearchSettings, objective_from};
use serde::Deserialize;
use std::{collections::BTreeMap, sync::LazyLock};

/// Fraction of the box's width that a coordinate may differ by, and of the start's largest cost that a cost may.
///
/// Both programs compute the same formulas in another order of operations, so each move differs by a few roundings (1e-16) times the
/// factors in it, Lévy and t steps of up to some tens, and four iterations build on each other. Measured, no difference exceeds 1e-15;
/// 1e-12 leaves room for larger factors and other mathematical libraries, and is far below what a wrong formula does.
const TOLERANCE: f64 = 1e-12;

#[derive(Deserialize)]
struct Oracle {
    objective: Quartic,
    /// What the formulas of each method say of its courses, by its key.
    laws: BTreeMap<String, Vec<String>>,
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
    /// Its key and its settings.
    #[serde(flatten)]
    method: Method,
    dimension: usize,
    lower: Vec<f64>,
    upper: Vec<f64>,
    population: usize,
    iterations: usize,
    /// No cost is lower.
    floor: f64,
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
    /// `z' A z + (c . z)^4` with `z` the position in the unit box, from the centre; flat below the floor.
    fn cost(&self, case: &Case, x: &[f64]) -> f64 {
        let z: Vec<f64> = (0..case.dimension).map(|d| (x[d] - case.lower[d]) / (case.upper[d] - case.lower[d]) - self.centre[d]).collect();
        let dot = |row: &[f64]| row.iter().zip(&z).map(|(factor, z)| factor * z).sum::<f64>();
        let height = self.coupling.iter().zip(&z).map(|(row, z)| z * dot(row)).sum::<f64>() + dot(&self.quartic).powi(4);
        height.max(case.floor)
    }
}

impl Case {
    fn start(&self, objective: &impl Objective) -> Optimizer {
        let settings = SearchSettings { population: self.population, iterations: self.iterations, ..SearchSettings::default() };
        let bounds = Bounds::new(self.lower.clone(), self.upper.clone()).unwrap();
        Optimizer::start_from(self.method, settings, bounds, Draws::replay(self.draws.clone()), objective).unwrap()
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

static ORACLE: LazyLock<Oracle> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/optimizer_steps.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
});

/// Whether a method's formulas say that a law holds for it.
pub(crate) fn obeys(method: &Method, law: &str) -> bool {
    ORACLE.laws[method.key()].iter().any(|held| held == law)
}

#[test]
fn every_step_is_the_oracles() {
    let oracle = &*ORACLE;
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
fn every_method_has_its_cases_and_the_oracles_default_settings() {
    let oracle = &*ORACLE;
    let case = |name: &str| oracle.cases.iter().find(|case| case.name == name);
    for method in Method::all() {
        let [defaults, altered] = ["defaults", "altered"].map(|which| case(&format!("{} {which}", method.key())));
        assert_eq!(defaults.unwrap().method, method);
        assert_eq!(altered.unwrap().method.key(), method.key());
    }
    for which in ["tgfpa from the last trial", "cma-es wide", "ipop-cma-es plateau", "l-shade few crossed"] {
        assert!(case(which).is_some(), "{which}");
    }
}
