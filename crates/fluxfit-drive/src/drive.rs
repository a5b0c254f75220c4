//! The drive: sample, command, let the plant run; period after period.

use crate::{
    control::{Asked, Command, Controller},
    error::Error,
    inverter::{Bridge, duties},
    plant::Plant,
    recording::{Recording, Row},
    scenario::{Mechanics, Scenario},
    sensors::{Instruments, Measured},
};
use fluxfit::{
    frames::{AlphaBeta, Dq},
    optimizer::draws::Draws,
};
use std::f64::consts::TAU;

/// What makes the seed of the disturbance another one than the sensors': the digits of pi in hexadecimal.
const DISTURBANCE: u64 = 0x243f_6a88_85a3_08d3;

/// Simulates a scenario with draw number `draw` of its noise; `done` is called after each row.
///
/// # Errors
/// If the scenario is refused by [`Scenario::check`], the drive trips, or the current leaves the flux map.
pub fn simulate(scenario: &Scenario, draw: u64, mut done: impl FnMut()) -> Result<Recording, Error> {
    scenario.check()?;
    let mut drive = Drive::new(scenario, draw);
    let mut recording = Recording::with_capacity(scenario.rows());
    for _ in 0..scenario.rows() {
        recording.push(&drive.step()?);
        done();
    }
    Ok(recording)
}

/// A drive at work.
#[derive(Debug, Clone)]
pub struct Drive<'a> {
    scenario: &'a Scenario,
    plant: Plant<'a>,
    bridge: Bridge,
    instruments: Instruments,
    controller: Controller<'a>,
    /// The command that acts over the period which begins now; it was computed one sample ago.
    acting: Command,
    /// What acted, as far as the drive knows, over the period that ended now.
    acted: AlphaBeta,
    /// What disturbs the voltage.
    disturbance: Draws,
    /// Number of the sample.
    sample: u64,
}

impl<'a> Drive<'a> {
    /// A drive at rest: no current, no voltage; on a dynamometer at its scheduled speed. The scenario should have passed its check.
    pub fn new(scenario: &'a Scenario, draw: u64) -> Self {
        let speed = match scenario.mechanics {
            Mechanics::Free { .. } => 0.0,
            Mechanics::Dyno => scenario.schedule.speed.at(0.0),
        };
        let (pole_pairs, sample_period) = (scenario.motor.pole_pairs, scenario.inverter.sample_period());
        let zero = AlphaBeta { alpha: 0.0, beta: 0.0 };
        Self {
            scenario,
            plant: Plant::new(&scenario.motor, scenario.mechanics, speed),
            bridge: Bridge::new(scenario.inverter),
            instruments: Instruments::new(scenario.sensors, scenario.seed, draw, pole_pairs, sample_period),
            controller: Controller::new(scenario),
            acting: Command { u: Dq::default(), u_stator: zero, duties: duties(zero, scenario.inverter.u_dc) },
            acted: zero,
            // A stream of its own: with or without disturbance the sensors' noise is the same.
            disturbance: Draws::seeded(scenario.seed ^ DISTURBANCE, draw),
            sample: 0,
        }
    }

    /// Samples, commands, and lets one period pass. The row is that of the sample.
    ///
    /// # Errors
    /// If the drive trips or the current leaves the flux map.
    pub fn step(&mut self) -> Result<Row, Error> {
        let t = self.time(self.sample);
        self.trip(t)?;
        let measured = self.instruments.measure(&self.plant, &self.bridge, t);
        let command = self.controller.command(&measured, &self.asked(t), t);
        if !command.u.magnitude().is_finite() {
            return Err(Error::Diverged { t });
        }
        let row = self.row(t, &measured, &command);

        self.set_load(t);
        let duties = self.disturbed_duties();
        if !self.bridge.run(&mut self.plant, duties, t) {
            return Err(self.scenario.outside_map(t, self.plant.current()));
        }
        self.acted = self.acting.u_stator;
        self.acting = command;
        self.sample += 1;
        Ok(row)
    }

    /// The plant, for whoever wants to know what really happens.
    pub fn plant(&self) -> &Plant<'a> {
        &self.plant
    }

    fn time(&self, sample: u64) -> f64 {
        sample as f64 / self.scenario.inverter.sample_rate()
    }

    fn asked(&self, t: f64) -> Asked {
        let schedule = &self.scenario.schedule;
        Asked { id: schedule.id.at(t), iq: schedule.iq.at(t), speed: schedule.speed.at(t) }
    }

    /// The duties that act: those of the command, or of the command with its disturbance.
    fn disturbed_duties(&mut self) -> [f64; 3] {
        let noise = self.scenario.inverter.voltage_noise;
        if noise == 0.0 {
            return self.acting.duties;
        }
        let AlphaBeta { alpha, beta } = self.acting.u_stator;
        let u = AlphaBeta { alpha: alpha + noise * self.disturbance.normal(), beta: beta + noise * self.disturbance.normal() };
        duties(u, self.scenario.inverter.u_dc)
    }

    /// Load and imposed speed over the period that begins at `t`: the load is held, the speed moves evenly; a
    /// step of it comes with its sample.
    fn set_load(&mut self, t: f64) {
        let schedule = &self.scenario.schedule;
        match self.scenario.mechanics {
            Mechanics::Free { .. } => self.plant.load = schedule.load.at(t),
            Mechanics::Dyno => {
                let (now, next) = (schedule.speed.at(t), schedule.speed.before(self.time(self.sample + 1)));
                self.plant.set_omega_m(now);
                self.plant.acceleration = (next - now) / self.scenario.inverter.sample_period();
            }
        }
    }

    fn trip(&self, t: f64) -> Result<(), Error> {
        let (current, limit) = (self.plant.current().magnitude(), self.scenario.control.trip_current);
        if current <= limit {
            return Ok(());
        }
        let rpm = self.plant.omega_m() * 60.0 / TAU;
        let used = 100.0 * self.acting.u.magnitude() / self.scenario.inverter.voltage_limit();
        Err(Error::Trip { t, current, limit, circumstances: format!("at {rpm:.0} r/min, with {used:.0} % of the voltage in use") })
    }

    /// Voltages are what the drive believes: the mean of the periods before and after the sample, as its commands were.
    fn row(&self, t: f64, measured: &Measured, command: &Command) -> Row {
        let (before, after) = (self.acted, self.acting.u_stator);
        let mean = AlphaBeta { alpha: 0.5 * (before.alpha + after.alpha), beta: 0.5 * (before.beta + after.beta) };
        Row {
            t,
            u: mean.to_dq(measured.theta_e),
            i: measured.i.to_dq(measured.theta_e),
            omega_e: measured.omega_e,
            theta_e: measured.theta_e,
            u_ref: command.u,
            u_dc: measured.u_dc,
        }
    }
}
