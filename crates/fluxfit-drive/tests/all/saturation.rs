//! What an identification says of a motor that saturates: a measured flux map on a simulated test bench.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use fluxfit::{
    Known, Model, Request, evidence::Identification, frames::Dq, identify, motor::Parameter, objective::acting_voltage::VoltageTiming,
};
use fluxfit_drive::{
    FluxMap, Scenario,
    scenario::{Control, Inverter, Magnetics, Mechanics, Modulation, Schedule, SimulatedMotor},
    schedule::{Profile, Ramp},
    simulate,
};
use std::{f64::consts::TAU, path::Path};

const RS: f64 = 0.63;

/// Currents of `examples/scenarios/pm_syrm.toml`, A.
const POINTS: [(f64, f64); 5] = [(0.0, 4.0), (-4.0, 8.0), (-8.0, 12.0), (-12.0, 16.0), (-4.0, 16.0)];

/// The Baldor motor, measured.
fn map() -> FluxMap {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenarios/baldor_ecs101_flux_map.csv");
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (Dq { d: cells[0], q: cells[1] }, Dq { d: cells[2], q: cells[3] })
    };
    FluxMap::new(&std::fs::read_to_string(path).unwrap().lines().skip(1).map(row).collect::<Vec<_>>()).unwrap()
}

/// It, at 900 r/min through these currents, each held so long, s.
fn bench(points: &[(f64, f64)], hold: f64, carrier: f64, settings: &Request) -> Identification {
    let steps = |axis: fn(&(f64, f64)) -> f64| {
        Profile::new(points.iter().enumerate().map(|(k, point)| Ramp { at: k as f64 * hold, to: axis(point), over: 0.0 }).collect())
    };
    let mut scenario = Scenario {
        duration: points.len() as f64 * hold,
        motor: SimulatedMotor::new(RS, Magnetics::Map(map()), 2),
        mechanics: Mechanics::Dyno,
        inverter: Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(540.0, carrier) },
        control: Control::new(40.0, 1.0, 25.0),
        schedule: Schedule {
            id: steps(|point| point.0),
            iq: steps(|point| point.1),
            speed: Profile::constant(900.0 * TAU / 60.0),
            ..Schedule::default()
        },
        ..Scenario::paper()
    };
    scenario.sensors.current_noise = 0.05;
    identify(&simulate(&scenario, 0, || ()).unwrap().log().unwrap(), settings).unwrap().identification
}

fn warns(found: &Identification, code: &str) -> bool {
    found.warnings.iter().any(|warning| warning.code() == code)
}

/// No parameter is answered whose interval misses what the map says: R_s, the apparent inductances of every point, the flux without
/// current.
fn nothing_is_confidently_wrong(found: &Identification, points: &[(f64, f64)]) {
    let map = map();
    let psi = |d: f64, q: f64| map.at(Dq { d, q }).unwrap().psi;
    let psi_f = psi(0.0, 0.0).d;
    for judgement in found.parameters.iter() {
        let Some([low, high]) = judgement.interval() else { continue };
        let truths: Vec<f64> = match judgement.parameter {
            Parameter::Rs => vec![RS],
            Parameter::PsiF => vec![psi_f],
            Parameter::Lq => points.iter().map(|(d, q)| psi(*d, *q).q / q).collect(),
            Parameter::Ld => points.iter().filter(|(d, _)| *d != 0.0).map(|(d, q)| (psi(*d, *q).d - psi_f) / d).collect(),
        };
        assert!(truths.iter().all(|truth| (low..=high).contains(truth)), "{:?}: {low} .. {high}, {truths:?}", judgement.parameter);
    }
}

/// Flux by the point, against the map at the currents of the point.
fn flux_is_the_maps(found: &Identification, part: f64) {
    let fluxes = &found.saturation.as_ref().unwrap().fluxes;
    assert!(fluxes.len() >= 3 && fluxes.iter().all(Option::is_some));
    for flux in fluxes.iter().flatten() {
        let truth = map().at(flux.current).unwrap().psi;
        let error = (flux.psi.d - truth.d).hypot(flux.psi.q - truth.q) / truth.magnitude();
        println!("i {:?}: flux {:.4} % off", flux.current, 100.0 * error);
        assert!(error < part, "{flux:?} {truth:?}");
    }
}

