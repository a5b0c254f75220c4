//! Estimators on a stream, against the Cramér-Rao bound: many draws of the noise on the paper's rig, from random starts.

use fluxfit::{
    Columns,
    frames::Dq,
    log::Row,
    motor::{Motor, PARAMETERS},
    optimizer::Draws,
};
use fluxfit_core::period::arrival;
use fluxfit_drive::{Scenario, simulate};
use fluxfit_track::{Estimator, Event, Method, Start, Stream, Timing, TrackSettings, Tracker};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use std::error::Error;

/// How the commands of a simulated drive act.
pub const COMMANDS: Timing = Timing::Delayed { delay: 1, at_row: false };

/// Half-width of a 95 % interval in standard errors.
const HALF_WIDTH95: f64 = 1.959_964;

/// What an estimator reached in many draws, by parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// The estimator.
    pub method: Method,
    /// Root mean square of the errors over the Cramér-Rao bound.
    pub over_bound: [f64; PARAMETERS],
    /// Mean error, %.
    pub bias_percent: [f64; PARAMETERS],
    /// Share of the 95 % intervals that hold the truth; none without intervals.
    pub coverage: Option<[f64; PARAMETERS]>,
    /// Draws in which all four ended within 5 %.
    pub settled: usize,
    /// Draws in which a filter was started anew.
    pub anew: usize,
    /// Root mean square of the errors over the bound, in the other draws.
    pub over_bound_otherwise: [f64; PARAMETERS],
    /// Draws.
    pub draws: usize,
}

/// The rows of a recording, with the commands for voltages.
pub fn rows(columns: &Columns, u: Option<(&[f64], &[f64])>) -> Vec<Row> {
    let (ud, uq) = u.unwrap_or((&columns.ud, &columns.uq));
    (0..columns.t.len())
        .map(|k| Row {
            t: columns.t[k],
            ud: ud[k],
            uq: uq[k],
            id: columns.id[k],
            iq: columns.iq[k],
            omega_e: columns.omega_e[k],
            ..Row::default()
        })
        .collect()
}

/// The relative Cramér-Rao bound of a motor's parameters from these rows, with noise of this standard deviation, A, on each axis:
/// inverse of `sum G'G / sigma²`, with the sensitivities `G` of the output to initial current and parameters.
pub fn bound(rows: &[Row], motor: &Motor, noise: f64) -> [f64; PARAMETERS] {
    const STATES: usize = PARAMETERS + 2;
    let theta = motor.to_array();
    let mut stream = Stream::new(COMMANDS);
    let mut g = SMatrix::<f64, 2, STATES>::zeros();
    (g[(0, 0)], g[(1, 1)]) = (1.0, 1.0);
    let mut information = SMatrix::<f64, STATES, STATES>::zeros();
    let mut i = [0.0; 2];
    for event in rows.iter().filter_map(|row| stream.push(row)) {
        match event {
            Event::Begin(start) => i = start,
            Event::Period(period, _) => {
                let next = arrival(&theta, i, &period);
                let f = SMatrix::<f64, 2, 2>::from_fn(|r, c| next.by_current[c][r]);
                g = f * g;
                for j in 0..PARAMETERS {
                    for c in 0..2 {
                        g[(c, j + 2)] += next.by_parameter[j][c] * theta[j];
                    }
                }
                i = next.i;
            }
        }
        information += g.transpose() * g / (noise * noise);
    }
    let covariance = information.try_inverse().unwrap_or_else(|| SMatrix::from_element(f64::NAN));
    std::array::from_fn(|j| covariance[(j + 2, j + 2)].sqrt())
}

/// A start within a factor of the truth.
pub fn random_start(motor: &Motor, factor: f64, draws: &mut Draws) -> Start {
    let off = |value: f64, draws: &mut Draws| value * factor.powf(2.0 * draws.uniform() - 1.0);
    Start { values: motor.to_array().map(|value| Some(off(value, draws))), ..Start::default() }
}

/// Of one draw, for each method: errors as parts of the truth, standard errors likewise, and whether a filter started anew.
type Ends = Vec<([f64; PARAMETERS], Option<[f64; PARAMETERS]>, bool)>;

