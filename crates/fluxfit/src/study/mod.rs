//! The study: many independent runs of several methods on one fitness, as the paper compares them.
//!
//! Run `k` of every method uses random stream `k` of the same seed. Runs are distributed over all cores; each depends only on its own
//! stream and results are collected in order, so any number of threads gives the same bits. Methods are compared by their final cost
//! above the minimum, which is known: `F - F_LS` for fitness (11), `F - F_LM` for the output error. The distance from the truth cannot
//! rank them: on a noisy log it is the noise's.

pub mod comparison;
pub mod fitness;

use crate::{
    error::Error,
    motor::{Motor, PARAMETERS, Parameter},
    optimizer::{Bounds, Method, SearchReport, SearchSettings, run_many},
};
use fitness::Fitness;
use statrs::statistics::{Data, OrderStatistics};
use std::ops::ControlFlow;

/// The results of many runs of one method.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MethodStudy {
    /// The method.
    pub method: Method,
    /// Evaluations of the fitness in each run; a run that stopped early has fewer.
    pub evaluations_per_run: u64,
    /// The best motor of each finished run; there is at least one.
    pub motors: Vec<Motor>,
    /// Final cost above the minimum of each run.
    pub cost_above_optimum: Vec<f64>,
    /// Convergence of the runs, by iteration.
    pub convergence: ConvergenceCurves,
}

/// Convergence of many runs: one entry per iteration, the start included. A run that stopped early keeps its last value.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct ConvergenceCurves {
    /// Cost above the minimum: lower quartile, median and upper quartile over the runs.
    pub quartiles: Vec<[f64; 3]>,
    /// Median of each parameter over the runs.
    pub parameters_median: Vec<[f64; PARAMETERS]>,
}

/// Most records of convergence, of 40 bytes each: 400 MB. The paper's study has 15 050 of each method.
const MOST_RECORDS: f64 = 1e7;

/// Costs above the minimum that are smaller than this are rounding errors, and rank equal.
pub const ROUNDING: f64 = 1e-12;

/// Runs one method `runs` times. `go_on` is called after each iteration, from any thread, and can interrupt the study: then only the
/// finished runs count, with the results of an uninterrupted study; `None` if no run is finished.
///
/// For the output error, costs may lie below the minimum known until [`use_lowest_minimum`] has been called with all methods.
///
/// # Errors
/// If `runs` is zero or a run cannot start, or if the runs are too many or too long for their convergence to be kept.
pub fn run_method(
    method: Method,
    runs: usize,
    settings: SearchSettings,
    bounds: &Bounds,
    fitness: &Fitness,
    go_on: impl Fn() -> ControlFlow<()> + Sync,
) -> Result<Option<MethodStudy>, Error> {
    settings.check_runs(runs)?;
    let records = runs as f64 * (settings.iterations as f64 + 1.0);
    if records > MOST_RECORDS {
        let (setting, reason) = ("the number of runs x iterations", "so that the convergence of all runs fits into memory");
        return Err(fluxfit_optimize::Error::Limit { setting, value: records, most: MOST_RECORDS, reason }.into());
    }
    let histories = run_many(method, runs, settings, bounds, fitness, |report| RunHistory::of(&report, fitness), go_on)?;
    Ok((!histories.is_empty()).then(|| MethodStudy {
        method,
        evaluations_per_run: histories.iter().map(|history| history.evaluations).max().unwrap_or(0),
        motors: histories.iter().map(|history| history.last().0).collect(),
        cost_above_optimum: histories.iter().map(|history| history.last().1).collect(),
        convergence: ConvergenceCurves::of(&histories),
    }))
}

/// Makes the costs of all studies relative to the lowest minimum known. Where a run has ended below the minimum of the fitness, the
/// minimum is replaced by the local minimum reached from that run's end.
pub fn use_lowest_minimum(fitness: &mut Fitness, studies: &mut [MethodStudy]) {
    let ends = studies.iter().flat_map(|study| study.cost_above_optimum.iter().zip(&study.motors));
    let lowest = ends.min_by(|a, b| a.0.total_cmp(b.0)).filter(|(above, _)| **above < 0.0).map(|(_, motor)| *motor);
    if let Some(motor) = lowest {
        let decrease = fitness.improve_minimum(&motor);
        studies.iter_mut().for_each(|study| study.add_to_costs(decrease));
    }
}

