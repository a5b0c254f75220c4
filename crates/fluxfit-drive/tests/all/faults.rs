//! Faults of a drive that identification with the output error finds, each in the paper's rig with noise: the fault inside its own
//! interval, the motor within the limits, and nothing identified that is wrong.

// What was found is worth seeing when a test fails.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use fluxfit::{
    Request, Verdict,
    evidence::Identification,
    evidence::OutputFit,
    faults::Fault,
    identify,
    motor::{Motor, PARAMETERS, Parameter},
    objective::acting_voltage::{VoltageFrame, VoltageTiming},
    paper,
};
use fluxfit_drive::{
    Recording, Scenario,
    scenario::{Control, CurrentSensors, Inverter, Logging, Mechanics, Schedule, Sensors, SimulatedMotor},
    schedule::{Profile, Ramp},
    simulate,
};
use std::f64::consts::FRAC_PI_3;

/// The paper's rig with 50 mA of noise on each current sensor, and a fault.
fn rig(fault: impl FnOnce(&mut Scenario)) -> Recording {
    let mut scenario = Scenario::paper();
    scenario.sensors.current_noise = 0.05;
    fault(&mut scenario);
    simulate(&scenario, 0, || ()).unwrap()
}

fn found(recording: &Recording) -> Identification {
    identify(&recording.log().unwrap(), &Request::default()).unwrap().identification
}

/// The motor lies within these limits, in percent of the truth, and within its own 95 % intervals, which are half as wide again as
/// two standard errors for being one of many; what is identified is so.
fn holds(name: &str, found: &Identification, truth: &Motor, limits: [f64; PARAMETERS]) {
    for (judgement, limit) in found.parameters.iter().zip(limits) {
        let truth = truth.get(judgement.parameter);
        let (error, standard_error) = (judgement.raw - truth, judgement.uncertainty.standard_error());
        let percent = 100.0 * error / truth;
        println!(
            "{name}: {} {percent:+.3} % ± {:.3} %, {:?}",
            judgement.parameter.key(),
            200.0 * standard_error / truth,
            judgement.verdict
        );
        assert!(percent.abs() < limit, "{name}: {} is {percent:.2} % off", judgement.parameter.key());
        assert!(
            error.abs() < 3.0 * standard_error,
            "{name}: {} by {:.1} standard errors",
            judgement.parameter.key(),
            error / standard_error
        );
    }
}

/// The faults found are these, with these values inside three of their own standard errors.
fn finds(name: &str, fit: &OutputFit, fault: Fault, values: &[(&str, f64)]) {
    let faults: Vec<&str> = fit.fault_trials.iter().filter(|tried| fit.has(tried.fault)).map(|tried| tried.fault.key()).collect();
    assert_eq!(faults, [fault.key()], "{name}");
    for (key, expected) in values {
        let nuisance = fit.fault_estimates.iter().find(|nuisance| nuisance.unknown.key() == *key).unwrap();
        println!("{name}: {key} {:.5} ± {:.5}, truly {expected:.5}", nuisance.value, 2.0 * nuisance.standard_error);
        assert!((nuisance.value - expected).abs() < 3.0 * nuisance.standard_error, "{name}: {nuisance:?} instead of {expected}");
    }
}

const WITHIN_ONE_PERCENT: [f64; PARAMETERS] = [1.0; PARAMETERS];

#[test]
fn a_perfect_drive_has_no_faults() {
    let found = found(&rig(|_| ()));
    let fit = found.output.as_ref().unwrap();
    assert!(fit.fault_trials.iter().all(|tried| !fit.has(tried.fault)), "{:?}", fit.fault_trials);
    holds("perfect", &found, &paper::MOTOR, [0.2, 0.2, 0.05, 0.05]);
}

#[test]
fn an_encoder_that_is_three_degrees_off() {
    let offset = 3.0_f64.to_radians();
    let found = found(&rig(|scenario| scenario.sensors.angle_offset = offset));
    finds("angle", found.output.as_ref().unwrap(), Fault::AngleOffset, &[("angle_offset", offset)]);
    holds("angle", &found, &paper::MOTOR, WITHIN_ONE_PERCENT);
}

