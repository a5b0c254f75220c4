//! What the output error makes of a log: a motor in an imperfect drive whose simulated currents are nearest the measured ones.
//!
//! ```text
//! start → voltage timing → faults of the drive → disturbances → polish of all rows → errors
//! ```

use super::{
    super::{
        prepare::stretches,
        progress::{Progress, Step},
        request::{Provenance, Request, Resolved},
    },
    all_rows::AllRows,
    fault_search::{RIPPLE, schwarz},
    fault_trial::{FaultOutcome, FaultTrial},
    faults_in_doubt,
    finding::{Bench, Finding, Trust, covariance},
    long_run,
    output_choice::{Chosen, choose},
    output_errors::{CORRELATED, Errors, FaultEstimate, OutputShifts, correlation_of_neighbours, other_kind_of_fit, sensors},
    output_start,
    readings::{self, TimingTrial},
    steady::SteadyFit,
    swarm::{self, Search},
    uncertainty::{Systematic, Uncertainty},
    undetected_loss,
    voltage_accuracy::VoltageAccuracy,
    voltage_loss, within_rows,
};
use crate::{
    error::Error,
    faults::Fault,
    frames::Dq,
    log::{Log, speed_lag::LagByAngle},
    motor::Motor,
    objective::{acting_voltage::VoltageTiming, adjustable::Adjustable, output_error::OutputError},
    optimizer::{Bounds, Method},
    steady::OperatingPoint,
};
use std::ops::Range;

/// A drive controls its currents many times within the time constant of the winding, `L / R_s`: less than this part of a period is no
/// motor's. What comes out smaller took the place of something else that bends to the steps of the currents, a filter above all.
const LEAST_PERIODS: f64 = 0.5;

/// The simulated currents, and the motor that they ask for.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutputFit {
    /// The motor, and what was found to stand between it and the log.
    pub drive: Adjustable,
    /// The timing of the voltage columns, stated or found.
    pub voltage_timing: Resolved<VoltageTiming>,
    /// Every timing that was tried, with the faults that were found, the best first.
    pub timings: Vec<TimingTrial>,
    /// Every fault that was tried, those taken first.
    pub fault_trials: Vec<FaultTrial>,
    /// Numbers of the drive beside the motor that were found.
    pub fault_estimates: Vec<FaultEstimate>,
    /// By how much the speed was advanced, s, before its lag was fitted.
    pub(crate) undone_lag: f64,
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
    /// By how many volts dead time may differ from what was found of it: what the model of it usually lacks, or what an observer corrects.
    pub(crate) unexplained_loss: f64,
    /// What it comes to.
    pub finding: Finding,
}

/// Steps that a polish of all rows usually takes, each of a simulation and its derivatives: only for the progress display.
const USUAL_STEPS: usize = 3;

