//! Laws that hold for any simulated drive.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{frames::Dq, paper};
use fluxfit_drive::{
    Drive, Error, FluxMap, Scenario,
    inverter::Bridge,
    plant::Plant,
    scenario::{Adc, Axis, CurrentSensors, Injection, Inverter, Magnetics, Mechanics, Modulation, Sensors, Update, Waveform},
    schedule::{Profile, Ramp},
    sensors::SensorModel,
    simulate,
};
use std::f64::consts::TAU;

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// Electrical in = copper + mechanical + stored in the field; mechanical = stored in the rotor + load.
#[test]
fn energy_balances() {
    for modulation in [Modulation::Averaged, Modulation::Switched] {
        let mut scenario = Scenario::paper();
        scenario.inverter.modulation = modulation;
        scenario.mechanics = Mechanics::Free { inertia: paper::INERTIA, friction: 0.0 };
        let mut drive = Drive::new(&scenario, 0);
        let (mut into_load, mut theta) = (0.0, 0.0);
        for _ in 0..scenario.rows() {
            drive.step().unwrap();
            let turned = (drive.plant().theta_e() - theta) / f64::from(paper::POLE_PAIRS);
            theta = drive.plant().theta_e();
            into_load += drive.plant().load * turned;
        }
        let (energies, i) = (drive.plant().energies(), drive.plant().current());
        let field = 0.75 * (paper::MOTOR.ld * i.d * i.d + paper::MOTOR.lq * i.q * i.q);
        let rotor = 0.5 * paper::INERTIA * drive.plant().omega_m().powi(2);
        let electrical = (energies.electrical - energies.copper - energies.mechanical - field) / energies.electrical;
        let mechanical = (energies.mechanical - rotor - into_load) / energies.electrical;
        println!(
            "{modulation:?}: {:.1} J in; missing {electrical:.1e} of it at the terminals, {mechanical:.1e} at the shaft",
            energies.electrical
        );
        assert!(electrical.abs() < 1e-9 && mechanical.abs() < 1e-9);
    }
}

#[test]
fn a_linear_flux_map_is_the_constant_motor() {
    let constant = Scenario { duration: 0.3, ..Scenario::paper() };
    let currents = [-30.0, -11.0, 0.0, 4.0, 30.0];
    let points: Vec<_> = currents
        .iter()
        .flat_map(|d| currents.map(|q| Dq { d: *d, q }))
        .map(|i| (i, Dq { d: paper::MOTOR.ld * i.d + paper::MOTOR.psi_f, q: paper::MOTOR.lq * i.q }))
        .collect();
    let mut mapped = constant.clone();
    mapped.motor.magnetics = Magnetics::Map(FluxMap::new(&points).unwrap());
    let (constant, mapped) = (simulate(&constant, 0, || ()).unwrap(), simulate(&mapped, 0, || ()).unwrap());
    for ((name, a), (_, b)) in constant.named().into_iter().zip(mapped.named()) {
        let worst = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Angles wrap: one that rounds to the other side of pi is the same angle.
        let worst = if name == "theta_e" { worst.min((worst - TAU).abs()) } else { worst };
        assert!(worst < 1e-8, "{name}: {worst:e}");
    }
}

#[test]
fn the_same_seed_and_draw_give_the_same_bits_on_any_thread() {
    let mut scenario = Scenario { duration: 0.05, ..Scenario::paper() };
    scenario.sensors.current_noise = 0.05;
    let here = simulate(&scenario, 3, || ()).unwrap();
    let elsewhere = std::thread::scope(|scope| scope.spawn(|| simulate(&scenario, 3, || ()).unwrap()).join().unwrap());
    assert_eq!(here, elsewhere);
    assert_ne!(here, simulate(&scenario, 4, || ()).unwrap());
    assert_ne!(here, simulate(&Scenario { seed: 2, ..scenario.clone() }, 3, || ()).unwrap());
}

