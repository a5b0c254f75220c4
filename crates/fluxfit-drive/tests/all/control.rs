//! The controllers against what loops of their kind do by theory: bandwidths, limits, recovery.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{frames::Dq, paper};
use fluxfit_drive::{
    Drive, FluxMap, Recording, Scenario,
    scenario::{Axis, Control, Injection, Inverter, Magnetics, Mechanics, Modulation, SimulatedMotor, Waveform},
    schedule::{Profile, Ramp},
    simulate,
};
use std::{f64::consts::TAU, path::Path};

const SAMPLE_PERIOD: f64 = 1e-4;

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Largest distance of values from one, which a mean might hide.
fn farthest(values: &[f64], from: f64) -> f64 {
    values.iter().map(|value| (value - from).abs()).fold(0.0, f64::max)
}

fn steps(moves: &[(f64, f64)]) -> Profile {
    Profile::new(moves.iter().map(|(at, to)| Ramp { at: *at, to: *to, over: 0.0 }).collect())
}

/// The paper's motor on a dynamometer at an electrical speed, rad/s, with all the voltage it may want; averaged.
fn on_a_dyno(duration: f64, omega_e: f64) -> Scenario {
    let mut scenario = Scenario { duration, ..Scenario::paper() };
    scenario.inverter = Inverter { modulation: Modulation::Averaged, u_dc: 2500.0, ..scenario.inverter };
    scenario.mechanics = Mechanics::Dyno;
    scenario.schedule.load = Profile::default();
    scenario.schedule.id = Profile::default();
    scenario.schedule.speed = Profile::constant(omega_e / 4.0);
    scenario
}

/// Records a drive whose schedule may ask for more than there is.
fn driven(scenario: &Scenario) -> Recording {
    let mut drive = Drive::new(scenario, 0);
    let mut recording = Recording::default();
    for _ in 0..scenario.rows() {
        recording.push(&drive.step().unwrap());
    }
    recording
}

/// `1 - e^(-alpha t)`, one period late as its command is, with a winding whose own `R/L` is far below alpha; along both axes.
#[test]
fn a_current_step_rises_with_the_bandwidth_asked_for() {
    for bandwidth in [50.0, 100.0] {
        for axis in [Axis::D, Axis::Q] {
            let mut scenario = on_a_dyno(0.05, 0.0);
            scenario.motor.rs = 0.05;
            scenario.control.current_bandwidth = bandwidth;
            match axis {
                Axis::D => scenario.schedule.id = Profile::constant(5.0),
                Axis::Q => scenario.schedule.iq = Profile::constant(5.0),
            }
            let recording = simulate(&scenario, 0, || ()).unwrap();
            let (along, across) = match axis {
                Axis::D => (&recording.columns.id, &recording.columns.iq),
                Axis::Q => (&recording.columns.iq, &recording.columns.id),
            };
            for (k, i) in along.iter().enumerate().skip(2) {
                let expected = 5.0 * (1.0 - (-TAU * bandwidth * (k as f64 - 1.0) * SAMPLE_PERIOD).exp());
                // That period, 0.06 of the time constant at most, lets the loop learn of its success that much too late.
                assert!((i - expected).abs() < 0.06 * 5.0, "{bandwidth} Hz, {axis:?}, row {k}: {i} {expected}");
            }
            assert!(farthest(across, 0.0) < 1e-9);
        }
    }
}

