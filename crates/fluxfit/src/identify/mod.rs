//! Identification: from a log to four parameters, each with an interval and a verdict.
//!
//! [`identify`] is the main path. It fits the [steady equations](steady_fit) to the log's operating points and, where the log is
//! sampled fast enough, the [simulated currents](output_fit) to its rows; the [model] that suits the log answers. The swarm's own
//! answer is reported beside it.

mod advice;
pub mod conventions;
pub mod dead_time;
pub mod estimate;
pub mod excitation;
mod explain;
mod long_run;
pub mod misfit;
pub mod model;
pub mod output_fit;
mod pieces;
pub mod saturation;
pub mod search_box;
pub mod steady_fit;
pub mod terms;
pub mod timing;
pub mod uncertainty;
pub mod verdict;
pub mod warning;

use crate::{
    error::Error,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::acting_voltage::VoltageReading,
    optimizer::{Bounds, Method, Objective, Optimizer, SearchReport, SearchSettings},
    steady::OperatingPoint,
};
use model::Model;
use output_fit::OutputFit;
use saturation::Saturation;
use std::ops::ControlFlow;
use steady_fit::SteadyFit;
pub use steady_fit::{beliefs, operating_points, voltage_timing};
use verdict::Judgement;
use warning::Warning;

/// What the voltages are trusted to, as a fraction of their vector, unless told otherwise: no drive's are known better.
pub const VOLTAGE_ACCURACY: f64 = 1e-4;

/// What is asked of an identification.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The model that answers; none: the one that suits the log.
    pub model: Option<Model>,
    /// Windows in time, s; none: they are found.
    pub windows: Vec<(f64, f64)>,
    /// What the voltage columns mean; none: the output error finds it; operating points take it as centred, with the doubt in the
    /// systematic uncertainty.
    pub voltage_timing: Option<VoltageReading>,
    /// Systematic uncertainty of the voltages as a fraction of the vector, one standard deviation, independent between windows and axes.
    pub voltage_accuracy: f64,
    /// What is known of the motor beforehand.
    pub known: [Known; PARAMETERS],
    /// The swarm that searches beside the exact answer, if any. On the output error it takes some seconds.
    pub method: Option<Method>,
    /// Its settings.
    pub search: SearchSettings,
    /// Its box; none: from the log.
    pub bounds: Option<Bounds>,
}

/// What is known of one parameter before the log is read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Known {
    /// Nothing.
    #[default]
    Nothing,
    /// Its value, taken as exact.
    Fixed(f64),
    /// A value with a standard error.
    Prior {
        /// Value, SI.
        value: f64,
        /// Standard error, SI.
        standard_error: f64,
    },
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            model: None,
            windows: Vec::new(),
            voltage_timing: None,
            voltage_accuracy: VOLTAGE_ACCURACY,
            known: [Known::Nothing; PARAMETERS],
            method: None,
            search: SearchSettings::default(),
            bounds: None,
        }
    }
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// The parameters, in the order of [`Parameter::ALL`].
    pub parameters: [Judgement; PARAMETERS],
    /// The model that answered, and why it did.
    pub model: (Model, String),
    /// What the operating points say; none where there is none.
    pub steady: Option<SteadyFit>,
    /// What the simulated currents say; none where the steady model answered.
    pub output: Option<OutputFit>,
    /// Flux at the operating points, where inductances depend on the current; none where nothing says so.
    pub saturation: Option<Saturation>,
    /// Correlation of the parameters' errors.
    pub correlation: [[f64; PARAMETERS]; PARAMETERS],
    /// The swarm's own answer.
    pub search: Option<Search>,
    /// What the reader should know.
    pub warnings: Vec<Warning>,
}

/// Where a choice comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Provenance {
    /// The settings state it.
    Stated,
    /// The log shows it.
    Found,
    /// It is assumed, and the doubt counted as uncertainty.
    Assumed,
}

/// What an identification is about to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Find the operating points and solve them.
    OperatingPoints,
    /// Choose the reading of the voltages.
    Readings,
    /// Look for faults of the drive.
    Faults,
    /// Fit all rows.
    Fit {
        /// Simulations of all rows so far.
        simulations: usize,
        /// As many as it usually takes.
        usual: usize,
    },
    /// Tell how uncertain the answer is.
    Uncertainty,
    /// Let the swarm search.
    Search {
        /// Iterations done.
        iteration: usize,
        /// Their limit.
        limit: usize,
    },
}

/// Whoever watches an identification, and says whether to go on.
pub type Watch<'a> = &'a dyn Fn(Step) -> ControlFlow<()>;

