//! Whole runs of the swarm optimizers, as a user starts them: 50 candidates, 300 iterations, history kept.

use crate::timing::{median, median_cpu_seconds};
use fluxfit::{
    error::Error,
    motor::{Motor, PARAMETERS},
    objective::voltage_error::VoltageError,
    optimizer::{Bounds, Method, Optimizer, SearchReport, SearchSettings},
};
use serde::Serialize;

/// Runs timed; each has its own stream of random numbers.
const RUNS: usize = 201;

/// One method.
#[derive(Serialize)]
pub(crate) struct Figures {
    key: &'static str,
    label: &'static str,
    milliseconds_per_run: f64,
    evaluations: u64,
    /// Median over the runs of `F - F_LS`.
    cost_above_optimum: f64,
}

/// Times the runs of a method.
pub(crate) fn measure(method: Method, bounds: &Bounds, objective: &VoltageError) -> Result<Figures, Error> {
    let run = |run: usize| -> Result<SearchReport, Error> {
        let settings = SearchSettings { run: run as u64, ..SearchSettings::default() };
        Ok(Optimizer::start(method, settings, bounds.clone(), objective)?.run(objective))
    };
    let reports = (0..RUNS).map(run).collect::<Result<Vec<_>, _>>()?;
    let mut above: Vec<f64> = reports.iter().map(|report| objective.cost_above_optimum(&motor(&report.best))).collect();
    Ok(Figures {
        key: method.key(),
        label: method.label(),
        milliseconds_per_run: 1e3 * median_cpu_seconds(RUNS, run),
        evaluations: reports.iter().map(|report| report.evaluations).max().unwrap_or(0),
        cost_above_optimum: median(&mut above),
    })
}

fn motor(best: &[f64]) -> Motor {
    let mut parameters = [0.0; PARAMETERS];
    parameters.copy_from_slice(best);
    Motor::from(parameters)
}
