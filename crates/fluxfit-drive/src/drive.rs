//! The drive: in each sample period it samples, computes a command, and integrates the plant.

use crate::{
    control::{Controller, References, VoltageCommand},
    error::Error,
    inverter::{Bridge, duties},
    logging::{LogFilters, RowBuilder},
    plant::Plant,
    recording::{RecordedRow, Recording},
    scenario::{Mechanics, Scenario},
    sensors::{Sample, SensorModel},
};
use fluxfit::{
    frames::{AlphaBeta, Dq},
    optimizer::Draws,
};
use std::f64::consts::TAU;

/// Makes the seed of the disturbance differ from the sensors': hexadecimal digits of pi.
const DISTURBANCE_SEED: u64 = 0x243f_6a88_85a3_08d3;

/// Simulates a scenario with noise stream `draw`; `sample_done` is called after each sample.
///
/// # Errors
/// If [`Scenario::check`] refuses the scenario, there is no memory for its rows, the drive trips, or the current leaves the flux map.
pub fn simulate(scenario: &Scenario, draw: u64, mut sample_done: impl FnMut()) -> Result<Recording, Error> {
    scenario.check()?;
    let mut drive = Drive::new(scenario, draw);
    let rows = scenario.logged_rows();
    let mut recording = Recording::with_capacity(rows).ok_or(Error::Memory { rows })?;
    let mut row = RowBuilder::new(&scenario.logging);
    for _ in 0..scenario.rows() {
        if let Some(row) = row.take(drive.step()?) {
            recording.push(&row);
        }
        sample_done();
    }
    if !scenario.logging.theta_e {
        recording.columns.theta_e = None;
    }
    if !scenario.logging.u_dc {
        recording.columns.u_dc = None;
    }
    Ok(recording)
}

/// A drive with its state.
#[derive(Debug, Clone)]
pub struct Drive<'a> {
    scenario: &'a Scenario,
    plant: Plant<'a>,
    bridge: Bridge,
    sensors: SensorModel,
    filters: LogFilters,
    controller: Controller<'a>,
    /// The command that acts over the period which begins now; it was computed at the previous sample.
    acting: VoltageCommand,
    /// The commanded voltage of the period that ended now.
    acted: AlphaBeta,
    /// Random numbers of the voltage disturbance.
    disturbance: Draws,
    /// Index of the sample.
    sample: u64,
}

impl<'a> Drive<'a> {
    /// A drive without current and voltage, at rest or, on a dynamometer, at its scheduled speed. The scenario should have passed
    /// [`Scenario::check`].
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
            sensors: SensorModel::new(scenario.sensors, scenario.seed, draw, pole_pairs, sample_period),
            filters: LogFilters::new(&scenario.logging, sample_period),
            controller: Controller::new(scenario),
            acting: VoltageCommand { u: Dq::default(), u_stator: zero, duties: duties(zero, scenario.inverter.u_dc) },
            acted: zero,
            // A separate stream: the sensors' noise is the same with and without a disturbance.
            disturbance: Draws::seeded(scenario.seed ^ DISTURBANCE_SEED, draw),
            sample: 0,
        }
    }

    /// Samples, computes a command, and integrates one sample period. Returns the row of the sample, filtered as it is logged.
    ///
    /// # Errors
    /// If the drive trips or the current leaves the flux map.
    pub fn step(&mut self) -> Result<RecordedRow, Error> {
        let t = self.time(self.sample);
        self.check_trip(t)?;
        let measured = self.sensors.measure(&self.plant, &self.bridge, t);
        let command = self.controller.command(&measured, &self.references(t), t);
        if !(command.u.d.is_finite() && command.u.q.is_finite()) {
            return Err(Error::Diverged { t });
        }
        let row = self.row(t, &measured, &command);

        self.set_load(t);
        self.plant.change(t, t / self.scenario.duration);
        let duties = self.disturbed_duties();
        if !self.bridge.run(&mut self.plant, duties, t) {
            return Err(self.scenario.outside_map(t, self.plant.current()));
        }
        self.acted = self.acting.u_stator;
        self.acting = command;
        self.sample += 1;
        Ok(row)
    }

    /// The plant, with its true currents, angle and speed.
    pub fn plant(&self) -> &Plant<'a> {
        &self.plant
    }

    fn time(&self, sample: u64) -> f64 {
        sample as f64 / self.scenario.inverter.sample_rate()
    }

    fn references(&self, t: f64) -> References {
        let schedule = &self.scenario.schedule;
        References { id: schedule.id.at(t), iq: schedule.iq.at(t), speed: schedule.speed.at(t) }
    }

    /// The duties of the inverter: those of the command, or of the command with the disturbance.
    fn disturbed_duties(&mut self) -> [f64; 3] {
        let noise = self.scenario.inverter.voltage_noise;
        if noise == 0.0 {
            return self.acting.duties;
        }
        let AlphaBeta { alpha, beta } = self.acting.u_stator;
        let u = AlphaBeta { alpha: alpha + noise * self.disturbance.normal(), beta: beta + noise * self.disturbance.normal() };
        duties(u, self.scenario.inverter.u_dc)
    }

    /// Sets the load or the dynamometer's speed over the period that begins at `t`: the load is constant, the speed changes linearly; a
    /// step of the speed happens at its sample.
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

    fn check_trip(&self, t: f64) -> Result<(), Error> {
        let (i, limit) = (self.plant.current(), self.scenario.control.trip_current);
        if i.d * i.d + i.q * i.q <= limit * limit {
            return Ok(());
        }
        let current = i.magnitude();
        let rpm = self.plant.omega_m() * 60.0 / TAU;
        let modulation = self.acting.u.magnitude() / self.scenario.inverter.voltage_limit();
        Err(Error::Trip { t, current, limit, rpm, modulation })
    }

    /// Voltages are the commanded ones, as in a real log: the mean of the periods before and after the sample.
    fn row(&mut self, t: f64, measured: &Sample, command: &VoltageCommand) -> RecordedRow {
        let (before, after) = (self.acted, self.acting.u_stator);
        let mean = AlphaBeta { alpha: 0.5 * (before.alpha + after.alpha), beta: 0.5 * (before.beta + after.beta) };
        RecordedRow {
            t,
            u: self.filters.voltage(mean, measured.direction),
            i: self.filters.current(measured.i, measured.direction),
            omega_e: self.filters.speed(measured.omega_e),
            theta_e: measured.theta_e,
            u_ref: command.u,
            u_dc: measured.u_dc,
        }
    }
}
