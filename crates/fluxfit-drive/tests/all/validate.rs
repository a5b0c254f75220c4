//! Validation on logs whose truth is known: the true motor is accepted as often as is stated, a wrong one is found out.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use fluxfit::{
    Columns, Given, Log, Model, Request, Validation,
    frames::Dq,
    identify,
    motor::{Motor, Parameter},
    objective::acting_voltage::VoltageTiming,
    optimizer::Draws,
    paper, validate,
    validation::prediction::Prediction,
    validation::validate::LITTLE,
    validation::validate::Outcome,
};
use fluxfit_drive::{
    Scenario,
    scenario::{Mechanics, Modulation},
    schedule::{Profile, Ramp},
    simulate,
};
use std::f64::consts::TAU;

/// Of each test; the limits follow from it.
const DRAWS: u64 = 200;

/// The rig on a dynamometer, averaged inverter; noise of 0.1 A on each current sensor.
fn rig() -> Scenario {
    let mut scenario = Scenario::paper();
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.mechanics = Mechanics::Dyno;
    scenario.schedule.load = Profile::default();
    scenario.schedule.speed = Profile::constant(500.0 * TAU / 60.0);
    scenario.sensors.current_noise = 0.1;
    scenario
}

/// Both currents jump for a tenth of a second: everything is told.
fn transients() -> Scenario {
    let mut scenario = rig();
    scenario.duration = 0.1;
    let jumps = |levels: [f64; 2], offset: f64| {
        Profile::new((0..8).map(|k| Ramp { at: offset + 0.012 * f64::from(k), to: levels[k as usize % 2], over: 0.0 }).collect())
    };
    scenario.schedule.iq = jumps([9.0, 3.0], 0.0);
    scenario.schedule.id = jumps([-4.0, 0.0], 0.006);
    scenario
}

/// These currents in turn, each for 0.15 s.
fn levels(currents: &[(f64, f64)]) -> Scenario {
    const HOLD: f64 = 0.15;
    let mut scenario = rig();
    scenario.duration = HOLD * currents.len() as f64;
    let course = |of: fn(&(f64, f64)) -> f64| {
        let moves = currents.iter().enumerate().map(|(k, current)| Ramp { at: HOLD * k as f64, to: of(current), over: 0.0 });
        Profile::new(moves.collect())
    };
    scenario.schedule.id = course(|current| current.0);
    scenario.schedule.iq = course(|current| current.1);
    scenario
}

fn log(scenario: &Scenario, draw: u64) -> Log {
    simulate(scenario, draw, || ()).unwrap().log().unwrap()
}

/// The voltages of a simulated drive are exact, and what their columns mean is known.
fn exact() -> Request {
    Request { voltage_accuracy: 0.0, voltage_timing: Some(VoltageTiming::Centered), ..Request::default() }
}

fn with(parameter: Parameter, factor: f64) -> Given {
    let mut values = paper::MOTOR.to_array();
    values[parameter as usize] *= factor;
    Given::from(Motor::from(values))
}

/// Four standard errors of a binomial count.
fn within(count: usize, probability: f64) -> bool {
    let expected = probability * DRAWS as f64;
    (count as f64 - expected).abs() <= 4.0 * (expected * (1.0 - probability)).sqrt()
}

/// Of each draw, were the motor true.
fn probabilities(settings: &Request, scenario: &Scenario, of: impl Fn(&Validation) -> f64) -> Vec<f64> {
    (0..DRAWS).map(|draw| of(&validate(&log(scenario, draw), &paper::MOTOR.into(), settings).unwrap())).collect()
}

fn assert_uniform(what: &str, probabilities: &[f64]) {
    let below = |limit: f64| probabilities.iter().filter(|probability| **probability < limit).count();
    let counts = [0.01, 0.05, 0.5, 0.9].map(|limit| (limit, below(limit)));
    println!("{what}: of {DRAWS} probabilities so many lie below: {counts:?}");
    assert!(counts.iter().all(|(limit, count)| within(*count, *limit)), "{what}: {counts:?}");
}

#[test]
fn the_true_motor_is_accepted_as_often_as_is_stated() {
    assert_uniform("all", &probabilities(&exact(), &transients(), |validation| validation.test.probability));
}

#[test]
fn so_is_each_channel() {
    for axis in 0..2 {
        assert_uniform(
            ["id", "iq"][axis],
            &probabilities(&exact(), &transients(), |validation| validation.channels[axis].test.probability),
        );
    }
}

/// What one log tells, held against another: both errors count.
#[test]
fn a_motor_that_another_log_told_is_accepted_as_often_as_is_stated() {
    let scenario = transients();
    let probability = |draw| {
        let given = Given::of(&identify(&log(&scenario, DRAWS + draw), &exact()).unwrap().identification).unwrap();
        validate(&log(&scenario, draw), &given, &exact()).unwrap().test.probability
    };
    assert_uniform("two logs", &(0..DRAWS).map(probability).collect::<Vec<_>>());
}

/// Four levels from equation (2), noise on voltages and currents: what the covariance of means is made for. A current controller's noise is
/// less in the mean than that covariance says, so that a drive's log is accepted more often.
fn noisy_levels(draw: u64) -> Log {
    const ROWS: usize = 400;
    let mut draws = Draws::seeded(11, draw);
    let mut columns = Columns::default();
    for (level, (d, q)) in [(0.0, 9.0), (-4.0, 9.0), (-4.0, 3.0), (0.0, 3.0)].into_iter().enumerate() {
        let u = paper::MOTOR.steady_voltage(Dq { d, q }, 400.0);
        for k in 0..ROWS {
            columns.t.push(1e-2 * (2 * level * ROWS + k) as f64);
            columns.ud.push(u.d + 0.2 * draws.normal());
            columns.uq.push(u.q + 0.2 * draws.normal());
            columns.id.push(d + 0.01 * draws.normal());
            columns.iq.push(q + 0.01 * draws.normal());
            columns.omega_e.push(400.0);
        }
    }
    Log::new(columns).unwrap()
}

