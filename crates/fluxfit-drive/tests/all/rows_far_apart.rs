//! Logs of an angle that is exact, or off, in rows that are not the drive's periods: what tells it from inductances.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    Motor, Parameter, Request, Swarm,
    evidence::{FaultOutcome, Identification},
    faults::Fault,
    identify,
};
use fluxfit_drive::{
    Scenario,
    scenario::{Control, Inverter, LoggedRows, Logging, Mechanics, Schedule, Sensors, SimulatedMotor, Update},
    schedule::{Profile, Ramp},
    simulate,
};

/// A servo motor without saliency.
const SERVO: Motor = Motor { rs: 2.0, ld: 6e-3, lq: 6e-3, psi_f: 0.1 };

fn steps(points: &[(f64, f64)]) -> Profile {
    Profile::new(points.iter().map(|(at, to)| Ramp { at: *at, to: *to, over: 0.0 }).collect())
}

/// Its drive switches at 12 kHz, on a dynamometer.
fn drive(every: u32, rows: LoggedRows, duration: f64) -> Scenario {
    Scenario {
        duration,
        seed: 5,
        motor: SimulatedMotor::new(SERVO.rs, SERVO.into(), 4),
        mechanics: Mechanics::Dyno,
        inverter: Inverter { update: Update::Single, ..Inverter::ideal(320.0, 12e3) },
        control: Control::new(400.0, 20.0, 8.0),
        sensors: Sensors { current_noise: 0.02, ..Sensors::IDEAL },
        logging: Logging { every, rows, ..Logging::COMPLETE },
        ..Scenario::paper()
    }
}

/// How many half-widths a parameter's value is off; nothing where there is no value.
fn off(found: &Identification, parameter: Parameter) -> Option<f64> {
    let judged = found.parameter(parameter);
    judged.value().map(|value| (value - SERVO.get(parameter)).abs() / judged.uncertainty.half_width)
}

fn found(scenario: &Scenario) -> Identification {
    let log = simulate(scenario, 0, || ()).unwrap().log().unwrap();
    identify(&log, &Request { swarm: Swarm::Off, ..Request::default() }).unwrap().identification
}

/// Two loads at one speed have as many equations as a motor has parameters. The angle is exact, dead time acts, and an angle explains what
/// rows of two periods lack.
#[test]
fn two_loads_in_rows_far_apart_tell_no_angle() {
    for rows in [LoggedRows::Mean, LoggedRows::First] {
        let mut scenario = drive(2, rows, 0.8);
        scenario.inverter.dead_time = 1.5e-6;
        let (id, speed) = (steps(&[(0.4, -3.0)]), Profile::constant(160.0));
        scenario.schedule = Schedule { id, iq: Profile::constant(4.0), speed, ..Schedule::default() };
        let found = found(&scenario);
        let trials = &found.output.as_ref().unwrap().fault_trials;
        let is_angle = |fault: Fault| matches!(fault, Fault::AngleOffset | Fault::AngleDelay);
        let of_angle = |outcome| trials.iter().any(|trial| is_angle(trial.fault) && trial.outcome == outcome);
        assert!(of_angle(FaultOutcome::NeedsMorePoints) && !of_angle(FaultOutcome::Taken), "{rows:?}: {trials:?}");
        assert!(off(&found, Parameter::Ld).is_some() && off(&found, Parameter::PsiF).is_some());
        for parameter in Parameter::ALL {
            assert!(off(&found, parameter).is_none_or(|off| off < 1.5), "{rows:?}, {parameter:?}: {:?}", off(&found, parameter));
        }
    }
}

/// The angle is read 3 degrees too large, i_d is zero, and rows are 12 periods apart: `u_d = -omega_e (L_q i_q - psi_f sin 3°)`, in which
/// the last part makes points of three loads contradict each other, and stands for a sixth of L_q.
#[test]
fn points_that_an_angle_reconciles_leave_lq_in_doubt() {
    let mut scenario = drive(12, LoggedRows::First, 2.0);
    scenario.sensors.angle_offset = 3.0_f64.to_radians();
    let (iq, speed) = (steps(&[(0.0, 3.0), (0.7, 7.0), (1.4, 5.0)]), steps(&[(0.0, 80.0), (1.0, 200.0)]));
    scenario.schedule = Schedule { iq, speed, ..Schedule::default() };
    let found = found(&scenario);
    assert!(found.steady.as_ref().is_some_and(|points| points.misfit.is_some()));
    assert!(off(&found, Parameter::Lq).is_some_and(|off| off < 1.0), "{:?}", off(&found, Parameter::Lq));
}
