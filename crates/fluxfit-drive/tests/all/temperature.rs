//! A winding that warms while the log is taken: the resistance at 20 degrees comes out of a log with the temperature.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Log, Model, Request,
    evidence::Identification,
    identify,
    log::Columns,
    motor::{Motor, Parameter},
    paper,
};
use fluxfit_drive::{Scenario, simulate};

/// Part of itself by which the resistance grows while the log is taken.
const DRIFT: f64 = 0.2;

/// Copper is at 20 degC when the log begins: 235 + T grows as the resistance does.
fn found(model: Model) -> Identification {
    let mut scenario = Scenario::paper();
    scenario.sensors.current_noise = 0.05;
    scenario.motor.rs_drift = DRIFT;
    let columns = simulate(&scenario, 0, || ()).unwrap().log().unwrap().columns().clone();
    let temperature = columns.t.iter().map(|t| 255.0 * (1.0 + DRIFT * t / scenario.duration) - 235.0).collect();
    let log = Log::new(Columns { temperature: Some(temperature), ..columns }).unwrap();
    identify(&log, &Request { model: Some(model), ..Request::default() }).unwrap().identification
}

#[test]
fn a_drift_of_the_resistance_is_that_of_the_temperature() {
    let found = found(Model::OutputError);
    let temperature = found.temperature.unwrap();
    let Motor { rs, .. } = paper::MOTOR;
    // R_s itself is that in the middle of the log, a tenth above its start.
    assert!((found.parameter(Parameter::Rs).raw / rs - 1.1).abs() < 0.01, "{found:?}");
    assert!((temperature.copper_gain - DRIFT).abs() < 1e-3 && (temperature.mean - 45.5).abs() < 0.5, "{temperature:?}");
    let at_20 = temperature.rs.unwrap();
    assert!((at_20.value / rs - 1.0).abs() < 0.01, "{at_20:?}");
    assert!((at_20.interval[0]..=at_20.interval[1]).contains(&rs), "{at_20:?}");
}

/// Operating points have one resistance for all: which of their temperatures it belongs to is part of the interval.
#[test]
fn operating_points_have_the_temperature_of_their_rows() {
    let temperature = found(Model::Steady).temperature.unwrap();
    let at_20 = temperature.rs.unwrap();
    assert!((at_20.interval[0]..=at_20.interval[1]).contains(&paper::MOTOR.rs), "{temperature:?}");
}
