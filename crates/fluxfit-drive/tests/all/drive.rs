//! The drive's log against the machine's equations, worked out from the log itself and from schedules.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    frames::{AlphaBeta, Dq},
    paper,
};
use fluxfit_drive::{
    Drive, FluxMap, Recording, Scenario,
    inverter::Bridge,
    plant::Plant,
    scenario::{Axis, Injection, Inverter, Magnetics, Mechanics, Modulation, SimulatedMotor, Waveform},
    schedule::{Profile, Ramp},
    simulate,
};
use std::f64::consts::TAU;

/// Of the paper's rig, s.
const SAMPLE_PERIOD: f64 = 1e-4;

/// The paper's motor on a dynamometer, averaged, without noise.
fn on_a_dyno(duration: f64, speed: Profile) -> Scenario {
    let mut scenario = Scenario { duration, ..Scenario::paper() };
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.mechanics = Mechanics::Dyno;
    scenario.schedule.load = Profile::default();
    (scenario.schedule.id, scenario.schedule.speed) = (Profile::default(), speed);
    scenario
}

fn steps(moves: &[(f64, f64)]) -> Profile {
    Profile::new(moves.iter().map(|(at, to)| Ramp { at: *at, to: *to, over: 0.0 }).collect())
}

/// What differs of two angles beyond whole turns, rad.
fn apart(a: f64, b: f64) -> f64 {
    let turns = (a - b) / TAU;
    TAU * (turns - turns.round()).abs()
}

fn angle(recording: &Recording) -> &[f64] {
    recording.columns.theta_e.as_deref().unwrap()
}

/// The vector that acts from row `k + 1` to row `k + 2`: the command of row `k`, in the frame at the middle between those two.
fn acts(recording: &Recording, k: usize) -> AlphaBeta {
    let middle = angle(recording)[k + 1] + 0.5 * recording.columns.omega_e[k + 1] * SAMPLE_PERIOD;
    Dq { d: recording.ud_ref[k], q: recording.uq_ref[k] }.to_alpha_beta(middle)
}

fn recorded(scenario: &Scenario) -> Recording {
    simulate(scenario, 0, || ()).unwrap()
}

/// A drive whose currents move, at a speed at which the rotor turns by 0.05 rad per sample.
fn moving() -> Recording {
    let mut scenario = on_a_dyno(0.05, Profile::constant(125.0));
    scenario.schedule.id = steps(&[(0.01, -4.0), (0.03, 2.0)]);
    scenario.schedule.iq = steps(&[(0.02, 6.0), (0.035, -3.0)]);
    recorded(&scenario)
}

#[test]
fn the_logged_voltage_is_the_mean_of_the_commands_around_its_sample() {
    let recording = moving();
    for k in 0..recording.columns.t.len() - 2 {
        let (before, after) = (acts(&recording, k), acts(&recording, k + 1));
        let mean = AlphaBeta { alpha: 0.5 * (before.alpha + after.alpha), beta: 0.5 * (before.beta + after.beta) };
        let expected = mean.to_dq(angle(&recording)[k + 2]);
        let (d, q) = (recording.columns.ud[k + 2] - expected.d, recording.columns.uq[k + 2] - expected.q);
        assert!(d.hypot(q) < 1e-9, "row {}: {d:e} {q:e} V", k + 2);
    }
}

/// `psi(t_k+2) - psi(t_k+1) = T_s (u - R i)` in the stator: the flux tells which command acted. Over a period the mean of `R i` is that
/// of its ends up to the curvature `T_s^2/12 i''`: 100 V make 2e4 A/s in d, which the rotor's 500 rad/s turns and the winding's 180/s
/// let decay, 1e7 A/s²: 0.01 V.
#[test]
fn the_logged_command_acts_in_the_period_after_the_next_sample() {
    let recording = moving();
    let columns = &recording.columns;
    let current = |k: usize| Dq { d: columns.id[k], q: columns.iq[k] };
    let flux = |k: usize| Dq { d: paper::MOTOR.psi_f + paper::MOTOR.ld * current(k).d, q: paper::MOTOR.lq * current(k).q };
    let mut largest = 0.0_f64;
    for k in 0..columns.t.len() - 2 {
        let u = acts(&recording, k);
        let (from, to) = (k + 1, k + 2);
        let (a, b) = (flux(from).to_alpha_beta(angle(&recording)[from]), flux(to).to_alpha_beta(angle(&recording)[to]));
        let (i, j) = (current(from).to_alpha_beta(angle(&recording)[from]), current(to).to_alpha_beta(angle(&recording)[to]));
        let alpha = (b.alpha - a.alpha) / SAMPLE_PERIOD + 0.5 * paper::MOTOR.rs * (i.alpha + j.alpha) - u.alpha;
        let beta = (b.beta - a.beta) / SAMPLE_PERIOD + 0.5 * paper::MOTOR.rs * (i.beta + j.beta) - u.beta;
        assert!(alpha.hypot(beta) < 0.05, "row {k}: {alpha} {beta} V");
        let Dq { d, q } = Dq { d: recording.ud_ref[k + 1] - recording.ud_ref[k], q: recording.uq_ref[k + 1] - recording.uq_ref[k] };
        largest = largest.max(d.hypot(q));
    }
    // A command of one row earlier or later would be another one by this much.
    assert!(largest > 50.0, "{largest}");
}

