//! What the output error makes of a log: a motor in an imperfect drive whose simulated currents are nearest the measured ones.
//!
//! ```text
//! start → reading of the voltages → faults of the drive → disturbances → covariance → judgement
//! ```
//!
//! Its statistical uncertainty is that of its scores, the products of derivatives and residuals: `(J'J)^-1 S (J'J)^-1` with their
//! long-run covariance `S` (long_run.rs). The voltages' accuracy comes through the adjoint equations, which tell what a volt at any
//! row does to each parameter.

use super::{
    Known, Provenance, Search, Settings, Step, Watch,
    advice::{self, Advice},
    excitation::Excitation,
    fault_search::{FaultSearch, FaultTrial, LEAST_RESIDUAL, Outcome},
    long_run,
    normal_matrix::inverse_normal,
    pieces,
    saturation::Saturation,
    search_box, searched,
    steady_fit::SteadyFit,
    timing,
    uncertainty::{ParameterUncertainty, Systematic, Uncertainty},
    verdict::{self, Judgement, Trust},
    voltage_accuracy::accuracy,
};
use crate::{
    error::Error,
    faults::{Fault, Faults, disturbance::Disturbance},
    frames::Dq,
    least_squares::{Equation, TriangularFactor},
    levenberg_marquardt::{MOTOR, Polished, PriorResidual, jacobian, polish_unknowns, polish_with_progress},
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::{
        acting_voltage::VoltageReading,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
    steady::{OperatingPoint, windows},
};
use nalgebra::DMatrix;
use std::ops::Range;

/// The simulated currents, and the motor that they ask for.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputFit {
    /// The motor, and what was found to stand between it and the log.
    pub drive: Adjustable,
    /// How the voltage columns were read, and whether that was stated or found.
    pub voltage_reading: (VoltageReading, Provenance),
    /// Every reading that was tried, with the faults that were found, the best first.
    pub readings: Vec<timing::Tried>,
    /// Every fault that was tried, those taken first.
    pub terms: Vec<FaultTrial>,
    /// Numbers of the drive beside the motor that were found.
    pub nuisance: Vec<Nuisance>,
    /// Stretches of the log whose rows are compared.
    pub stretches: Vec<Range<usize>>,
    /// Measured less simulated current, A: `d, q` of each of those rows in turn; with an observer, less the prediction from the row before.
    pub residuals: Vec<f64>,
    /// Sum of their squares, A².
    pub cost: f64,
    /// Residuals less unknowns.
    pub redundancy: usize,
    /// Correlation of neighbouring residuals, the larger of both axes.
    pub correlation_of_neighbours: f64,
    /// Whether the electrical angle was in the log and turned with the speed.
    pub angle_known: bool,
    pub(super) uncertainty: Uncertainty,
    advice: Advice,
    /// Correlation of neighbours, zero where the residuals are too small to mean anything.
    correlation_beyond_rounding: f64,
    /// Root mean square of the residuals as a part of the largest current.
    misses: f64,
}

/// A number of the drive beside the motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nuisance {
    /// Which.
    pub unknown: Unknown,
    /// SI.
    pub value: f64,
    /// Statistical standard error, SI.
    pub standard_error: f64,
}