/// Runs the swarm that `settings` ask for, if any, watched.
fn searched(objective: &impl Objective, bounds: &Bounds, settings: &Settings, watch: Watch) -> Result<Option<SearchReport>, Error> {
    let Some(method) = settings.method else { return Ok(None) };
    let (mut iteration, limit) = (0, settings.search.iterations);
    let _ = watch(Step::Search { iteration, limit });
    let mut optimizer = Optimizer::start(method, settings.search, bounds.clone(), objective)?;
    Ok(Some(optimizer.run_while(objective, || {
        iteration += 1;
        watch(Step::Search { iteration, limit })
    })))
}

/// What the swarm found, unpolished.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Its motor.
    pub motor: Motor,
    /// How far its cost lies above the exact minimum.
    pub cost_above_optimum: f64,
    /// Where it searched.
    pub bounds: Bounds,
    /// Its course.
    pub report: SearchReport,
}

impl Identification {
    /// One parameter's judgement.
    pub fn parameter(&self, parameter: Parameter) -> &Judgement {
        &self.parameters[parameter as usize]
    }

    /// The log's operating points; none where it never holds still.
    pub fn operating_points(&self) -> &[OperatingPoint] {
        self.steady.as_ref().map_or(&[], |fit| &fit.operating_points)
    }

    /// Whether everything asked for was identified.
    pub fn is_complete(&self) -> bool {
        self.parameters.iter().all(|judgement| judgement.verdict == verdict::Verdict::Identified)
    }
}

/// Identifies a motor from a log.
///
/// # Errors
/// If a setting is out of range, or no steady operating point is found. A log that cannot carry some parameter is no error: the
/// verdicts say so.
pub fn identify(log: &Log, settings: &Settings) -> Result<Identification, Error> {
    identify_watched(log, settings, &|_| ControlFlow::Continue(()))
}

/// [`identify`], telling each step that begins. Told to break, the swarm's search ends after its current iteration; the exact answer is
/// never cut.
///
/// # Errors
/// As [`identify`].
pub fn identify_watched(log: &Log, settings: &Settings, watch: Watch) -> Result<Identification, Error> {
    check(settings)?;
    let _ = watch(Step::OperatingPoints);
    let steady = SteadyFit::of(log, settings);
    let model = model::choose(log, settings);
    let mut found = match model.0 {
        Model::Steady => of_points(steady?, model, settings, watch)?,
        Model::OutputError => of_currents(log, steady.ok(), model, settings, watch)?,
    };
    found.warnings = warning::warnings(log, &found, settings);
    Ok(found)
}

/// The answer of the operating points.
fn of_points(fit: SteadyFit, model: (Model, String), settings: &Settings, watch: Watch) -> Result<Identification, Error> {
    let (parameters, correlation) = fit.judge(settings);
    let search = fit.search(settings, watch)?;
    let saturation = fit.saturation.clone();
    Ok(Identification { parameters, model, steady: Some(fit), output: None, saturation, correlation, search, warnings: Vec::new() })
}

/// The answer of the simulated currents.
fn of_currents(
    log: &Log,
    steady: Option<SteadyFit>,
    model: (Model, String),
    settings: &Settings,
    watch: Watch,
) -> Result<Identification, Error> {
    let fit = OutputFit::of(log, steady.as_ref(), settings, watch)?;
    let of_points = steady.as_ref().map_or((&[][..], None), |fit| (&fit.operating_points[..], fit.saturation.as_ref()));
    let saturation = Saturation::of_currents(&fit, log, of_points, settings);
    let (parameters, correlation) = fit.judge(saturation.as_ref(), settings);
    let search = fit.search(log, steady.as_ref(), settings, watch)?;
    Ok(Identification { parameters, model, steady, output: Some(fit), saturation, correlation, search, warnings: Vec::new() })
}

fn check(settings: &Settings) -> Result<(), Error> {
    let accuracy = settings.voltage_accuracy;
    if !(0.0..1.0).contains(&accuracy) {
        return Err(Error::Setting { setting: "the voltage accuracy", value: accuracy, range: "a fraction from 0 up to 1" });
    }
    for known in settings.known {
        let (value, standard_error) = match known {
            Known::Nothing => continue,
            Known::Fixed(value) => (value, 1.0),
            Known::Prior { value, standard_error } => (value, standard_error),
        };
        if !value.is_finite() {
            return Err(Error::Setting { setting: "a known parameter", value, range: "a finite number" });
        }
        if !(standard_error > 0.0 && standard_error.is_finite()) {
            return Err(Error::Setting {
                setting: "the standard error of a known parameter",
                value: standard_error,
                range: "a positive number",
            });
        }
    }
    if settings.known.iter().all(|known| matches!(known, Known::Fixed(_))) { Err(Error::NothingToIdentify) } else { Ok(()) }
}