/// 1 % of 20 A on phase a alone: two thirds of it along alpha, a third in the zero sequence that no frame sees.
#[test]
fn a_sensor_that_reads_one_percent_at_zero() {
    let found = found(&rig(|scenario| scenario.sensors.current_offset = [0.2, 0.0, 0.0]));
    let expected = [("current_offset_alpha", 0.2 * 2.0 / 3.0), ("current_offset_beta", 0.0)];
    finds("offset", found.output.as_ref().unwrap(), Fault::CurrentOffset, &expected);
    holds("offset", &found, &paper::MOTOR, WITHIN_ONE_PERCENT);
}

/// Of three sensors one reads 2 % too much: the imbalance is a third of that. So is the common gain, which no log shows: every
/// impedance comes out 0.66 % too small, and the interval knows.
#[test]
fn one_of_three_sensors_that_reads_two_percent_too_much() {
    let found = found(&rig(|scenario| scenario.sensors.current_gain = [1.0, 1.02, 1.0]));
    // Phase b lies a third of a turn ahead of a; the imbalance turns twice as far.
    let (sin, cos) = (-2.0 * FRAC_PI_3).sin_cos();
    // Relative to the common gain of 1 + 0.02/3.
    let imbalance = 0.02 / 3.0 / (1.0 + 0.02 / 3.0);
    let expected = [("current_imbalance_alpha", imbalance * cos), ("current_imbalance_beta", imbalance * sin)];
    finds("gain of three", found.output.as_ref().unwrap(), Fault::ThreeSensors, &expected);
    holds("gain of three", &found, &paper::MOTOR, WITHIN_ONE_PERCENT);
}

/// Of two sensors, the common gain is half of the fault: 1 % that no log shows, and a hair of noise beyond it.
#[test]
fn one_of_two_sensors_that_reads_two_percent_too_much() {
    let recording = rig(|scenario| {
        scenario.sensors.current_sensors = CurrentSensors::Two;
        scenario.sensors.current_gain = [1.0, 1.02, 1.0];
    });
    let found = found(&recording);
    // a over b, relative to the common gain of 1.01.
    let expected = [("current_gain_a_over_b", -0.02 / 1.01)];
    finds("gain of two", found.output.as_ref().unwrap(), Fault::SensorsAb, &expected);
    holds("gain of two", &found, &paper::MOTOR, [1.1; PARAMETERS]);
}

/// A commanded voltage that acts one period later, and the same column moved by a row to either side.
#[test]
fn a_delay_of_no_one_and_two_periods() {
    let recording = rig(|_| ());
    let rows = recording.columns.t.len();
    for delay in [0_usize, 1, 2] {
        let mut columns = recording.columns.clone();
        let moved = |column: &[f64]| -> Vec<f64> { (0..rows).map(|k| column[(k + delay).saturating_sub(1).min(rows - 1)]).collect() };
        (columns.ud, columns.uq) = (moved(&recording.ud_ref), moved(&recording.uq_ref));
        let found = identify(&fluxfit::Log::new(columns).unwrap(), &Request::default()).unwrap().identification;
        let fit = found.output.as_ref().unwrap();
        // The frame is that of the period in which it acts: two periods' looking ahead, if the column is that late, and so on.
        let frame = VoltageFrame::Middle;
        assert_eq!(fit.voltage_timing.value, VoltageTiming::Delayed { delay, frame }, "{delay}");
        holds("delay", &found, &paper::MOTOR, WITHIN_ONE_PERCENT);
    }
}

