//! The scenario: all settings of a simulation, in SI units.
//!
//! The settings of a part of the drive stand in the file of that part, with their ranges: [`Inverter`], [`Sensors`], [`Logging`].
//! [`Scenario::paper`] is the paper's rig. [`Scenario::check`] refuses impossible settings; its errors name the keys of a scenario file.

mod check;
mod feasibility;
pub mod reference_cases;

pub use crate::{
    harmonics::Harmonics,
    inverter::{Inverter, Modulation, Update},
    logging::{FilterFrame, LoggedRows, Logging},
    machine::{Magnetics, Mechanics, SimulatedMotor},
    sensors::{Adc, CurrentSensors, Sensors},
};

use crate::schedule::{Profile, Ramp};
use fluxfit::paper;
use std::f64::consts::TAU;

/// A motor in a drive, with its schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Simulated time, s.
    pub duration: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The motor.
    pub motor: SimulatedMotor,
    /// Rotor and load, or a dynamometer.
    pub mechanics: Mechanics,
    /// The inverter.
    pub inverter: Inverter,
    /// The controllers.
    pub control: Control,
    /// References and loads over time.
    pub schedule: Schedule,
    /// The sensors.
    pub sensors: Sensors,
    /// What is logged.
    pub logging: Logging,
}

/// The field-oriented control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// Bandwidth of the closed current loop, Hz, if it is well above that of the winding, `R/(2 pi L)`.
    pub current_bandwidth: f64,
    /// Bandwidth of the closed speed loop, Hz; not used with a dynamometer.
    pub speed_bandwidth: f64,
    /// Largest reference of the current vector, A.
    pub max_current: f64,
    /// Trip level of the overcurrent protection, A: largest true current vector at a sample.
    pub trip_current: f64,
    /// Field weakening: whether `i_d` is lowered at the voltage limit.
    pub field_weakening: bool,
}

/// References and loads over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Schedule {
    /// Reference of `i_d`, A.
    pub id: Profile,
    /// Reference of `i_q`, A; only with a dynamometer.
    pub iq: Profile,
    /// Speed reference, or speed of the dynamometer, mechanical rad/s.
    pub speed: Profile,
    /// Load torque, N m, in the negative direction of rotation at any speed.
    pub load: Profile,
    /// A test voltage added to the command, if any.
    pub injection: Option<Injection>,
}

/// A test voltage.
#[derive(Debug, Clone, PartialEq)]
pub struct Injection {
    /// The axis on which it acts.
    pub axis: Axis,
    /// Waveform.
    pub waveform: Waveform,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Amplitude over time, V.
    pub voltage: Profile,
}

/// An axis of the rotor frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Along the magnet.
    D,
    /// 90 electrical degrees ahead of it.
    Q,
}

/// Waveform of a test voltage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Waveform {
    /// Sine wave.
    Sine,
    /// Square wave.
    Square,
}

impl Control {
    /// Control without field weakening, and with a trip level of 1.5 times the largest current.
    pub fn new(current_bandwidth: f64, speed_bandwidth: f64, max_current: f64) -> Self {
        Self { current_bandwidth, speed_bandwidth, max_current, trip_current: 1.5 * max_current, field_weakening: false }
    }
}

impl Scenario {
    /// The paper's rig (its section 4.1): 1000 r/min against 10 N m with i_d = 0, then with i_d = -2 A; a switched inverter.
    ///
    /// Settings that the paper does not state are those of the independent logs in `examples/logs`: 310 V, a 5 kHz carrier with double
    /// update (10 kHz samples), bandwidths of 200 Hz and 20 Hz; full speed after 0.15 s, load from 0.2 s, i_d = -2 A from 0.6 s.
    pub fn paper() -> Self {
        Self {
            duration: 0.9,
            seed: 1,
            motor: SimulatedMotor::new(paper::MOTOR.rs, paper::MOTOR.into(), paper::POLE_PAIRS),
            mechanics: Mechanics::Free { inertia: paper::INERTIA, friction: paper::FRICTION },
            inverter: Inverter::ideal(310.0, 5e3),
            control: Control::new(200.0, 20.0, 20.0),
            schedule: Schedule {
                id: Profile::new(vec![Ramp { at: 0.6, to: paper::ID, over: 0.0 }]),
                speed: Profile::new(vec![Ramp { at: 0.0, to: paper::SPEED_RPM * (TAU / 60.0), over: 0.15 }]),
                load: Profile::new(vec![Ramp { at: 0.2, to: paper::LOAD, over: 0.0 }]),
                ..Schedule::default()
            },
            sensors: Sensors::IDEAL,
            logging: Logging::COMPLETE,
        }
    }

    /// Number of samples.
    pub fn rows(&self) -> usize {
        // The sample at the end belongs to the log, even if rounding puts it just behind the end.
        const ROUNDING: f64 = 1e-6;
        (self.duration * self.inverter.sample_rate() + ROUNDING) as usize + 1
    }

    /// Number of rows of the log: samples, or groups of [`Logging::every`] of them.
    pub fn logged_rows(&self) -> usize {
        let every = self.logging.every.max(1) as usize;
        match self.logging.rows {
            LoggedRows::First => self.rows().div_ceil(every),
            LoggedRows::Mean => self.rows() / every,
        }
    }

    /// Rows of the log per second.
    pub fn row_rate(&self) -> f64 {
        self.inverter.sample_rate() / f64::from(self.logging.every.max(1))
    }
}
