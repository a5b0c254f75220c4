//! Scenarios whose logs the output error models exactly: an inverter that makes each period's mean vector, and noise on the current
//! sensors. What is wrong with an answer from them is the estimate's own.

use super::{Control, Inverter, Mechanics, Modulation, Scenario, Schedule, Sensors, SimulatedMotor};
use crate::schedule::{Course, Move};
use fluxfit::{motor::Motor, paper};
use std::f64::consts::TAU;

/// The part of [`two_modes`] and [`two_loads`] that holds still but for the step in its middle, s.
pub const STEADY: (f64, f64) = (0.45, 0.75);

/// The paper's rig at its two modes, i_d = 0 and -2 A.
pub fn two_modes() -> Scenario {
    Scenario { duration: STEADY.1, ..rig() }
}

/// The rig with i_d = 0 throughout, and less load in the second half: nothing but noise in the loop excites L_d.
pub fn two_loads() -> Scenario {
    let mut scenario = two_modes();
    scenario.schedule.id = Course::constant(0.0);
    let unloaded = Move { at: 0.6, to: 0.4 * paper::LOAD, over: 0.0 };
    scenario.schedule.load = Course::new(vec![Move { at: 0.2, to: paper::LOAD, over: 0.0 }, unloaded]);
    scenario
}

/// The rig from 200 to 1500 r/min while i_d toggles.
pub fn acceleration() -> Scenario {
    let rpm = TAU / 60.0;
    Scenario {
        duration: 0.25,
        mechanics: Mechanics::Free { inertia: 0.01, friction: paper::FRICTION },
        schedule: Schedule {
            speed: Course::new(vec![Move { at: 0.0, to: 200.0 * rpm, over: 0.0 }, Move { at: 0.03, to: 1500.0 * rpm, over: 0.2 }]),
            load: Course::constant(1.0),
            id: toggling(0.0, 0.025, -2.0),
            ..Schedule::default()
        },
        ..rig()
    }
}

/// The smallest motors of the field: 20 uH, samples at 20 kHz, 0.1 rad of turn between them, R_s T_s / L of 0.13.
pub fn small_motor() -> Scenario {
    let motor = Motor { rs: 0.05, ld: 19e-6, lq: 23e-6, psi_f: 2e-3 };
    Scenario {
        duration: 0.1,
        motor: SimulatedMotor { rs: motor.rs, magnetics: motor.into(), pole_pairs: paper::POLE_PAIRS },
        mechanics: Mechanics::Dyno,
        inverter: Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(24.0, 10e3) },
        control: Control::new(500.0, 20.0, 30.0),
        schedule: Schedule {
            speed: Course::constant(500.0),
            iq: toggling(0.0, 0.012, 10.0),
            id: toggling(0.006, 0.012, -8.0),
            ..Schedule::default()
        },
        ..rig()
    }
}

/// The paper's rig, averaged, with half a percent of noise.
fn rig() -> Scenario {
    let mut scenario = Scenario::paper();
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.sensors = Sensors { current_noise: 0.05, ..Sensors::IDEAL };
    scenario
}

/// Ten moves between zero, with which it begins, and a value.
fn toggling(from: f64, every: f64, value: f64) -> Course {
    let to = |k: u32| if k.is_multiple_of(2) { 0.0 } else { value };
    Course::new((0..10).map(|k| Move { at: from + every * f64::from(k), to: to(k), over: 0.0 }).collect())
}