/// Up to speed, evenly, at 1e4 rad/s²; then a step. The angle is the integral of the schedule, which the trapezoid gives exactly.
#[test]
fn a_dynamometer_turns_as_its_schedule_says() {
    let moves = vec![
        Ramp { at: 0.0, to: 20.0, over: 0.0 },
        Ramp { at: 0.01, to: 120.0, over: 0.01 },
        Ramp { at: 0.03, to: 60.0, over: 0.0 },
        Ramp { at: 0.04, to: -40.0, over: 0.005 },
    ];
    let scenario = on_a_dyno(0.05, Profile::new(moves));
    let speed = |t: f64| match t {
        t if t < 0.01 => 20.0,
        t if t < 0.02 => 20.0 + 1e4 * (t - 0.01),
        t if t < 0.03 - 1e-12 => 120.0,
        t if t < 0.04 => 60.0,
        t if t < 0.045 => 60.0 - 2e4 * (t - 0.04),
        _ => -40.0,
    };
    let recording = recorded(&scenario);
    for (k, omega_e) in recording.columns.omega_e.iter().enumerate() {
        let now = speed(k as f64 * SAMPLE_PERIOD);
        // The sample that meets the step at 0.03 s still reads the speed before it.
        let read = if k == 300 { 120.0 } else { now };
        assert!((omega_e / 4.0 - read).abs() < 1e-9, "row {k}: {omega_e}");
        let Some(next) = angle(&recording).get(k + 1) else { break };
        // Up to the next row it moves as before; a step comes with its row.
        let end = speed(k as f64 * SAMPLE_PERIOD + 0.999_999 * SAMPLE_PERIOD);
        let turned = 4.0 * 0.5 * (now + end) * SAMPLE_PERIOD;
        assert!(apart(*next, angle(&recording)[k] + turned) < 1e-8, "row {k}: {}", next - angle(&recording)[k] - turned);
    }
}

/// What an encoder that is off by 0.3 rad makes of the true current.
#[test]
fn logged_currents_are_in_the_frame_that_the_drive_believes_in() {
    let mut scenario = on_a_dyno(0.03, Profile::constant(50.0));
    scenario.schedule.iq = Profile::constant(5.0);
    scenario.sensors.angle_offset = 0.3;
    let mut drive = Drive::new(&scenario, 0);
    for k in 0..scenario.rows() {
        let (true_current, true_angle) = (drive.plant().current(), drive.plant().theta_e());
        let row = drive.step().unwrap();
        let expected = true_current.to_alpha_beta(0.0).to_dq(0.3);
        assert!((row.i.d - expected.d).hypot(row.i.q - expected.q) < 1e-9, "row {k}");
        assert!(apart(row.theta_e, true_angle + 0.3) < 1e-9);
    }
    // The believed current has reached its reference: the true one lies 0.3 rad ahead of the true q axis.
    let i = drive.plant().current();
    assert!((i.d + 5.0 * 0.3_f64.sin()).abs() < 0.05 && (i.q - 5.0 * 0.3_f64.cos()).abs() < 0.05, "{i:?}");
}

/// Fluxes with cross saturation that are parabolas along each axis, which a map reproduces exactly. The cross inductances differ, so
/// that exchanging them shows; and with them the derivatives for Newton's method.
fn saturated(i: Dq) -> (Dq, [[f64; 2]; 2]) {
    let Dq { d, q } = i;
    (
        Dq { d: 0.1 + 6e-3 * d - 4e-5 * d * d + 2.5e-3 * q + 3e-5 * d * q, q: 10e-3 * q - 8e-5 * q * q + 0.5e-3 * d + 2e-5 * d * q },
        [[6e-3 - 8e-5 * d + 3e-5 * q, 2.5e-3 + 3e-5 * d], [0.5e-3 + 2e-5 * q, 10e-3 - 16e-5 * q + 2e-5 * d]],
    )
}

/// The current that makes a flux, by Newton's method from a guess nearby.
fn current_of(psi: Dq, guess: Dq) -> Dq {
    (0..20).fold(guess, |i, _| {
        let (found, [[a, b], [c, d]]) = saturated(i);
        let (x, y, determinant) = (psi.d - found.d, psi.q - found.q, a * d - b * c);
        Dq { d: i.d + (d * x - b * y) / determinant, q: i.q + (a * y - c * x) / determinant }
    })
}