impl OutputFit {
    /// Fits the rows of the log, or of the windows that are named.
    ///
    /// # Errors
    /// If a window is not in the log, or no stretch is long enough.
    pub fn of(log: &Log, steady: Option<&SteadyFit>, settings: &Settings, watch: Watch) -> Result<Self, Error> {
        let stretches = stretches(log, settings)?;
        let scale = Excitation::of(&whole(log, &stretches), &settings.known).scale;
        let start = start(log, &stretches, steady, settings, &scale);
        let free = free(settings);
        let chosen = choose(log, &stretches, &start, free, settings, watch)?;
        let Chosen { reading, unknowns, beliefs, readings, terms: tried, independent, .. } = chosen;
        let objective = &OutputError::of_rows(log, &stretches, reading)?;
        let usual = USUAL_STEPS * (1 + 2 * unknowns.len());
        let fitting = |simulations| {
            let _ = watch(Step::Fit { simulations, usual });
        };
        let Polished { drive, cost, .. } = polish_with_progress(objective, &chosen.drive, &unknowns, &beliefs, &fitting);
        let _ = watch(Step::Uncertainty);
        let residuals = objective.residuals(&drive);
        let doubt = Doubt {
            timing: timing::doubt(&readings, independent),
            process_noise: without_observer(objective, &drive, &unknowns, &beliefs),
            sensors: sensors(&drive),
        };
        let errors = Errors::of(objective, &drive, &unknowns, &beliefs, &residuals, settings, &scale);
        let uncertainty = errors.uncertainty(&unknowns, &doubt);
        let points = steady.map_or_else(|| whole(log, &stretches), |fit| fit.operating_points.clone());
        let rms = (cost / residuals.len() as f64).sqrt();
        Ok(Self {
            advice: advice(&drive.motor, &uncertainty, &points, rms, errors.correlation_of_neighbours, log, settings),
            correlation_beyond_rounding: if rms > LEAST_RESIDUAL * objective.peak_current() {
                errors.correlation_of_neighbours
            } else {
                0.0
            },
            misses: rms / objective.peak_current(),
            drive,
            voltage_reading: (reading, if settings.voltage_timing.is_some() { Provenance::Stated } else { Provenance::Found }),
            terms: tried,
            nuisance: errors.nuisance(&drive, &unknowns),
            stretches: objective.stretches().collect(),
            angle_known: objective.angle_known(),
            redundancy: residuals.len().saturating_sub(unknowns.len()),
            correlation_of_neighbours: errors.correlation_of_neighbours,
            uncertainty,
            readings,
            residuals,
            cost,
        })
    }

    /// Whether a fault is part of the answer.
    pub fn has(&self, fault: Fault) -> bool {
        self.terms.iter().any(|tried| tried.fault == fault && tried.outcome == Outcome::Taken)
    }

    /// Whether the residuals are more than rounding and the last digits of an inverter's ripple, so that their correlation means something.
    pub fn leaves_something(&self) -> bool {
        self.correlation_beyond_rounding != 0.0
    }