/// 0.3 rad per sample: the rotor turns twice as fast as the loop decays. Decoupled, the other axis sees what the delay of one and a half
/// periods leaves, `1.5 T_s alpha`, 0.19 of the step, in flux: the current of the smaller inductance up to `L_q / L_d` times more.
#[test]
fn a_step_along_one_axis_leaves_the_other_at_any_speed() {
    for omega_e in [3000.0, -3000.0, 1500.0] {
        for axis in [Axis::D, Axis::Q] {
            let mut scenario = on_a_dyno(0.14, omega_e);
            let step = steps(&[(0.1, -5.0)]);
            match axis {
                Axis::D => scenario.schedule.id = step,
                Axis::Q => scenario.schedule.iq = step,
            }
            let recording = simulate(&scenario, 0, || ()).unwrap();
            let (along, across) = match axis {
                Axis::D => (&recording.columns.id, &recording.columns.iq),
                Axis::Q => (&recording.columns.iq, &recording.columns.id),
            };
            assert!(farthest(&across[900..1000], 0.0) < 1e-3, "{}", farthest(&across[900..1000], 0.0));
            assert!(farthest(&across[1000..], 0.0) < 0.3 * 5.0, "{omega_e} {axis:?}: {}", farthest(&across[1000..], 0.0));
            // Ten time constants of 0.8 ms later all is done.
            assert!(farthest(&along[1100..], -5.0) < 0.02 * 5.0 && farthest(&across[1100..], 0.0) < 0.02 * 5.0, "{omega_e} {axis:?}");
        }
    }
}

/// A small fast motor and a test voltage of almost all that there is: the loop is at or near its limit for a tenth of a second, and back
/// at its references after it.
#[test]
fn a_loop_that_was_at_its_limit_recovers_at_any_speed() {
    for (turn, bandwidth) in [(0.2, 20.0), (0.2, 50.0), (0.3, 20.0), (0.4, 20.0), (0.4, 50.0), (-0.4, 50.0)] {
        let mut scenario = on_a_dyno(0.6, turn / SAMPLE_PERIOD);
        scenario.motor = SimulatedMotor::new(0.2, Magnetics::Constant { ld: 0.5e-3, lq: 1e-3, psi_f: 5e-3 }, 4);
        scenario.inverter.u_dc = 60.0;
        scenario.control = Control { trip_current: 1e3, ..Control::new(bandwidth, 1.0, 100.0) };
        scenario.schedule.id = Profile::constant(-2.0);
        scenario.schedule.iq = Profile::constant(3.0);
        scenario.schedule.injection = Some(Injection {
            axis: Axis::Q,
            waveform: Waveform::Sine,
            frequency: 50.0,
            voltage: steps(&[(0.3, 0.98 * 60.0 / 3.0_f64.sqrt()), (0.4, 0.0)]),
        });
        let recording = simulate(&scenario, 0, || ()).unwrap();
        let limit = 60.0 / 3.0_f64.sqrt();
        let used: Vec<f64> = recording.ud_ref.iter().zip(&recording.uq_ref).map(|(d, q)| d.hypot(*q)).collect();
        assert!(used.iter().all(|u| *u < limit * (1.0 + 1e-12)), "{turn} {bandwidth}");
        assert!(used[3000..4000].iter().any(|u| *u > 0.9 * limit), "{turn} {bandwidth}");
        for (column, reference) in [(&recording.columns.id, -2.0), (&recording.columns.iq, 3.0)] {
            // The slowest loop's time constant is 8 ms: a tenth of a second is twelve of them.
            assert!(farthest(&column[2900..3000], reference) < 0.01, "before, {turn} {bandwidth}");
            assert!(farthest(&column[5000..], reference) < 0.01, "after, {turn} {bandwidth}: {}", farthest(&column[5000..], reference));
        }
    }
}

/// Where the magnet alone takes 146 V of 167 V, a reference of i_q that the voltage does not reach, for a tenth of a second. An integral
/// that went on would have to be unwound for as long; without, the current comes back like after any step.
#[test]
fn what_the_voltage_did_not_reach_is_not_integrated() {
    let mut scenario = on_a_dyno(0.4, 800.0);
    scenario.inverter.u_dc = 290.0;
    scenario.schedule.iq = steps(&[(0.1, 18.0), (0.2, 2.0)]);
    let recording = driven(&scenario);
    let iq = &recording.columns.iq;
    let limit = 290.0 / 3.0_f64.sqrt();
    let used: Vec<f64> = recording.ud_ref.iter().zip(&recording.uq_ref).map(|(d, q)| d.hypot(*q)).collect();
    assert!(
        used.iter().all(|u| *u < limit * (1.0 + 1e-12)) && used[1500] > 0.999_999 * limit && iq[1999] < 17.0,
        "{} {}",
        used[1500],
        iq[1999]
    );
    // 12 time constants of 0.8 ms after the step down.
    assert!(farthest(&iq[2100..], 2.0) < 0.1, "{}", farthest(&iq[2100..], 2.0));
    assert!(farthest(&recording.columns.id[2100..], 0.0) < 0.1, "{}", farthest(&recording.columns.id[2100..], 0.0));
}