/// The same motor with the flux as its state, in the stator, where it has no rotation: `d psi/dt = u - R i`; by the midpoint rule.
#[test]
fn a_cross_saturated_map_moves_as_its_fluxes_do() {
    let grid = [-20.0, -9.0, 0.0, 8.0, 20.0];
    let points: Vec<_> = grid.iter().flat_map(|d| grid.map(|q| Dq { d: *d, q })).map(|i| (i, saturated(i).0)).collect();
    let motor = SimulatedMotor::new(0.6, Magnetics::Map(FluxMap::new(&points).unwrap()), 2);
    let (speed, u_dc) = (100.0, 100.0);
    let mut plant = Plant::new(&motor, Mechanics::Dyno, speed);
    let mut bridge = Bridge::new(Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(u_dc, 5e3) });
    let (mut psi, mut i, mut angle) = (saturated(Dq::default()).0.to_alpha_beta(0.0), Dq::default(), 0.0_f64);
    const PARTS: usize = 100;
    let h = SAMPLE_PERIOD / PARTS as f64;
    let mut largest = 0.0_f64;
    for k in 0..200 {
        // A voltage that turns with the rotor, and swings around what the magnet takes: 20 V at 200 rad/s.
        let (now, swing) = (2.0 * speed * k as f64 * SAMPLE_PERIOD, (0.1 * k as f64).sin());
        let u = Dq { d: 12.0 * swing - 4.0, q: 20.0 + 14.0 * (0.07 * k as f64).sin() }.to_alpha_beta(now);
        assert!(bridge.run(&mut plant, fluxfit_drive::inverter::duties(u, u_dc), 0.0));
        for _ in 0..PARTS {
            let slope = |i: Dq, angle: f64| {
                let i = i.to_alpha_beta(angle);
                AlphaBeta { alpha: u.alpha - motor.rs * i.alpha, beta: u.beta - motor.rs * i.beta }
            };
            let moved = |slope: AlphaBeta, h: f64| AlphaBeta { alpha: psi.alpha + h * slope.alpha, beta: psi.beta + h * slope.beta };
            let half = angle + speed * h;
            let middle = current_of(moved(slope(i, angle), 0.5 * h).to_dq(half), i);
            psi = moved(slope(middle, half), h);
            angle += 2.0 * speed * h;
            i = current_of(psi.to_dq(angle), middle);
        }
        let found = plant.current();
        assert!((found.d - i.d).hypot(found.q - i.q) < 1e-5, "period {k}: {found:?} {i:?}");
        largest = largest.max(i.magnitude());
    }
    assert!(largest > 5.0, "{largest}");
}

/// A motor at rest, and a voltage beside whatever else the controller wants.
fn injected(waveform: Waveform, axis: Axis, frequency: f64, voltage: f64, duration: f64) -> Recording {
    let mut scenario = on_a_dyno(duration, Profile::default());
    scenario.control.current_bandwidth = 20.0;
    scenario.schedule.injection = Some(Injection { axis, waveform, frequency, voltage: Profile::constant(voltage) });
    recorded(&scenario)
}

#[test]
fn a_square_wave_has_equal_halves_at_any_whole_number_of_samples() {
    for frequency in [250, 1000, 2500, 5000] {
        let recording = injected(Waveform::Square, Axis::D, f64::from(frequency), 20.0, 0.5);
        for (k, u) in recording.ud_ref.iter().enumerate() {
            // Half-waves begun since the start, in whole numbers.
            let positive = (2 * frequency as usize * k / 10_000).is_multiple_of(2);
            // The loop answers with 2 alpha L times the current: 252/s times 20 V times 2 ms of a half-wave at most, 10 V.
            assert!((u * if positive { 1.0 } else { -1.0 } - 20.0).abs() < 11.0, "{frequency} Hz, row {k}: {u}");
        }
    }
}

/// Nothing acts before the second period, and the sine begins at zero: three commands without any current are the test voltage alone.
#[test]
fn a_sine_begins_at_zero_and_keeps_to_its_axis() {
    for axis in [Axis::D, Axis::Q] {
        let recording = injected(Waveform::Sine, axis, 500.0, 20.0, 0.01);
        for k in 0..3 {
            let expected = 20.0 * (TAU * 500.0 * k as f64 * SAMPLE_PERIOD).sin();
            let (along, across) = match axis {
                Axis::D => (recording.ud_ref[k], recording.uq_ref[k]),
                Axis::Q => (recording.uq_ref[k], recording.ud_ref[k]),
            };
            assert!((along - expected).abs() < 1e-6 && across.abs() < 1e-6, "row {k}: {along} {across}");
        }
    }
}

/// A square wave of a period longer than the run is a constant disturbance, which the integral takes out: were the test voltage itself
/// integrated, `u / (alpha L)`, 7.6 A, would stay.
#[test]
fn the_test_voltage_is_a_disturbance_to_the_loop_and_no_part_of_its_integral() {
    let recording = injected(Waveform::Square, Axis::D, 1.0, 5.0, 0.2);
    assert!(recording.columns.id.iter().fold(0.0, |most: f64, i| most.max(i.abs())) > 1.0);
    assert!(recording.columns.id[1990].abs() < 1e-3, "{}", recording.columns.id[1990]);
}
