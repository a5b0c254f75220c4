//! Estimators on a stream, against the Cramér-Rao bound: many draws of the noise on the paper's rig, from random starts.

use fluxfit::{
    Columns,
    frames::Dq,
    log::Row,
    motor::{Motor, PARAMETERS},
    optimizer::Draws,
};
use fluxfit_core::period::arrival;
use fluxfit_drive::{Drive, Scenario, simulate};
use fluxfit_track::{DriveFaults, Event, Method, Start, Stream, Timing, TrackSettings, Tracker};
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
    let mut stream = Stream::new(COMMANDS, DriveFaults::default());
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

/// Of one draw, for each method: errors as parts of the truth, and standard errors likewise.
type Ends = Vec<([f64; PARAMETERS], Option<[f64; PARAMETERS]>)>;

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
                let mut tracker = Tracker::new(TrackSettings { start, ..TrackSettings::new(*method, Some(COMMANDS)) });
                rows.iter().for_each(|row| tracker.push(row));
                let estimate = tracker.estimator().map(fluxfit_track::Estimator::estimate);
                estimate.map_or(([f64::NAN; PARAMETERS], None), |estimate| {
                    let error = std::array::from_fn(|j| estimate.values[j] / truth[j] - 1.0);
                    (error, estimate.standard_errors.map(|errors| std::array::from_fn(|j| errors[j] / truth[j])))
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
        settled: ends.iter().filter(|ends| ends[place].0.iter().all(|error| error.abs() < 0.05)).count(),
        draws: ends.len(),
    }
}

/// Length of a period, s.
const PERIOD: f64 = 1e-4;

/// The rows of a drive one by one, with its commands for voltages: what a stream sees.
///
/// # Errors
/// If the scenario cannot be simulated.
pub fn each_row(scenario: &Scenario, draw: u64, mut take: impl FnMut(&Row)) -> Result<(), Box<dyn Error>> {
    scenario.check()?;
    let mut drive = Drive::new(scenario, draw);
    for _ in 0..scenario.rows() {
        let row = drive.step()?;
        let (u, i, theta_e) = (row.u_ref, row.i, Some(row.theta_e));
        take(&Row { t: row.t, ud: u.d, uq: u.q, id: i.d, iq: i.q, omega_e: row.omega_e, theta_e, ..Row::default() });
    }
    Ok(())
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
    /// Steps of parameters that were found.
    pub steps: u32,
}

/// Follows the motor of `examples/scenarios/warming.toml`, or of one like it, with an estimator; `faults` are known.
///
/// # Errors
/// If the scenario cannot be simulated.
pub fn followed(scenario: &Scenario, method: Method, faults: DriveFaults, draw: u64) -> Result<Followed, Box<dyn Error>> {
    let values = [0, 1, 2, 3].map(|j| Some(START[j] * fluxfit::paper::MOTOR.to_array()[j]));
    let start = Start { values, rating: Some([10.0, 419.0]), ..Start::default() };
    let mut tracker = Tracker::new(TrackSettings { start, faults, ..TrackSettings::new(method, Some(COMMANDS)) });
    let mut squares = SVector::<f64, PARAMETERS>::zeros();
    let (mut counted, mut quiet, mut last_off, mut k) = (0_u64, [0.0_f64; PARAMETERS], 40.0, 0_u64);
    let (mut printed, mut held) = ([0_u64; PARAMETERS], [0_u64; PARAMETERS]);
    each_row(scenario, draw, |row| {
        tracker.push(row);
        k += 1;
        let (Some(estimator), true) = (tracker.estimator(), k.is_multiple_of(10)) else { return };
        let Some(truth) = scenario.motor.parameters_at(row.t, scenario.duration).map(Motor::to_array) else { return };
        let estimate = estimator.estimate();
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
        if row.t > 1.0 && k.is_multiple_of(1000) {
            for (j, tracked) in tracker.parameters_or_nothing().iter().enumerate() {
                if let Some([low, high]) = tracked.interval() {
                    printed[j] += 1;
                    held[j] += u64::from((low..=high).contains(&truth[j]));
                }
            }
        }
    })?;
    Ok(Followed {
        rms_percent: std::array::from_fn(|j| (squares[j] / counted as f64).sqrt()),
        quiet_percent: quiet,
        step_s: last_off - 40.0,
        coverage: std::array::from_fn(|j| held[j] as f64 / printed[j] as f64),
        steps: tracker.steps(),
    })
}

