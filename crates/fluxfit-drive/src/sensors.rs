//! The sensors: currents through current sensors and A/D converter, angle and speed through the encoder.

use crate::{
    inverter::Bridge,
    plant::Plant,
    scenario::{CurrentSensors, Sensors},
};
use fluxfit::{
    frames::{Abc, AlphaBeta},
    optimizer::draws::Draws,
};
use std::f64::consts::{PI, TAU};

/// Bandwidth of the observer that estimates the speed from encoder steps, rad/s: five times the usual 20 Hz of a speed loop. At
/// constant acceleration its speed lags by twice the acceleration divided by this bandwidth.
pub(crate) const SPEED_OBSERVER: f64 = TAU * 100.0;

/// One sample of all sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Current, A.
    pub i: AlphaBeta,
    /// Electrical angle, rad, from -pi to pi.
    pub theta_e: f64,
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
    pub fn measure(&mut self, plant: &Plant, bridge: &Bridge, t: f64) -> Measurement {
        let (theta_m, omega_m) = self.rotor(plant);
        Measurement {
            i: self.currents(plant.current().to_alpha_beta(plant.theta_e())),
            theta_e: wrapped(self.pole_pairs * theta_m + self.settings.angle_offset),
            omega_e: self.pole_pairs * omega_m,
            u_dc: bridge.u_dc(t),
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
        let theta_m = plant.theta_e() / self.pole_pairs;
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
