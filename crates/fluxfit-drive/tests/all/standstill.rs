//! A rotor that stands still: steps of the currents tell resistance and inductances, nothing tells the flux.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    ErrorKind, Known, Parameter, Reason, Remedy, Request, Verdict, identify,
    log::{Columns, Log},
    optimizer::Draws,
};
use fluxfit_drive::{
    Scenario,
    scenario::{Control, Magnetics, Mechanics, SimulatedMotor},
    schedule::{Profile, Ramp},
    simulate,
};
use std::f64::consts::TAU;

const RS: f64 = 0.1;
const LD: f64 = 150e-6;
const LQ: f64 = 250e-6;

/// On a bench that holds the rotor at an angle, steps of i_d, and one of i_q if asked for, with 50 mA of noise.
fn bench(dead_time: f64, id: &[f64], iq: f64) -> Scenario {
    let step = |(k, to): (usize, &f64)| Ramp { at: 0.05 + 0.09 * k as f64, to: *to, over: 0.0 };
    let mut scenario = Scenario::paper();
    scenario.duration = 0.41;
    scenario.motor = SimulatedMotor::new(RS, Magnetics::Constant { ld: LD, lq: LQ, psi_f: 12e-3 }, 7);
    scenario.mechanics = Mechanics::Dyno;
    (scenario.inverter.u_dc, scenario.inverter.carrier, scenario.inverter.dead_time) = (48.0, 16e3, dead_time);
    scenario.control = Control::new(400.0, 20.0, 30.0);
    scenario.schedule = Default::default();
    scenario.schedule.id = Profile::new(id.iter().enumerate().map(step).collect());
    scenario.schedule.iq = Profile::new(vec![Ramp { at: 0.32, to: iq, over: 0.0 }]);
    scenario.sensors.current_noise = 0.05;
    scenario
}

fn log(scenario: &Scenario) -> Log {
    simulate(scenario, 0, || ()).unwrap().log().unwrap()
}

/// Without its angle, and with the noise of an observer as its speed: at rest they tell nothing.
fn with_noisy_speed(log: &Log) -> Log {
    let mut draws = Draws::seeded(3, 0);
    let omega_e = log.columns().t.iter().map(|_| draws.normal()).collect();
    Log::new(Columns { theta_e: None, omega_e, ..log.columns().clone() }).unwrap()
}

/// Currents of several sizes tell dead time from resistance, with the angle and with a noisy speed alone.
#[test]
fn steps_of_several_sizes_tell_resistance_and_inductances_beside_dead_time() {
    for dead_time in [0.0, 1e-6] {
        let log = log(&bench(dead_time, &[5.0, 10.0, 20.0], 8.0));
        for log in [with_noisy_speed(&log), log] {
            let found = identify(&log, &Request::default()).unwrap().identification;
            for (parameter, truth) in [(Parameter::Rs, RS), (Parameter::Ld, LD), (Parameter::Lq, LQ)] {
                let one = found.parameter(parameter);
                let (off, half_width) = ((one.raw / truth - 1.0).abs(), one.uncertainty.half_width / truth);
                assert_eq!(
                    one.verdict,
                    Verdict::Identified,
                    "{dead_time} s, {parameter:?}: {:+.4} ± {half_width:.4}",
                    one.raw / truth - 1.0
                );
                assert!(off < 1.5 * half_width, "{dead_time} s, {parameter:?}: off by {off:.5} ± {half_width:.5}");
            }
            let psi_f = found.parameter(Parameter::PsiF);
            assert_eq!((psi_f.value(), &psi_f.reason, &psi_f.remedy), (None, &Some(Reason::AtRest), &Some(Remedy::Turn)));
        }
    }
}

/// A single current does not: its voltage may be dead time's.
#[test]
fn one_step_does_not_tell_resistance_from_dead_time() {
    let log = log(&bench(1e-6, &[10.0], 0.0));
    for log in [with_noisy_speed(&log), log] {
        let found = identify(&log, &Request::default()).unwrap().identification;
        for (parameter, truth) in [(Parameter::Rs, RS), (Parameter::Ld, LD), (Parameter::Lq, LQ)] {
            let one = found.parameter(parameter);
            let is_held = one.value().is_none_or(|value| (value - truth).abs() < 1.5 * one.uncertainty.half_width);
            assert!(is_held, "{parameter:?}: {} ± {}", one.raw, one.uncertainty.half_width);
        }
        assert_ne!(found.parameter(Parameter::Rs).verdict, Verdict::Identified);
    }
}

