//! The fitness that a study minimizes on a log, and its minimum: exact for fitness (11); for the output error, the local minimum found
//! by [Levenberg and Marquardt's method](crate::levenberg_marquardt).

use crate::{
    error::Error,
    identification::{
        fit::{
            excitation::Excitation,
            steady::{operating_points, preliminary_estimates, voltage_timing},
        },
        prepare::search_box,
        request::{Known, Request},
    },
    least_squares::{Equation, TriangularFactor},
    levenberg_marquardt::{MOTOR, Polished, jacobian, polish},
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::{
        acting_voltage::VoltageTiming,
        adjustable::Adjustable,
        output_error::OutputError,
        voltage_error::{IdZero, VoltageError},
    },
    optimizer::{self, Bounds, Method, Objective, Optimizer, SearchSettings},
    parallel,
    steady::{OperatingPoint, windows::at_most_paper_rows},
};

/// The coarse search that gives a start for the Levenberg-Marquardt method, which converges from far away.
const COARSE_SEARCH: SearchSettings =
    SearchSettings { population: 20, iterations: 30, seed: 1, run: 0, close_to_optimum: None, target_cost: None };

/// Half-width of a 95 % interval in standard errors.
const HALF_WIDTH: f64 = 1.96;

/// A value below this fraction of the width of the search box counts as zero.
const SMALL_FRACTION: f64 = 0.01;

/// The minimization problem of a study: a fitness on a log, and its search box.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyProblem {
    /// The fitness to be minimized.
    pub fitness: Fitness,
    /// The steady windows over which the fitness sums, before any correction; empty for the output error, which sums over all rows.
    pub operating_points: Vec<OperatingPoint>,
    /// Number of rows over which the fitness sums, per window or per segment.
    pub rows: Vec<usize>,
    /// The search box, derived from the log.
    pub bounds: Bounds,
    /// Parameters that the log does not excite: the fitness does not depend on them, and a swarm's values for them are random.
    pub unexcited: Vec<Parameter>,
}

/// The fitness of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum Fitness {
    /// Fitness (11), the voltage error.
    VoltageError(VoltageError),
    /// The output error.
    OutputError {
        /// The objective.
        objective: OutputError,
        /// The voltage timing.
        reading: VoltageTiming,
        /// The lowest minimum known.
        minimum: Box<Polished>,
    },
}

impl StudyProblem {
    /// Fitness (11) on the steady windows of a log: on at most the paper's 4000 samples of each, with the zero-order-hold correction
    /// of an identification.
    ///
    /// # Errors
    /// If there is no steady window.
    pub fn steady(log: &Log, request: &Request, id_zero: IdZero) -> Result<Self, Error> {
        let whole = operating_points(log, request)?;
        let rows = at_most_paper_rows(&whole.into_iter().map(|point| point.rows).collect::<Vec<_>>());
        let points: Vec<_> = rows.into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect();
        let preliminary = preliminary_estimates(log, &points, voltage_timing(request).value, request);
        let windows: Vec<_> = points.iter().zip(preliminary).map(|(point, estimate)| (point.rows.clone(), estimate.hold)).collect();
        let excitation = Excitation::of(&points, &[Known::Nothing; PARAMETERS]);
        Ok(Self {
            fitness: Fitness::VoltageError(VoltageError::of_samples(log, &windows, id_zero)),
            rows: windows.iter().map(|(rows, _)| rows.len()).collect(),
            bounds: search_box::from_points(&points)?,
            unexcited: Parameter::ALL.into_iter().filter(|parameter| excitation.is_open(*parameter)).collect(),
            operating_points: points,
        })
    }

