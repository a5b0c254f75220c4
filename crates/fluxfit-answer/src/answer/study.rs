//! The document of `compare`: schema `fluxfit.study/1`.

use super::{by_parameter, motor_with_cost};
use fluxfit::{
    motor::Motor,
    optimizer::{Bounds, SearchSettings},
    study::{
        ConvergenceCurves, MethodStudy,
        fitness::{Fitness, StudyProblem},
    },
};
use serde_json::{Value, json};

/// What the methods have in common.
#[derive(Debug, Clone, Copy)]
pub struct StudyFacts<'a> {
    /// Settings of every run.
    pub settings: &'a SearchSettings,
    /// Runs of each method.
    pub runs: usize,
    /// Where they searched.
    pub bounds: &'a Bounds,
    /// What they minimized.
    pub problem: &'a StudyProblem,
    /// The true motor, if known.
    pub truth: Option<&'a Motor>,
}

impl StudyFacts<'_> {
    /// Whether this many methods have finished all their runs, none of them interrupted.
    pub fn is_whole(&self, methods: &[(MethodStudy, f64)], asked: usize) -> bool {
        methods.len() == asked && methods.iter().all(|(study, _)| study.motors.len() == self.runs)
    }
}

/// The document of a study; each method with the seconds that one of its runs took.
pub fn study(facts: &StudyFacts, methods: &[(MethodStudy, f64)]) -> Value {
    let fitness = &facts.problem.fitness;
    let (motor, cost) = fitness.minimum();
    let solution = match fitness {
        Fitness::VoltageError(objective) => Some(objective.least_squares()),
        Fitness::OutputError { .. } => None,
    };
    json!({
        "schema": "fluxfit.study/1",
        "model": fitness.key(),
        "voltage_reading": fitness.voltage_reading(),
        "cost_unit": fitness.unit(),
        "seed": facts.settings.seed,
        "runs": facts.runs,
        "population": facts.settings.population,
        "iterations": facts.settings.iterations,
        "truth": facts.truth.map(|truth| by_parameter(truth.to_array())),
        "minimum": motor_with_cost(&motor, cost),
        "converged": fitness.has_converged(),
        "least_squares": solution.map(|solution| motor_with_cost(&solution.motor, solution.cost)),
        "rank": solution.map(|solution| solution.rank),
        "rows": facts.problem.rows,
        "search_box": by_parameter::<Value>(
            facts.bounds.iter().map(|(lower, upper)| json!([lower, upper])).collect::<Vec<_>>().try_into().unwrap_or_default(),
        ),
        "methods": methods.iter().map(|(study, seconds)| method(study, *seconds, facts.truth)).collect::<Vec<_>>(),
    })
}

fn method(study: &MethodStudy, seconds_per_run: f64, truth: Option<&Motor>) -> Value {
    json!({
        "method": study.method.key(),
        "runs": study.motors.len(),
        "evaluations_per_run": study.evaluations_per_run,
        "seconds_per_run": seconds_per_run,
        "mean": by_parameter(study.mean().to_array()),
        "mean_error_percent": truth.map(|truth| by_parameter(study.mean_error_percent(truth))),
        "cost_above_optimum": { "median": study.median(), "worst": study.worst() },
        "convergence": convergence(&study.convergence),
    })
}

fn convergence(curves: &ConvergenceCurves) -> Value {
    let quartile = |which: usize| curves.quartiles.iter().map(|quartiles| quartiles[which]).collect::<Vec<_>>();
    let parameter = |p: usize| curves.parameters_median.iter().map(|median| median[p]).collect::<Vec<_>>();
    json!({
        "iteration": (0..curves.quartiles.len()).collect::<Vec<_>>(),
        "cost_above_optimum": { "median": quartile(1), "lower_quartile": quartile(0), "upper_quartile": quartile(2) },
        "parameters_median": by_parameter([0, 1, 2, 3].map(parameter)),
    })
}