/// White voltages of 1 V that nobody knows: nothing identified is wrong, and since everything is, and the residuals are white, there is no
/// warning of them. Of 10 V, which leave a parameter weak, there is one.
#[test]
fn disturbing_voltages() {
    for (volts, is_warned_of) in [(1.0, false), (10.0, true)] {
        let found = found(&rig(|scenario| scenario.inverter.voltage_noise = volts));
        assert!(found.output.as_ref().unwrap().has(Fault::Disturbance), "{volts} V");
        assert_eq!(found.is_complete(), !is_warned_of, "{volts} V: {:?}", found.parameters);
        assert_eq!(found.warnings.iter().any(|warning| warning.code() == "process-noise"), is_warned_of, "{volts} V");
        if !is_warned_of {
            holds("disturbed", &found, &paper::MOTOR, [2.0; PARAMETERS]);
        }
    }
}

/// A traction motor at 100 A, 300 V, 10 kHz.
const TRACTION: Motor = Motor { rs: 18e-3, ld: 175e-6, lq: 250e-6, psi_f: 0.0515 };

/// What is found in its log with so much dead time, s.
fn traction(dead_time: f64) -> Identification {
    let scenario = Scenario {
        motor: SimulatedMotor::new(TRACTION.rs, TRACTION.into(), 10),
        inverter: Inverter { dead_time, ..Inverter::ideal(300.0, 10e3) },
        mechanics: Mechanics::Dyno,
        control: Control::new(200.0, 10.0, 150.0),
        schedule: Schedule {
            id: Profile::new(vec![Ramp { at: 0.2, to: -30.0, over: 0.0 }]),
            iq: Profile::new(vec![Ramp { at: 0.02, to: 100.0, over: 0.0 }]),
            speed: Profile::constant(100.0),
            ..Schedule::default()
        },
        duration: 0.4,
        sensors: Sensors { current_noise: 0.5, ..Sensors::IDEAL },
        ..Scenario::paper()
    };
    found(&simulate(&scenario, 0, || ()).unwrap())
}

/// 2 us of dead time: 6 V per phase, four times what R_s takes.
#[test]
fn dead_time_that_takes_more_than_the_resistance() {
    let with = traction(2e-6);
    let fit = with.output.as_ref().unwrap();
    assert!(fit.has(Fault::DeadTime));
    let lost = fit.drive.faults.dead_time.voltage;
    assert!((lost / 6.0 - 1.0).abs() < 0.02, "{lost} V");
    holds("dead time", &with, &TRACTION, [2.0, 0.2, 0.2, 0.2]);
    assert!(Parameter::ALL.iter().all(|parameter| with.parameter(*parameter).verdict == Verdict::Identified));
}

#[test]
fn without_dead_time_none_is_found() {
    let without = traction(0.0);
    assert!(!without.output.as_ref().unwrap().has(Fault::DeadTime));
    holds("no dead time", &without, &TRACTION, [2.0, 1.0, 1.0, 1.0]);
    assert!(Parameter::ALL.iter().all(|parameter| without.parameter(*parameter).verdict == Verdict::Identified));
}

/// A small traction motor that accelerates from 500 to 2500 r/min in 0.16 s, and whose logged speed is filtered at 20 Hz: it lags by
/// 73 rad/s, which costs 0.6 V, as much as 20 A in R_s.
#[test]
fn a_speed_that_lags_in_an_acceleration() {
    const SCOOTER: Motor = Motor { rs: 30e-3, ld: 60e-6, lq: 90e-6, psi_f: 8e-3 };
    let step = |at, to| Ramp { at, to, over: 0.0 };
    let scenario = Scenario {
        motor: SimulatedMotor::new(SCOOTER.rs, SCOOTER.into(), 7),
        inverter: Inverter { dead_time: 0.3e-6, ..Inverter::ideal(48.0, 8e3) },
        mechanics: Mechanics::Dyno,
        control: Control::new(600.0, 0.0, 60.0),
        schedule: Schedule {
            id: Profile::new(vec![step(0.06, -15.0), step(0.12, 0.0), step(0.16, -10.0)]),
            iq: Profile::new(vec![step(0.01, 10.0), step(0.05, 25.0), step(0.09, 5.0), step(0.14, 30.0)]),
            speed: Profile::new(vec![step(0.0, 52.4), Ramp { at: 0.02, to: 261.8, over: 0.16 }]),
            ..Schedule::default()
        },
        duration: 0.2,
        sensors: Sensors { current_noise: 0.1, ..Sensors::IDEAL },
        logging: Logging { speed_filter: Some(20.0), ..Logging::COMPLETE },
        ..Scenario::paper()
    };
    let recording = simulate(&scenario, 1, || ()).unwrap();
    assert_eq!(fluxfit::check_columns(&recording.log().unwrap()), [], "a lag is no other unit");
    let found = found(&recording);
    assert!(found.output.as_ref().unwrap().has(Fault::SpeedLag));
    holds("lagging speed", &found, &SCOOTER, [1.0, 0.5, 0.3, 0.1]);
}