impl MethodStudy {
    /// Accounts for a minimum that is lower by `decrease`. No cost lies below it: what is negative then is rounding error.
    fn add_to_costs(&mut self, decrease: f64) {
        let quartiles = self.convergence.quartiles.iter_mut().flatten();
        self.cost_above_optimum.iter_mut().chain(quartiles).for_each(|above| *above = (*above + decrease).max(0.0));
    }

    /// The mean of the runs' estimates, as in the paper's Table 2.
    pub fn mean(&self) -> Motor {
        let runs = self.motors.len() as f64;
        Motor::from(std::array::from_fn(|p| self.motors.iter().map(|motor| motor.to_array()[p]).sum::<f64>() / runs))
    }

    /// Mean over the runs of each parameter's distance from the truth, %: the most plausible definition of the error in the paper's
    /// Table 2.
    pub fn mean_error_percent(&self, truth: &Motor) -> [Option<f64>; PARAMETERS] {
        Parameter::ALL.map(|parameter| {
            let errors = self.motors.iter().map(|motor| error_percent(motor, truth, parameter));
            errors.sum::<Option<f64>>().map(|sum| sum / self.motors.len() as f64)
        })
    }

    /// Median over the runs of the final cost above the minimum.
    pub fn median(&self) -> f64 {
        quartiles(self.cost_above_optimum.clone())[1]
    }

    /// Largest final cost above the minimum.
    pub fn worst(&self) -> f64 {
        self.cost_above_optimum.iter().copied().fold(0.0, f64::max)
    }

    /// The part of the runs, 0 to 1, whose final cost above the minimum is at most this.
    pub fn share_within(&self, cost: f64) -> f64 {
        self.cost_above_optimum.iter().filter(|above| **above <= cost).count() as f64 / self.cost_above_optimum.len() as f64
    }

    /// Evaluations after which the median over the runs is at most this, of as many per iteration as `population`; none if it ends above.
    pub fn evaluations_within(&self, cost: f64, population: usize) -> Option<u64> {
        let iteration = self.convergence.quartiles.iter().position(|[_, median, _]| *median <= cost)?;
        Some((population * (iteration + 1)) as u64)
    }
}

/// Distance of one parameter from the truth, %; `None` where the truth is zero, as the flux of a motor without magnets.
pub fn error_percent(motor: &Motor, truth: &Motor, parameter: Parameter) -> Option<f64> {
    let truth = truth.get(parameter);
    (truth != 0.0).then(|| 100.0 * (motor.get(parameter) / truth - 1.0).abs())
}

/// One run: the best motor after each iteration and its cost above the minimum.
struct RunHistory {
    evaluations: u64,
    best: Vec<(Motor, f64)>,
}

impl RunHistory {
    fn of(report: &SearchReport, fitness: &Fitness) -> Self {
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

impl ConvergenceCurves {
    fn of(histories: &[RunHistory]) -> Self {
        let iterations = histories.iter().map(|history| history.best.len()).max().unwrap_or(0);
        let mut curves = Self::default();
        for iteration in 0..iterations {
            let best: Vec<(Motor, f64)> = histories.iter().map(|history| history.at(iteration)).collect();
            curves.quartiles.push(quartiles(best.iter().map(|(_, cost)| *cost).collect()));
            curves
                .parameters_median
                .push(std::array::from_fn(|p| quartiles(best.iter().map(|(motor, _)| motor.to_array()[p]).collect())[1]));
        }
        curves
    }
}

fn quartiles(values: Vec<f64>) -> [f64; 3] {
    let mut data = Data::new(values);
    [data.lower_quartile(), data.median(), data.upper_quartile()]
}