impl OutputFit {
    /// Fits the rows of the log, or of the windows that are named. Of a drive that is `known` from another log neither the reading of the
    /// voltages nor faults are looked for, and the fit is only as near to its end as a comparison with that other one needs.
    ///
    /// # Errors
    /// If a window is not in the log, or no stretch is long enough.
    pub(crate) fn of(
        log: &Log,
        steady: Option<&SteadyFit>,
        request: &Request,
        known: Option<&Self>,
        progress: Progress,
    ) -> Result<Self, Error> {
        let stretches = stretches::fitted(log, &request.windows)?;
        let whole = stretches::as_points(log, &stretches);
        let scale = output_start::scale(log, &stretches, request);
        let start = output_start::start(log, &stretches, steady, request, &scale);
        let Advanced { log: advanced, lag, chosen } = match known {
            Some(known) => known.refitted(log, &stretches, request)?,
            None => with_speed_in_time(
                log,
                |log, undone_lag| choose(log, &stretches, &start, undone_lag, request, progress),
                |chosen, log| chosen.again(log, &stretches, &readings::asked(log, request)),
            )?,
        };
        let log = advanced.as_ref().unwrap_or(log);
        let usual = USUAL_STEPS * (1 + 2 * chosen.unknowns.len());
        let fitting = |simulations| {
            let _ = progress(Step::Fit { simulations, usual });
        };
        let AllRows { chosen, objective, drive, cost, residuals, runaway } =
            AllRows::of((log, lag), &stretches, chosen, request, (known.is_some(), &fitting))?;
        let Chosen { reading, unknowns, priors, readings, terms, independent, .. } = chosen;
        let objective = &objective;
        let _ = progress(Step::Uncertainty);
        let is_noise = correlation_of_neighbours(&residuals, &objective.rows_per_segment()) <= CORRELATED;
        let shifts = OutputShifts {
            timing: readings::doubt(&readings, independent),
            within_rows: within_rows::doubt(objective, reading, &drive, &unknowns, &priors),
            process_noise: other_kind_of_fit(objective, &drive, &unknowns, &priors, is_noise),
            faults_in_doubt: faults_in_doubt::doubt(&terms),
            sensors: sensors(&drive),
            dead_time: undetected_loss::doubt(log, objective, &drive, &unknowns, &residuals, steady, request),
        };
        let misshapen = voltage_loss::misshapen_in_rows(log, reading, &drive.faults.dead_time);
        let corrected_beside_loss = voltage_loss::corrected_by_observer(log, &drive, rms_by_axis(&residuals));
        let corrected = VoltageAccuracy { volts: corrected_beside_loss, ..VoltageAccuracy::default() };
        let accuracies = [VoltageAccuracy { fraction: request.voltage_accuracy, ..misshapen }, corrected];
        let errors = Errors::of(objective, &drive, &unknowns, &priors, &residuals, accuracies, &scale);
        let shifts = OutputShifts { process_noise: errors.by_contradiction(&unknowns, &shifts.process_noise), ..shifts };
        let uncertainty = errors.uncertainty(&unknowns, &shifts);
        let correlation = errors.correlation_of_neighbours;
        let points = steady.map_or(&whole[..], |fit| &fit.operating_points);
        let rms = (cost / residuals.len() as f64).sqrt();
        // Below it, what is left is the rounding of the columns or what an inverter's ripple leaves, whose correlation means nothing.
        let is_rounding = rms <= RIPPLE * objective.peak_current();
        let finding = Finding {
            motor: drive.motor,
            open: [false; 4],
            trust: Trust {
                correlation_of_neighbours: if is_rounding { 0.0 } else { correlation },
                too_sharp: !is_rounding && errors.are_too_small(objective, &drive, &unknowns, &priors, &residuals),
                misses: missed(objective, &drive) / objective.peak_current(),
                runaway,
                speed_too_high: None,
                least_inductance: if log.is_control_rate() { LEAST_PERIODS * log.slowest_period() * drive.motor.rs } else { 0.0 },
                repeated_values: false,
            },
            bench: bench(&drive.motor, &uncertainty, points, rms, correlation, log, request),
            uncertainty,
        };
        Ok(Self {
            drive,
            voltage_timing: Resolved {
                value: reading,
                provenance: if request.voltage_timing.is_some() { Provenance::Stated } else { Provenance::Found },
            },
            fault_trials: terms,
            fault_estimates: with_lag(errors.nuisance(&drive, &unknowns), lag),
            undone_lag: lag,
            stretches: objective.stretches().collect(),
            angle_known: objective.angle_known(),
            redundancy: residuals.len().saturating_sub(unknowns.len()),
            unexplained_loss: corrected_beside_loss.max(voltage_loss::misshapen_if_fitted(drive.faults.dead_time.voltage)),
            correlation_of_neighbours: correlation,
            finding,
            timings: readings,
            residuals,
            cost,
        })
    }

    /// The same reading and faults for another log of the same drive.
    fn refitted(&self, log: &Log, stretches: &[Range<usize>], request: &Request) -> Result<Advanced, Error> {
        let advanced = (self.undone_lag != 0.0).then(|| log.without_speed_lag(self.undone_lag));
        let of_faults = self.fault_estimates.iter().map(|estimate| estimate.unknown);
        let chosen = Chosen {
            reading: self.voltage_timing.value,
            drive: self.drive,
            unknowns: output_start::free(log, request).into_iter().chain(of_faults).collect(),
            priors: output_start::priors(request, self.undone_lag, self.cost / self.residuals.len() as f64),
            readings: self.timings.clone(),
            terms: self.fault_trials.clone(),
            independent: long_run::effective_sample_size(&self.residuals),
            // Nothing else is chosen from.
            criterion: 0.0,
        };
        // A reading that this log has ruled out stays so.
        let possible: Vec<VoltageTiming> = self.possible_timings().map(|trial| trial.timing).collect();
        let chosen = chosen.again(advanced.as_ref().unwrap_or(log), stretches, &possible)?;
        Ok(Advanced { log: advanced, lag: self.undone_lag, chosen })
    }