/// Logs the commands as a drive that does not turn them on writes them: from the frame in the middle of the period in which they act, which
/// is late by so much, s.
fn in_frame_of_sample(recording: &mut Recording, late: f64) {
    let columns = &mut recording.columns;
    for (k, (d, q)) in recording.ud_ref.iter().zip(&recording.uq_ref).enumerate() {
        let (sin, cos) = (late * columns.omega_e[k]).sin_cos();
        columns.ud[k] = cos * d - sin * q;
        columns.uq[k] = sin * d + cos * q;
    }
}

/// Every eighth command of a small motor's drive at 16 kHz, written in the frame of its sample: it acts one and a half periods later,
/// 94 us, and the log says neither how late nor how often. Voltages that are turned so contradict each other as those of a motor that
/// saturates; beside the lag they agree.
#[test]
fn every_eighth_voltage_of_a_drive_that_does_not_turn_it_on() {
    const SERVO: Motor = Motor { rs: 0.9, ld: 1.1e-3, lq: 1.4e-3, psi_f: 9e-3 };
    const EVERY: u32 = 8;
    const PERIOD: f64 = 62.5e-6;
    let ramp = |at, to| Ramp { at, to, over: 0.02 };
    let scenario = Scenario {
        motor: SimulatedMotor::new(SERVO.rs, SERVO.into(), 7),
        inverter: Inverter::ideal(48.0, 8e3),
        mechanics: Mechanics::Dyno,
        control: Control::new(500.0, 0.0, 15.0),
        schedule: Schedule {
            id: Profile::new((0..9).map(|k| ramp(0.15 * f64::from(k), -1.5 * f64::from(k / 3 % 3))).collect()),
            iq: Profile::new((0..9).map(|k| ramp(0.15 * f64::from(k), 2.0 + 3.0 * f64::from(k % 3))).collect()),
            speed: Profile::new((0..3).map(|k| ramp(0.45 * f64::from(k), 40.0 + 60.0 * f64::from(k))).collect()),
            ..Schedule::default()
        },
        duration: 1.35,
        sensors: Sensors { current_noise: 0.01, ..Sensors::IDEAL },
        logging: Logging { every: EVERY, theta_e: false, u_dc: false, ..Logging::COMPLETE },
        ..Scenario::paper()
    };
    let mut recording = simulate(&scenario, 1, || ()).unwrap();
    in_frame_of_sample(&mut recording, 1.5 * PERIOD);
    let found = found(&recording);
    let fit = found.output.as_ref().unwrap();
    // Terms for what happens between such rows may be found beside it.
    let lag = fit.fault_estimates.iter().find(|estimate| estimate.unknown.fault() == Some(Fault::VoltageLag)).unwrap();
    assert!((lag.value - 1.5 * PERIOD).abs() < 3.0 * lag.standard_error && lag.standard_error < 0.05 * PERIOD, "{lag:?}");
    holds("lagging voltages", &found, &SERVO, [1.0, 5.0, 5.0, 0.5]);
    assert!(found.is_complete(), "{:?}", found.parameters);
}