/// Dead time takes `4/pi U_dc T_dead f_carrier` from the voltage along the current, as resistance would at that current; here seen
/// by what the controller has to add to hold the same currents. The inverter that is only averaged agrees.
#[test]
fn dead_time_costs_the_voltage_that_the_formula_says() {
    let (u_dc, carrier, dead_time) = (310.0, 5e3, 3e-6);
    let along_current = |modulation, dead_time| {
        let mut scenario = Scenario::paper();
        scenario.inverter = Inverter { modulation, dead_time, ..scenario.inverter };
        let recording = simulate(&scenario, 0, || ()).unwrap();
        let rows = 5000..5990;
        mean(&recording.columns.uq[rows.clone()]) - paper::MOTOR.rs * mean(&recording.columns.iq[rows])
    };
    let expected = 4.0 / std::f64::consts::PI * u_dc * dead_time * carrier;
    for modulation in [Modulation::Averaged, Modulation::Switched] {
        let cost = along_current(modulation, dead_time) - along_current(modulation, 0.0);
        println!("{modulation:?}: {cost:.4} V, formula {expected:.4} V");
        // The current is no pure sine, and around its zeros the ripple has both signs.
        assert!((cost / expected - 1.0).abs() < 0.03, "{modulation:?}: {cost} V instead of {expected} V");
    }
}

#[test]
fn devices_drop_their_voltage_along_the_current() {
    // All devices alike: a drop of V against the current in each phase, 4/pi V along the current.
    let drop = 1.5;
    let along = |drop: f64| {
        let mut scenario = Scenario::paper();
        scenario.inverter = Inverter { switch_drop: drop, diode_drop: drop, ..scenario.inverter };
        mean(&simulate(&scenario, 0, || ()).unwrap().columns.uq[5000..5990])
    };
    let expected = 4.0 / std::f64::consts::PI * drop;
    assert!(((along(drop) - along(0.0)) / expected - 1.0).abs() < 0.02);
}

#[test]
fn sensor_noise_is_white_and_of_the_size_asked_for() {
    let motor = Scenario::paper().motor;
    let plant = Plant::new(&motor, Mechanics::Dyno, 10.0);
    let bridge = Bridge::new(Inverter::ideal(310.0, 5e3));
    // Clarke's transform of three equal noises: sqrt(2/3) in both axes; of two, a stays a, and beta = (a + 2 b) / sqrt(3).
    let third = (2.0_f64 / 3.0).sqrt();
    for (current_sensors, alpha, beta) in [(CurrentSensors::Three, third, third), (CurrentSensors::Two, 1.0, (5.0_f64 / 3.0).sqrt())] {
        let settings = Sensors { current_sensors, current_noise: 0.1, ..Sensors::IDEAL };
        let mut instruments = SensorModel::new(settings, 7, 0, 4, 1e-4);
        let samples: Vec<_> = (0..20_000).map(|_| instruments.measure(&plant, &bridge, 0.0).i).collect();
        let found = [samples.iter().map(|i| i.alpha).collect::<Vec<_>>(), samples.iter().map(|i| i.beta).collect()];
        for (axis, expected) in found.iter().zip([alpha, beta]) {
            // The standard error of a standard deviation is 1/sqrt(2 n) of it, 0.5 %; four of them.
            assert!((deviation(axis) / (0.1 * expected) - 1.0).abs() < 0.02, "{current_sensors:?}");
            assert!(mean(axis).abs() < 4.0 * 0.1 * expected / 20_000.0_f64.sqrt());
        }
    }
}

#[test]
fn a_converter_reads_its_steps_and_its_range() {
    let mut scenario = Scenario { duration: 0.4, ..Scenario::paper() };
    scenario.sensors.adc = Some(Adc { bits: 12, range: 20.0 });
    let recording = simulate(&scenario, 0, || ()).unwrap();
    // Phase a alone, at rotor angles: alpha = a when the three sum to zero, up to the steps of b and c.
    let step = 20.0 / 2048.0;
    let angle = recording.columns.theta_e.as_deref().unwrap();
    for (k, theta_e) in angle.iter().enumerate() {
        let i = Dq { d: recording.columns.id[k], q: recording.columns.iq[k] }.to_alpha_beta(*theta_e);
        // beta = (b - c) / sqrt(3): a whole number of steps.
        let steps = i.beta * 3.0_f64.sqrt() / step;
        assert!((steps - steps.round()).abs() < 1e-6, "row {k}: {steps}");
    }
}

