//! Output error on logs whose truth is known: those of an independent simulator, and our own drive's by the dozen.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    Columns, Log,
    faults::{Faults, angle_delay::AngleDelay, dead_time::DeadTime},
    levenberg_marquardt::{MOTOR, Polished, jacobian, polish},
    motor::{Motor, PARAMETERS},
    objective::{
        acting_voltage::{VoltageFrame, VoltageTiming},
        adjustable::Adjustable,
        output_error::OutputError,
    },
    optimizer::{Bounds, Method, Optimizer, SearchSettings},
    paper,
};
use fluxfit_drive::{
    scenario::{
        Adc, Inverter, Update,
        reference_cases::{acceleration, small_motor},
    },
    simulate,
};
use std::path::Path;

const NEXT_PERIOD: VoltageTiming = VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle };

/// A log of `examples/logs`, with these columns as voltages.
fn example(name: &str, voltages: [&str; 2]) -> Log {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/logs").join(name);
    let text = std::fs::read_to_string(path).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let column = |name: &str| -> Vec<f64> {
        let at = header.iter().position(|other| *other == name).unwrap();
        text.lines().skip(1).map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
    };
    let [ud, uq] = voltages.map(column);
    Log::new(Columns { t: column("t"), ud, uq, id: column("id"), iq: column("iq"), omega_e: column("omega_e"), ..Columns::default() })
        .unwrap()
}

/// A first guess that is off by 10 to 20 %.
const START: Motor = Motor { rs: 1.1, ld: 6e-3, lq: 11e-3, psi_f: 0.16 };

/// Errors in percent.
fn errors(motor: &Motor) -> [f64; PARAMETERS] {
    std::array::from_fn(|p| 100.0 * (motor.to_array()[p] / paper::MOTOR.to_array()[p] - 1.0))
}

/// The reading that fits best, and the motor found under it.
fn best(log: &Log) -> (VoltageTiming, Polished) {
    let found = VoltageTiming::ALL.map(|reading| (reading, polish(&OutputError::of(log, reading).unwrap(), &START)));
    found.into_iter().min_by(|a, b| a.1.cost.total_cmp(&b.1.cost)).unwrap()
}

#[test]
fn independent_logs_give_their_motor_and_their_timing() {
    let (ideal, noisy) = ("paper_rig_ideal.csv", "paper_rig_pwm_noise.csv");
    // Limits in percent: R_s, L_d, L_q, psi_f. With noise some three standard errors.
    let exact = [0.05, 0.02, 0.02, 0.02];
    let noise = [0.2, 0.1, 0.03, 0.03];
    let (logged, commands) = (["ud", "uq"], ["ud_ref", "uq_ref"]);
    for (name, voltages, expected, limits) in [
        (ideal, logged, VoltageTiming::Centered, exact),
        (ideal, commands, NEXT_PERIOD, exact),
        (noisy, logged, VoltageTiming::Centered, noise),
        (noisy, commands, NEXT_PERIOD, noise),
    ] {
        let (reading, found) = best(&example(name, voltages));
        println!("{name}, {voltages:?}: {reading:?}, {:.4?} %", errors(&found.drive.motor));
        assert_eq!(reading, expected, "{name}");
        assert!(found.converged && errors(&found.drive.motor).iter().zip(limits).all(|(error, limit)| error.abs() < limit), "{name}");
    }
}

/// The smallest motors of the field: 20 uH, samples at 20 kHz, 0.1 rad of turn between them, R_s T_s / L of 0.13.
#[test]
fn a_stiff_motor_at_speed_is_integrated_exactly() {
    let mut scenario = small_motor();
    let motor = scenario.motor.unsaturated();
    scenario.sensors.current_noise = 0.0;
    let log = simulate(&scenario, 0, || ()).unwrap().log().unwrap();
    let objective = OutputError::of(&log, VoltageTiming::Centered).unwrap();
    let rms = (objective.cost(&motor) / (2 * objective.rows()) as f64).sqrt();
    assert!(rms < 1e-6, "the true motor misses the log by {rms:e} A");
    let start = Motor { rs: 0.06, ld: 15e-6, lq: 30e-6, psi_f: 2.2e-3 };
    let found = polish(&objective, &start);
    for (found, truth) in found.drive.motor.to_array().iter().zip(motor.to_array()) {
        assert!((found / truth - 1.0).abs() < 1e-5, "{found:?}");
    }
}

