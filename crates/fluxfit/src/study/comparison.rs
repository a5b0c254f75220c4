//! The comparison of methods: one call, [`compare`], does everything that `fluxfit compare` shows.

use super::{
    MethodStudy, ROUNDING,
    fitness::{Fitness, StudyProblem},
    run_method, use_lowest_minimum,
};
use crate::{
    error::{Error, ErrorKind},
    identification::{prepare::model::Model, request::Request},
    log::Log,
    motor::Motor,
    objective::voltage_error::IdZero,
    optimizer::{Bounds, CloseTo, Method, SearchSettings},
    paper,
};
use std::ops::ControlFlow;

/// Most methods whose curves an eye tells apart in one plot, and whose columns fit into 80 characters.
const MOST_TOGETHER: usize = 5;

/// What is asked of a comparison. The default is the paper's: its four methods, 50 runs each, on fitness (11).
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonRequest {
    /// The windows, the voltage timing, the settings of the searches, their bounds and the nameplate.
    pub request: Request,
    /// What is minimized: fitness (11), or the output error.
    pub model: Model,
    /// The methods, in the order of their results.
    pub methods: Vec<Method>,
    /// Runs of each.
    pub runs: usize,
    /// Whether i_d counts as measured or as the zero that it was controlled to, in fitness (11).
    pub id_zero: IdZero,
    /// Distance from the minimum at which a run ends, if it is to.
    pub tolerance: Option<f64>,
    /// The true motor, if known.
    pub truth: Option<Motor>,
}

impl Default for ComparisonRequest {
    fn default() -> Self {
        Self {
            request: Request::default(),
            model: Model::Steady,
            methods: paper::METHODS.to_vec(),
            runs: paper::RUNS,
            id_zero: IdZero::Measured,
            tolerance: None,
            truth: None,
        }
    }
}

/// What a comparison is about to do.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ComparisonStep {
    /// Find the minimum of what is minimized.
    Minimum,
    /// Run this method.
    Method(Method),
    /// One iteration of one run is done.
    Iteration,
    /// All runs are done, or stopped; the lowest minimum is refined.
    LowestMinimum,
}

/// The results of many runs of several methods.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// What was minimized.
    pub problem: StudyProblem,
    /// Settings of every run.
    pub settings: SearchSettings,
    /// Runs of each method that were asked for.
    pub runs: usize,
    /// Where they searched.
    pub bounds: Bounds,
    /// The true motor, if known.
    pub truth: Option<Motor>,
    /// The methods that were asked for.
    pub asked: Vec<Method>,
    /// The results, of each method that has a finished run.
    pub studies: Vec<MethodStudy>,
}

impl Comparison {
    /// Whether every method has finished all its runs.
    pub fn is_whole(&self) -> bool {
        self.studies.len() == self.asked.len() && self.studies.iter().all(|study| study.motors.len() == self.runs)
    }

    /// Whether there are too many methods for a table with a column for each, and for one plot of all their curves.
    pub fn is_crowded(&self) -> bool {
        self.studies.len() > MOST_TOGETHER
    }

    /// Evaluations after which the median of a method's runs is within the noise of the data; none if it ends above.
    pub fn evaluations_to_noise(&self, study: &MethodStudy) -> Option<u64> {
        study.evaluations_within(self.problem.noise(), self.settings.population)
    }

    /// The places of the studies, the best first: by the median of the final costs, then by the evaluations to the noise of the data,
    /// then by the worst run. Rounding errors count as equal.
    pub fn ranking(&self) -> Vec<usize> {
        let key = |place: &usize| {
            let study = &self.studies[*place];
            (study.median().max(ROUNDING), self.evaluations_to_noise(study).unwrap_or(u64::MAX), study.worst().max(ROUNDING))
        };
        let mut places: Vec<usize> = (0..self.studies.len()).collect();
        places.sort_by(|a, b| {
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.total_cmp(&b.2))
        });
        places
    }
}

/// Compares methods on a log. `progress` is told each step, from any thread; if it answers [`ControlFlow::Break`], the runs end, and only
/// those that were finished count.
///
/// # Errors
/// If the log has nothing to minimize, or a setting or bound is out of its range.
pub fn compare(
    log: &Log,
    asked: &ComparisonRequest,
    progress: &(dyn Fn(ComparisonStep) -> ControlFlow<()> + Sync),
) -> Result<Comparison, Error> {
    let _ = progress(ComparisonStep::Minimum);
    let mut problem = match asked.model {
        Model::Steady => StudyProblem::steady(log, &asked.request, asked.id_zero)?,
        Model::OutputError => StudyProblem::output_error(log, asked.request.voltage_timing)?,
    };
    let bounds = asked.request.search_box(&problem.bounds)?;
    let settings = search_settings(asked, &problem.fitness)?;
    let mut studies = Vec::new();
    for method in &asked.methods {
        if progress(ComparisonStep::Method(*method)).is_break() {
            break;
        }
        let iterated = || progress(ComparisonStep::Iteration);
        studies.extend(run_method(*method, asked.runs, settings, &bounds, &problem.fitness, iterated)?);
    }
    let _ = progress(ComparisonStep::LowestMinimum);
    use_lowest_minimum(&mut problem.fitness, &mut studies);
    Ok(Comparison { problem, settings, runs: asked.runs, bounds, truth: asked.truth, asked: asked.methods.clone(), studies })
}

fn search_settings(asked: &ComparisonRequest, fitness: &Fitness) -> Result<SearchSettings, Error> {
    let settings = asked.request.search;
    for (setting, value) in [("the tolerance", asked.tolerance), ("the target cost", settings.target_cost)] {
        if let Some(value) = value.filter(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(ErrorKind::Setting { setting, value, range: "a finite number, zero or more" }.into());
        }
    }
    let close_to_optimum = asked.tolerance.map(|tolerance| CloseTo { optimum: fitness.minimum().1, tolerance });
    Ok(SearchSettings { close_to_optimum, run: 0, ..settings })
}