/// What the estimators reach in so many draws of a scenario's noise, from starts within a factor of the truth.
///
/// # Errors
/// If the scenario cannot be simulated.
pub fn reached(scenario: &Scenario, noise: f64, methods: &[Method], draws: u64, factor: f64) -> Result<Vec<Reached>, Box<dyn Error>> {
    let motor = scenario.motor.unsaturated();
    let truth = motor.to_array();
    let first = simulate(scenario, 0, || ())?;
    let bound = bound(&rows(&first.columns, Some((&first.ud_ref, &first.uq_ref))), &motor, noise);
    let ends: Vec<Ends> = (0..draws)
        .into_par_iter()
        .map(|draw| -> Result<Ends, String> {
            let recording = simulate(scenario, draw, || ()).map_err(|error| error.to_string())?;
            let rows = rows(&recording.columns, Some((&recording.ud_ref, &recording.uq_ref)));
            let start = random_start(&motor, factor, &mut Draws::seeded(7, draw));
            let end = |method: &Method| {
                let mut tracker = Tracker::new(TrackSettings { method: *method, timing: Some(COMMANDS), start });
                rows.iter().for_each(|row| tracker.push(row));
                let estimate = tracker.estimator().map(fluxfit_track::Estimator::estimate);
                estimate.map_or(([f64::NAN; PARAMETERS], None, false), |estimate| {
                    let error = std::array::from_fn(|j| estimate.values[j] / truth[j] - 1.0);
                    let is_anew = matches!(tracker.estimator(), Some(Estimator::Ekf(filter)) if filter.restarts() > 0);
                    (error, estimate.standard_errors.map(|errors| std::array::from_fn(|j| errors[j] / truth[j])), is_anew)
                })
            };
            Ok(methods.iter().map(end).collect())
        })
        .collect::<Result<_, _>>()?;
    Ok(methods.iter().enumerate().map(|(place, method)| summary(*method, place, &ends, &bound)).collect())
}

fn summary(method: Method, place: usize, ends: &[Ends], bound: &[f64; PARAMETERS]) -> Reached {
    let count = ends.len() as f64;
    let of = |j: usize, value: &dyn Fn(f64, Option<f64>) -> f64| {
        ends.iter().map(|ends| value(ends[place].0[j], ends[place].1.map(|errors| errors[j]))).sum::<f64>() / count
    };
    let coverage = ends.first().and_then(|ends| ends[place].1).map(|_| {
        std::array::from_fn(|j| {
            of(j, &|error, standard| f64::from(u8::from(standard.is_some_and(|own| error.abs() <= HALF_WIDTH95 * own))))
        })
    });
    Reached {
        method,
        over_bound: std::array::from_fn(|j| of(j, &|error, _| error * error).sqrt() / bound[j]),
        bias_percent: std::array::from_fn(|j| 100.0 * of(j, &|error, _| error)),
        coverage,
        anew: ends.iter().filter(|ends| ends[place].2).count(),
        over_bound_otherwise: std::array::from_fn(|j| {
            let others: Vec<f64> = ends.iter().filter(|ends| !ends[place].2).map(|ends| ends[place].0[j].powi(2)).collect();
            (others.iter().sum::<f64>() / others.len() as f64).sqrt() / bound[j]
        }),
        settled: ends.iter().filter(|ends| ends[place].0.iter().all(|error| error.abs() < 0.05)).count(),
        draws: ends.len(),
    }
}

/// A motor whose parameters change, run without a drive: exact periods with given voltages, and noise on the measured currents.
#[derive(Debug)]
pub struct Warming {
    i: [f64; 2],
    k: u64,
    draws: Draws,
    /// Standard deviation of the noise of each axis, A.
    noise: f64,
    /// Parameters at a time, s.
    parameters: fn(f64) -> [f64; PARAMETERS],
}

/// Length of a period, s.
pub const PERIOD: f64 = 1e-4;

/// The parameters of the warming log at a time, s: in 60 s R_s grows by 30 % and psi_f falls by 5 %; at 40 s L_q falls by 17 %.
pub fn warming(t: f64) -> [f64; PARAMETERS] {
    let [rs, ld, lq, psi_f] = fluxfit::paper::MOTOR.to_array();
    [rs * (1.0 + 0.3 * t / 60.0), ld, if t >= 40.0 { 0.83 * lq } else { lq }, psi_f * (1.0 - 0.05 * t / 60.0)]
}