/// Periods of one length share tabulated transitions; where one of them differs, each is exponentiated by itself. Both are the same.
#[test]
fn even_and_uneven_periods_agree() {
    let columns = simulate(&acceleration(), 0, || ()).unwrap().columns;
    let mut stretched = columns.clone();
    if let Some(last) = stretched.t.last_mut() {
        // Half a percent of the last period; its own row's part of the cost changes.
        *last += 5e-7;
    }
    let cost = |columns| OutputError::of(&Log::new(columns).unwrap(), VoltageTiming::Centered).unwrap().cost(&START);
    let (even, uneven) = (cost(columns), cost(stretched));
    assert!((even / uneven - 1.0).abs() < 1e-6 && even != uneven, "{even} {uneven}");
}

/// The swarm of the paper on the output error, no derivatives and a box: it ends where the polish does.
#[test]
fn the_papers_swarm_ends_where_the_polish_does() {
    let mut scenario = acceleration();
    scenario.duration = 0.12;
    scenario.sensors.adc = Some(Adc { bits: 12, range: 20.0 });
    let log = simulate(&scenario, 0, || ()).unwrap().log().unwrap();
    let objective = OutputError::of(&log, VoltageTiming::Centered).unwrap();
    let bounds = Bounds::new(vec![0.05, 5e-4, 5e-4, 0.01], paper::SEARCH_BOX.to_vec()).unwrap();
    let settings = SearchSettings { population: 40, iterations: 250, ..SearchSettings::default() };
    let report = Optimizer::start(Method::all()[0], settings, bounds, &objective).unwrap().run(&objective);
    let found = polish(&objective, &START);
    let swarm = Motor::from([report.best[0], report.best[1], report.best[2], report.best[3]]);
    println!("swarm {:.4?} %, polish {:.4?} %, cost {:e} above", errors(&swarm), errors(&found.drive.motor), report.cost - found.cost);
    assert!(report.cost >= found.cost * (1.0 - 1e-12));
    assert!(errors(&swarm).iter().zip(errors(&found.drive.motor)).all(|(one, other)| (one - other).abs() < 1.0));
}

/// Of an unstable motor nearly all of the cost is explained by its unknown start; what is left still is the sum of squares.
#[test]
fn a_cost_is_the_sum_of_its_squared_residuals_wherever_the_motor_is() {
    let log = example("paper_rig_ideal.csv", ["ud", "uq"]);
    let objective = OutputError::of(&log, VoltageTiming::Centered).unwrap();
    for motor in [paper::MOTOR, START, Motor { ld: -2e-2, ..START }, Motor { rs: -0.05, ..START }, Motor { rs: 5.0, ld: 1e-9, ..START }] {
        let direct: f64 = objective.residuals(&motor.into()).iter().map(|residual| residual * residual).sum();
        let cost = objective.cost(&motor);
        assert!(direct.is_finite() && (cost / direct - 1.0).abs() < 1e-6, "{motor:?}: {cost:e} {direct:e}");
    }
}

/// What a volt at one row does to the answer, by the adjoint equations, is what happens when that row has a volt more.
#[test]
fn the_adjoint_tells_what_a_volt_does() {
    let mut scenario = acceleration();
    scenario.sensors.current_noise = 0.0;
    let recording = simulate(&scenario, 0, || ()).unwrap();
    // Commands act one period later as they stand: nothing is left over that would bend the cost.
    let fit = |change: &dyn Fn(&mut Columns)| {
        let mut columns = recording.columns.clone();
        (columns.ud, columns.uq) = (recording.ud_ref.clone(), recording.uq_ref.clone());
        change(&mut columns);
        let objective = OutputError::of(&Log::new(columns).unwrap(), NEXT_PERIOD).unwrap();
        let found = polish(&objective, &paper::MOTOR).drive;
        (objective, found)
    };
    let (objective, drive) = fit(&|_| ());
    let slopes = jacobian(&objective, &drive, &MOTOR);
    let normal = nalgebra::Matrix4::from_fn(|p, q| slopes[p].iter().zip(&slopes[q]).map(|(a, b)| a * b).sum::<f64>());
    let inverse = normal.try_inverse().unwrap();
    const VOLT: f64 = 0.1;
    for (parameter, row) in [(0, 700), (1, 400), (2, 1500), (3, 90)] {
        let weights: Vec<f64> =
            (0..slopes[0].len()).map(|k| (0..PARAMETERS).map(|q| inverse[(parameter, q)] * slopes[q][k]).sum()).collect();
        let expected = VOLT * objective.by_voltage(&drive, std::slice::from_ref(&weights))[0][row].q;
        let (_, above) = fit(&|columns| columns.uq[row] += VOLT);
        let (_, below) = fit(&|columns| columns.uq[row] -= VOLT);
        let found = 0.5 * (above.motor.to_array()[parameter] - below.motor.to_array()[parameter]);
        assert!((found / expected - 1.0).abs() < 0.02, "{parameter} at {row}: {found:e} instead of {expected:e}");
    }
}