/// Means of four commands of a small motor's drive at 28.2 kHz, written in the frames of their samples, at one speed and without the
/// angle: an angle that is off by a constant explains them nearly as well as voltages that lag, with inductances a tenth too small.
#[test]
fn means_of_voltages_that_are_not_turned_on_at_one_speed() {
    const DRONE: Motor = Motor { rs: 0.106, ld: 24e-6, lq: 30e-6, psi_f: 1.78e-3 };
    const EVERY: usize = 4;
    const RATE: f64 = 28.2e3;
    const OMEGA_E: f64 = 3440.0;
    let steps = |values: [f64; 4]| {
        let ramps = values.into_iter().enumerate().map(|(k, to)| Ramp { at: 0.1 * k as f64, to, over: 0.0 });
        Profile::new(ramps.collect())
    };
    let scenario = Scenario {
        motor: SimulatedMotor::new(DRONE.rs, DRONE.into(), 7),
        inverter: Inverter::ideal(24.0, RATE / 2.0),
        mechanics: Mechanics::Dyno,
        control: Control::new(600.0, 0.0, 25.0),
        schedule: Schedule {
            id: steps([0.0, -8.75, -8.75, 0.0]),
            iq: steps([-7.5, -7.5, -17.5, -17.5]),
            speed: Profile::constant(OMEGA_E / 7.0),
            ..Schedule::default()
        },
        duration: 0.4,
        sensors: Sensors { current_noise: 0.12, ..Sensors::IDEAL },
        logging: Logging { u_dc: false, ..Logging::COMPLETE },
        ..Scenario::paper()
    };
    let mut recording = simulate(&scenario, 1, || ()).unwrap();
    in_frame_of_sample(&mut recording, 1.5 / RATE);
    let columns = &mut recording.columns;
    columns.theta_e = None;
    for column in [&mut columns.t, &mut columns.ud, &mut columns.uq, &mut columns.id, &mut columns.iq, &mut columns.omega_e] {
        *column = column.chunks_exact(EVERY).map(|row| row.iter().sum::<f64>() / EVERY as f64).collect();
    }
    let found = found(&recording);
    assert!(found.output.as_ref().unwrap().has(Fault::VoltageLag));
    holds("means of lagging voltages", &found, &DRONE, [3.0, 2.0, 2.0, 0.5]);
}

/// Device drops in a log without the angle: their harmonics tell them, and R_s, which they would make 30 % too large, is right.
#[test]
fn losses_without_an_angle_are_found() {
    let mut recording = rig(|scenario| (scenario.inverter.switch_drop, scenario.inverter.diode_drop) = (1.2, 1.2));
    recording.columns.theta_e = None;
    let found = found(&recording);
    assert!(found.output.as_ref().unwrap().has(Fault::DeadTimeWithoutAngle));
    holds("no angle", &found, &paper::MOTOR, [3.0, 1.0, 1.0, 1.0]);
}

/// Columns that do not belong together are no noise: whatever is done to them, no parameter has a value. A test for each, because every
/// fault is tried to its end against such data.
fn no_answer(spoil: impl FnOnce(&mut Recording)) {
    let mut recording = rig(|_| ());
    spoil(&mut recording);
    for judgement in &found(&recording).parameters {
        assert_eq!(judgement.value(), None, "{judgement:?}");
        assert!(
            judgement.remedy.as_ref().is_some_and(|remedy| remedy.to_string().contains("signs and order of the columns")),
            "{judgement:?}"
        );
    }
}

#[test]
fn exchanged_axes_are_no_answer() {
    no_answer(|recording| {
        let columns = &mut recording.columns;
        std::mem::swap(&mut columns.ud, &mut columns.uq);
        std::mem::swap(&mut columns.id, &mut columns.iq);
    });
}

#[test]
fn currents_the_other_way_around_are_no_answer() {
    no_answer(|recording| [&mut recording.columns.id, &mut recording.columns.iq].into_iter().flatten().for_each(|i| *i = -*i));
}

#[test]
fn voltages_the_other_way_around_are_no_answer() {
    no_answer(|recording| [&mut recording.columns.ud, &mut recording.columns.uq].into_iter().flatten().for_each(|u| *u = -*u));
}