/// The first command of a drive at rest is `alpha psi(i*)`: it tells the reference that was chosen. The speed loop's torque is
/// `alpha_n J` times the missing speed, its current that over `3/2 p (psi_f + (L_d - L_q) i_d)`; `i_d` has priority in the current limit.
#[test]
fn the_first_command_tells_the_reference_within_its_limits() {
    let alpha = TAU * 200.0;
    let reference = |id: f64, speed: f64, max_current: f64| {
        let mut scenario = Scenario { duration: 0.01, ..Scenario::paper() };
        scenario.inverter.u_dc = 5000.0;
        (scenario.control.max_current, scenario.control.trip_current) = (max_current, 2.0 * max_current);
        scenario.schedule.speed = Profile::constant(speed);
        scenario.schedule.id = Profile::constant(id);
        let recording = driven(&Scenario {
            schedule: fluxfit_drive::scenario::Schedule { load: Profile::default(), ..scenario.schedule.clone() },
            ..scenario
        });
        Dq { d: recording.ud_ref[0] / (alpha * paper::MOTOR.ld), q: recording.uq_ref[0] / (alpha * paper::MOTOR.lq) }
    };
    let torque = |speed: f64| TAU * 20.0 * paper::INERTIA * speed;
    for (id, speed, max_current, d, q) in [
        (0.0, 10.0, 20.0, 0.0, torque(10.0) / (6.0 * 0.1827)),
        (0.0, -10.0, 20.0, 0.0, torque(-10.0) / (6.0 * 0.1827)),
        // Reluctance helps, and hinders.
        (-10.0, 10.0, 20.0, -10.0, torque(10.0) / (6.0 * (0.1827 + 6.75e-3 * 10.0))),
        (8.0, 10.0, 20.0, 8.0, torque(10.0) / (6.0 * (0.1827 - 6.75e-3 * 8.0))),
        // Limits: 20 A in all, of which i_d leaves sqrt(20² - 12²) = 16.
        (0.0, 1000.0, 20.0, 0.0, 20.0),
        (-12.0, 1000.0, 20.0, -12.0, 16.0),
        (-12.0, -1000.0, 20.0, -12.0, -16.0),
        (-30.0, 10.0, 20.0, -20.0, 0.0),
        (30.0, 10.0, 20.0, 20.0, 0.0),
        (0.0, 1000.0, 7.0, 0.0, 7.0),
    ] {
        let found = reference(id, speed, max_current);
        assert!((found.d - d).abs() < 1e-9 && (found.q - q).abs() < 1e-9, "{id} {speed} {max_current}: {found:?}");
    }
}

/// A run-up at the current limit lasts several time constants of the speed loop; what its integral gathered would overshoot.
#[test]
fn a_speed_reached_at_the_current_limit_is_not_overshot() {
    for (direction, id) in [(1.0, 0.0), (-1.0, 0.0), (1.0, -3.0)] {
        let mut scenario = Scenario { duration: 0.4, ..Scenario::paper() };
        (scenario.control.max_current, scenario.control.trip_current) = (6.0, 20.0);
        scenario.schedule.load = Profile::default();
        scenario.schedule.id = Profile::constant(id);
        scenario.schedule.speed = Profile::constant(direction * 100.0);
        let recording = simulate(&scenario, 0, || ()).unwrap();
        let speed: Vec<f64> = recording.columns.omega_e.iter().map(|omega| direction * omega / 4.0).collect();
        // 6 A make 6.6 N m, 2200 rad/s²: 45 ms, while the loop's time constant is 8 ms.
        assert!(speed[300] < 80.0, "{}", speed[300]);
        let most = speed.iter().copied().fold(0.0, f64::max);
        assert!(most < 101.0, "{direction} {id}: {most}");
        assert!(farthest(&speed[3000..], 100.0) < 0.1, "{direction} {id}: {}", farthest(&speed[3000..], 100.0));
        assert!(recording.columns.iq[50..200].iter().all(|iq| iq.hypot(id) < 6.3));
    }
}