/// The paper's motor at any time, s.
pub fn constant(_: f64) -> [f64; PARAMETERS] {
    fluxfit::paper::MOTOR.to_array()
}

impl Warming {
    /// Before the first row.
    pub fn new(parameters: fn(f64) -> [f64; PARAMETERS], noise: f64, draw: u64) -> Self {
        Self { i: [0.0, 9.0], k: 0, draws: Draws::seeded(11, draw), noise, parameters }
    }

    /// The next row, whose voltage acts from it on. i_d alternates between 0 and -2 A every 0.25 s, the speed by 10 % over 2 s; from 20 to
    /// 30 s both stand still, if the motor warms. i_q is 2 A more or less while the speed rises or falls, and from 40 s on 3 A more, as
    /// where saturation comes from load.
    pub fn row(&mut self, has_quiet: bool) -> Row {
        let t = self.k as f64 * PERIOD;
        let is_quiet = has_quiet && (20.0..30.0).contains(&t);
        let id = if !is_quiet && (t / 0.25) as u64 % 2 == 1 { -2.0 } else { 0.0 };
        let (swing, rise) = if is_quiet { (0.0, 0.0) } else { (std::f64::consts::TAU * t / 2.0).sin_cos() };
        let (swing, rise) = (0.1 * swing, 2.0 * rise);
        let iq = rise + if t >= 40.0 && has_quiet { 12.0 } else { 9.0 };
        let omega_e = 419.0 * (1.0 + swing);
        let theta = (self.parameters)(t);
        let [rs, ld, lq, psi_f] = theta;
        // A proportional controller of 100 Hz on measured currents, with the motor's voltages fed forward.
        let measured = [0, 1].map(|c| self.i[c] + self.noise * self.draws.normal());
        let wanted = Motor { rs, ld, lq, psi_f }.steady_voltage(Dq { d: id, q: iq }, omega_e);
        let gain = std::f64::consts::TAU * 100.0;
        let u = [wanted.d + gain * ld * (id - measured[0]), wanted.q + gain * lq * (iq - measured[1])];
        let row = Row { t, ud: u[0], uq: u[1], id: measured[0], iq: measured[1], omega_e, ..Row::default() };
        self.k += 1;
        let next = self.k as f64 * PERIOD;
        let next_swing = if has_quiet && (20.0..30.0).contains(&next) { 0.0 } else { 0.1 * (std::f64::consts::TAU * next / 2.0).sin() };
        let omega = 0.5 * (omega_e + 419.0 * (1.0 + next_swing));
        // The stream turns the vector from the middle that the speed of the row foretells to the middle that came.
        self.i = fluxfit_core::period::current_after(
            &theta,
            self.i,
            &fluxfit_core::Period { u: turned(u, (omega_e - omega) * 0.5 * PERIOD), omega_e: omega, length: PERIOD },
        );
        row
    }
}

fn turned(v: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]]
}

/// Start values as parts of the true ones: -30, +40, -25 and -12 %.
pub const START: [f64; PARAMETERS] = [0.7, 1.4, 0.75, 0.88];

/// How the tracking filter followed the warming log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Followed {
    /// Root mean square of the errors over 5 to 60 s without the quiet spell and the 3 s after the step, %.
    pub rms_percent: [f64; PARAMETERS],
    /// Largest error in the quiet spell, %.
    pub quiet_percent: [f64; PARAMETERS],
    /// Time from the step of L_q until its error stays below 2 %, s.
    pub step_s: f64,
    /// Share of the intervals that hold the truth, of those that were printed.
    pub coverage: [f64; PARAMETERS],
}

