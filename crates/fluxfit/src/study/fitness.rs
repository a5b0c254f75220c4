//! What a study minimizes on a log, and where its minimum is: that of fitness (11) exactly, that of the output error as the
//! [polish](crate::levenberg_marquardt) finds it.

use crate::{
    error::Error,
    identify::{self, Known, excitation::Excitation, search_box},
    least_squares::{Equation, TriangularFactor},
    levenberg_marquardt::{MOTOR, Polished, jacobian, polish},
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::{
        acting_voltage::VoltageReading,
        adjustable::Adjustable,
        output_error::OutputError,
        voltage_error::{IdZero, VoltageError},
    },
    optimizer::{self, Bounds, Method, Objective, Optimizer, SearchSettings},
    steady::{OperatingPoint, windows::at_most_paper_rows},
};
use rayon::prelude::*;

/// The search from which a polish starts where no steady window gives one: coarse, since the polish comes home from far away.
const COARSE: SearchSettings =
    SearchSettings { population: 20, iterations: 30, seed: 1, run: 0, close_to_optimum: None, target_cost: None };

/// Half a 95 % interval, in standard errors.
const INTERVAL: f64 = 1.96;

/// A small part of what the log allows a parameter.
const SMALL_PART: f64 = 0.01;

/// A fitness on a log, and what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// What is minimized.
    pub fitness: Fitness,
    /// The steady windows that it sums over, before any correction; none of the output error, which takes all rows.
    pub operating_points: Vec<OperatingPoint>,
    /// Rows that the fitness sums over, per window or per segment.
    pub rows: Vec<usize>,
    /// The box that the log allows.
    pub bounds: Bounds,
    /// Parameters of which the fitness tells nothing: what a swarm says of them is chance.
    pub unexcited: Vec<Parameter>,
}

/// What is minimized.
#[derive(Debug, Clone, PartialEq)]
pub enum Fitness {
    /// Fitness (11).
    VoltageError(VoltageError),
    /// The output error.
    OutputError {
        /// The output error itself.
        objective: OutputError,
        /// How the voltage columns were read.
        reading: VoltageReading,
        /// The lowest cost that is known.
        minimum: Polished,
    },
}

impl Problem {
    /// Fitness (11) on the steady windows of a log: on at most the paper's 4000 samples of each, with the held-vector correction
    /// that an identification makes.
    ///
    /// # Errors
    /// If there is no steady window.
    pub fn steady(log: &Log, settings: &identify::Settings, id_zero: IdZero) -> Result<Self, Error> {
        let whole = identify::operating_points(log, settings)?;
        let rows = at_most_paper_rows(&whole.into_iter().map(|point| point.rows).collect::<Vec<_>>());
        let points: Vec<_> = rows.into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect();
        let beliefs = identify::beliefs(log, &points, identify::voltage_timing(settings).0, settings);
        let windows: Vec<_> = points.iter().zip(beliefs).map(|(point, belief)| (point.rows.clone(), belief.held_vector)).collect();
        let excitation = Excitation::of(&points, &[Known::Nothing; PARAMETERS]);
        Ok(Self {
            fitness: Fitness::VoltageError(VoltageError::of_samples(log, &windows, id_zero)),
            rows: windows.iter().map(|(rows, _)| rows.len()).collect(),
            bounds: search_box::from_points(&points)?,
            unexcited: Parameter::ALL.into_iter().filter(|parameter| excitation.is_open(*parameter)).collect(),
            operating_points: points,
        })
    }

    /// The output error on every row of a log, its voltages read as stated, or else as they fit best.
    ///
    /// # Errors
    /// If the log is too short, or no motor that it allows has a finite cost.
    pub fn output_error(log: &Log, stated: Option<VoltageReading>) -> Result<Self, Error> {
        let steady = Self::steady(log, &identify::Settings::default(), IdZero::Measured).ok();
        let (mut starts, bounds) = match steady {
            Some(steady) => (vec![steady.fitness.minimum().0], steady.bounds),
            None => (Vec::new(), search_box::from_rows(log)?),
        };
        let objectives: Vec<(VoltageReading, OutputError)> =
            readings(stated).into_iter().map(|reading| Ok((reading, OutputError::of(log, reading)?))).collect::<Result<_, Error>>()?;
        // Least squares may leave an inductance at zero or below, from where no polish starts: the coarse search helps it out.
        if let Some((_, objective)) = objectives.first() {
            starts.push(coarse(objective, &bounds)?);
        }
        let polished = objectives.into_par_iter().filter_map(|(reading, objective)| {
            let ends = starts.iter().map(|start| polish(&objective, start)).filter(|end| end.cost.is_finite());
            let minimum = ends.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
            Some((reading, objective, minimum))
        });
        // Per row: a delay costs rows, and a sum over fewer is no better fit.
        let per_row = |(_, objective, minimum): &(VoltageReading, OutputError, Polished)| minimum.cost / objective.rows() as f64;
        let best = polished.collect::<Vec<_>>().into_iter().min_by(|a, b| per_row(a).total_cmp(&per_row(b)));
        let (reading, objective, minimum) = best.ok_or(optimizer::Error::NonFiniteStart { population: COARSE.population })?;
        Ok(Self {
            rows: objective.rows_per_segment(),
            unexcited: unexcited(&objective, &minimum, &bounds),
            fitness: Fitness::OutputError { objective, reading, minimum },
            operating_points: Vec::new(),
            bounds,
        })
    }
}

