//! Identification: from a log to four parameters, each with an interval and a verdict.
//!
//! [`identify`] is the main path. Its model is the steady one: equation (2) on the means of steady windows, for which weighted
//! least squares is exact; the swarm's answer is reported beside it.

pub mod conventions;
pub mod dead_time;
pub mod estimate;
pub mod excitation;
mod explain;
pub mod misfit;
pub mod search_box;
pub mod uncertainty;
pub mod verdict;
pub mod warning;

use crate::{
    error::Error,
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    optimizer::{self, Method, Optimizer, Report, bounds::Bounds},
    steady::{
        Belief, OperatingPoint,
        held_vector::{HeldVector, MAX_ANGLE_PER_SAMPLE, MAX_DECAY_PER_SAMPLE, VoltageTiming},
        windows,
    },
};
use estimate::Estimate;
use excitation::Excitation;
use misfit::Misfit;
use uncertainty::{Doubt, Uncertainty};
use verdict::Judgement;
use warning::Warning;

/// What the voltages are trusted to, as a fraction of their vector, unless told otherwise: no drive's are known better.
pub const VOLTAGE_ACCURACY: f64 = 1e-4;

/// What is asked of an identification.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Windows in time, s; none: they are found.
    pub windows: Vec<(f64, f64)>,
    /// What the voltage columns mean; none: centred, where the sampling is fast enough for it to matter, with the doubt in the
    /// systematic uncertainty.
    pub voltage_timing: Option<VoltageTiming>,
    /// Systematic uncertainty of the voltages as a fraction of the vector, one standard deviation, independent between windows and axes.
    pub voltage_accuracy: f64,
    /// What is known of the motor beforehand.
    pub known: [Known; PARAMETERS],
    /// The swarm that searches beside least squares, if any.
    pub method: Option<Method>,
    /// Its settings.
    pub search: optimizer::Settings,
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
            windows: Vec::new(),
            voltage_timing: None,
            voltage_accuracy: VOLTAGE_ACCURACY,
            known: [Known::Nothing; PARAMETERS],
            method: Some(Method::Tgfpa(optimizer::tgfpa::Tgfpa::default())),
            search: optimizer::Settings::default(),
            bounds: None,
        }
    }
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// The parameters, in the order of [`Parameter::ALL`].
    pub parameters: [Judgement; PARAMETERS],
    /// The windows that carried them.
    pub operating_points: Vec<OperatingPoint>,
    /// Least squares, solved exactly.
    pub estimate: Estimate,
    /// What the log excites.
    pub excitation: Excitation,
    /// How the voltage columns were read, and whether that was stated or assumed.
    pub voltage_timing: (VoltageTiming, Provenance),
    /// Correlation of the parameters' errors.
    pub correlation: [[f64; PARAMETERS]; PARAMETERS],
    /// Contradiction between the operating points, if proven.
    pub misfit: Option<Misfit>,
    /// What dead time or device drops seem to take from each operating point's voltage along its current, V; zero where nothing is seen.
    pub voltage_losses: Vec<f64>,
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
    /// It is assumed, and the doubt counted as uncertainty.
    Assumed,
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
    pub report: Report,
}