/// A sine along the d axis, by the exact step of R and L, and noise alone along the other, which has no voltage: whatever its noise, L_q is
/// not told, and R_s and L_d are.
#[test]
fn an_axis_of_noise_alone_leaves_the_other() {
    const PERIOD: f64 = 1e-4;
    for (noise, seed) in (0..6).map(|seed| (if seed < 3 { 0.05 } else { 0.15 }, seed)) {
        let (decay, mut draws, mut id) = ((-0.9 / 1.1e-3 * PERIOD).exp(), Draws::seeded(seed, 0), 0.0);
        let mut columns = Columns::default();
        for row in 0..10_000 {
            let t = f64::from(row) * PERIOD;
            let ud = 3.0 * (TAU * 50.0 * t).sin();
            for (column, value) in [(&mut columns.t, t), (&mut columns.ud, ud), (&mut columns.uq, 0.0), (&mut columns.omega_e, 0.0)] {
                column.push(value);
            }
            columns.id.push(id + noise * draws.normal());
            columns.iq.push(noise * draws.normal());
            id = decay * id + (1.0 - decay) * ud / 0.9;
        }
        let found = identify(&Log::new(columns).unwrap(), &Request::default()).unwrap().identification;
        for (parameter, truth) in [(Parameter::Rs, 0.9), (Parameter::Ld, 1.1e-3)] {
            let one = found.parameter(parameter);
            let value = one.value().unwrap_or_else(|| panic!("{noise} A, {seed}: {parameter:?} has no value"));
            assert!((value - truth).abs() < 1.5 * one.uncertainty.half_width, "{noise} A, {seed}, {parameter:?}: {value}");
        }
        let lq = found.parameter(Parameter::Lq);
        assert_eq!((lq.value(), &lq.remedy), (None, &Some(Remedy::StepCurrent { parameter: Parameter::Lq })), "{noise} A, {seed}");
    }
}

/// A drive that did not log its speed does not stand: the voltage of its magnets is no resistance's. Where i_d is large and i_q is not,
/// it is seen in the means, else nothing comes out.
#[test]
fn a_speed_that_was_not_logged_is_no_standstill() {
    for (id, load) in [(-2.0, 10.0), (-12.0, 10.0), (-12.0, 2.0)] {
        let mut scenario = Scenario::paper();
        scenario.schedule.id = Profile::new(vec![Ramp { at: 0.6, to: id, over: 0.0 }]);
        scenario.schedule.load = Profile::new(vec![Ramp { at: 0.2, to: load, over: 0.0 }]);
        scenario.sensors.current_noise = 0.05;
        let mut columns = log(&scenario).columns().clone();
        columns.omega_e.fill(0.0);
        match identify(&Log::new(columns).unwrap(), &Request::default()) {
            Ok(answer) => {
                assert!(load > 5.0 && answer.identification.parameters.iter().all(|one| one.value().is_none()), "{id} A, {load} N m");
            }
            Err(error) => assert!(matches!(error.kind(), ErrorKind::AllZero { what } if what.contains("omega_e")), "{error}"),
        }
    }
}

/// What is known of R_s makes nothing else less known: one operating point, whose transients tell L_q, with priors around the truth.
#[test]
fn a_prior_widens_nothing() {
    let mut scenario = Scenario::paper();
    scenario.schedule.id = Profile::constant(0.0);
    scenario.sensors.current_noise = 0.05;
    let (log, truth) = (log(&scenario), fluxfit::paper::MOTOR);
    let with = |known: Known| {
        let mut request = Request::default();
        request.known[Parameter::Rs as usize] = known;
        identify(&log, &request).unwrap().identification
    };
    let free = with(Known::Nothing);
    for part in [0.05, 0.01, 0.001] {
        let found = with(Known::Prior { value: truth.rs, standard_error: part * truth.rs });
        for parameter in [Parameter::Lq, Parameter::PsiF] {
            let half_width = |of: &fluxfit::evidence::Identification| of.parameter(parameter).uncertainty.half_width;
            assert!(half_width(&found) < 1.05 * half_width(&free), "{part}, {parameter:?}: {} {}", half_width(&found), half_width(&free));
        }
    }
}