    /// The output error on every row of a log, with the stated voltage timing, or else with the one that fits best.
    ///
    /// # Errors
    /// If the log is too short, or no motor in the search box has a finite cost.
    pub fn output_error(log: &Log, stated: Option<VoltageTiming>) -> Result<Self, Error> {
        log.refuse_short_circuit()?;
        let steady = Self::steady(log, &Request::default(), IdZero::Measured).ok();
        let (mut starts, bounds) = match steady {
            Some(steady) => (vec![steady.fitness.minimum().0], steady.bounds),
            None => (Vec::new(), search_box::from_rows(log)?),
        };
        let objectives: Vec<(VoltageTiming, OutputError)> = voltage_timings(stated)
            .into_iter()
            .map(|reading| Ok((reading, OutputError::of(log, reading)?)))
            .collect::<Result<_, Error>>()?;
        // Least squares may give an inductance that is not positive, from which there is no descent; hence a second start.
        if let Some((_, objective)) = objectives.first() {
            starts.push(coarse_start(objective, &bounds)?);
        }
        let lowest = |(_, objective): &(VoltageTiming, OutputError)| {
            let ends = starts.iter().map(|start| polish(objective, start)).filter(|end| end.cost.is_finite());
            ends.min_by(|a, b| a.cost.total_cmp(&b.cost))
        };
        let minima = parallel::map(&objectives, lowest);
        let polished =
            objectives.into_iter().zip(minima).filter_map(|((reading, objective), minimum)| Some((reading, objective, minimum?)));
        // Costs are compared per row: a delay leaves fewer rows, and a sum over fewer rows is smaller without a better fit.
        let per_row = |(_, objective, minimum): &(VoltageTiming, OutputError, Polished)| minimum.cost / objective.rows() as f64;
        let best = polished.min_by(|a, b| per_row(a).total_cmp(&per_row(b)));
        let (reading, objective, minimum) = best.ok_or(optimizer::Error::NonFiniteStart { population: COARSE_SEARCH.population })?;
        Ok(Self {
            rows: objective.rows_per_segment(),
            unexcited: unexcited(&objective, &minimum, &bounds),
            fitness: Fitness::OutputError { objective, reading, minimum: Box::new(minimum) },
            operating_points: Vec::new(),
            bounds,
        })
    }
}

impl StudyProblem {
    /// The noise of the data as a cost: how far above the minimum the true motor lies on average, `p F / (n - p)` of `p` parameters and
    /// `n` equations, two per row, if the residuals at the minimum are white noise. Ends closer to the minimum than this are equally good.
    pub fn noise(&self) -> f64 {
        let (parameters, equations) = (PARAMETERS as f64, 2.0 * self.rows.iter().sum::<usize>() as f64);
        parameters * self.fitness.minimum().1 / (equations - parameters).max(1.0)
    }
}

