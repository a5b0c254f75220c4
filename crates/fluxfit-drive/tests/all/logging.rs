//! What is logged of the samples: filters against their frequency response, decimated and averaged logs against the complete one.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::frames::Dq;
use fluxfit_drive::{
    Recording, Scenario,
    scenario::{FilterFrame, LoggedRows, Logging, Mechanics, Modulation},
    schedule::{Profile, Ramp},
    simulate,
};
use std::f64::consts::TAU;

/// Of the paper's rig, s.
const SAMPLE_PERIOD: f64 = 1e-4;
/// Electrical, rad/s.
const SPEED: f64 = 1000.0;
const POLE: f64 = 500.0;

/// The paper's motor on a dynamometer at constant currents, averaged; without noise unless told otherwise.
fn rig(speed: Profile, logging: Logging) -> Scenario {
    let mut scenario = Scenario { duration: 0.2, logging, ..Scenario::paper() };
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.inverter.u_dc = 1000.0;
    scenario.mechanics = Mechanics::Dyno;
    scenario.schedule.load = Profile::default();
    (scenario.schedule.id, scenario.schedule.iq) = (Profile::constant(-3.0), Profile::constant(5.0));
    scenario.schedule.speed = speed;
    scenario
}

fn recorded(scenario: &Scenario) -> Recording {
    simulate(scenario, 0, || ()).unwrap()
}

fn at_constant_speed(logging: Logging) -> Recording {
    recorded(&rig(Profile::constant(SPEED / 4.0), logging))
}

/// With noise and moving references, so that no two rows are alike.
fn restless(logging: Logging) -> Recording {
    let mut scenario = rig(Profile::constant(SPEED / 4.0), logging);
    scenario.sensors.current_noise = 0.1;
    scenario.schedule.id = Profile::new(vec![Ramp { at: 0.05, to: -6.0, over: 0.02 }, Ramp { at: 0.1, to: 0.0, over: 0.0 }]);
    recorded(&scenario)
}

/// `H(e^(j w T)) = g / (1 - (1 - g) e^(-j w T))` with `g = 1 - e^(-2 pi f T)`: real and imaginary part.
fn response(pole: f64, omega: f64) -> (f64, f64) {
    let rest = (-TAU * pole * SAMPLE_PERIOD).exp();
    let (sin, cos) = (omega * SAMPLE_PERIOD).sin_cos();
    let (re, im) = (1.0 - rest * cos, rest * sin);
    let square = re * re + im * im;
    ((1.0 - rest) * re / square, -(1.0 - rest) * im / square)
}

/// In the rotor frame a vector that turns in the stator is constant: the filter multiplies it by its response at the rotor's frequency.
fn filtered(v: Dq) -> Dq {
    let (re, im) = response(POLE, SPEED);
    Dq { d: re * v.d - im * v.q, q: re * v.q + im * v.d }
}

fn last(d: &[f64], q: &[f64]) -> Dq {
    Dq { d: *d.last().unwrap(), q: *q.last().unwrap() }
}

fn apart(a: Dq, b: Dq) -> f64 {
    (a.d - b.d).hypot(a.q - b.q)
}

#[test]
fn a_current_filter_has_the_response_of_its_pole() {
    let complete = at_constant_speed(Logging::COMPLETE).columns;
    let logged = at_constant_speed(Logging { current_filter: Some(POLE), ..Logging::COMPLETE }).columns;
    let expected = filtered(last(&complete.id, &complete.iq));
    // 500 Hz passes a sine of 159 Hz at 95 % and late by 15 degrees.
    assert!(apart(expected, Dq { d: -3.0, q: 5.0 }) > 1.0);
    assert!(apart(last(&logged.id, &logged.iq), expected) < 1e-9);
    assert_eq!((logged.ud, logged.omega_e), (complete.ud, complete.omega_e));
    // The filter begins with the first sample, as if the current had flowed before.
    assert_eq!((logged.id[0], logged.iq[0]), (complete.id[0], complete.iq[0]));
}

#[test]
fn a_voltage_filter_has_the_response_of_its_pole() {
    let complete = at_constant_speed(Logging::COMPLETE);
    let logged = at_constant_speed(Logging { voltage_filter: Some(POLE), ..Logging::COMPLETE });
    let expected = filtered(last(&complete.columns.ud, &complete.columns.uq));
    assert!(apart(last(&logged.columns.ud, &logged.columns.uq), expected) < 1e-7);
    assert_eq!((logged.columns.id, logged.ud_ref), (complete.columns.id, complete.ud_ref));
}