impl Fitness {
    /// Name in files and on the command line: the model of `--model`.
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

    /// What its minimum is called.
    pub fn minimum_label(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "exact minimum",
            Self::OutputError { .. } => "polished minimum",
        }
    }

    /// The index of its minimum, F with it being the cost there.
    pub fn minimum_index(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "LS",
            Self::OutputError { .. } => "LM",
        }
    }

    /// What finds its minimum.
    pub fn solver(&self) -> &'static str {
        match self {
            Self::VoltageError(_) => "least squares",
            Self::OutputError { .. } => "polish",
        }
    }

    /// How the voltage columns were read, where the fitness asks.
    pub fn voltage_reading(&self) -> Option<String> {
        match self {
            Self::VoltageError(_) => None,
            Self::OutputError { reading, .. } => Some(reading.key().to_owned()),
        }
    }

    /// The lowest motor known, and its cost.
    pub fn minimum(&self) -> (Motor, f64) {
        match self {
            Self::VoltageError(objective) => (objective.least_squares().motor, objective.least_squares().cost),
            Self::OutputError { minimum, .. } => (minimum.drive.motor, minimum.cost),
        }
    }

    /// Whether the lowest motor known is a minimum. Of least squares it always is.
    pub fn has_converged(&self) -> bool {
        match self {
            Self::VoltageError(_) => true,
            Self::OutputError { minimum, .. } => minimum.converged,
        }
    }

    /// How far a motor of this cost lies above the minimum: of fitness (11) without cancellation; of the output error the plain
    /// difference, negative where a search has found less than the polish.
    pub fn cost_above_optimum(&self, motor: &Motor, cost: f64) -> f64 {
        match self {
            Self::VoltageError(objective) => objective.cost_above_optimum(motor),
            Self::OutputError { minimum, .. } => cost - minimum.cost,
        }
    }

    /// Takes a motor that lies below the minimum known, polished, as the new minimum; returns by how much the minimum fell.
    pub(super) fn lower_to(&mut self, motor: &Motor) -> f64 {
        let Self::OutputError { objective, minimum, .. } = self else { return 0.0 };
        let (before, cost) = (minimum.cost, objective.cost(motor));
        let polished = polish(objective, motor);
        // At a minimum already, the polish cannot gain, and may lose a rounding.
        *minimum = if polished.cost <= cost { polished } else { Polished { drive: Adjustable::from(*motor), cost, ..polished } };
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

/// The readings to try: the one stated, or all that drives are known to have.
fn readings(stated: Option<VoltageReading>) -> Vec<VoltageReading> {
    stated.map_or_else(|| VoltageReading::ALL.to_vec(), |stated| vec![stated])
}

/// Where a coarse search ends.
fn coarse(objective: &OutputError, bounds: &Bounds) -> Result<Motor, Error> {
    let report = Optimizer::start(Method::default(), COARSE, bounds.clone(), objective)?.run(objective);
    Ok(Motor::from(std::array::from_fn(|p| report.best[p])))
}

/// Parameters that might as well be zero: their 95 % interval at the minimum, were the residuals white, holds it, and is no small
/// part of what the log allows. (A motor without magnets knows its flux, zero, well.)
///
/// A standard error is the residuals' standard deviation over what of the parameter's derivative the other three cannot imitate.
fn unexcited(objective: &OutputError, minimum: &Polished, bounds: &Bounds) -> Vec<Parameter> {
    let derivatives = jacobian(objective, &minimum.drive, &MOTOR);
    let freedom = (2 * objective.rows()).saturating_sub(PARAMETERS).max(1);
    let variance = minimum.cost / freedom as f64;
    let is_open = |(parameter, (lower, upper)): &(Parameter, (f64, f64))| {
        let own = *parameter as usize;
        let others = (0..derivatives[own].len()).map(|row| Equation {
            coefficients: std::array::from_fn(|p| if p == own { 0.0 } else { derivatives[p][row] }),
            value: derivatives[own][row],
        });
        let alone = others.collect::<TriangularFactor>().solve().cost;
        let told = minimum.drive.motor.get(*parameter).abs().max(SMALL_PART * (upper - lower));
        let is_told = told * told * alone > INTERVAL * INTERVAL * variance;
        !is_told
    };
    Parameter::ALL.into_iter().zip(bounds.iter()).filter(is_open).map(|(parameter, _)| parameter).collect()
}