    /// Whether a fault is part of the answer.
    pub fn has(&self, fault: Fault) -> bool {
        is_taken(&self.fault_trials, fault)
    }

    /// Whether a filter of what is logged is part of the answer, or would be if it did not stand in for what voltages do within rows.
    pub(crate) fn is_filtered(&self) -> bool {
        let is_found = |trial: &FaultTrial| matches!(trial.outcome, FaultOutcome::Taken | FaultOutcome::WithinRows);
        self.fault_trials.iter().any(|trial| trial.fault.is_filter() && is_found(trial))
    }

    /// Whether the residuals are more than rounding and the last digits of an inverter's ripple, so that their correlation means something.
    pub fn leaves_something(&self) -> bool {
        self.finding.trust.correlation_of_neighbours != 0.0
    }

    /// Whether what is left is noise.
    pub(crate) fn is_explained(&self) -> bool {
        self.correlation_of_neighbours <= CORRELATED
    }

    /// Root mean square of the residuals along d and q, A.
    pub fn residual_rms(&self) -> Dq {
        rms_by_axis(&self.residuals)
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
    pub fn possible_timings(&self) -> impl Iterator<Item = &TimingTrial> {
        readings::possible(&self.timings, long_run::effective_sample_size(&self.residuals))
    }

    /// Lets the swarm minimize the same output error.
    ///
    /// # Errors
    /// If the box or the settings do not suit it.
    pub(crate) fn search(&self, log: &Log, method: Method, bounds: Bounds, request: &Request, progress: Progress) -> Result<Search, Error> {
        let stretches = stretches::fitted(log, &request.windows)?;
        let objective = OutputError::of_rows(log, &stretches, self.voltage_timing.value)?.holding(self.drive.faults);
        let report = swarm::run(&objective, method, &bounds, request, progress)?;
        let motor = Motor::from(std::array::from_fn(|p| report.best[p]));
        Ok(Search { cost_above_optimum: report.cost - self.cost, motor, bounds, report })
    }
}

/// Root mean square of residuals, `d, q` of each row in turn.
fn rms_by_axis(residuals: &[f64]) -> Dq {
    let (rows, _) = residuals.as_chunks::<2>();
    let rms = |axis: usize| (rows.iter().map(|row| row[axis].powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
    Dq { d: rms(0), q: rms(1) }
}

/// Root mean square of what a simulation misses that no measured current corrects, A: an observer follows anything.
fn missed(objective: &OutputError, drive: &Adjustable) -> f64 {
    let mut alone = drive.without_observer();
    alone.faults.filter.noise_before = 0.0;
    let cost = if alone == *drive { objective.cost_of(drive) } else { objective.cost_of(&alone).min(f64::MAX) };
    (cost / (2.0 * objective.rows() as f64)).sqrt()
}

/// A log whose speed lags, in time again.
struct Advanced {
    /// The log with the speed in time; `None` if it always was.
    log: Option<Log>,
    /// By how much it was advanced, s.
    lag: f64,
    chosen: Chosen,
}

/// A speed that lags spoils the angle, which comes from it or is made smooth by it: what was found of the lag is undone, and all is chosen
/// again, with what is left of it unknown: faults that were found beside a wrong angle are bent by it. The lag is found to first order, so
/// what is left is undone once more; this changes no choice. What was chosen second, with a lag, may fit best once that is undone.
fn with_speed_in_time(
    log: &Log,
    choose: impl Fn(&Log, f64) -> Result<Vec<Chosen>, Error>,
    again: impl Fn(Chosen, &Log) -> Result<Chosen, Error>,
) -> Result<Advanced, Error> {
    let lags = |chosen: &Chosen| {
        let is_lag = |trial: &&FaultTrial| trial.fault == Fault::SpeedLag && trial.outcome == FaultOutcome::Taken;
        chosen.terms.iter().find(is_lag).cloned()
    };
    let in_time = |lag: f64, lags: FaultTrial| {
        let chosen = choose(&log.without_speed_lag(lag), lag)?.into_iter().next().ok_or_else(Error::no_rows)?;
        let lag = lag + chosen.drive.faults.speed_lag.time;
        let advanced = log.without_speed_lag(lag);
        let mut chosen = again(chosen, &advanced)?;
        chosen.terms.insert(0, lags);
        Ok(Advanced { log: Some(advanced), lag, chosen })
    };
    // What the angle shows needs no fit.
    if let Some(lag) = log.speed_lag_by_angle() {
        return in_time(lag.time, of_lag_by_angle(&lag));
    }
    let mut found = choose(log, 0.0)?.into_iter();
    let first = found.next().ok_or_else(Error::no_rows)?;
    let found_lag = |chosen: &Chosen| chosen.drive.faults.speed_lag.time;
    if let Some(lags) = lags(&first) {
        return in_time(found_lag(&first), lags);
    }
    let as_logged = Advanced { log: None, lag: 0.0, chosen: first };
    let Some((lag, lags)) = found.find_map(|chosen| lags(&chosen).map(|lags| (found_lag(&chosen), lags))) else { return Ok(as_logged) };
    let second = in_time(lag, lags)?;
    Ok(if second.chosen.criterion < as_logged.chosen.criterion { second } else { as_logged })
}

/// A lag of the speed that the angle tells, before anything is fitted: what it gains there.
fn of_lag_by_angle(lag: &LagByAngle) -> FaultTrial {
    let rows = lag.left.len();
    let left = lag.left.iter().map(|left| left * left).sum::<f64>() / rows as f64;
    let rho = long_run::first_correlation(&lag.left, &[rows]).max(0.0);
    let independent = (rows as f64 * (1.0 - rho) / (1.0 + rho)).max(1.0);
    FaultTrial { gain: schwarz(lag.variance, left, 1, independent), ..FaultTrial::not_judged(Fault::SpeedLag, FaultOutcome::Taken) }
}

/// The lag as a whole, where a part of it was undone.
fn with_lag(mut estimates: Vec<FaultEstimate>, lag: f64) -> Vec<FaultEstimate> {
    estimates.iter_mut().filter(|estimate| estimate.unknown.fault() == Some(Fault::SpeedLag)).for_each(|estimate| estimate.value += lag);
    estimates
}

fn is_taken(trials: &[FaultTrial], fault: Fault) -> bool {
    trials.iter().any(|trial| trial.fault == fault && trial.outcome == FaultOutcome::Taken)
}

/// What is known from noise, accuracy and excitation: what a further stretch would improve.
fn bench(
    motor: &Motor,
    uncertainty: &Uncertainty,
    points: &[OperatingPoint],
    rms: f64,
    correlation: f64,
    log: &Log,
    request: &Request,
) -> Bench {
    let standard_errors = uncertainty.parameters.map(|parameter| {
        let Systematic { accuracy, excitation, .. } = parameter.systematic;
        parameter.statistical.hypot(accuracy).hypot(excitation)
    });
    let fastest = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    // A current's noise as a voltage, and how much longer than white noise correlated noise lasts.
    let impedance = motor.rs.abs() + fastest * motor.ld.abs().max(motor.lq.abs());
    let lasting = (1.0 + correlation.clamp(0.0, 0.9)) / (1.0 - correlation.clamp(0.0, 0.9));
    Bench {
        motor: Bench::guess(*motor, |parameter| uncertainty.parameters[parameter as usize].systematic.excitation == 0.0),
        covariance: covariance(standard_errors, &uncertainty.correlation),
        held: points.iter().map(|point| (point.current(), point.omega_e())).collect(),
        row_variance: (impedance * rms).powi(2) * lasting,
        sample_period: log.segments().iter().map(|segment| segment.sample_period).fold(0.0, f64::max),
        voltage: points.iter().map(|point| point.voltage().magnitude()).fold(0.0, f64::max),
        voltage_accuracy: request.voltage_accuracy,
        is_at_rest: log.is_at_rest(),
    }
}
