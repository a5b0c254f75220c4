//! The study: many independent runs of many methods on one fitness, as the paper compares them.
//!
//! Run `k` of every method takes stream `k` of the same seed. Runs are spread over all cores; each depends on its own stream
//! alone and results are collected in order, so any number of threads gives the same bits. Swarms are compared by `F - F_LS`, how
//! far they end above the exact minimum: on a noisy log their distance from the truth ranks the noise.

use crate::{
    error::Error,
    identify,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::voltage_error::{IdZero, VoltageError},
    optimizer::{Method, Optimizer, Report, Settings, bounds::Bounds},
    steady::{OperatingPoint, windows::at_most_paper_rows},
};
use rayon::prelude::*;
use statrs::statistics::{Data, OrderStatistics};

/// Many runs of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodStudy {
    /// The method.
    pub method: Method,
    /// Candidates evaluated in each run; fewer where a run stopped early.
    pub evaluations_per_run: u64,
    /// Where each run ended.
    pub motors: Vec<Motor>,
    /// `F - F_LS` of each run's end.
    pub cost_above_optimum: Vec<f64>,
    /// The course of the runs, iteration by iteration.
    pub convergence: Convergence,
}

/// The course of many runs: one entry per iteration, the start included. A run that stopped early keeps its last value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Convergence {
    /// `F - F_LS`: lower quartile, median and upper quartile over the runs.
    pub quartiles: Vec<[f64; 3]>,
    /// Median of each parameter over the runs.
    pub parameters_median: Vec<[f64; PARAMETERS]>,
}

/// The paper's fitness on a log, and what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitness {
    /// What it sums over, before any correction.
    pub operating_points: Vec<OperatingPoint>,
    /// Rows that the fitness sums over, per window.
    pub rows: Vec<usize>,
    /// Fitness (11) itself.
    pub objective: VoltageError,
}

/// Fitness (11) on the steady windows of a log: on at most the paper's 4000 samples of each, with the held-vector correction that
/// an identification makes.
///
/// # Errors
/// If there is no steady window.
pub fn fitness(log: &Log, settings: &identify::Settings, id_zero: IdZero) -> Result<Fitness, Error> {
    let whole = identify::operating_points(log, settings)?;
    let rows = at_most_paper_rows(&whole.into_iter().map(|point| point.rows).collect::<Vec<_>>());
    let points: Vec<_> = rows.into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect();
    let beliefs = identify::beliefs(log, &points, identify::voltage_timing(settings).0, settings);
    let windows: Vec<_> = points.iter().zip(beliefs).map(|(point, belief)| (point.rows.clone(), belief.held_vector)).collect();
    Ok(Fitness {
        operating_points: points,
        rows: windows.iter().map(|(rows, _)| rows.len()).collect(),
        objective: VoltageError::of_samples(log, &windows, id_zero),
    })
}

/// Runs one method `runs` times; `done` is called after each run, from any thread.
///
/// # Errors
/// If `runs` is zero or a run cannot start.
pub fn run_method(
    method: Method,
    runs: usize,
    settings: Settings,
    bounds: &Bounds,
    objective: &VoltageError,
    done: impl Fn() + Sync,
) -> Result<MethodStudy, Error> {
    if runs == 0 {
        return Err(Error::Setting { setting: "the number of runs", value: 0.0, range: "at least 1" });
    }
    let run = |run: usize| {
        let settings = Settings { run: run as u64, ..settings };
        let report = Optimizer::start(method, settings, bounds.clone(), objective)?.run(objective);
        done();
        Ok(Course::of(&report, objective))
    };
    let courses: Vec<Course> = (0..runs).into_par_iter().map(run).collect::<Result<_, Error>>()?;
    Ok(MethodStudy {
        method,
        evaluations_per_run: courses.iter().map(|course| course.evaluations).max().unwrap_or(0),
        motors: courses.iter().map(|course| course.last().0).collect(),
        cost_above_optimum: courses.iter().map(|course| course.last().1).collect(),
        convergence: Convergence::of(&courses),
    })
}

impl MethodStudy {
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

    /// Median over the runs of `F - F_LS`.
    pub fn median(&self) -> f64 {
        quartiles(self.cost_above_optimum.clone())[1]
    }

    /// Largest `F - F_LS` of a run.
    pub fn worst(&self) -> f64 {
        self.cost_above_optimum.iter().copied().fold(0.0, f64::max)
    }
}

/// Distance of one parameter from the truth, in percent; none where the truth is zero, as the flux of a motor without magnets.
pub fn error_percent(motor: &Motor, truth: &Motor, parameter: Parameter) -> Option<f64> {
    let truth = truth.get(parameter);
    (truth != 0.0).then(|| 100.0 * (motor.get(parameter) / truth - 1.0).abs())
}

/// One run, iteration by iteration: the best motor and its cost above the optimum.
struct Course {
    evaluations: u64,
    best: Vec<(Motor, f64)>,
}

impl Course {
    fn of(report: &Report, objective: &VoltageError) -> Self {
        let motor = |best: &[f64]| Motor::from(std::array::from_fn(|p| best[p]));
        let best = report.history.iter().map(|record| motor(&record.best)).map(|motor| (motor, objective.cost_above_optimum(&motor)));
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