#[test]
fn operating_points_accept_the_true_motor_as_often_as_is_stated() {
    let probability = |draw| {
        let found = validate(&noisy_levels(draw), &paper::MOTOR.into(), &exact()).unwrap();
        assert!(matches!(found.prediction, Prediction::Voltages(_)));
        found.test.probability
    };
    assert_uniform("operating points", &(0..DRAWS).map(probability).collect::<Vec<_>>());
}

#[test]
fn three_percent_of_any_parameter_are_found_out_by_name() {
    for parameter in [Parameter::Ld, Parameter::Lq, Parameter::PsiF] {
        let found = validate(&log(&transients(), 0), &with(parameter, 1.03), &Request::default()).unwrap();
        assert_ne!(found.outcome, Outcome::Agrees, "{parameter:?}");
        for difference in found.parameters {
            let errors = difference.standard_errors().unwrap();
            let is_it = difference.parameter == parameter;
            // 1/1.03 - 1 is -2.91 %.
            assert!(if is_it { errors < -5.0 } else { errors.abs() < 4.0 }, "{parameter:?}: {difference:?}");
            let percent = 100.0 * difference.difference().unwrap() / difference.given;
            assert!(!is_it || (percent + 2.91).abs() < 0.5, "{percent}");
        }
    }
}

/// At 500 r/min and 9 A, 3 % of L_q are some tenths of an ampere in i_d and i_q: by hand, from equation (2) at a given voltage.
#[test]
fn the_share_is_what_the_steady_equations_say() {
    let (omega_e, i) = (paper::POLE_PAIRS as f64 * 500.0 * TAU / 60.0, Dq { d: -2.0, q: 9.0 });
    let given = with(Parameter::Lq, 1.03);
    let found = validate(&log(&levels(&[(i.d, i.q)]), 0), &given, &Request { model: Some(Model::OutputError), ..exact() }).unwrap();
    let u = paper::MOTOR.steady_voltage(i, omega_e);
    let Motor { rs, ld, lq, psi_f } = given.motor;
    let determinant = rs * rs + omega_e * omega_e * ld * lq;
    let predicted = Dq {
        d: (rs * u.d + omega_e * lq * (u.q - omega_e * psi_f)) / determinant,
        q: (rs * (u.q - omega_e * psi_f) - omega_e * ld * u.d) / determinant,
    };
    let expected = (predicted.d - i.d).hypot(predicted.q - i.q) / i.magnitude();
    assert!((found.share / expected - 1.0).abs() < 0.05 && expected > LITTLE, "{} {expected}", found.share);
    assert_eq!(found.outcome, Outcome::Contradicts);
}

#[test]
fn a_difference_that_hardly_moves_the_current_is_called_little() {
    // A thousandth of L_q is many standard errors of this log, and moves the current by about as much.
    let mut scenario = transients();
    scenario.sensors.current_noise = 1e-3;
    let found = validate(&log(&scenario, 0), &with(Parameter::Lq, 1.002), &exact()).unwrap();
    assert_eq!(found.outcome, Outcome::DiffersLittle, "{:?}", found.test);
    assert!(found.share > 1e-4 && found.share < 2e-3, "{}", found.share);
}

/// One load at i_d = 0: nothing of L_d; of R_s and psi_f only the one with the other given.
#[test]
fn what_a_log_cannot_tell_is_not_tested_and_the_rest_is() {
    let settings = Request { model: Some(Model::Steady), ..exact() };
    let log = log(&levels(&[(0.0, 9.0)]), 0);
    let told = |found: &Validation| found.parameters.map(|difference| difference.own.is_some());
    let agrees = validate(&log, &paper::MOTOR.into(), &settings).unwrap();
    assert_eq!((agrees.outcome, told(&agrees)), (Outcome::Agrees, [false, false, true, true]));
    let untold = validate(&log, &with(Parameter::Ld, 2.0), &settings).unwrap();
    assert_eq!(untold.outcome, Outcome::Agrees);
    let wrong = validate(&log, &with(Parameter::PsiF, 1.05), &settings).unwrap();
    assert_eq!((wrong.outcome, told(&wrong)), (Outcome::Contradicts, [false, false, true, true]));
    assert!(matches!(wrong.prediction, Prediction::Voltages(ref residuals) if residuals.len() == 1));
}

/// A resistance far too small has a wide interval by its own measure, and is found out all the same.
#[test]
fn a_value_that_is_small_because_it_is_wrong_is_tested() {
    let found = validate(&log(&transients(), 0), &with(Parameter::Rs, 0.1), &Request::default()).unwrap();
    assert_eq!(found.outcome, Outcome::Contradicts);
    assert!(found.parameters[0].standard_errors().unwrap() > 5.0, "{:?}", found.parameters[0]);
}

#[test]
fn what_no_motor_has_is_refused() {
    for (parameter, factor) in [(Parameter::Rs, -1.0), (Parameter::Lq, 0.0), (Parameter::Ld, f64::NAN), (Parameter::PsiF, f64::INFINITY)] {
        let error = validate(&log(&transients(), 0), &with(parameter, factor), &Request::default()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{} is ", parameter.symbol())) && error.contains("must be a finite number"), "{error}");
    }
}
