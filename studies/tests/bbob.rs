//! The BBOB functions beside the values of the COCO platform, which `oracles/bbob.py` wrote.
// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used)]

use fluxfit_studies::bbob::{FUNCTIONS, Problem};
use serde_json::Value;
use std::collections::BTreeSet;

/// Of a cost, relative where it is larger than one: rounding of sums whose terms have magnitudes up to 1e10 in another order.
const TOLERANCE: f64 = 1e-10;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn every_function_has_the_optimum_and_the_costs_of_coco() {
    let values: Value =
        serde_json::from_str(&std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bbob.json")).unwrap()).unwrap();
    let mut seen = BTreeSet::new();
    for case in values["cases"].as_array().unwrap() {
        let (function, instance) = (case["function"].as_u64().unwrap(), case["instance"].as_u64().unwrap());
        let best = numbers(&case["optimum"]);
        let name = format!("f{function}, {} dimensions, instance {instance}", best.len());
        let problem = Problem::new(function, best.len(), instance);
        for (ours, theirs) in problem.optimum.iter().zip(&best) {
            // COCO writes its optimum with this many digits.
            assert!((ours - theirs).abs() < 1e-9, "{name}: optimum at {:?}, not {best:?}", problem.optimum);
        }
        let agrees = |x: &[f64], theirs: f64| {
            let ours = problem.cost(x);
            assert!((ours - theirs).abs() <= TOLERANCE * theirs.abs().max(1.0), "{name} at {x:?}: {ours}, not {theirs}");
        };
        agrees(&best, case["lowest"].as_f64().unwrap());
        let dimension = best.len().to_string();
        for (point, cost) in values["points"][&dimension].as_array().unwrap().iter().zip(numbers(&case["costs"])) {
            agrees(&numbers(point), cost);
        }
        for (step, cost) in values["steps"][&dimension].as_array().unwrap().iter().zip(numbers(&case["near"])) {
            agrees(&best.iter().zip(numbers(step)).map(|(x, step)| x + step).collect::<Vec<f64>>(), cost);
        }
        seen.insert((function, best.len(), instance));
    }
    assert_eq!(seen.len(), FUNCTIONS as usize * 3 * 3);
}
