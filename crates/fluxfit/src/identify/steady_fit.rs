//! What the steady model makes of a log: equation (2) on the means of steady windows, for which weighted least squares is exact.

use super::{
    Known, Provenance, Search, Settings, Watch,
    advice::{self, Advice},
    estimate::Estimate,
    excitation::Excitation,
    misfit::{self, Misfit},
    saturation::Saturation,
    search_box, searched,
    uncertainty::{Doubt, Uncertainty},
    verdict::{self, Judgement},
};
use crate::{
    error::Error,
    faults::dead_time::ripple,
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    steady::{
        Belief, OperatingPoint,
        held_vector::{HeldVector, MAX_ANGLE_PER_SAMPLE, MAX_DECAY_PER_SAMPLE, VoltageTiming},
        windows,
    },
};

/// The operating points, and the motor that they ask for.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyFit {
    /// The windows that carried it.
    pub operating_points: Vec<OperatingPoint>,
    /// Least squares, solved exactly.
    pub estimate: Estimate,
    /// What they excite.
    pub excitation: Excitation,
    /// How the voltage columns were read, and whether that was stated or assumed.
    pub voltage_timing: (VoltageTiming, Provenance),
    /// Contradiction between the operating points, if proven.
    pub misfit: Option<Misfit>,
    /// Saturation, if it explains the contradiction.
    pub saturation: Option<Saturation>,
    /// What dead time or device drops seem to take from each operating point's voltage along its current, V; zero where nothing is seen.
    pub voltage_losses: Vec<f64>,
    /// How far the motor moves with what nobody stated.
    doubt: Doubt,
}

impl SteadyFit {
    /// Finds the operating points and solves them.
    ///
    /// # Errors
    /// If there is none.
    pub fn of(log: &Log, settings: &Settings) -> Result<Self, Error> {
        let rough = operating_points(log, settings)?;
        let (points, timing_doubt) = measure(log, &rough, settings);
        let excitation = Excitation::of(&points, &settings.known);
        let estimate = Estimate::solve(&points, &excitation, settings);
        let (estimate, misfit) = misfit::admit(&points, &excitation, estimate, settings);
        let saturation = Saturation::of_points(&points, &excitation, &estimate.motor, misfit.as_ref(), settings);
        let Dq { d: ld, q: lq } = inductance(&estimate.motor, &excitation);
        let losses = ripple::losses(log, &points, &Motor { ld, lq, ..estimate.motor }, super::VOLTAGE_ACCURACY);
        let dead_time = ripple::parameter_errors(log, &points, &estimate.gains, &losses);
        let doubt = Doubt { timing: timing_doubt, dead_time };
        Ok(Self {
            operating_points: points,
            estimate,
            excitation,
            voltage_timing: voltage_timing(settings),
            misfit,
            saturation,
            voltage_losses: losses,
            doubt,
        })
    }

    /// The parameters, judged, and the correlation of their errors.
    pub(super) fn judge(&self, settings: &Settings) -> ([Judgement; PARAMETERS], [[f64; PARAMETERS]; PARAMETERS]) {
        let uncertainty = Uncertainty::of(&self.operating_points, &self.excitation, &self.estimate, self.misfit.as_ref(), &self.doubt)
            .with_saturation(self.saturation.as_ref(), &self.estimate.motor);
        let advice = self.advice(&uncertainty, settings);
        let parameters = verdict::judge(&self.operating_points, &self.excitation, &self.estimate, &uncertainty, &advice, settings);
        (parameters, uncertainty.correlation)
    }

    /// What is known from noise, accuracy and excitation: what more operating points would cure.
    fn advice(&self, uncertainty: &Uncertainty, settings: &Settings) -> Advice {
        let points = &self.operating_points;
        let standard_errors = uncertainty.parameters.map(|parameter| parameter.statistical.hypot(parameter.systematic.accuracy));
        let row_variance = points.iter().map(|point| {
            let noise = point.residual_covariance(&self.estimate.motor);
            0.5 * (noise[0][0] + noise[1][1]) * point.rows.len() as f64
        });
        let mean_period = points.iter().map(|point| (point.time.1 - point.time.0) / (point.rows.len() - 1).max(1) as f64);
        Advice {
            motor: Advice::guessed(self.estimate.motor, |parameter| !self.excitation.is_open(parameter)),
            covariance: advice::covariance(standard_errors, &uncertainty.correlation) + self.excitation.unexcited_parameters(),
            held: points.iter().map(|point| (point.current(), point.omega_e())).collect(),
            row_variance: row_variance.sum::<f64>() / points.len() as f64,
            sample_period: mean_period.fold(0.0, f64::max),
            voltage: points.iter().map(|point| point.voltage().magnitude()).fold(0.0, f64::max),
            voltage_accuracy: settings.voltage_accuracy,
        }
    }

    /// Lets the swarm minimize the same weighted equations that least squares solved.
    pub(super) fn search(&self, settings: &Settings, watch: Watch) -> Result<Option<Search>, Error> {
        let bounds = match &settings.bounds {
            Some(bounds) => bounds.clone(),
            None => search_box::from_points(&self.operating_points)?,
        };
        let objective = &self.estimate.objective;
        let Some(report) = searched(objective, &bounds, settings, watch)? else { return Ok(None) };
        // Where the cost is flat a swarm ends anywhere: only what the log excites is its answer.
        let mut found = self.excitation.excited_motor(&Motor::from(std::array::from_fn(|p| report.best[p]))).to_array();
        for (p, known) in settings.known.iter().enumerate() {
            if let Known::Fixed(value) = known {
                found[p] = *value;
            }
        }
        let motor = Motor::from(found);
        Ok(Some(Search { cost_above_optimum: self.estimate.cost_above_optimum(&motor), motor, bounds, report }))
    }
}

/// Centred, unless stated otherwise: what drives that log their realized voltage mostly mean.
pub fn voltage_timing(settings: &Settings) -> (VoltageTiming, Provenance) {
    settings.voltage_timing.map_or((VoltageTiming::Centered, Provenance::Assumed), |stated| (stated.into(), Provenance::Stated))
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
pub(super) fn inductance(motor: &Motor, excitation: &Excitation) -> Dq {
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
