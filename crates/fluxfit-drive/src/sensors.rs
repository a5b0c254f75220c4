//! The sensors, their settings and their faults: currents through current sensors and A/D converter, angle and speed through the encoder.

use crate::{
    direction::Direction,
    error::Error,
    inverter::Bridge,
    plant::Plant,
    range::{finite, not_negative, positive, setting},
};
use fluxfit::{
    frames::{Abc, AlphaBeta},
    optimizer::Draws,
};
use std::f64::consts::{PI, TAU};

/// Bandwidth of the observer that estimates the speed from encoder steps, rad/s: five times the usual 20 Hz of a speed loop. At
/// constant acceleration its speed lags by twice the acceleration divided by this bandwidth.
pub(crate) const SPEED_OBSERVER: f64 = TAU * 100.0;

/// Current sensors and encoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// How many phases have a current sensor.
    pub current_sensors: CurrentSensors,
    /// White noise of each current sample, standard deviation, A.
    pub current_noise: f64,
    /// Offset of each phase's sensor, A.
    pub current_offset: [f64; 3],
    /// Gain of each phase's sensor.
    pub current_gain: [f64; 3],
    /// The A/D converter of the currents; `None` for an ideal one.
    pub adc: Option<Adc>,
    /// Error of the measured angle, electrical rad.
    pub angle_offset: f64,
    /// Time by which the measured angle is late, s: at the speed `omega_e` it is too small by `omega_e` times this.
    pub angle_delay: f64,
    /// Steps of the encoder per mechanical revolution; the angle is read as the middle of a step. `None`: angle and speed are exact.
    pub encoder_steps: Option<u32>,
    /// Gain of the DC voltage's measurement.
    pub u_dc_gain: f64,
}

/// How many phases have a current sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurrentSensors {
    /// Phases a and b; the current of c is minus their sum.
    Two,
    /// All phases.
    Three,
}

/// An analog to digital converter of currents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adc {
    /// Number of bits.
    pub bits: u32,
    /// Largest current, A; the smallest is its negative.
    pub range: f64,
}

impl Sensors {
    /// Sensors without a fault.
    pub const IDEAL: Self = Self {
        current_sensors: CurrentSensors::Three,
        current_noise: 0.0,
        current_offset: [0.0; 3],
        current_gain: [1.0; 3],
        adc: None,
        angle_offset: 0.0,
        angle_delay: 0.0,
        encoder_steps: None,
        u_dc_gain: 1.0,
    };

    /// Refuses settings out of their ranges.
    pub(crate) fn check(&self) -> Result<(), Error> {
        not_negative("sensors.current_noise", self.current_noise)?;
        self.current_offset.iter().try_for_each(|offset| finite("sensors.current_offset", *offset))?;
        self.current_gain.iter().try_for_each(|gain| positive("sensors.current_gain", *gain))?;
        finite("sensors.angle_offset", self.angle_offset)?;
        finite("sensors.angle_delay", self.angle_delay)?;
        positive("sensors.u_dc_gain", self.u_dc_gain)?;
        if let Some(adc) = self.adc {
            positive("sensors.adc_range", adc.range)?;
            if !(2..=32).contains(&adc.bits) {
                return Err(setting("sensors.adc_bits", f64::from(adc.bits), "from 2 to 32"));
            }
        }
        match self.encoder_steps {
            Some(steps) if steps < 16 => Err(setting("sensors.encoder_steps", f64::from(steps), "at least 16")),
            _ => Ok(()),
        }
    }
}

/// One sample of all sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Current, A.
    pub i: AlphaBeta,
    /// Electrical angle, rad, from -pi to pi.
    pub theta_e: f64,
    /// Of that angle.
    pub direction: Direction,
    /// Speed, electrical rad/s.
    pub omega_e: f64,
    /// DC voltage, V.
    pub u_dc: f64,
}

/// The sensors with their state.
#[derive(Debug, Clone)]
pub struct SensorModel {
    settings: Sensors,
    draws: Draws,
    pole_pairs: f64,
    sample_period: f64,
    /// Angle and speed of the observer, mechanical; `None` before the first sample.
    observed: Option<(f64, f64)>,
}

impl SensorModel {
    /// Sensors whose noise is stream `draw` of `seed`.
    pub fn new(settings: Sensors, seed: u64, draw: u64, pole_pairs: u32, sample_period: f64) -> Self {
        Self { settings, draws: Draws::seeded(seed, draw), pole_pairs: f64::from(pole_pairs), sample_period, observed: None }
    }

    /// Samples the plant at time `t`, s.
    pub fn measure(&mut self, plant: &Plant, bridge: &Bridge, t: f64) -> Sample {
        let (theta_m, omega_m) = self.rotor(plant);
        let theta_e = wrapped(self.pole_pairs * theta_m + self.settings.angle_offset);
        Sample {
            i: self.currents(plant.stator_current()),
            theta_e,
            direction: Direction::of(theta_e),
            omega_e: self.pole_pairs * omega_m,
            u_dc: self.settings.u_dc_gain * bridge.u_dc(t),
        }
    }

    fn currents(&mut self, i: AlphaBeta) -> AlphaBeta {
        let Abc { a, b, c } = i.to_abc();
        match self.settings.current_sensors {
            CurrentSensors::Three => Abc { a: self.current(0, a), b: self.current(1, b), c: self.current(2, c) },
            CurrentSensors::Two => {
                let (a, b) = (self.current(0, a), self.current(1, b));
                Abc { a, b, c: -a - b }
            }
        }
        .to_alpha_beta()
    }

    fn current(&mut self, phase: usize, i: f64) -> f64 {
        let noise = if self.settings.current_noise > 0.0 { self.settings.current_noise * self.draws.normal() } else { 0.0 };
        let measured = self.settings.current_gain[phase] * i + self.settings.current_offset[phase] + noise;
        let Some(adc) = self.settings.adc else { return measured };
        let codes = 2.0_f64.powi(adc.bits as i32 - 1);
        let step = adc.range / codes;
        (measured / step).round().clamp(-codes, codes - 1.0) * step
    }

    /// Mechanical angle, rad, and speed, rad/s.
    fn rotor(&mut self, plant: &Plant) -> (f64, f64) {
        let theta_m = plant.theta_e() / self.pole_pairs - self.settings.angle_delay * plant.omega_m();
        let Some(steps) = self.settings.encoder_steps else { return (theta_m, plant.omega_m()) };
        let step = TAU / f64::from(steps);
        // The middle of the step: a constant error belongs to the angle offset, which the drive's alignment determines.
        let read = ((theta_m / step).floor() + 0.5) * step;
        // The observer starts at the true speed: a drive is usually switched on at a known one.
        let (angle, speed) = self.observed.unwrap_or((read, plant.omega_m()));
        let error = read - angle;
        let next = (
            angle + self.sample_period * (speed + 2.0 * SPEED_OBSERVER * error),
            speed + self.sample_period * SPEED_OBSERVER * SPEED_OBSERVER * error,
        );
        self.observed = Some(next);
        (read, speed)
    }
}

/// The angle wrapped to the range from -pi to pi.
fn wrapped(angle: f64) -> f64 {
    let positive = angle.rem_euclid(TAU);
    if positive > PI { positive - TAU } else { positive }
}
