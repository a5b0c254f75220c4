//! Sensors against formulas.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::frames::{Abc, AlphaBeta, Dq};
use fluxfit_drive::{
    Drive, Scenario,
    inverter::Bridge,
    plant::Plant,
    scenario::{Adc, CurrentSensors, Inverter, Magnetics, Mechanics, Modulation, Sensors, SimulatedMotor},
    schedule::Profile,
    sensors::{Sample, SensorModel},
    simulate,
};
use std::f64::consts::{PI, TAU};

const POLE_PAIRS: u32 = 3;
const SAMPLE_PERIOD: f64 = 1e-4;

fn motor() -> SimulatedMotor {
    SimulatedMotor::new(0.5, Magnetics::Constant { ld: 2e-3, lq: 3e-3, psi_f: 0.05 }, POLE_PAIRS)
}

fn bridge() -> Bridge {
    Bridge::new(Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(100.0, 5e3) })
}

/// A plant whose rotor has turned a little and whose three phases carry different currents.
fn plant_with_current(motor: &SimulatedMotor) -> Plant<'_> {
    let mut plant = Plant::new(motor, Mechanics::Dyno, 50.0);
    let mut bridge = bridge();
    for _ in 0..40 {
        assert!(bridge.run(&mut plant, [0.8, 0.6, 0.3], 0.0));
    }
    plant
}

/// True phase currents, from the plant's own.
fn phases(plant: &Plant) -> [f64; 3] {
    let Abc { a, b, c } = plant.current().to_alpha_beta(plant.theta_e()).to_abc();
    assert!(a.abs() > 1.0 && b.abs() > 1.0 && c.abs() > 1.0 && (a - b).abs() > 1.0, "{a} {b} {c}");
    [a, b, c]
}

fn measured(settings: Sensors, plant: &Plant) -> Sample {
    SensorModel::new(settings, 1, 0, POLE_PAIRS, SAMPLE_PERIOD).measure(plant, &bridge(), 0.0)
}

/// Clarke's transform, written out.
fn clarke([a, b, c]: [f64; 3]) -> AlphaBeta {
    AlphaBeta { alpha: 2.0 / 3.0 * (a - 0.5 * b - 0.5 * c), beta: (b - c) / 3.0_f64.sqrt() }
}

fn assert_close(found: AlphaBeta, expected: AlphaBeta) {
    let off = Dq { d: found.alpha - expected.alpha, q: found.beta - expected.beta }.magnitude();
    assert!(off < 1e-12, "{found:?} instead of {expected:?}");
}

#[test]
fn each_phase_has_its_own_gain_and_offset() {
    let motor = motor();
    let plant = plant_with_current(&motor);
    let [a, b, c] = phases(&plant);
    let (current_gain, current_offset) = ([1.02, 0.95, 1.1], [0.3, -0.2, 0.7]);
    let settings = Sensors { current_gain, current_offset, ..Sensors::IDEAL };
    let (ra, rb, rc) = (1.02 * a + 0.3, 0.95 * b - 0.2, 1.1 * c + 0.7);
    assert_close(measured(settings, &plant).i, clarke([ra, rb, rc]));
    // With two sensors the third phase is minus what the others read, errors included.
    let settings = Sensors { current_sensors: CurrentSensors::Two, ..settings };
    assert_close(measured(settings, &plant).i, clarke([ra, rb, -ra - rb]));
    assert_close(measured(Sensors::IDEAL, &plant).i, clarke([a, b, c]));
}

/// Two's complement: `bits` bits from `-range` to one step less than `range`.
#[test]
fn a_converter_rounds_to_its_step_and_ends_at_its_range() {
    let motor = motor();
    let plant = Plant::new(&motor, Mechanics::Dyno, 0.0);
    let settings = |offset: f64| Sensors { current_offset: [offset, 0.0, 0.0], adc: Some(Adc { bits: 4, range: 8.0 }), ..Sensors::IDEAL };
    // Steps of 16 A / 2^4 = 1 A.
    for (truth, read) in
        [(0.4, 0.0), (0.6, 1.0), (-2.7, -3.0), (6.6, 7.0), (7.4, 7.0), (7.9, 7.0), (50.0, 7.0), (-7.6, -8.0), (-50.0, -8.0)]
    {
        assert_close(measured(settings(truth), &plant).i, clarke([read, 0.0, 0.0]));
    }
}

#[test]
fn the_angle_is_too_large_by_its_offset_and_wraps() {
    let motor = motor();
    let mut plant = Plant::new(&motor, Mechanics::Dyno, 100.0);
    let mut bridge = bridge();
    for _ in 0..400 {
        let truth = plant.theta_e();
        for offset in [0.0, 0.2, -0.7] {
            let found = measured(Sensors { angle_offset: offset, ..Sensors::IDEAL }, &plant);
            let off = (found.theta_e - truth - offset) / TAU;
            assert!(found.theta_e.abs() <= PI && (off - off.round()).abs() < 1e-12, "{off}");
            assert_eq!(found.omega_e, 300.0);
        }
        assert!(bridge.run(&mut plant, [0.5; 3], 0.0));
    }
    assert!(plant.theta_e() > TAU);
}

