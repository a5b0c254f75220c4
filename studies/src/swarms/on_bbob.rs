//! The methods on the BBOB functions: when each target was reached, the expected running time, and the share of targets reached.

use crate::bbob::{FUNCTIONS, Problem};
use fluxfit::optimizer::{Error, Method, Optimizer, SearchSettings};
use rayon::prelude::*;

/// Targets, as costs above the lowest one: from 100 to 1e-8 in fifths of a decade, as COCO's.
pub const TARGETS: usize = 51;

/// A target; the first is the easiest.
pub fn target(k: usize) -> f64 {
    10_f64.powf(2.0 - 0.2 * k as f64)
}

/// The target of 1e-1, where a function counts as about solved, and that of 1e-8, where it counts as solved.
pub const ROUGH: usize = 15;
/// The last target.
pub const EXACT: usize = TARGETS - 1;

/// A run of a method on a problem.
#[derive(Debug, Clone, PartialEq)]
pub struct BbobRun {
    /// 1 to 24.
    pub function: u64,
    /// Of the problem.
    pub dimension: usize,
    /// Of the function.
    pub instance: u64,
    /// Evaluations after which each target was reached.
    pub reached: Vec<Option<u64>>,
    /// All evaluations; the run ends at the last target.
    pub evaluations: u64,
}

/// The runs of a method: one on each function, dimension and instance, with the population and iterations of the paper.
///
/// # Errors
/// If a method refuses a problem.
pub fn runs(method: Method, dimensions: &[usize], instances: u64) -> Result<Vec<BbobRun>, Error> {
    let problems: Vec<(u64, usize, u64)> = (1..=FUNCTIONS)
        .flat_map(|function| {
            dimensions.iter().flat_map(move |dimension| (1..=instances).map(move |instance| (function, *dimension, instance)))
        })
        .collect();
    problems.into_par_iter().map(|(function, dimension, instance)| run(method, &Problem::new(function, dimension, instance))).collect()
}

fn run(method: Method, problem: &Problem) -> Result<BbobRun, Error> {
    let settings = SearchSettings { run: problem.instance, target_cost: Some(target(EXACT)), ..SearchSettings::default() };
    let report = Optimizer::start(method, settings, problem.bounds()?, problem)?.run(problem);
    let reached = |k: usize| report.history.iter().find(|record| record.cost <= target(k)).map(|record| record.evaluations);
    Ok(BbobRun {
        function: problem.function,
        dimension: problem.optimum.len(),
        instance: problem.instance,
        reached: (0..TARGETS).map(reached).collect(),
        evaluations: report.evaluations,
    })
}

/// How many runs reached a target.
pub fn solved<'a>(runs: impl IntoIterator<Item = &'a BbobRun>, target: usize) -> usize {
    runs.into_iter().filter(|run| run.reached[target].is_some()).count()
}

/// Expected running time to a target: the evaluations of all runs up to it, by the runs that reached it. With independent restarts it is
/// the mean number of evaluations until it is reached. None if no run reached it.
pub fn expected_running_time<'a>(runs: impl IntoIterator<Item = &'a BbobRun>, target: usize) -> Option<f64> {
    let (mut spent, mut successes) = (0, 0_u32);
    for run in runs {
        spent += run.reached[target].unwrap_or(run.evaluations);
        successes += u32::from(run.reached[target].is_some());
    }
    (successes > 0).then(|| spent as f64 / f64::from(successes))
}

/// The share of all targets of all runs that are reached within so many evaluations: a point of the distribution of running times.
pub fn share_reached<'a>(runs: impl IntoIterator<Item = &'a BbobRun>, evaluations: u64) -> f64 {
    let (mut reached, mut all) = (0, 0);
    for run in runs {
        reached += run.reached.iter().flatten().filter(|at| **at <= evaluations).count();
        all += run.reached.len();
    }
    reached as f64 / all as f64
}
