//! Logs as drives make them: motors, faults, courses and kinds of logs drawn at random, each simulated and identified.
//!
//! | file | concept |
//! |---|---|
//! | `course.rs` | what the motor does |
//! | `fault.rs` | what is wrong with the drive |
//! | `log_kind.rs` | what is logged |
//! | `tally.rs` | wrong numbers, intervals that hold the truth, half-widths |
//! | `table.rs` | the same by fault, verdict, course, kind of log, as tables |
//!
//! What no log can tell is not among the faults: a gain common to all current sensors, the gain of the DC voltage's measurement, an angle
//! that errs with the load. Nor is saturation, whose motors have no constant truth.

pub mod course;
pub mod fault;
pub mod log_kind;
pub mod table;
pub mod tally;

use crate::rated::Rated;
use course::Course;
use fault::Fault;
use fluxfit::{
    Request, identify,
    motor::{PARAMETERS, Parameter},
    optimizer::Draws,
};
use fluxfit_drive::{
    Recording, Scenario,
    scenario::{Adc, Control, Inverter, Mechanics, Sensors, SimulatedMotor, Update},
    simulate,
};
use log_kind::LogKind;
use rayon::prelude::*;
use std::ops::Range;
use tally::Number;

/// Seed of everything that is drawn.
const SEED: u64 = 20;
/// Most faults in one drive; none to this many are equally likely.
const MOST_FAULTS: u64 = 3;

/// Noise of each current sensor, as a fraction of the rated current, from and to.
const NOISE: [f64; 2] = [0.002, 0.008];
/// Bits of the converter of the currents, and its range in rated currents.
const BITS: u32 = 12;
const RANGE: f64 = 2.0;

/// Sample rates, Hz, from and to; more where a winding or a speed needs it.
const SAMPLE_RATE: [f64; 2] = [8e3, 20e3];
/// Samples per time constant of the winding, and largest turn of the rotor per sample, rad.
const SAMPLES_PER_TIME_CONSTANT: f64 = 20.0;
const TURN: f64 = 0.12;
/// Bandwidth of the current loop as an angle per sample, rad.
const BANDWIDTH: f64 = 0.15;

/// Rows of a log, at least; and at least so many radians at full speed.
const ROWS: f64 = 4000.0;
const RADIANS: f64 = 60.0;

/// The part of the voltage limit up to which the highest speed takes voltage: the rest is for dead time, drops and the current loop.
const VOLTAGE: f64 = 0.75;
/// Largest currents of the courses, as fractions of the rated current: i_d, negative, and i_q.
const MOST_ID: f64 = 0.5;
const MOST_IQ: f64 = 0.9;

/// A log that was drawn.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Its number.
    pub index: u64,
    /// Its motor.
    pub rated: Rated,
    /// What the motor does.
    pub course: Course,
    /// What is wrong with the drive, in the order of [`Fault::ALL`].
    pub faults: Vec<Fault>,
    /// What is logged.
    pub kind: LogKind,
    /// The drive with all of that.
    pub scenario: Scenario,
}

/// A log and what was found in it.
#[derive(Debug, Clone)]
pub struct Found {
    /// The log.
    pub drawn: Drawn,
    /// What was found for each parameter, in the order of [`Parameter::ALL`].
    pub numbers: [Number; PARAMETERS],
    /// Keys of the faults that were taken, as in `nuisance` of the command's JSON.
    pub terms: Vec<&'static str>,
    /// Why there is no answer at all; nothing is printed then.
    pub refusal: Option<String>,
}

impl Drawn {
    /// Log number `index` of a sequence that depends on the motors alone; `None` if there are no motors.
    pub fn new(index: u64, motors: &[Rated]) -> Option<Self> {
        Self::with_faults(index, motors, MOST_FAULTS)
    }

    /// The same of drives without a fault.
    pub fn without_fault(index: u64, motors: &[Rated]) -> Option<Self> {
        Self::with_faults(index, motors, 0)
    }

    fn with_faults(index: u64, motors: &[Rated], most: u64) -> Option<Self> {
        let mut draws = Draws::seeded(SEED, index);
        let rated = *pick(&mut draws, motors)?;
        let course = *pick(&mut draws, &Course::ALL)?;
        let kind = LogKind::drawn(&mut draws)?;
        let count = (draws.uniform() * (most + 1) as f64) as usize;
        let mut left = Fault::ALL.to_vec();
        let mut faults: Vec<Fault> = (0..count).filter_map(|_| take(&mut draws, &mut left)).collect();
        faults.sort();
        let mut scenario = perfect_drive(&rated, index, &mut draws);
        scenario.logging = kind.logging();
        scenario.duration *= f64::from(scenario.logging.every);
        let speed = highest_speed(&rated);
        faults.iter().for_each(|fault| fault.put_into(&mut scenario, rated.current, speed, &mut draws));
        // After the duration is known.
        scenario.schedule = course.drawn(scenario.duration, rated.current, speed / f64::from(rated.pole_pairs), &mut draws);
        Some(Self { index, rated, course, faults, kind, scenario })
    }