impl Fitness {
    /// Name in files: that of the model.
    pub fn key(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "steady",
            Self::OutputError { .. } => "output-error",
        }
    }

    /// Name in prose.
    pub fn label(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "fitness (11)",
            Self::OutputError { .. } => "the output error",
        }
    }

    /// Unit of the cost.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "V²",
            Self::OutputError { .. } => "A²",
        }
    }

    /// Name of its minimum.
    pub fn minimum_label(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "exact minimum",
            Self::OutputError { .. } => "polished minimum",
        }
    }

    /// Subscript of the cost at the minimum, as in F_LS.
    pub fn minimum_subscript(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "LS",
            Self::OutputError { .. } => "LM",
        }
    }

    /// Name of the method that finds its minimum.
    pub fn solver(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "least squares",
            Self::OutputError { .. } => "polish",
        }
    }

    /// The voltage timing, for a fitness that depends on it.
    pub fn voltage_timing(&self) -> Option<String> {
        match self {
            Self::VoltageError(_) => None,
            Self::OutputError { reading, .. } => Some(reading.key().to_owned()),
        }
    }

    /// The motor of lowest cost known, and its cost.
    pub fn minimum(&self) -> (Motor, f64) {
        match self {
            Self::VoltageError(objective) => (objective.least_squares().motor, objective.least_squares().cost),
            Self::OutputError { minimum, .. } => (minimum.drive.motor, minimum.cost),
        }
    }

    /// Whether the motor of lowest cost known is a minimum. That of least squares always is.
    pub fn has_converged(&self) -> bool {
        match self {
            Self::VoltageError(_) => true,
            Self::OutputError { minimum, .. } => minimum.converged,
        }
    }

    /// Cost of a motor above the minimum: for fitness (11) without cancellation; for the output error the difference of costs, which is
    /// negative where a search has found a lower cost than the Levenberg-Marquardt method.
    pub fn cost_above_optimum(&self, motor: &Motor, cost: f64) -> f64 {
        match self {
            Self::VoltageError(objective) => objective.cost_above_optimum(motor),
            Self::OutputError { minimum, .. } => cost - minimum.cost,
        }
    }

    /// Replaces the minimum by the local minimum reached from a motor of lower cost; returns the decrease of the minimum.
    pub(super) fn improve_minimum(&mut self, motor: &Motor) -> f64 {
        let Self::OutputError { objective, minimum, .. } = self else { return 0.0 };
        let (before, cost) = (minimum.cost, objective.cost(motor));
        let polished = polish(objective, motor);
        // From a minimum the polish cannot descend, and rounding may make its result slightly worse.
        **minimum = if polished.cost <= cost { polished } else { Polished { drive: Adjustable::from(*motor), cost, ..polished } };
        before - minimum.cost
    }
}

impl Objective for Fitness {
    fn dimension(&self) -> usize {
        PARAMETERS
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        match self {
            Self::VoltageError(objective) => objective.evaluate(candidates, costs),
            Self::OutputError { objective, .. } => objective.evaluate(candidates, costs),
        }
    }
}

/// The voltage timings to try: the one stated, or all that inverters have.
fn voltage_timings(stated: Option<VoltageTiming>) -> Vec<VoltageTiming> {
    stated.map_or_else(|| VoltageTiming::ALL.into_iter().filter(|timing| !timing.is_unusual()).collect(), |stated| vec![stated])
}

/// The best motor of a coarse search.
fn coarse_start(objective: &OutputError, bounds: &Bounds) -> Result<Motor, Error> {
    let report = Optimizer::start(Method::default(), COARSE_SEARCH, bounds.clone(), objective)?.run(objective);
    Ok(Motor::from(std::array::from_fn(|p| report.best[p])))
}

/// Parameters that the log does not excite: their 95 % interval at the minimum, for white residuals, contains zero and is not small
/// compared with the search box. (The interval of a motor without magnets is narrow about its flux of zero.)
///
/// The standard error is the residuals' standard deviation divided by the norm of the part of the parameter's derivative that is
/// orthogonal to the derivatives of the other three.
fn unexcited(objective: &OutputError, minimum: &Polished, bounds: &Bounds) -> Vec<Parameter> {
    let derivatives = jacobian(objective, &minimum.drive, &MOTOR);
    let freedom = (2 * objective.rows()).saturating_sub(PARAMETERS).max(1);
    let variance = minimum.cost / freedom as f64;
    let is_unexcited = |(parameter, (lower, upper)): &(Parameter, (f64, f64))| {
        let own = *parameter as usize;
        let others = (0..derivatives[own].len()).map(|row| Equation {
            coefficients: std::array::from_fn(|p| if p == own { 0.0 } else { derivatives[p][row] }),
            value: derivatives[own][row],
        });
        let orthogonal = others.collect::<TriangularFactor>().solve().cost;
        let size = minimum.drive.motor.get(*parameter).abs().max(SMALL_FRACTION * (upper - lower));
        let is_excited = size * size * orthogonal > HALF_WIDTH * HALF_WIDTH * variance;
        !is_excited
    };
    Parameter::ALL.into_iter().zip(bounds.iter()).filter(is_unexcited).map(|(parameter, _)| parameter).collect()
}