impl Identification {
    /// One parameter's judgement.
    pub fn parameter(&self, parameter: Parameter) -> &Judgement {
        &self.parameters[parameter as usize]
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
    check(settings)?;
    let rough = operating_points(log, settings)?;
    let (points, timing_doubt) = measure(log, &rough, settings);
    let excitation = Excitation::of(&points, &settings.known);
    let estimate = Estimate::solve(&points, &excitation, settings);
    let (estimate, misfit) = misfit::admit(&points, &excitation, estimate, settings);
    let search = search(&points, &excitation, &estimate, settings)?;
    let losses = dead_time::losses(log, &points, &excitation, &estimate);
    let doubt = Doubt { timing: timing_doubt, dead_time: dead_time::doubt(log, &points, &estimate, &losses) };
    let uncertainty = Uncertainty::of(&points, &excitation, &estimate, misfit.as_ref(), &doubt);
    let parameters = verdict::judge(&points, &excitation, &estimate, &uncertainty, settings);
    let mut found = Identification {
        parameters,
        operating_points: points,
        estimate,
        excitation,
        voltage_timing: voltage_timing(settings),
        correlation: uncertainty.correlation,
        misfit,
        voltage_losses: losses,
        search,
        warnings: Vec::new(),
    };
    found.warnings = warning::warnings(log, &found, settings);
    Ok(found)
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

/// Centred, unless stated otherwise: what drives that log their realized voltage mostly mean.
pub fn voltage_timing(settings: &Settings) -> (VoltageTiming, Provenance) {
    settings.voltage_timing.map_or((VoltageTiming::Centered, Provenance::Assumed), |stated| (stated, Provenance::Stated))
}

/// The operating points in the windows named, or in those found, as the log has them: before any correction, and with a coarse covariance.
///
/// # Errors
/// If there is none.
pub fn operating_points(log: &Log, settings: &Settings) -> Result<Vec<OperatingPoint>, Error> {
    let mut windows = Vec::new();
    for times in &settings.windows {
        windows.extend(windows::between(log, *times)?);
    }
    if windows.is_empty() {
        windows = windows::find(log)?;
    }
    Ok(windows.into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect())
}

/// Measures the points again: now the motor is known roughly, and the corrections and the covariance that need it are possible.
/// Beside the points: how far the answer moves with the timing of the voltage columns, where nobody stated it.
fn measure(log: &Log, rough: &[OperatingPoint], settings: &Settings) -> (Vec<OperatingPoint>, [f64; PARAMETERS]) {
    let with = |timing: VoltageTiming| -> Vec<OperatingPoint> {
        let beliefs = beliefs(log, rough, timing, settings);
        rough.iter().zip(&beliefs).map(|(point, belief)| OperatingPoint::measure(log, point.rows.clone(), Some(belief))).collect()
    };
    let solve = |points: &[OperatingPoint]| Estimate::solve(points, &Excitation::of(points, &settings.known), settings).motor;
    let points = with(voltage_timing(settings).0);
    let doubt = match settings.voltage_timing {
        Some(_) => [0.0; PARAMETERS],
        None => {
            let (one, other) = (solve(&points).to_array(), solve(&with(VoltageTiming::Compensated)).to_array());
            std::array::from_fn(|p| (one[p] - other[p]).abs())
        }
    };
    (points, doubt)
}

/// What a first look at the operating points tells of each: the motor, and the held-vector correction of its window.
pub fn beliefs(log: &Log, rough: &[OperatingPoint], timing: VoltageTiming, settings: &Settings) -> Vec<Belief> {
    let excitation = Excitation::of(rough, &settings.known);
    let motor = Estimate::solve(rough, &excitation, settings).motor;
    let inductance = inductance(&motor, &excitation);
    let fastest = rough.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    rough.iter().map(|point| Belief { motor, held_vector: held_vector(log, point, fastest, timing, motor.rs, inductance) }).collect()
}

/// The inductances for the current's ripple: a rough estimate will do, but not one of noise. What the log does not excite is
/// taken from the other axis.
fn inductance(motor: &Motor, excitation: &Excitation) -> Dq {
    let known =
        |parameter| Some(motor.get(parameter)).filter(|value| *value > 0.0 && excitation.unexcited_reach[parameter as usize] < *value);
    let (ld, lq) = (known(Parameter::Ld), known(Parameter::Lq));
    Dq { d: ld.or(lq).unwrap_or(f64::INFINITY), q: lq.or(ld).unwrap_or(f64::INFINITY) }
}

/// The correction that fits a window: none where the log's sampling cannot be the inverter's at the fastest speed (rad/s) of all
/// windows, so that either all of them are corrected or none; none of the current where so long a period does not shape it.
fn held_vector(log: &Log, point: &OperatingPoint, fastest: f64, timing: VoltageTiming, rs: f64, inductance: Dq) -> HeldVector {
    match log.segment_of(point.rows.start).map(|segment| segment.sample_period) {
        Some(sample_period) if fastest * sample_period <= MAX_ANGLE_PER_SAMPLE => {
            let shapes = |l: f64| if rs > 0.0 && rs * sample_period <= MAX_DECAY_PER_SAMPLE * l { l } else { f64::INFINITY };
            HeldVector { timing, sample_period, inductance: Dq { d: shapes(inductance.d), q: shapes(inductance.q) } }
        }
        _ => HeldVector::NONE,
    }
}

/// Lets the swarm minimize the same weighted equations that least squares solved.
fn search(points: &[OperatingPoint], excitation: &Excitation, estimate: &Estimate, settings: &Settings) -> Result<Option<Search>, Error> {
    let Some(method) = settings.method else { return Ok(None) };
    let bounds = match &settings.bounds {
        Some(bounds) => bounds.clone(),
        None => search_box::from_points(points)?,
    };
    let objective = &estimate.objective;
    let report = Optimizer::start(method, settings.search, bounds.clone(), objective)?.run(objective);
    // Where the cost is flat a swarm ends anywhere: only what the log excites is its answer.
    let mut found = excitation.excited_motor(&Motor::from(std::array::from_fn(|p| report.best[p]))).to_array();
    for (p, known) in settings.known.iter().enumerate() {
        if let Known::Fixed(value) = known {
            found[p] = *value;
        }
    }
    let motor = Motor::from(found);
    Ok(Some(Search { cost_above_optimum: estimate.cost_above_optimum(&motor), motor, bounds, report }))
}