/// More than five times the speed that the voltage allows unweakened: 120 V / sqrt(3) over 4 * 0.1827 Wb is 95 rad/s, 905 r/min.
#[test]
fn a_weaker_field_reaches_and_holds_a_high_speed_in_both_directions() {
    let recordings = [1.0, -1.0].map(|direction| {
        let mut scenario = Scenario { duration: 2.0, ..Scenario::paper() };
        scenario.mechanics = Mechanics::Free { inertia: paper::INERTIA, friction: 1e-4 };
        scenario.inverter = Inverter { u_dc: 120.0, modulation: Modulation::Averaged, ..scenario.inverter };
        scenario.control = Control { field_weakening: true, ..Control::new(200.0, 20.0, 60.0) };
        let speed = 5000.0 * TAU / 60.0;
        scenario.schedule.id = Profile::default();
        scenario.schedule.speed = Profile::new(vec![Ramp { at: 0.0, to: direction * speed, over: 0.3 }]);
        scenario.schedule.load = steps(&[(1.5, direction * 0.2)]);
        let recording = simulate(&scenario, 0, || ()).unwrap();
        let reached: Vec<f64> = recording.columns.omega_e.iter().map(|omega| direction * omega / 4.0 / speed).collect();
        for rows in [13_000..15_000, 18_000..20_000] {
            assert!(farthest(&reached[rows.clone()], 1.0) < 0.01, "{direction}: {}", farthest(&reached[rows.clone()], 1.0));
            // Almost all of the magnet's flux is opposed: psi_f / L_d is 34.8 A.
            let id = mean(&recording.columns.id[rows]);
            assert!(id < -25.0 && id > -36.0, "{direction}: {id}");
        }
        recording
    });
    // Turning the other way is the mirror image: i_d alike, speed and i_q of the other sign.
    let [forth, back] = recordings.map(|recording| recording.columns);
    for k in 0..forth.t.len() {
        let (d, q, speed) = (forth.id[k] - back.id[k], forth.iq[k] + back.iq[k], forth.omega_e[k] + back.omega_e[k]);
        assert!(d.abs() < 1e-3 && q.abs() < 1e-3 && speed.abs() < 1e-3, "row {k}: {d} {q} {speed}");
    }
}

/// A motor that saturates: the controller's flux is the map's, so that its loop stays itself.
#[test]
fn a_saturated_motor_settles_on_its_references() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenarios/baldor_ecs101_flux_map.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (Dq { d: cells[0], q: cells[1] }, Dq { d: cells[2], q: cells[3] })
    };
    let map = FluxMap::new(&text.lines().skip(1).map(row).collect::<Vec<_>>()).unwrap();
    for iq in [10.0, 15.0, 20.0] {
        let mut scenario = on_a_dyno(0.5, 0.0);
        scenario.motor = SimulatedMotor::new(0.63, Magnetics::Map(map.clone()), 2);
        scenario.inverter.u_dc = 540.0;
        scenario.control = Control::new(200.0, 1.0, 24.0);
        scenario.schedule.speed = Profile::constant(40.0);
        scenario.schedule.id = Profile::constant(-5.0);
        scenario.schedule.iq = Profile::new(vec![Ramp { at: 0.05, to: iq, over: 0.2 }]);
        let recording = simulate(&scenario, 0, || ()).unwrap();
        assert!(farthest(&recording.columns.id[4000..], -5.0) < 0.05, "{iq}: {}", farthest(&recording.columns.id[4000..], -5.0));
        assert!(farthest(&recording.columns.iq[4000..], iq) < 0.05, "{iq}: {}", farthest(&recording.columns.iq[4000..], iq));
    }
}
