//! The document of `compare`: schema `fluxfit.study/1`.

use super::by_parameter::{ByParameter, MotorWithCost};
use crate::study::{ConvergenceCurves, MethodStudy, comparison::Comparison, fitness::Fitness};
use serde::Serialize;

/// The name of this document.
pub const STUDY: &str = "fluxfit.study/1";

/// The document that `fluxfit compare --json` prints: many runs of many optimizers on the same function. Fields are added in later
/// versions, never renamed. What is not known is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = STUDY))]
#[non_exhaustive]
pub struct StudyDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = STUDY)))]
    pub schema: &'static str,
    /// What was minimized: `steady`, the squared error of the steady voltage equations, or `output-error`.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::models())))]
    pub model: &'static str,
    /// How the voltage columns were read; null for `steady`.
    pub voltage_reading: Option<String>,
    /// Unit of every cost: V² or A².
    pub cost_unit: &'static str,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Runs of each method that were asked for.
    pub runs: usize,
    /// Candidates of each population.
    pub population: usize,
    /// The limit of iterations of each run.
    pub iterations: usize,
    /// The true parameters, SI units; null if not known.
    pub truth: Option<ByParameter<f64>>,
    /// The parameters of the lowest cost known, SI units, and this cost.
    pub minimum: MotorWithCost<f64>,
    /// Whether the polish that found the minimum converged; always true for `steady`.
    pub converged: bool,
    /// The noise of the data as a cost above the minimum: that of the true motor, on average.
    pub noise: f64,
    /// The exact minimum by least squares, SI units; null for `output-error`.
    pub least_squares: Option<MotorWithCost<f64>>,
    /// Rank of the least squares problem: 4 if it holds every parameter; null for `output-error`.
    pub rank: Option<usize>,
    /// Rows of each window, or of each segment, that were compared.
    pub rows: Vec<usize>,
    /// Lower and upper bound of the search, SI units.
    pub search_box: ByParameter<[f64; 2]>,
    /// The methods, in the order in which they were asked for.
    pub methods: Vec<MethodEntry>,
    /// Whether the study was interrupted, so that methods or runs are missing.
    pub interrupted: bool,
}

impl StudyDocument {
    /// The document of a study; each method with the seconds that one of its runs took.
    pub fn of(facts: &Comparison, methods: &[(MethodStudy, f64)], interrupted: bool) -> Self {
        let fitness = &facts.problem.fitness;
        let (motor, cost) = fitness.minimum();
        let solution = match fitness {
            Fitness::VoltageError(objective) => Some(objective.least_squares()),
            Fitness::OutputError { .. } => None,
        };
        Self {
            schema: STUDY,
            model: fitness.key(),
            voltage_reading: fitness.voltage_timing(),
            cost_unit: fitness.unit(),
            seed: facts.settings.seed,
            runs: facts.runs,
            population: facts.settings.population,
            iterations: facts.settings.iterations,
            truth: facts.truth.as_ref().map(ByParameter::from),
            minimum: MotorWithCost { motor: (&motor).into(), cost },
            converged: fitness.has_converged(),
            noise: facts.problem.noise(),
            least_squares: solution.map(|solution| MotorWithCost { motor: (&solution.motor).into(), cost: solution.cost }),
            rank: solution.map(|solution| solution.rank),
            rows: facts.problem.rows.clone(),
            search_box: ByParameter::of_box(&facts.bounds),
            methods: methods.iter().map(|(study, seconds)| MethodEntry::of(study, *seconds, facts)).collect(),
            interrupted,
        }
    }
}

/// The runs of one method.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MethodEntry {
    /// Its name.
    pub method: &'static str,
    /// Runs that were finished.
    pub runs: usize,
    /// The most evaluations that a run made.
    pub evaluations_per_run: u64,
    /// Wall time of one run, s: the only number that differs when the study is repeated.
    pub seconds_per_run: f64,
    /// Mean of the parameters over the runs, SI units.
    pub mean: ByParameter<f64>,
    /// Mean distance from the true parameters, percent; null for a true value of zero.
    pub mean_error_percent: Option<ByParameter<Option<f64>>>,
    /// Cost above the minimum at the ends of the runs.
    pub cost_above_optimum: CostAboveOptimum,
    /// The part of the runs, 0 to 1, that end within the noise of the data.
    pub share_within_noise: f64,
    /// Evaluations after which the median over the runs is within the noise of the data; null if it ends above.
    pub evaluations_to_noise: Option<u64>,
    /// The course of the runs.
    pub convergence: ConvergenceEntry,
}

impl MethodEntry {
    fn of(study: &MethodStudy, seconds_per_run: f64, facts: &Comparison) -> Self {
        Self {
            method: study.method.key(),
            runs: study.motors.len(),
            evaluations_per_run: study.evaluations_per_run,
            seconds_per_run,
            mean: (&study.mean()).into(),
            mean_error_percent: facts.truth.as_ref().map(|truth| study.mean_error_percent(truth).into()),
            cost_above_optimum: CostAboveOptimum { median: study.median(), worst: study.worst() },
            share_within_noise: study.share_within(facts.problem.noise()),
            evaluations_to_noise: facts.evaluations_to_noise(study),
            convergence: ConvergenceEntry::of(&study.convergence),
        }
    }
}

/// Cost above the minimum at the ends of many runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CostAboveOptimum {
    /// The median over the runs.
    pub median: f64,
    /// The largest.
    pub worst: f64,
}

/// The course of many runs. All lists have an entry for each iteration, the start included.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConvergenceEntry {
    /// Iterations done.
    pub iteration: Vec<usize>,
    /// Cost above the minimum.
    pub cost_above_optimum: QuartileEntry,
    /// The median of each parameter over the runs, SI units.
    pub parameters_median: ByParameter<Vec<f64>>,
}

impl ConvergenceEntry {
    fn of(convergence: &ConvergenceCurves) -> Self {
        let quartile = |which: usize| convergence.quartiles.iter().map(|quartiles| quartiles[which]).collect();
        let median = |p: usize| convergence.parameters_median.iter().map(|median| median[p]).collect();
        Self {
            iteration: (0..convergence.quartiles.len()).collect(),
            cost_above_optimum: QuartileEntry { median: quartile(1), lower_quartile: quartile(0), upper_quartile: quartile(2) },
            parameters_median: ByParameter::each(|parameter| median(parameter as usize)),
        }
    }
}

/// Quartiles over the runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuartileEntry {
    /// The median.
    pub median: Vec<f64>,
    /// A quarter of the runs lies below.
    pub lower_quartile: Vec<f64>,
    /// A quarter of the runs lies above.
    pub upper_quartile: Vec<f64>,
}