/// Follows the warming log with an estimator.
pub fn followed(method: Method, noise: f64, draw: u64) -> Followed {
    let mut motor = Warming::new(warming, noise, draw);
    let values = [0, 1, 2, 3].map(|j| Some(START[j] * fluxfit::paper::MOTOR.to_array()[j]));
    let start = Start { values, rating: Some([10.0, 419.0]), ..Start::default() };
    let timing = Some(Timing::Delayed { delay: 0, at_row: false });
    let mut tracker = Tracker::new(TrackSettings { method, timing, start });
    let mut squares = SVector::<f64, PARAMETERS>::zeros();
    let (mut counted, mut quiet, mut last_off) = (0_u64, [0.0_f64; PARAMETERS], 40.0);
    let (mut printed, mut held) = ([0_u64; PARAMETERS], [0_u64; PARAMETERS]);
    while motor.k < 600_000 {
        let row = motor.row(true);
        tracker.push(&row);
        let Some(estimator) = tracker.estimator() else { continue };
        if !motor.k.is_multiple_of(10) {
            continue;
        }
        let (truth, estimate) = (warming(row.t), estimator.estimate());
        let error: [f64; PARAMETERS] = std::array::from_fn(|j| 100.0 * (estimate.values[j] / truth[j] - 1.0));
        if row.t > 40.0 && row.t < 50.0 && error[2].abs() > 2.0 {
            last_off = row.t;
        }
        if (20.0..30.0).contains(&row.t) {
            quiet = std::array::from_fn(|j| quiet[j].max(error[j].abs()));
        } else if row.t > 5.0 && !(40.0..43.0).contains(&row.t) {
            squares += SVector::from(error.map(|error| error * error));
            counted += 1;
        }
        if row.t > 1.0 && motor.k.is_multiple_of(1000) {
            for (j, tracked) in tracker.parameters_or_nothing().iter().enumerate() {
                if let Some([low, high]) = tracked.interval() {
                    printed[j] += 1;
                    held[j] += u64::from((low..=high).contains(&truth[j]));
                }
            }
        }
    }
    Followed {
        rms_percent: std::array::from_fn(|j| (squares[j] / counted as f64).sqrt()),
        quiet_percent: quiet,
        step_s: last_off - 40.0,
        coverage: std::array::from_fn(|j| held[j] as f64 / printed[j] as f64),
    }
}

/// Steps that the tracking filter found in so many seconds of constant parameters.
pub fn false_alarms(seconds: u64, noise: f64, draw: u64) -> u32 {
    let mut motor = Warming::new(constant, noise, draw);
    let timing = Some(Timing::Delayed { delay: 0, at_row: false });
    let start = Start { values: fluxfit::paper::MOTOR.to_array().map(Some), ..Start::default() };
    let mut tracker = Tracker::new(TrackSettings { method: Method::EkfTracking, timing, start });
    for _ in 0..seconds * 10_000 {
        tracker.push(&motor.row(false));
    }
    tracker.steps()
}

/// Of drawn logs with i_d = 0 at one operating point: how many intervals were printed for each parameter, and how many hold the truth.
pub fn rank_deficient(draws: u64) -> [(usize, usize); PARAMETERS] {
    let truth = fluxfit::paper::MOTOR.to_array();
    let [rs, ld, lq, psi_f] = truth;
    let mut counts = [(0, 0); PARAMETERS];
    for draw in 0..draws {
        let mut random = Draws::seeded(23, draw);
        // Half of them without noise.
        let noise = if draw % 2 == 0 { 0.0 } else { 0.04 };
        let start = random_start(&fluxfit::paper::MOTOR, 1.5, &mut random);
        let timing = Timing::Delayed { delay: 0, at_row: false };
        let mut tracker = Tracker::new(TrackSettings { method: Method::EkfTracking, timing: Some(timing), start });
        let (iq, omega) = (2.0 + 10.0 * random.uniform(), 100.0 + 500.0 * random.uniform());
        let wanted = Motor { rs, ld, lq, psi_f }.steady_voltage(Dq { d: 0.0, q: iq }, omega);
        let mut i = [0.0, iq];
        for k in 0..20_000 {
            let measured = [0, 1].map(|c| i[c] + noise * random.normal());
            let u = [wanted.d - 600.0 * ld * measured[0], wanted.q + 600.0 * lq * (iq - measured[1])];
            let t = f64::from(k) * PERIOD;
            tracker.push(&Row { t, ud: u[0], uq: u[1], id: measured[0], iq: measured[1], omega_e: omega, ..Row::default() });
            i = fluxfit_core::period::current_after(&truth, i, &fluxfit_core::Period { u, omega_e: omega, length: PERIOD });
        }
        for (j, tracked) in tracker.parameters_or_nothing().iter().enumerate() {
            if let Some([low, high]) = tracked.interval() {
                counts[j].0 += 1;
                counts[j].1 += usize::from((low..=high).contains(&truth[j]));
            }
        }
    }
    counts
}