/// While the speed grows, the rotor turns faster than an angle that is late by a fixed time: simulated with the true motor and the true
/// delay, nothing is left of the currents. Of the voltage that the missing speed induces, `psi_f` times delay times acceleration,
/// some hundredths of an ampere would be left.
#[test]
fn a_late_angle_leaves_nothing_while_the_speed_grows() {
    const DELAY: f64 = 100e-6;
    let mut scenario = acceleration();
    scenario.sensors.current_noise = 0.0;
    scenario.sensors.angle_delay = DELAY;
    let recording = simulate(&scenario, 0, || ()).unwrap();
    let mut columns = recording.columns.clone();
    (columns.ud, columns.uq) = (recording.ud_ref.clone(), recording.uq_ref.clone());
    assert!(columns.theta_e.is_some());
    let growth = (columns.omega_e[columns.t.len() - 1] - columns.omega_e[0]) / columns.t[columns.t.len() - 1];
    let missing = paper::MOTOR.psi_f * DELAY * growth.abs() / paper::MOTOR.rs;
    let objective = OutputError::of(&Log::new(columns).unwrap(), NEXT_PERIOD).unwrap();
    let drive =
        Adjustable { faults: Faults { angle_delay: AngleDelay { time: DELAY }, ..Faults::default() }, ..Adjustable::from(paper::MOTOR) };
    let left = (objective.cost_of(&drive) / (2 * objective.rows()) as f64).sqrt();
    println!("left {left:e} A of {missing:e} A");
    assert!(left < 0.02 * missing, "{left:e} A of {missing:e} A");
}

/// Without the angle, the phases lie by the integral of the speed, which is not late as the frame of the currents is: simulated with the
/// true drive, dead time and all, no more is left than with the angle.
#[test]
fn a_late_angle_that_is_not_logged_moves_no_phase() {
    const DELAY: f64 = 200e-6;
    let mut scenario = acceleration();
    (scenario.sensors.current_noise, scenario.sensors.angle_delay) = (0.0, DELAY);
    scenario.inverter = Inverter { dead_time: 3e-6, update: Update::Single, ..Inverter::ideal(310.0, 10e3) };
    let recording = simulate(&scenario, 0, || ()).unwrap();
    let mut columns = recording.columns.clone();
    (columns.ud, columns.uq) = (recording.ud_ref.clone(), recording.uq_ref.clone());
    let start = columns.theta_e.as_ref().unwrap()[0] + DELAY * columns.omega_e[0];
    let left = |phase: f64, columns: Columns| {
        let objective = OutputError::of(&Log::new(columns).unwrap(), NEXT_PERIOD).unwrap();
        // 310 V for 3 us of each 100 us.
        let dead_time = DeadTime { voltage: 9.3, width: 1e-3, ripple: 1.0, phase, ..DeadTime::default() };
        let faults = Faults { angle_delay: AngleDelay { time: DELAY }, dead_time, ..Faults::default() };
        (objective.cost_of(&Adjustable { faults, ..Adjustable::from(paper::MOTOR) }) / (2 * objective.rows()) as f64).sqrt()
    };
    let with_angle = left(0.0, columns.clone());
    columns.theta_e = None;
    let without = left(start, columns.clone());
    println!("left {with_angle} A with the angle, {without} A without");
    assert!(without < 1.1 * with_angle, "{without} A, with the angle {with_angle} A");
}
