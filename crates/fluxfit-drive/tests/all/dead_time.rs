//! What an identification says of a drive that loses voltage to dead time and devices, which its model does not have.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{Model, Request, Swarm, Verdict, evidence::Identification, identify, motor::Parameter, paper};
use fluxfit_drive::{
    Scenario,
    scenario::{Inverter, Modulation},
    simulate,
};
use std::f64::consts::PI;

fn found(change: impl Fn(&mut Inverter), noise: f64) -> Identification {
    let mut scenario = Scenario::paper();
    change(&mut scenario.inverter);
    scenario.sensors.current_noise = noise;
    identify(
        &simulate(&scenario, 0, || ()).unwrap().log().unwrap(),
        &Request { model: Some(Model::Steady), swarm: Swarm::Off, ..Request::default() },
    )
    .unwrap()
    .identification
}

/// Where the losses show, no parameter is identified whose interval does not hold the truth.
#[test]
fn losses_are_seen_and_no_wrong_number_is_confident() {
    for (name, dead_time, drop, modulation, noise) in [
        ("2 us", 2e-6, 0.0, Modulation::Switched, 0.0),
        ("2 us, noise", 2e-6, 0.0, Modulation::Switched, 0.05),
        ("1 us", 1e-6, 0.0, Modulation::Switched, 0.0),
        ("4 us", 4e-6, 0.0, Modulation::Switched, 0.05),
        ("2 us, averaged", 2e-6, 0.0, Modulation::Averaged, 0.05),
        ("1 V devices", 0.0, 1.0, Modulation::Switched, 0.05),
    ] {
        let change = |inverter: &mut Inverter| {
            *inverter = Inverter { dead_time, switch_drop: drop, diode_drop: drop, modulation, ..*inverter };
        };
        let found = found(change, noise);
        // The square wave's fundamental.
        let expected = 4.0 / PI * (310.0 * dead_time * 5e3 + drop);
        for loss in &found.steady.as_ref().unwrap().voltage_losses {
            assert!((loss / expected - 1.0).abs() < 0.25, "{name}: {loss} V of {expected} V");
        }
        assert!(found.warnings.iter().any(|warning| warning.code() == "dead-time"), "{name}");
        assert_ne!(found.parameter(Parameter::Rs).verdict, Verdict::Identified, "{name}");
        for judgement in &found.parameters {
            let truth = paper::MOTOR.get(judgement.parameter);
            if let Some([low, high]) = judgement.interval() {
                assert!((low..=high).contains(&truth), "{name}: {:?} {low} .. {high}", judgement.parameter);
            }
        }
    }
}

#[test]
fn an_inverter_without_losses_is_not_suspected() {
    for (noise, modulation) in
        [(0.0, Modulation::Switched), (0.0, Modulation::Averaged), (0.05, Modulation::Switched), (0.2, Modulation::Averaged)]
    {
        let found = found(|inverter| inverter.modulation = modulation, noise);
        assert!(
            found.steady.as_ref().unwrap().voltage_losses.iter().all(|loss| *loss == 0.0),
            "{noise} {modulation:?}: {:?}",
            found.steady.as_ref().unwrap().voltage_losses
        );
    }
}
