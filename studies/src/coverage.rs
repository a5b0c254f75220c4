//! Whether the output error's answers scatter as little as the noise allows, and its intervals hold the truth as often as they say.
//!
//! Logs whose model is exact: an inverter that makes each period's mean vector, noise on the current sensors and nothing else. The
//! least that an unbiased estimate can scatter is the Cramér–Rao bound: the inverse of `J'J / variance`, with the derivatives `J` of the
//! predicted currents at recorded voltages, initial currents and first vectors solved for, averaged over the draws. S. M. Kay,
//! Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, section 3.7.

use fluxfit::{
    Judgement, Model, Request, TimeWindow,
    evidence::Identification,
    identify,
    levenberg_marquardt::{MOTOR, jacobian},
    motor::{Motor, PARAMETERS, Parameter},
    objective::{acting_voltage::VoltageTiming, adjustable::Adjustable, output_error::OutputError},
};
use fluxfit_drive::{
    Scenario,
    scenario::reference_cases::{STEADY, acceleration, small_motor, two_loads, two_modes},
    simulate,
};
use nalgebra::Matrix4;
use rayon::prelude::*;
use std::error::Error;

/// Three current sensors: this part of a sensor's variance on each axis, the rest in the zero sequence.
const AXIS_VARIANCE: f64 = 2.0 / 3.0;

/// A drive, its motor, and the part of its log that is looked at.
#[derive(Debug, Clone)]
pub struct Case {
    /// What it is called.
    pub name: &'static str,
    /// The drive.
    pub scenario: Scenario,
    /// Its motor.
    pub motor: Motor,
    /// From when to when, s; none: all of it.
    pub window: Option<TimeWindow>,
}

/// What many draws make of a parameter.
#[derive(Debug, Clone, Copy)]
pub struct Figures {
    /// Cramér–Rao bound of the standard error, as a fraction of the truth.
    pub bound: f64,
    /// Root-mean-square error over the bound.
    pub ratio: f64,
    /// Mean error over the bound.
    pub bias: f64,
    /// Draws whose 95 % interval holds the truth.
    pub covered: usize,
    /// Mean half-width of the intervals over the bound: 1.96 where they are as wide as they need be.
    pub half_width: f64,
}

/// What many draws make of a log.
#[derive(Debug, Clone, Copy)]
pub struct Tally {
    /// Draws.
    pub draws: usize,
    /// Of them, those in which the drive was said to have a fault. It has none.
    pub with_fault: usize,
    /// In the order of [`Parameter::ALL`].
    pub parameters: [Figures; PARAMETERS],
}

impl Case {
    /// All that are published.
    pub fn all() -> [Self; 4] {
        let case = |name, scenario: Scenario, window| Self { name, motor: scenario.motor.unsaturated(), scenario, window };
        [
            case("two modes, i_d 0 and -2 A", two_modes(), Some(STEADY)),
            case("acceleration", acceleration(), None),
            case("20 uH motor", small_motor(), None),
            case("i_d = 0, two loads", two_loads(), Some(STEADY)),
        ]
    }

    /// Simulates and identifies the log with so many draws of noise, on as many threads as there are, with the same result on any number.
    ///
    /// # Errors
    /// If a log cannot be simulated or identified.
    pub fn tally(&self, voltage_timing: Option<VoltageTiming>, draws: usize) -> Result<Tally, Box<dyn Error>> {
        let settings = Request {
            model: Some(Model::OutputError),
            windows: self.window.into_iter().collect(),
            voltage_timing,
            voltage_accuracy: 0.0,
            ..Request::default()
        };
        let draws: Vec<Draw> = (0..draws as u64).into_par_iter().map(|draw| self.draw(draw, &settings)).collect::<Result<_, _>>()?;
        let count = draws.len() as f64;
        let information = draws.iter().fold(Matrix4::zeros(), |sum, draw| sum + draw.information) / count;
        let bound = information.try_inverse().ok_or("this log leaves a parameter open")?.diagonal().map(f64::sqrt);
        let figures = |p: usize| {
            let errors = || draws.iter().map(|draw| draw.errors[p]);
            Figures {
                bound: bound[p],
                ratio: (errors().map(|error| error * error).sum::<f64>() / count).sqrt() / bound[p],
                bias: errors().sum::<f64>() / count / bound[p],
                covered: draws.iter().filter(|draw| draw.errors[p].abs() <= draw.half_widths[p]).count(),
                half_width: draws.iter().map(|draw| draw.half_widths[p]).sum::<f64>() / count / bound[p],
            }
        };
        let with_fault = draws.iter().filter(|draw| draw.has_fault).count();
        Ok(Tally { draws: draws.len(), with_fault, parameters: std::array::from_fn(figures) })
    }

    fn draw(&self, draw: u64, settings: &Request) -> Result<Draw, String> {
        let recording = simulate(&self.scenario, draw, || ()).map_err(|error| error.to_string())?;
        let log = recording.log().map_err(|error| error.to_string())?;
        let found = identify(&log, settings).map_err(|error| error.to_string())?.identification;
        let fit = found.output.as_ref().ok_or("another model than the output error answered")?;
        let objective = OutputError::of_rows(&log, &fit.stretches, VoltageTiming::Centered).map_err(|error| error.to_string())?;
        Ok(Draw {
            errors: self.relative(&found, |judgement, truth| judgement.raw / truth - 1.0),
            half_widths: self.relative(&found, |judgement, truth| judgement.uncertainty.half_width / truth),
            information: self.information(&objective),
            has_fault: fit.fault_trials.iter().any(|tried| fit.has(tried.fault)),
        })
    }

    fn relative(&self, found: &Identification, of: impl Fn(&Judgement, f64) -> f64) -> [f64; PARAMETERS] {
        Parameter::ALL.map(|parameter| of(found.parameter(parameter), self.motor.get(parameter)))
    }

    /// Fisher's information of the parameters as fractions of the truth, at the truth.
    fn information(&self, objective: &OutputError) -> Matrix4<f64> {
        let slopes = jacobian(objective, &Adjustable::from(self.motor), &MOTOR);
        let truth = self.motor.to_array();
        let variance = AXIS_VARIANCE * self.scenario.sensors.current_noise.powi(2);
        let product = |p: usize, q: usize| slopes[p].iter().zip(&slopes[q]).map(|(a, b)| a * b).sum::<f64>();
        Matrix4::from_fn(|p, q| truth[p] * truth[q] * product(p, q) / variance)
    }
}

/// One draw; fractions of the truth.
struct Draw {
    errors: [f64; PARAMETERS],
    half_widths: [f64; PARAMETERS],
    information: Matrix4<f64>,
    has_fault: bool,
}