/// Steps that the tracking filter found in so many draws of a scenario whose parameters do not change, here made of one whose do.
///
/// # Errors
/// If the scenario cannot be simulated.
pub fn false_alarms(scenario: &Scenario, draws: u64) -> Result<u32, Box<dyn Error>> {
    let mut constant = scenario.clone();
    constant.motor.changes = Default::default();
    let start = Start { values: fluxfit::paper::MOTOR.to_array().map(Some), ..Start::default() };
    let mut steps = 0;
    for draw in 0..draws {
        let mut tracker = Tracker::new(TrackSettings { start, ..TrackSettings::new(Method::EkfTracking, Some(COMMANDS)) });
        each_row(&constant, draw, |row| tracker.push(row))?;
        steps += tracker.steps();
    }
    Ok(steps)
}

/// Logs that do not determine all four parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deficient {
    /// i_d = 0 at one operating point: only lq, and the sum `rs i_q + omega psi_f`.
    OnePoint,
    /// One operating point with i_d below zero: two combinations of all four.
    OnePointWithId,
    /// i_d = 0 at a speed that goes up and down: all but ld.
    ZeroId,
    /// Steps of both currents at standstill: all but psi_f.
    Standstill,
}

impl Deficient {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::OnePoint, Self::OnePointWithId, Self::ZeroId, Self::Standstill];

    /// References of i_d, i_q, A, and the speed, electrical rad/s, at the k-th row of a log with this current and speed.
    fn wanted(self, k: u32, iq: f64, omega: f64) -> [f64; 3] {
        let is_second = k / 2500 % 2 == 1;
        // Up and down by 20 % once a second.
        let part = f64::from(k % 10_000) / 10_000.0;
        match self {
            Self::OnePoint => [0.0, iq, omega],
            Self::OnePointWithId => [-0.3 * iq, iq, omega],
            Self::ZeroId => [0.0, iq, omega * (0.8 + 0.8 * (part - 0.5).abs())],
            Self::Standstill => [if is_second { -0.3 * iq } else { 0.0 }, if k / 5000 % 2 == 1 { iq } else { 0.5 * iq }, 0.0],
        }
    }
}

/// How many intervals were printed for each parameter at the end of drawn logs of 2 s, and how many of them hold the truth.
#[must_use]
pub fn rank_deficient(kind: Deficient, draws: u64) -> [(usize, usize); PARAMETERS] {
    let ends: Vec<[Option<bool>; PARAMETERS]> = (0..draws).into_par_iter().map(|draw| held_of_deficient(kind, draw)).collect();
    std::array::from_fn(|j| {
        let printed: Vec<bool> = ends.iter().filter_map(|held| held[j]).collect();
        (printed.len(), printed.iter().filter(|held| **held).count())
    })
}

/// Of one such log: whether the interval of each parameter holds the truth, where one is printed.
fn held_of_deficient(kind: Deficient, draw: u64) -> [Option<bool>; PARAMETERS] {
    let motor = fluxfit::paper::MOTOR;
    let [_, ld, lq, _] = motor.to_array();
    let mut random = Draws::seeded(23, draw);
    // Half of them without noise.
    let noise = if draw.is_multiple_of(2) { 0.0 } else { 0.04 };
    let start = random_start(&motor, 1.5, &mut random);
    let timing = Timing::Delayed { delay: 0, at_row: false };
    let mut tracker = Tracker::new(TrackSettings { start, ..TrackSettings::new(Method::EkfTracking, Some(timing)) });
    let (iq, omega) = (2.0 + 10.0 * random.uniform(), 100.0 + 500.0 * random.uniform());
    let [id, first_iq, mut omega_e] = kind.wanted(0, iq, omega);
    let mut i = [id, first_iq];
    for k in 0..20_000 {
        let [id, iq, _] = kind.wanted(k, iq, omega);
        let steady = motor.steady_voltage(Dq { d: id, q: iq }, omega_e);
        let measured = [0, 1].map(|c| i[c] + noise * random.normal());
        let u = [steady.d + 600.0 * ld * (id - measured[0]), steady.q + 600.0 * lq * (iq - measured[1])];
        tracker.push(&Row { t: f64::from(k) * PERIOD, ud: u[0], uq: u[1], id: measured[0], iq: measured[1], omega_e, ..Row::default() });
        let [_, _, next] = kind.wanted(k + 1, iq, omega);
        let period = fluxfit_core::Period { u, omega_e: 0.5 * (omega_e + next), length: PERIOD };
        i = fluxfit_core::period::current_after(&motor.to_array(), i, &period);
        omega_e = next;
    }
    let truth = motor.to_array();
    let tracked = tracker.parameters_or_nothing();
    std::array::from_fn(|j| tracked[j].interval().map(|[low, high]| (low..=high).contains(&truth[j])))
}
