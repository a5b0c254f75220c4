//! What the drive knows: currents through sensors and converter, angle and speed through the encoder.

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

/// Bandwidth of the observer that makes a speed of encoder steps, rad/s: five times the usual 20 Hz of a speed loop. On a ramp its
/// speed lags by twice the acceleration over it.
pub(crate) const SPEED_OBSERVER: f64 = TAU * 100.0;

/// One sample of everything.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Current, A.
    pub i: AlphaBeta,
    /// Electrical angle, rad, between minus and plus pi.
    pub theta_e: f64,
    /// Speed, electrical rad/s.
    pub omega_e: f64,
    /// DC voltage, V.
    pub u_dc: f64,
}

/// The sensors at work.
#[derive(Debug, Clone)]
pub struct Instruments {
    settings: Sensors,
    draws: Draws,
    pole_pairs: f64,
    sample_period: f64,
    /// Angle and speed as the observer has them, mechanical.
    observed: Option<(f64, f64)>,
}

impl Instruments {
    /// Sensors whose noise is stream `draw` of a seed.
    pub fn new(settings: Sensors, seed: u64, draw: u64, pole_pairs: u32, sample_period: f64) -> Self {
        Self { settings, draws: Draws::seeded(seed, draw), pole_pairs: f64::from(pole_pairs), sample_period, observed: None }
    }

    /// Samples the plant at time `t`, s.
    pub fn measure(&mut self, plant: &Plant, bridge: &Bridge, t: f64) -> Measured {
        let (theta_m, omega_m) = self.rotor(plant);
        Measured {
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
        let read = self.settings.current_gain[phase] * i + self.settings.current_offset[phase] + noise;
        let Some(adc) = self.settings.adc else { return read };
        let codes = 2.0_f64.powi(adc.bits as i32 - 1);
        let step = adc.range / codes;
        (read / step).round().clamp(-codes, codes - 1.0) * step
    }

    /// Mechanical angle, rad, and speed, rad/s.
    fn rotor(&mut self, plant: &Plant) -> (f64, f64) {
        let theta_m = plant.theta_e() / self.pole_pairs;
        let Some(steps) = self.settings.encoder_steps else { return (theta_m, plant.omega_m()) };
        let step = TAU / f64::from(steps);
        // The middle of the step: what is constant in the error belongs to the offset, which a drive's alignment finds.
        let read = ((theta_m / step).floor() + 0.5) * step;
        // A drive knows the speed at which it is switched on.
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

/// An angle between minus and plus pi.
fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}
