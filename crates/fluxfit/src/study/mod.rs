//! The study: many independent runs of many methods on one fitness, as the paper compares them.
//!
//! Run `k` of every method takes stream `k` of the same seed. Runs are spread over all cores; each depends on its own stream
//! alone and results are collected in order, so any number of threads gives the same bits. Swarms are compared by how far they end
//! above the minimum, which is known: `F - F_LS` of fitness (11), `F - F_LM` of the output error. On a noisy log their distance from
//! the truth ranks the noise.

pub mod facts;
pub mod fitness;

use crate::{
    error::Error,
    motor::{Motor, PARAMETERS, Parameter},
    optimizer::{Method, Optimizer, Report, Settings, StopReason, bounds::Bounds},
};
use fitness::Fitness;
use rayon::prelude::*;
use statrs::statistics::{Data, OrderStatistics};
use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
};

/// Many runs of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodStudy {
    /// The method.
    pub method: Method,
    /// Candidates evaluated in each run; fewer where a run stopped early.
    pub evaluations_per_run: u64,
    /// Where each finished run ended; at least one did.
    pub motors: Vec<Motor>,
    /// Cost above the minimum of each run's end.
    pub cost_above_optimum: Vec<f64>,
    /// The course of the runs, iteration by iteration.
    pub convergence: Convergence,
}

/// The course of many runs: one entry per iteration, the start included. A run that stopped early keeps its last value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Convergence {
    /// Cost above the minimum: lower quartile, median and upper quartile over the runs.
    pub quartiles: Vec<[f64; 3]>,
    /// Median of each parameter over the runs.
    pub parameters_median: Vec<[f64; PARAMETERS]>,
}

/// Runs one method `runs` times; `go_on` is asked after each iteration, from any thread, whether to. Interrupted, only the runs that
/// are finished count, each the same as if all were; none, if there is no such run.
///
/// Of the output error costs may lie below the minimum known, until [`settle`] has seen all methods.
///
/// # Errors
/// If `runs` is zero or a run cannot start.
pub fn run_method(
    method: Method,
    runs: usize,
    settings: Settings,
    bounds: &Bounds,
    fitness: &Fitness,
    go_on: impl Fn() -> ControlFlow<()> + Sync,
) -> Result<Option<MethodStudy>, Error> {
    if runs == 0 {
        return Err(Error::Setting { setting: "the number of runs", value: 0.0, range: "at least 1" });
    }
    let interrupted = AtomicBool::new(false);
    let run = |run: usize| {
        // A run that has not begun costs its first population before anybody is asked.
        if interrupted.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let settings = Settings { run: run as u64, ..settings };
        let mut optimizer = Optimizer::start(method, settings, bounds.clone(), fitness)?;
        let report = optimizer.run_while(fitness, || {
            let next = go_on();
            interrupted.fetch_or(next.is_break(), Ordering::Relaxed);
            next
        });
        Ok((report.stop_reason != StopReason::Interrupted).then(|| Course::of(&report, fitness)))
    };
    let courses = (0..runs).into_par_iter().map(run).collect::<Result<Vec<_>, Error>>()?;
    let courses: Vec<Course> = courses.into_iter().flatten().collect();
    Ok((!courses.is_empty()).then(|| MethodStudy {
        method,
        evaluations_per_run: courses.iter().map(|course| course.evaluations).max().unwrap_or(0),
        motors: courses.iter().map(|course| course.last().0).collect(),
        cost_above_optimum: courses.iter().map(|course| course.last().1).collect(),
        convergence: Convergence::of(&courses),
    }))
}

/// Counts every study from the lowest cost that is known: where a swarm has ended below the polish, that of a polish from there.
pub fn settle(fitness: &mut Fitness, studies: &mut [MethodStudy]) {
    let ends = studies.iter().flat_map(|study| study.cost_above_optimum.iter().zip(&study.motors));
    let lowest = ends.min_by(|a, b| a.0.total_cmp(b.0)).filter(|(above, _)| **above < 0.0).map(|(_, motor)| *motor);
    if let Some(motor) = lowest {
        let fall = fitness.lower_to(&motor);
        studies.iter_mut().for_each(|study| study.raise(fall));
    }
}

impl MethodStudy {
    /// Counts from a minimum that is lower by this much. No run lies below it: what is negative now is rounding.
    fn raise(&mut self, by: f64) {
        let quartiles = self.convergence.quartiles.iter_mut().flatten();
        self.cost_above_optimum.iter_mut().chain(quartiles).for_each(|above| *above = (*above + by).max(0.0));
    }

    /// The mean of the runs' motors: what the paper reports.
    pub fn mean(&self) -> Motor {
        let runs = self.motors.len() as f64;
        Motor::from(std::array::from_fn(|p| self.motors.iter().map(|motor| motor.to_array()[p]).sum::<f64>() / runs))
    }

    /// Mean over the runs of each parameter's distance from the truth, in percent: the paper's error, as its table can best be read.
    pub fn mean_error_percent(&self, truth: &Motor) -> [Option<f64>; PARAMETERS] {
        Parameter::ALL.map(|parameter| {
            let errors = self.motors.iter().map(|motor| error_percent(motor, truth, parameter));
            errors.sum::<Option<f64>>().map(|sum| sum / self.motors.len() as f64)
        })
    }

    /// Median over the runs of the cost above the minimum.
    pub fn median(&self) -> f64 {
        quartiles(self.cost_above_optimum.clone())[1]
    }

    /// Largest cost above the minimum of a run.
    pub fn worst(&self) -> f64 {
        self.cost_above_optimum.iter().copied().fold(0.0, f64::max)
    }
}

/// Distance of one parameter from the truth, in percent; none where the truth is zero, as the flux of a motor without magnets.
pub fn error_percent(motor: &Motor, truth: &Motor, parameter: Parameter) -> Option<f64> {
    let truth = truth.get(parameter);
    (truth != 0.0).then(|| 100.0 * (motor.get(parameter) / truth - 1.0).abs())
}

/// One run, iteration by iteration: the best motor and its cost above the minimum.
struct Course {
    evaluations: u64,
    best: Vec<(Motor, f64)>,
}

impl Course {
    fn of(report: &Report, fitness: &Fitness) -> Self {
        let best = report.history.iter().map(|record| {
            let motor = Motor::from(std::array::from_fn(|p| record.best[p]));
            (motor, fitness.cost_above_optimum(&motor, record.cost))
        });
        Self { evaluations: report.evaluations, best: best.collect() }
    }

    fn at(&self, iteration: usize) -> (Motor, f64) {
        self.best[iteration.min(self.best.len() - 1)]
    }

    fn last(&self) -> (Motor, f64) {
        self.at(usize::MAX)
    }
}

impl Convergence {
    fn of(courses: &[Course]) -> Self {
        let iterations = courses.iter().map(|course| course.best.len()).max().unwrap_or(0);
        let mut convergence = Self::default();
        for iteration in 0..iterations {
            let now: Vec<(Motor, f64)> = courses.iter().map(|course| course.at(iteration)).collect();
            convergence.quartiles.push(quartiles(now.iter().map(|(_, cost)| *cost).collect()));
            convergence
                .parameters_median
                .push(std::array::from_fn(|p| quartiles(now.iter().map(|(motor, _)| motor.to_array()[p]).collect())[1]));
        }
        convergence
    }
}

fn quartiles(values: Vec<f64>) -> [f64; 3] {
    let mut data = Data::new(values);
    [data.lower_quartile(), data.median(), data.upper_quartile()]
}
