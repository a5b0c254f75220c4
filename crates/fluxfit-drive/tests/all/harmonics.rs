//! Harmonics of the magnets' flux and a resistance that drifts, against formulas.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    frames::{AlphaBeta, Dq},
    paper,
};
use fluxfit_drive::{
    Drive, FluxMap, Scenario,
    plant::Plant,
    scenario::{Harmonics, Magnetics, Mechanics, Modulation, SimulatedMotor},
    schedule::Profile,
    simulate,
};
use std::f64::consts::TAU;

const HARMONICS: Harmonics = Harmonics { fifth: 0.03, seventh: -0.02 };
const RS: f64 = 0.5;
const L: f64 = 2e-3;
const PSI_F: f64 = 0.05;
/// Electrical, rad/s.
const SPEED: f64 = 300.0;

/// Without saliency the stator is a resistance and an inductance in series, whatever the rotor's angle.
fn motor(magnetics: Magnetics) -> SimulatedMotor {
    SimulatedMotor { harmonics: HARMONICS, ..SimulatedMotor::new(RS, magnetics, 3) }
}

/// The same motor as a flux map.
fn map() -> Magnetics {
    let currents = [-40.0, -10.0, 0.0, 10.0, 40.0];
    let points: Vec<_> = currents.iter().flat_map(|d| currents.map(|q| (Dq { d: *d, q }, Dq { d: PSI_F + L * d, q: L * q }))).collect();
    Magnetics::Map(FluxMap::new(&points).unwrap())
}

/// Amplitude of the part of the stator currents that turns `order` times as fast as the rotor, over whole turns.
fn amplitude(samples: &[(f64, AlphaBeta)], order: f64) -> f64 {
    let (re, im) = samples.iter().fold((0.0, 0.0), |(re, im), (theta_e, i)| {
        let (sin, cos) = (order * theta_e).sin_cos();
        (re + i.alpha * cos + i.beta * sin, im + i.beta * cos - i.alpha * sin)
    });
    f64::hypot(re, im) / samples.len() as f64
}

/// Terminals shorted and rotor driven, the stator's currents are the induced voltages over the impedances at their frequencies:
/// `n omega psi_f a_n / |R + j n omega L|`; the 5th turns backwards.
#[test]
fn short_circuit_currents_are_those_of_the_induced_harmonics() {
    for magnetics in [Magnetics::Constant { ld: L, lq: L, psi_f: PSI_F }, map()] {
        let motor = motor(magnetics);
        let mut plant = Plant::new(&motor, Mechanics::Dyno, SPEED / 3.0);
        // 600 samples per turn, each a whole number of steps.
        let interval = TAU / SPEED / 600.0;
        let mut samples = Vec::new();
        // The winding's transient has gone down to e^(-42) after eight turns.
        for k in 0..9 * 600 {
            plant.begin_period();
            let steps = plant.steps(interval);
            for _ in 0..steps {
                assert!(plant.step(AlphaBeta { alpha: 0.0, beta: 0.0 }, interval / steps as f64));
            }
            if k >= 8 * 600 {
                samples.push((plant.theta_e(), plant.current().to_alpha_beta(plant.theta_e())));
            }
        }
        for (order, part) in [(1.0, 1.0), (-5.0, HARMONICS.fifth), (7.0, HARMONICS.seventh), (5.0, 0.0), (-7.0, 0.0)] {
            let induced = f64::abs(order * SPEED * PSI_F * part);
            let expected = induced / RS.hypot(order * SPEED * L);
            let found = amplitude(&samples, order);
            assert!((found - expected).abs() < 1e-6, "order {order}: {found} A instead of {expected} A");
        }
    }
}

/// The torque takes from the rotor what the induced voltage gives to the currents: electrical energy is copper loss, mechanical energy
/// and the field of the inductances.
#[test]
fn energy_balances_with_harmonics() {
    let mut scenario = Scenario::paper();
    scenario.motor.harmonics = HARMONICS;
    let mut drive = Drive::new(&scenario, 0);
    for _ in 0..scenario.rows() {
        drive.step().unwrap();
    }
    let (energies, i) = (drive.plant().energies(), drive.plant().current());
    let field = 0.75 * (paper::MOTOR.ld * i.d * i.d + paper::MOTOR.lq * i.q * i.q);
    let missing = (energies.electrical - energies.copper - energies.mechanical - field) / energies.electrical;
    assert!(missing.abs() < 1e-9, "{missing:e}");
}

/// At standstill the voltage is that of the resistance, which grows by a fifth until the end.
#[test]
fn the_resistance_drifts_linearly() {
    let mut scenario = Scenario::paper();
    scenario.motor.rs_drift = 0.2;
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.mechanics = Mechanics::Dyno;
    (scenario.schedule.speed, scenario.schedule.load) = (Profile::default(), Profile::default());
    (scenario.schedule.id, scenario.schedule.iq) = (Profile::default(), Profile::constant(5.0));
    let log = simulate(&scenario, 0, || ()).unwrap().columns;
    for row in [3000, 6000, 9000] {
        let expected = paper::MOTOR.rs * (1.0 + 0.2 * log.t[row] / scenario.duration);
        let found = log.uq[row] / log.iq[row];
        // The current follows the drift at the bandwidth of its controller.
        assert!((found / expected - 1.0).abs() < 1e-4, "row {row}: {found} {expected}");
    }
}