    /// Its log.
    ///
    /// # Errors
    /// If the drive trips.
    pub fn record(&self) -> Result<Recording, fluxfit_drive::Error> {
        simulate(&self.scenario, self.index, || ())
    }

    /// What is found in it.
    pub fn found(self) -> Found {
        match self.numbers_and_terms() {
            Ok((numbers, terms)) => Found { drawn: self, numbers, terms, refusal: None },
            Err(error) => Found { drawn: self, numbers: Parameter::ALL.map(Number::none), terms: Vec::new(), refusal: Some(error) },
        }
    }

    fn numbers_and_terms(&self) -> Result<([Number; PARAMETERS], Vec<&'static str>), String> {
        let log = self.record().map_err(|error| error.to_string())?.log().map_err(|error| error.to_string())?;
        let answer = identify(&log, &Request::default()).map_err(|error| error.to_string())?;
        let number = |parameter: Parameter| {
            let (judgement, truth) = (answer.parameter(parameter), self.rated.motor.get(parameter));
            judgement.value().map_or(Number::none(parameter), |value| Number {
                parameter,
                verdict: judgement.verdict,
                error: self.error(parameter, value / truth),
                half_width: judgement.uncertainty.half_width / truth,
            })
        };
        let estimates = answer.identification.output.iter().flat_map(|fit| &fit.fault_estimates);
        Ok((Parameter::ALL.map(number), estimates.map(|estimate| estimate.unknown.key()).collect()))
    }

    /// The error of a value that is given as a fraction of the truth. A drifting resistance has the values from start to end.
    fn error(&self, parameter: Parameter, value: f64) -> f64 {
        let drift = if parameter == Parameter::Rs { self.scenario.motor.rs_drift } else { 0.0 };
        value - value.clamp(1.0, 1.0 + drift)
    }
}

/// Draws, simulates and identifies the logs with these numbers on as many threads as there are, with the same result on any number.
pub fn survey(logs: Range<u64>, motors: &[Rated], draw: fn(u64, &[Rated]) -> Option<Drawn>) -> Vec<Found> {
    let found: Vec<Option<Found>> = logs.into_par_iter().map(|index| Some(draw(index, motors)?.found())).collect();
    found.into_iter().flatten().collect()
}

/// A drive on a dynamometer, without a fault but the noise and the converter of its current sensors. Its schedule is still empty.
fn perfect_drive(rated: &Rated, index: u64, draws: &mut Draws) -> Scenario {
    let Rated { motor, current, .. } = *rated;
    let speed = highest_speed(rated);
    let winding = SAMPLES_PER_TIME_CONSTANT * motor.rs / motor.ld.min(motor.lq);
    let sample_rate = between(draws, SAMPLE_RATE).max(winding).max(speed / TURN);
    let update = if draws.uniform() < 0.5 { Update::Single } else { Update::Double };
    let carrier = if update == Update::Single { sample_rate } else { 0.5 * sample_rate };
    let bandwidth = BANDWIDTH * sample_rate / std::f64::consts::TAU;
    Scenario {
        duration: (ROWS / sample_rate).max(RADIANS / speed),
        seed: SEED + index,
        motor: SimulatedMotor::new(motor.rs, motor.into(), rated.pole_pairs),
        mechanics: Mechanics::Dyno,
        inverter: Inverter { update, ..Inverter::ideal(rated.u_dc, carrier) },
        control: Control { trip_current: 3.0 * current, ..Control::new(bandwidth, 0.0, 1.5 * current) },
        sensors: Sensors {
            current_noise: between(draws, NOISE) * current,
            adc: Some(Adc { bits: BITS, range: RANGE * current }),
            ..Sensors::IDEAL
        },
        ..Scenario::paper()
    }
}

/// The highest speed of the courses, electrical rad/s: the nominal one, or that for which the voltage suffices.
fn highest_speed(rated: &Rated) -> f64 {
    let Rated { motor, current, .. } = *rated;
    let (id, iq) = (MOST_ID * current, MOST_IQ * current);
    let flux = motor.psi_f.max((motor.psi_f - motor.ld * id).abs()).hypot(motor.lq * iq);
    let voltage = VOLTAGE * rated.u_dc / 3.0_f64.sqrt() - motor.rs * current;
    rated.omega_e.min(voltage.max(0.0) / flux)
}

/// A number between two, uniformly.
fn between(draws: &mut Draws, [from, to]: [f64; 2]) -> f64 {
    from + draws.uniform() * (to - from)
}

/// A positive number between two, uniformly in its logarithm.
fn between_decades(draws: &mut Draws, [from, to]: [f64; 2]) -> f64 {
    from * (to / from).powf(draws.uniform())
}

fn pick<'a, T>(draws: &mut Draws, of: &'a [T]) -> Option<&'a T> {
    of.get((draws.uniform() * of.len() as f64) as usize)
}

/// Takes one out.
fn take<T>(draws: &mut Draws, of: &mut Vec<T>) -> Option<T> {
    let index = (draws.uniform() * of.len() as f64) as usize;
    (index < of.len()).then(|| of.swap_remove(index))
}