    /// Root mean square of the residuals along d and q, A.
    pub fn residual_rms(&self) -> Dq {
        let (rows, _) = self.residuals.as_chunks::<2>();
        let rms = |axis: usize| (rows.iter().map(|row| row[axis].powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
        Dq { d: rms(0), q: rms(1) }
    }

    /// Autocorrelation, about zero, of the residuals along d and q at lags of 1 to `lags` rows; none reaches across a gap.
    pub fn autocorrelation(&self, lags: usize) -> [Vec<f64>; 2] {
        let lengths: Vec<usize> = self.stretches.iter().map(ExactSizeIterator::len).collect();
        let (rows, _) = self.residuals.as_chunks::<2>();
        [0, 1].map(|axis| {
            let series: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
            (1..=lags).map(|lag| long_run::correlation(&series, lag, &lengths)).collect()
        })
    }

    /// The readings of the voltages that are not ruled out, the best first: they fit about as well as it does.
    pub fn possible_readings(&self) -> impl Iterator<Item = &timing::Tried> {
        timing::possible(&self.readings, long_run::effective_sample_size(&self.residuals))
    }

    /// The parameters, judged, and the correlation of their errors.
    pub(super) fn judge(
        &self,
        saturation: Option<&Saturation>,
        settings: &Settings,
    ) -> ([Judgement; PARAMETERS], [[f64; PARAMETERS]; PARAMETERS]) {
        let uncertainty = self.uncertainty.clone().with_saturation(saturation, &self.drive.motor);
        let trust = Trust {
            correlation_of_neighbours: self.correlation_beyond_rounding,
            disturbed_without_angle: self.has(Fault::Disturbance) && !self.angle_known,
            misses: self.misses,
        };
        let parameters = verdict::judge_currents(&self.drive.motor, &uncertainty, &self.advice, &trust, settings);
        (parameters, self.uncertainty.correlation)
    }

    /// Lets the swarm that is asked for minimize the same output error.
    pub(super) fn search(&self, log: &Log, steady: Option<&SteadyFit>, settings: &Settings, watch: Watch) -> Result<Option<Search>, Error> {
        if settings.method.is_none() {
            return Ok(None);
        }
        let bounds = match (&settings.bounds, steady) {
            (Some(bounds), _) => bounds.clone(),
            (None, Some(steady)) => search_box::from_points(&steady.operating_points)?,
            (None, None) => search_box::from_points(&whole(log, &self.stretches))?,
        };
        let objective = OutputError::of_rows(log, &stretches(log, settings)?, self.voltage_reading.0)?.holding(self.drive.faults);
        let Some(report) = searched(&objective, &bounds, settings, watch)? else { return Ok(None) };
        let motor = Motor::from(std::array::from_fn(|p| report.best[p]));
        Ok(Some(Search { cost_above_optimum: report.cost - self.cost, motor, bounds, report }))
    }
}

/// What is to be fitted to all rows.
struct Chosen {
    reading: VoltageReading,
    drive: Adjustable,
    unknowns: Vec<Unknown>,
    beliefs: Vec<PriorResidual>,
    /// Every reading with these unknowns, the best first.
    readings: Vec<timing::Tried>,
    terms: Vec<FaultTrial>,
    /// Independent residuals of the rows by which it was chosen.
    independent: f64,
    /// Logarithm of the mean square that is left, and what the unknowns cost: Schwarz's criterion per residual.
    criterion: f64,
    /// Whether what is left is noise, and no observer was needed to make it so.
    explained: bool,
}

/// Steps that a polish of all rows usually takes, each of a simulation and its derivatives: for who waits, and for nothing else.
const USUAL_STEPS: usize = 3;

/// Readings from which faults are looked for, where the first one leaves something unexplained: a fault may pass for a delay.
const TRIED_READINGS: usize = 2;

/// Correlation of neighbours below which residuals are white enough.
const WHITE: f64 = 0.1;

/// Chooses the reading of the voltages and the faults of the drive.
fn choose(
    log: &Log,
    stretches: &[Range<usize>],
    start: &Adjustable,
    free: Vec<Unknown>,
    settings: &Settings,
    watch: Watch,
) -> Result<Chosen, Error> {
    let _ = watch(Step::Readings);
    let objectives = timing::objectives(log, &pieces::spread(stretches), settings)?;
    let rough = timing::readings(&objectives, start, &free, &[]);
    let beliefs = beliefs(settings, rough.first().map_or(0.0, |(_, best)| best.mean_square()));
    let mut best: Option<Chosen> = None;
    let tried = timing::readings(&objectives, start, &free, &beliefs);
    let _ = watch(Step::Faults);
    for (place, tried) in tried.into_iter().take(TRIED_READINGS) {
        let (drive, cost, voltage_accuracy) = (tried.polished.drive, tried.polished.cost, settings.voltage_accuracy);
        let search = FaultSearch {
            objectives: &objectives,
            reading: place,
            priors: &beliefs,
            drive,
            unknowns: free.clone(),
            cost,
            voltage_accuracy,
        };
        let one = with_faults(search, &objectives, &beliefs);
        let explained = one.explained;
        if best.as_ref().is_none_or(|best| one.criterion < best.criterion) {
            best = Some(one);
        }
        if explained {
            break;
        }
    }
    let mut best = best.ok_or(Error::TooShort { rows: log.rows(), least: 2 })?;
    let readings = timing::readings(&objectives, &best.drive, &best.unknowns, &beliefs);
    best.readings = readings.into_iter().map(|(_, tried)| tried).collect();
    Ok(best)
}

/// The faults that a log carries under a reading, and the reading that suits them.
fn with_faults(mut search: FaultSearch, objectives: &[(VoltageReading, OutputError)], beliefs: &[PriorResidual]) -> Chosen {
    let terms = search.run();
    let FaultSearch { drive, unknowns, cost, reading, .. } = search;
    let (reading, objective) = &objectives[reading];
    let residuals = objective.residuals(&drive);
    let count = residuals.len() as f64;
    let independent = long_run::effective_sample_size(&residuals);
    Chosen {
        reading: *reading,
        readings: Vec::new(),
        independent,
        criterion: (cost / count).ln() + unknowns.len() as f64 * count.ln() / count,
        explained: (cost / count).sqrt() <= LEAST_RESIDUAL * objective.peak_current()
            || unknowns.iter().all(|unknown| unknown.fault() != Some(Fault::Disturbance))
                && independent > (1.0 - WHITE) / (1.0 + WHITE) * count,
        drive,
        unknowns,
        beliefs: beliefs.to_vec(),
        terms,
    }
}

/// The windows that are named, or all that the log has without a gap; of a very long log, pieces.
fn stretches(log: &Log, settings: &Settings) -> Result<Vec<Range<usize>>, Error> {
    if settings.windows.is_empty() {
        return Ok(pieces::different(log, log.segments().iter().map(|segment| segment.rows.clone()).collect()));
    }
    let mut named = Vec::new();
    for times in &settings.windows {
        named.extend(windows::between(log, *times)?);
    }
    Ok(pieces::different(log, named))
}

/// Each stretch as one operating point, steady or not: for the size of things.
fn whole(log: &Log, stretches: &[Range<usize>]) -> Vec<OperatingPoint> {
    stretches.iter().map(|rows| OperatingPoint::measure(log, rows.clone(), None)).collect()
}

/// Parameters that are not fixed.
fn free(settings: &Settings) -> Vec<Unknown> {
    let is_free = |(_, known): &(Unknown, &Known)| !matches!(known, Known::Fixed(_));
    MOTOR.into_iter().zip(&settings.known).filter(is_free).map(|(unknown, _)| unknown).collect()
}

/// Priors as residuals, given the mean square of a current's.
fn beliefs(settings: &Settings, mean_square: f64) -> Vec<PriorResidual> {
    let priors = MOTOR.into_iter().zip(settings.known).filter_map(|(unknown, known)| match known {
        Known::Prior { value, standard_error } => Some(PriorResidual { unknown, value, weight: mean_square.sqrt() / standard_error }),
        Known::Nothing | Known::Fixed(_) => None,
    });
    priors.collect()
}

/// Where the polish begins: the operating points' motor where it is one, else that of the rows' own voltage equations.
fn start(log: &Log, stretches: &[Range<usize>], steady: Option<&SteadyFit>, settings: &Settings, scale: &[f64; PARAMETERS]) -> Adjustable {
    let rows = by_differences(log, stretches).to_array();
    let mut values: [f64; PARAMETERS] = std::array::from_fn(|p| {
        let parameter = Parameter::ALL[p];
        let of_points = steady.filter(|fit| !fit.excitation.is_open(parameter)).map(|fit| fit.estimate.motor.get(parameter));
        // A tenth of what the voltage allows is nobody's motor and everybody's start.
        [of_points, Some(rows[p])].into_iter().flatten().find(|value| *value > 0.0 && value.is_finite()).unwrap_or(0.1 * scale[p])
    });
    for (value, known) in values.iter_mut().zip(settings.known) {
        match known {
            Known::Fixed(known) | Known::Prior { value: known, .. } => *value = known,
            Known::Nothing => {}
        }
    }
    Adjustable::from(Motor::from(values))
}

/// Rows over which a difference of currents stands for their slope: enough to calm noise, few enough to follow a transient.
const DIFFERENCE: usize = 10;

/// The motor of equation (1), with differences of currents over some rows and means of the rest: biased by noise and delay, and
/// good enough to start from.
fn by_differences(log: &Log, stretches: &[Range<usize>]) -> Motor {
    let columns = log.columns();
    let mut equations = Vec::new();
    for rows in stretches {
        for first in rows.clone().step_by(DIFFERENCE).filter(|first| first + DIFFERENCE < rows.end) {
            let span = first..first + DIFFERENCE;
            let mean = |value: &dyn Fn(usize) -> f64| span.clone().map(value).sum::<f64>() / DIFFERENCE as f64;
            let slope = |current: &[f64]| (current[span.end] - current[first]) / (columns.t[span.end] - columns.t[first]);
            let omega_i = |current: &[f64]| mean(&|row| columns.omega_e[row] * current[row]);
            let (id, iq) = (mean(&|row| columns.id[row]), mean(&|row| columns.iq[row]));
            let d = [id, slope(&columns.id), -omega_i(&columns.iq), 0.0];
            let q = [iq, omega_i(&columns.id), slope(&columns.iq), mean(&|row| columns.omega_e[row])];
            equations.push(Equation { coefficients: d, value: mean(&|row| columns.ud[row]) });
            equations.push(Equation { coefficients: q, value: mean(&|row| columns.uq[row]) });
        }
    }
    equations.into_iter().collect::<TriangularFactor>().solve().motor
}

/// What is known from noise, accuracy and excitation: what a further stretch would cure.
fn advice(
    motor: &Motor,
    uncertainty: &Uncertainty,
    points: &[OperatingPoint],
    rms: f64,
    correlation: f64,
    log: &Log,
    settings: &Settings,
) -> Advice {
    let standard_errors = uncertainty.parameters.map(|parameter| {
        let Systematic { accuracy, excitation, .. } = parameter.systematic;
        parameter.statistical.hypot(accuracy).hypot(excitation)
    });
    let fastest = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    // A current's noise as a voltage, and how much longer than white noise correlated noise lasts.
    let impedance = motor.rs.abs() + fastest * motor.ld.abs().max(motor.lq.abs());
    let lasting = (1.0 + correlation.clamp(0.0, 0.9)) / (1.0 - correlation.clamp(0.0, 0.9));
    Advice {
        motor: Advice::guessed(*motor, |parameter| uncertainty.parameters[parameter as usize].systematic.excitation == 0.0),
        covariance: advice::covariance(standard_errors, &uncertainty.correlation),
        held: points.iter().map(|point| (point.current(), point.omega_e())).collect(),
        row_variance: (impedance * rms).powi(2) * lasting,
        sample_period: log.segments().iter().map(|segment| segment.sample_period).fold(0.0, f64::max),
        voltage: points.iter().map(|point| point.voltage().magnitude()).fold(0.0, f64::max),
        voltage_accuracy: settings.voltage_accuracy,
    }
}

/// How far each parameter moves with what is not certain, SI.
struct Doubt {
    timing: [f64; PARAMETERS],
    process_noise: [f64; PARAMETERS],
    sensors: [f64; PARAMETERS],
}

/// How far the motor lies from that of a drive without disturbance, if an observer was found: either may be right.
fn without_observer(objective: &OutputError, drive: &Adjustable, unknowns: &[Unknown], beliefs: &[PriorResidual]) -> [f64; PARAMETERS] {
    let rest: Vec<Unknown> = unknowns.iter().copied().filter(|unknown| unknown.fault() != Some(Fault::Disturbance)).collect();
    if rest.len() == unknowns.len() {
        return [0.0; PARAMETERS];
    }
    let start = Adjustable { faults: Faults { disturbance: Disturbance::default(), ..drive.faults }, ..*drive };
    let other = polish_unknowns(objective, &start, &rest, beliefs).drive.motor.to_array();
    std::array::from_fn(|p| (drive.motor.to_array()[p] - other[p]).abs())
}

/// Where gains of sensors differ, nobody knows which of them is right: a gain common to all would scale every impedance.
fn sensors(drive: &Adjustable) -> [f64; PARAMETERS] {
    let common = drive.faults.current_gains.magnitude();
    let Motor { rs, ld, lq, .. } = drive.motor;
    [common * rs, common * ld, common * lq, 0.0]
}

/// Errors of everything that was fitted.
struct Errors {
    /// Of the unknowns, from noise.
    covariance: DMatrix<f64>,
    degrees_of_freedom: f64,
    /// Of the unknowns, from the voltages' accuracy.
    accuracy: DMatrix<f64>,
    /// Of the unknowns, per prior.
    priors: Vec<Vec<f64>>,
    /// How far what the rows do not tell at all could move each unknown.
    open: Vec<f64>,
    correlation_of_neighbours: f64,
}

impl Errors {
    fn of(
        objective: &OutputError,
        drive: &Adjustable,
        unknowns: &[Unknown],
        beliefs: &[PriorResidual],
        residuals: &[f64],
        settings: &Settings,
        scale: &[f64; PARAMETERS],
    ) -> Self {
        let slopes = jacobian(objective, drive, unknowns);
        let mut with_beliefs = slopes.clone();
        for (column, unknown) in with_beliefs.iter_mut().zip(unknowns) {
            column.extend(beliefs.iter().map(|belief| if belief.unknown == *unknown { -belief.weight } else { 0.0 }));
        }
        let inverse = inverse_normal(&with_beliefs);
        let lengths: Vec<usize> = objective.stretches().map(|rows| rows.len()).collect();
        let (rows, _) = residuals.as_chunks::<2>();
        // A score per row: both axes together.
        let scores = slopes.iter().map(|slope| {
            let (slope, _) = slope.as_chunks::<2>();
            slope.iter().zip(rows).map(|(slope, residual)| slope[0] * residual[0] + slope[1] * residual[1]).collect()
        });
        let scores: Vec<Vec<f64>> = scores.collect();
        let long_run = long_run::covariance(&scores, &lengths);
        let axis = |axis: usize| rows.iter().map(|row| row[axis]).collect::<Vec<_>>();
        Self {
            covariance: &inverse * long_run.covariance * &inverse,
            degrees_of_freedom: long_run.degrees_of_freedom,
            accuracy: accuracy(objective, drive, &inverse, &slopes, settings.voltage_accuracy),
            priors: beliefs
                .iter()
                .map(|belief| {
                    let column = unknowns.iter().position(|unknown| *unknown == belief.unknown);
                    let noise = (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt();
                    // A belief's own error is one standard error, which is the noise of a current over its weight.
                    column.map_or(vec![0.0; unknowns.len()], |q| {
                        (0..unknowns.len()).map(|p| inverse[(p, q)] * belief.weight * noise).collect()
                    })
                })
                .collect(),
            open: open(&with_beliefs, &inverse, unknowns, scale),
            correlation_of_neighbours: [0, 1].map(|k| long_run::first_correlation(&axis(k), &lengths)).into_iter().fold(f64::MIN, f64::max),
        }
    }

    fn nuisance(&self, drive: &Adjustable, unknowns: &[Unknown]) -> Vec<Nuisance> {
        let beside = unknowns.iter().enumerate().filter(|(_, unknown)| !matches!(unknown, Unknown::Motor(_)));
        beside
            .map(|(k, unknown)| Nuisance {
                unknown: *unknown,
                value: drive.get(*unknown),
                standard_error: (self.covariance[(k, k)].max(0.0) + self.accuracy[(k, k)].max(0.0)).sqrt(),
            })
            .collect()
    }

    fn uncertainty(&self, unknowns: &[Unknown], doubt: &Doubt) -> Uncertainty {
        let place: Vec<Option<usize>> = MOTOR.iter().map(|parameter| unknowns.iter().position(|unknown| unknown == parameter)).collect();
        let parameters = std::array::from_fn(|p| {
            let Some(k) = place[p] else { return ParameterUncertainty::default() };
            let systematic = Systematic {
                accuracy: self.accuracy[(k, k)].max(0.0).sqrt(),
                prior: self.priors.iter().map(|prior| prior[k].powi(2)).sum::<f64>().sqrt(),
                timing: doubt.timing[p],
                process_noise: doubt.process_noise[p],
                sensors: doubt.sensors[p],
                excitation: self.open[k],
                ..Systematic::default()
            };
            ParameterUncertainty::of(self.covariance[(k, k)].max(0.0).sqrt(), self.degrees_of_freedom, systematic)
        });
        let both = |p: usize, q: usize| match (place[p], place[q]) {
            (Some(k), Some(l)) => {
                self.covariance[(k, l)] + self.accuracy[(k, l)] + self.priors.iter().map(|prior| prior[k] * prior[l]).sum::<f64>()
            }
            _ => 0.0,
        };
        let correlation = std::array::from_fn(|p| {
            std::array::from_fn(|q| {
                let scale = (both(p, p) * both(q, q)).sqrt();
                if scale > 0.0 { both(p, q) / scale } else { 0.0 }
            })
        });
        Uncertainty { parameters, correlation }
    }
}

/// A parameter is open if the rows tell less than all but this part of it.
const OPEN_PART: f64 = 0.01;

/// Per unknown: the range of a parameter that is open, as a standard deviation; zero for others.
fn open(columns: &[Vec<f64>], inverse: &DMatrix<f64>, unknowns: &[Unknown], scale: &[f64; PARAMETERS]) -> Vec<f64> {
    let dot = |p: usize, q: usize| columns[p].iter().zip(&columns[q]).map(|(a, b)| a * b).sum::<f64>();
    let told = |k: usize| (0..columns.len()).map(|l| inverse[(k, l)] * dot(l, k)).sum::<f64>();
    let range = |(k, unknown): (usize, &Unknown)| match unknown {
        Unknown::Motor(parameter) if (told(k) - 1.0).abs() > OPEN_PART || told(k).is_nan() => scale[*parameter as usize] / 3.0_f64.sqrt(),
        _ => 0.0,
    };
    unknowns.iter().enumerate().map(range).collect()
}