#[test]
fn an_encoder_of_steps_still_tells_speed_and_angle() {
    let mut scenario = Scenario { duration: 0.6, ..Scenario::paper() };
    scenario.sensors.encoder_steps = Some(4096);
    scenario.sensors.angle_offset = 3.0_f64.to_radians();
    let recording = simulate(&scenario, 0, || ()).unwrap();
    let speed = &recording.columns.omega_e[5000..];
    let asked = paper::SPEED_RPM * TAU / 60.0 * 4.0;
    assert!((mean(speed) / asked - 1.0).abs() < 1e-3 && deviation(speed) < 0.01 * asked, "{} {}", mean(speed), deviation(speed));
    // Three degrees too far: the drive's i_d = 0 is not the motor's. i_q looks smaller by the cosine, and torque needs the same.
    let expected = (paper::LOAD + paper::FRICTION * asked / 4.0) / (6.0 * paper::MOTOR.psi_f);
    let iq = mean(&recording.columns.iq[5000..]);
    assert!((iq / expected - 1.0).abs() < 0.02 && iq != expected, "{iq} {expected}");
}

#[test]
fn a_weaker_field_reaches_the_speed_that_the_voltage_alone_does_not() {
    let mut scenario = Scenario::paper();
    scenario.duration = 1.2;
    scenario.inverter.u_dc = 120.0;
    scenario.schedule.id = Profile::default();
    scenario.schedule.load = Profile::new(vec![Ramp { at: 0.5, to: 2.0, over: 0.0 }]);
    scenario.schedule.speed = Profile::new(vec![Ramp { at: 0.0, to: 1000.0 * TAU / 60.0, over: 0.3 }]);
    let refused = simulate(&scenario, 0, || ()).unwrap_err();
    assert!(matches!(refused, Error::VoltageLimit { .. }), "{refused}");
    scenario.control.field_weakening = true;
    let recording = simulate(&scenario, 0, || ()).unwrap();
    let rows = 10_000..12_000;
    let speed = mean(&recording.columns.omega_e[rows.clone()]) / 4.0 * 60.0 / TAU;
    let voltage = mean(&recording.columns.ud[rows.clone()]).hypot(mean(&recording.columns.uq[rows.clone()]));
    assert!((speed - 1000.0).abs() < 1.0 && mean(&recording.columns.id[rows]) < -1.0, "{speed}");
    assert!((voltage / (120.0 / 3.0_f64.sqrt()) - 0.95).abs() < 0.01, "{voltage}");
}

#[test]
fn a_dynamometer_holds_its_speed_and_currents_follow_their_schedule() {
    let mut scenario = Scenario::paper();
    scenario.duration = 0.5;
    scenario.mechanics = Mechanics::Dyno;
    scenario.schedule.load = Profile::default();
    scenario.schedule.speed = Profile::constant(100.0);
    scenario.schedule.id = Profile::constant(-3.0);
    scenario.schedule.iq = Profile::constant(5.0);
    scenario.schedule.injection = Some(Injection {
        axis: Axis::D,
        waveform: Waveform::Square,
        frequency: 250.0,
        voltage: Profile::new(vec![Ramp { at: 0.3, to: 5.0, over: 0.0 }]),
    });
    let recording = simulate(&scenario, 0, || ()).unwrap();
    assert!(recording.columns.omega_e.iter().all(|omega| *omega == 400.0));
    let (id, iq) = (&recording.columns.id, &recording.columns.iq);
    assert!((mean(&id[2000..3000]) + 3.0).abs() < 1e-3 && (mean(&iq[2000..3000]) - 5.0).abs() < 1e-3);
    assert!(deviation(&id[2000..3000]) < 0.02 && deviation(&id[3500..]) > 0.2, "{} {}", deviation(&id[2000..3000]), deviation(&id[3500..]));
}

#[test]
fn ripple_of_the_dc_voltage_is_logged_and_survived() {
    let mut scenario = Scenario { duration: 0.5, ..Scenario::paper() };
    scenario.control.current_bandwidth = 150.0;
    scenario.inverter = Inverter { ripple: 10.0, ripple_frequency: 300.0, update: Update::Single, ..scenario.inverter };
    let recording = simulate(&scenario, 0, || ()).unwrap();
    assert_eq!(recording.columns.t[1], 2e-4);
    assert!((deviation(recording.columns.u_dc.as_deref().unwrap()) / (10.0 / 2.0_f64.sqrt()) - 1.0).abs() < 0.01);
    assert!((mean(&recording.columns.iq[2200..]) - 9.886).abs() < 0.01);
}