/// The middle of the encoder's step; within it, the reading stands still.
#[test]
fn an_encoder_reads_the_middle_of_its_step() {
    let motor = motor();
    let mut plant = Plant::new(&motor, Mechanics::Dyno, 20.0);
    let mut bridge = bridge();
    for steps in [64, 1000] {
        for _ in 0..500 {
            let mechanical = plant.theta_e() / f64::from(POLE_PAIRS);
            let step = TAU / f64::from(steps);
            // How many whole steps have passed; half a step more is the middle.
            let expected = f64::from(POLE_PAIRS) * step * (0.5 + (mechanical / step).floor());
            let found = measured(Sensors { encoder_steps: Some(steps), ..Sensors::IDEAL }, &plant).theta_e;
            let off = (found - expected) / TAU;
            assert!((off - off.round()).abs() < 1e-9, "{steps}: {found} {expected}");
            assert!(bridge.run(&mut plant, [0.5; 3], 0.0));
        }
    }
}

/// The observer is of second order with a double pole at `-w`, `w` its bandwidth of 100 Hz. A step of the speed by `D` passes into it as
/// `1 - (1 + w t) e^(-w t)`, once the encoder is fine enough.
#[test]
fn the_speed_of_an_encoder_follows_with_the_observers_double_pole() {
    let motor = motor();
    let mut plant = Plant::new(&motor, Mechanics::Dyno, 50.0);
    let sample_period = 1e-5;
    let mut bridge = Bridge::new(Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(100.0, 0.5 / sample_period) });
    let settings = Sensors { encoder_steps: Some(1 << 24), ..Sensors::IDEAL };
    let mut instruments = SensorModel::new(settings, 1, 0, POLE_PAIRS, sample_period);
    for k in 0..1000 {
        let found = instruments.measure(&plant, &bridge, 0.0).omega_e / f64::from(POLE_PAIRS);
        if k == 0 {
            assert_eq!(found, 50.0);
            plant.set_omega_m(60.0);
        }
        let wt = TAU * 100.0 * k as f64 * sample_period;
        let expected = 50.0 + 10.0 * (1.0 - (1.0 + wt) * (-wt).exp());
        // Sampling shifts it by about a sample, 0.6 % of the time constant; the step's steepest slope is 1/e.
        assert!((found - expected).abs() < 0.05, "sample {k}: {found} {expected}");
        assert!(bridge.run(&mut plant, [0.5; 3], 0.0));
    }
}

/// Late by 40 us at 300 rad/s: 12 mrad behind, whatever the sampling.
#[test]
fn a_late_angle_is_behind_by_the_speed_times_its_delay() {
    let motor = motor();
    for speed in [100.0, -100.0] {
        let plant = Plant::new(&motor, Mechanics::Dyno, speed);
        let found = measured(Sensors { angle_delay: 40e-6, ..Sensors::IDEAL }, &plant);
        assert!((found.theta_e + 3.0 * speed * 40e-6).abs() < 1e-15, "{}", found.theta_e);
        assert_eq!(found.omega_e, 3.0 * speed);
    }
}

/// The drive controls and logs the currents in the late frame: the true ones are turned back by `omega_e tau`.
#[test]
fn a_late_angle_turns_currents_by_the_speed_times_its_delay() {
    let mut scenario = Scenario { duration: 0.3, ..Scenario::paper() };
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.mechanics = Mechanics::Dyno;
    (scenario.schedule.speed, scenario.schedule.load) = (Profile::constant(100.0), Profile::default());
    (scenario.schedule.id, scenario.schedule.iq) = (Profile::constant(-2.0), Profile::constant(6.0));
    scenario.sensors.angle_delay = 200e-6;
    let mut drive = Drive::new(&scenario, 0);
    let (mut before, mut logged) = (Dq::default(), Dq::default());
    for _ in 0..scenario.rows() {
        before = drive.plant().current();
        logged = drive.step().unwrap().i;
    }
    let (sin, cos) = (400.0_f64 * 200e-6).sin_cos();
    for (found, expected) in [(before.d, cos * logged.d + sin * logged.q), (before.q, cos * logged.q - sin * logged.d)] {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    assert!((logged.d + 2.0).abs() < 1e-6 && (logged.q - 6.0).abs() < 1e-6, "{logged:?}");
}

/// The drive takes its duty ratios from the DC voltage that it measures: it logs voltages that are too large by the gain.
#[test]
fn voltages_are_logged_with_the_gain_of_the_dc_voltage() {
    let last_row = |u_dc_gain: f64| {
        let mut scenario = Scenario { duration: 0.3, ..Scenario::paper() };
        scenario.inverter.modulation = Modulation::Averaged;
        scenario.mechanics = Mechanics::Dyno;
        (scenario.schedule.speed, scenario.schedule.load) = (Profile::constant(50.0), Profile::default());
        (scenario.schedule.id, scenario.schedule.iq) = (Profile::constant(-2.0), Profile::constant(6.0));
        scenario.sensors.u_dc_gain = u_dc_gain;
        let log = simulate(&scenario, 0, || ()).unwrap().columns;
        [log.ud[3000], log.uq[3000], log.u_dc.unwrap()[3000]]
    };
    for (found, truth) in last_row(1.03).into_iter().zip(last_row(1.0)) {
        assert!((found / truth - 1.03).abs() < 1e-6, "{found} {truth}");
    }
}
