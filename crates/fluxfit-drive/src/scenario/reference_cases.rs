//! Reference scenarios whose logs the output-error model describes exactly: an averaged inverter, and noise of the current sensors
//! only. Any error of an identification from them is an error of the estimator.

use super::{Control, Inverter, Mechanics, Modulation, Scenario, Schedule, Sensors, SimulatedMotor};
use crate::schedule::{Profile, Ramp};
use fluxfit::{TimeWindow, motor::Motor, paper};
use std::f64::consts::TAU;

/// The steady part of [`two_modes`] and [`two_loads`], with a step in its middle, s.
pub const STEADY: TimeWindow = TimeWindow { from: 0.45, to: 0.75 };

/// The paper's rig at its two operating points, i_d = 0 and -2 A.
pub fn two_modes() -> Scenario {
    Scenario { duration: STEADY.to, ..rig() }
}

/// The rig with i_d = 0 throughout, and less load in the second half: only noise in the control loop excites L_d.
pub fn two_loads() -> Scenario {
    let mut scenario = two_modes();
    scenario.schedule.id = Profile::constant(0.0);
    let unloaded = Ramp { at: 0.6, to: 0.4 * paper::LOAD, over: 0.0 };
    scenario.schedule.load = Profile::new(vec![Ramp { at: 0.2, to: paper::LOAD, over: 0.0 }, unloaded]);
    scenario
}

/// The rig accelerating from 200 to 1500 r/min with i_d as a square wave.
pub fn acceleration() -> Scenario {
    let rpm = TAU / 60.0;
    Scenario {
        duration: 0.25,
        mechanics: Mechanics::Free { inertia: 0.01, friction: paper::FRICTION },
        schedule: Schedule {
            speed: Profile::new(vec![Ramp { at: 0.0, to: 200.0 * rpm, over: 0.0 }, Ramp { at: 0.03, to: 1500.0 * rpm, over: 0.2 }]),
            load: Profile::constant(1.0),
            id: square_wave(0.0, 0.025, -2.0),
            ..Schedule::default()
        },
        ..rig()
    }
}

/// One of the smallest motors in use: 20 uH, samples at 20 kHz, 0.1 rad per sample, R_s T_s / L of 0.13.
pub fn small_motor() -> Scenario {
    let motor = Motor { rs: 0.05, ld: 19e-6, lq: 23e-6, psi_f: 2e-3 };
    Scenario {
        duration: 0.1,
        motor: SimulatedMotor::new(motor.rs, motor.into(), paper::POLE_PAIRS),
        mechanics: Mechanics::Dyno,
        inverter: Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(24.0, 10e3) },
        control: Control::new(500.0, 20.0, 30.0),
        schedule: Schedule {
            speed: Profile::constant(500.0),
            iq: square_wave(0.0, 0.012, 10.0),
            id: square_wave(0.006, 0.012, -8.0),
            ..Schedule::default()
        },
        ..rig()
    }
}

/// The paper's rig with an averaged inverter and half a percent of current noise.
fn rig() -> Scenario {
    let mut scenario = Scenario::paper();
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.sensors = Sensors { current_noise: 0.05, ..Sensors::IDEAL };
    scenario
}

/// A square wave of ten steps between zero, with which it begins, and `value`.
fn square_wave(from: f64, every: f64, value: f64) -> Profile {
    let to = |k: u32| if k.is_multiple_of(2) { 0.0 } else { value };
    Profile::new((0..10).map(|k| Ramp { at: from + every * f64::from(k), to: to(k), over: 0.0 }).collect())
}