fn settings(model: Option<Model>, fix_rs: bool) -> Request {
    let mut settings = Request { model, voltage_timing: Some(VoltageTiming::Centered), ..Request::default() };
    if fix_rs {
        settings.known[Parameter::Rs as usize] = Known::Fixed(RS);
    }
    settings
}

#[test]
fn operating_points_of_a_saturating_motor() {
    for points in [&POINTS[..], &POINTS[..3], &POINTS[1..4], &POINTS[2..]] {
        for fix_rs in [false, true] {
            let found = bench(points, 0.3, 5e3, &settings(Some(Model::Steady), fix_rs));
            let verdicts = found.parameters.each_ref().map(|judgement| (judgement.raw, judgement.verdict.key()));
            println!(
                "{} points, R_s fixed {fix_rs}: {verdicts:?} {:?}",
                points.len(),
                found.saturation.as_ref().map(|s| (s.rs, s.rs_uncertainty))
            );
            assert!(warns(&found, "saturation"), "{points:?} {fix_rs}");
            nothing_is_confidently_wrong(&found, points);
            if fix_rs {
                flux_is_the_maps(&found, 2e-3);
            }
        }
    }
}

/// Two operating points fit perfectly, and prove nothing.
#[test]
fn two_operating_points_say_that_they_prove_nothing() {
    let found = bench(&POINTS[1..3], 0.3, 5e3, &settings(Some(Model::Steady), false));
    assert!(warns(&found, "no-redundancy"));
}

/// The same as simulated currents, which the model prefers for such a log.
#[test]
fn simulated_currents_of_a_saturating_motor() {
    for fix_rs in [false, true] {
        let found = bench(&POINTS, 0.12, 2e3, &settings(None, fix_rs));
        assert_eq!(found.model.model, Model::OutputError);
        let verdicts = found.parameters.each_ref().map(|judgement| (judgement.raw, judgement.verdict.key()));
        println!("R_s fixed {fix_rs}: {verdicts:?} {:?}", found.output.as_ref().unwrap().fault_estimates);
        assert!(warns(&found, "saturation"), "{fix_rs}");
        nothing_is_confidently_wrong(&found, &POINTS);
        if fix_rs {
            flux_is_the_maps(&found, 2e-3);
        }
    }
}

/// The paper's motor on the same bench: constant parameters raise no alarm, in either model.
#[test]
fn constant_parameters_raise_no_alarm() {
    let moves = |values: [f64; 4]| {
        Profile::new(values.iter().enumerate().map(|(k, to)| Ramp { at: 0.15 * k as f64, to: *to, over: 0.0 }).collect())
    };
    for (model, draws) in [(Some(Model::Steady), 10), (None, 1)] {
        for draw in 0..draws {
            let mut scenario = Scenario { duration: 0.6, mechanics: Mechanics::Dyno, ..Scenario::paper() };
            scenario.inverter = Inverter { modulation: Modulation::Averaged, ..Inverter::ideal(310.0, 2e3) };
            scenario.control = Control::new(100.0, 1.0, 20.0);
            scenario.schedule = Schedule {
                id: moves([0.0, -2.0, -4.0, 0.0]),
                iq: moves([3.0, 6.0, 9.0, 12.0]),
                speed: Profile::constant(1000.0 * TAU / 60.0),
                ..Schedule::default()
            };
            scenario.sensors.current_noise = 0.05;
            let log = simulate(&scenario, draw, || ()).unwrap().log().unwrap();
            let found = identify(&log, &settings(model, false)).unwrap().identification;
            assert_eq!(found.saturation, None, "{model:?} {draw}");
            for code in ["saturation", "low-speed", "voltage-limit"] {
                assert!(!warns(&found, code), "{model:?} {draw}: {code}");
            }
        }
    }
}
