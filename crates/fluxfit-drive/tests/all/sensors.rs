//! Sensors against formulas.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::frames::{Abc, AlphaBeta, Dq};
use fluxfit_drive::{
    inverter::Bridge,
    plant::Plant,
    scenario::{Adc, CurrentSensors, Inverter, Magnetics, Mechanics, Modulation, Sensors, SimulatedMotor},
    sensors::{Sample, SensorModel},
};
use std::f64::consts::{PI, TAU};

const POLE_PAIRS: u32 = 3;
const SAMPLE_PERIOD: f64 = 1e-4;

fn motor() -> SimulatedMotor {
    SimulatedMotor { rs: 0.5, magnetics: Magnetics::Constant { ld: 2e-3, lq: 3e-3, psi_f: 0.05 }, pole_pairs: POLE_PAIRS }
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