/// Behind a ramp a filter lags by the slope times `T (1 - g) / g`.
#[test]
fn a_speed_filter_lags_behind_a_ramp() {
    let (pole, slope) = (20.0, 4.0 * 1000.0);
    let ramp = Profile::new(vec![Ramp { at: 0.0, to: 200.0, over: 0.2 }]);
    let logged = recorded(&rig(ramp, Logging { speed_filter: Some(pole), ..Logging::COMPLETE })).columns;
    let rest = (-TAU * pole * SAMPLE_PERIOD).exp();
    // 0.19 s are 24 time constants.
    let (t, speed) = (logged.t[1900], logged.omega_e[1900]);
    let expected = slope * (t - SAMPLE_PERIOD * rest / (1.0 - rest));
    assert!((speed - expected).abs() < 1e-6 && slope * t - speed > 30.0, "{speed} {expected}");
}

/// All columns of a recording, with their names.
fn rows_of(recording: &Recording) -> Vec<(&'static str, Vec<f64>)> {
    recording.named().into_iter().map(|(name, column)| (name, column.to_vec())).collect()
}

#[test]
fn a_decimated_log_is_every_nth_row_of_the_complete_one() {
    let complete = restless(Logging::COMPLETE);
    for every in [2, 7, 10] {
        let logged = restless(Logging { every, ..Logging::COMPLETE });
        for ((name, all), (_, found)) in rows_of(&complete).into_iter().zip(rows_of(&logged)) {
            let expected: Vec<f64> = all.iter().copied().step_by(every as usize).collect();
            assert_eq!(found, expected, "{name}, every {every}");
        }
    }
}

#[test]
fn an_averaged_log_has_the_means_of_the_complete_one() {
    let every = 7;
    let complete = restless(Logging::COMPLETE);
    let logged = restless(Logging { every: every as u32, rows: LoggedRows::Mean, ..Logging::COMPLETE });
    // 2001 samples: 285 rows, and six samples that fill none.
    assert_eq!(logged.columns.t.len(), 285);
    for ((name, all), (_, found)) in rows_of(&complete).into_iter().zip(rows_of(&logged)) {
        for (row, found) in found.into_iter().enumerate() {
            let samples = &all[row * every..(row + 1) * every];
            if name == "theta_e" {
                // The angle of the sample in the middle: the speed is constant.
                let turns = (found - samples[every / 2]) / TAU;
                assert!((turns - turns.round()).abs() < 1e-12, "row {row}");
            } else {
                let mean = samples.iter().sum::<f64>() / every as f64;
                assert!((found - mean).abs() < 1e-9, "{name}, row {row}: {found} {mean}");
            }
        }
    }
}

#[test]
fn columns_are_left_out() {
    let logged = restless(Logging { theta_e: false, u_dc: false, ..Logging::COMPLETE });
    let names: Vec<&str> = logged.named().iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["t", "ud", "uq", "id", "iq", "omega_e", "ud_ref", "uq_ref"]);
    let complete = restless(Logging::COMPLETE);
    assert_eq!((logged.columns.id, logged.uq_ref), (complete.columns.id, complete.uq_ref));
}

#[test]
fn the_number_of_rows_is_told_before() {
    for (every, rows) in [(1, LoggedRows::First), (3, LoggedRows::First), (3, LoggedRows::Mean), (2001, LoggedRows::Mean)] {
        let scenario = rig(Profile::constant(SPEED / 4.0), Logging { every, rows, ..Logging::COMPLETE });
        assert_eq!(recorded(&scenario).columns.t.len(), scenario.logged_rows(), "{every}");
        assert!((scenario.row_rate() * f64::from(every) - 1e4).abs() < 1e-9);
    }
}

/// In the rotor's frame the filter works on d and on q: `y[k] = y[k-1] + g (x[k] - y[k-1])`.
#[test]
fn a_filter_of_d_and_q_follows_its_recursion() {
    let complete = restless(Logging::COMPLETE).columns;
    let logged = restless(Logging { filter_frame: FilterFrame::Dq, current_filter: Some(POLE), ..Logging::COMPLETE }).columns;
    let gain = 1.0 - (-TAU * POLE * SAMPLE_PERIOD).exp();
    for (logged, complete) in [(&logged.id, &complete.id), (&logged.iq, &complete.iq)] {
        let mut y = complete[0];
        for (logged, x) in logged.iter().zip(complete) {
            y += gain * (x - y);
            assert!((logged - y).abs() < 1e-9);
        }
    }
}
