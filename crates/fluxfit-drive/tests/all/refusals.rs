//! What no drive has and what no drive can do: one change of the paper's rig per row, and the refusal that must follow.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::frames::Dq;
use fluxfit_drive::{
    Drive, Error, FluxMap, Scenario,
    scenario::{Adc, Axis, Injection, Magnetics, Mechanics, Update, Waveform},
    schedule::{Profile, Ramp},
    simulate,
};
use std::f64::consts::{PI, TAU};

type Change = fn(&mut Scenario);

fn changed(change: Change) -> Scenario {
    let mut scenario = Scenario::paper();
    change(&mut scenario);
    scenario
}

fn refused(change: Change) -> Error {
    changed(change).check().unwrap_err()
}

fn free(s: &mut Scenario, inertia: f64, friction: f64) {
    s.mechanics = Mechanics::Free { inertia, friction };
}

fn motor(s: &mut Scenario, ld: f64, lq: f64, psi_f: f64) {
    s.motor.magnetics = Magnetics::Constant { ld, lq, psi_f };
}

/// On a dynamometer at a speed, mechanical rad/s, without current.
fn dyno(s: &mut Scenario, speed: f64) {
    s.mechanics = Mechanics::Dyno;
    s.schedule.id = Profile::default();
    s.schedule.load = Profile::default();
    s.schedule.speed = Profile::constant(speed);
}

fn inject(s: &mut Scenario, frequency: f64, voltage: f64) {
    let voltage = Profile::constant(voltage);
    s.schedule.injection = Some(Injection { axis: Axis::D, waveform: Waveform::Sine, frequency, voltage });
}

fn at(at: f64, to: f64, over: f64) -> Profile {
    Profile::new(vec![Ramp { at, to, over }])
}

#[test]
fn every_number_out_of_its_range_is_refused_with_its_key() {
    let rows: &[(&str, &[Change])] = &[
        ("duration", &[|s| s.duration = 0.0, |s| s.duration = f64::INFINITY, |s| s.duration = 1e9, |s| s.duration = 0.5e-4]),
        ("motor.rs", &[|s| s.motor.rs = 0.0, |s| s.motor.rs = f64::NAN]),
        ("motor.rs_drift", &[|s| s.motor.rs_drift = -1.0, |s| s.motor.rs_drift = f64::NAN]),
        ("motor.flux_harmonics", &[|s| s.motor.harmonics.fifth = 0.21, |s| s.motor.harmonics.seventh = f64::NAN]),
        ("motor.ld", &[|s| motor(s, 0.0, 1e-2, 0.1)]),
        ("motor.lq", &[|s| motor(s, 5e-3, -1e-2, 0.1)]),
        ("motor.psi_f", &[|s| motor(s, 5e-3, 1e-2, -0.1), |s| motor(s, 5e-3, 1e-2, f64::NAN)]),
        ("motor.pole_pairs", &[|s| s.motor.pole_pairs = 0]),
        ("mechanics.inertia", &[|s| free(s, 0.0, 0.0), |s| free(s, f64::INFINITY, 0.0)]),
        ("mechanics.friction", &[|s| free(s, 1e-3, -1e-3)]),
        ("inverter.u_dc", &[|s| s.inverter.u_dc = 0.0]),
        ("inverter.ripple", &[|s| s.inverter.ripple = -1.0, |s| s.inverter.ripple = 310.0]),
        // At most the sample rate of 10 kHz.
        ("inverter.ripple_frequency", &[|s| s.inverter.ripple_frequency = -1.0, |s| s.inverter.ripple_frequency = 10_001.0]),
        ("inverter.carrier", &[|s| s.inverter.carrier = 0.0, |s| s.inverter.carrier = 50.0]),
        // A quarter of the carrier's period is 50 us.
        ("inverter.dead_time", &[|s| s.inverter.dead_time = -1e-6, |s| s.inverter.dead_time = 50e-6]),
        ("inverter.switch_drop", &[|s| s.inverter.switch_drop = -1.0]),
        ("inverter.diode_drop", &[|s| s.inverter.diode_drop = -1.0]),
        // A quarter of a radian per sample of 0.1 ms is 397.9 Hz.
        ("control.current_bandwidth", &[|s| s.control.current_bandwidth = 0.0, |s| s.control.current_bandwidth = 399.0]),
        // A third of the current loop's 200 Hz; with an encoder a quarter of its observer's 100 Hz.
        (
            "control.speed_bandwidth",
            &[
                |s| s.control.speed_bandwidth = 0.0,
                |s| s.control.speed_bandwidth = 67.0,
                |s| (s.control.speed_bandwidth, s.sensors.encoder_steps) = (25.1, Some(4096)),
            ],
        ),
        ("control.max_current", &[|s| s.control.max_current = 0.0]),
        ("control.trip_current", &[|s| s.control.trip_current = 20.0, |s| s.control.trip_current = f64::NAN]),
        ("schedule.id", &[|s| s.schedule.id = at(0.1, f64::NAN, 0.0), |s| s.schedule.id = at(-0.1, 0.0, 0.0)]),
        ("schedule.iq", &[|s| s.schedule.iq = Profile::constant(1.0), |s| s.schedule.iq = at(0.1, f64::INFINITY, 0.0)]),
        ("schedule.speed", &[|s| s.schedule.speed = at(0.1, 1.0, -0.1), |s| s.schedule.speed = at(f64::NAN, 1.0, 0.0)]),
        ("schedule.load", &[|s| s.schedule.load = at(0.1, 1.0, f64::INFINITY), |s| s.mechanics = Mechanics::Dyno]),
        ("injection.frequency", &[|s| inject(s, 0.0, 1.0), |s| inject(s, 5001.0, 1.0)]),
        // 310 V / sqrt(3) is 178.98 V.
        ("injection.voltage", &[|s| inject(s, 100.0, 179.0), |s| inject(s, 100.0, -179.0), |s| inject(s, 100.0, f64::NAN)]),
        ("sensors.current_noise", &[|s| s.sensors.current_noise = -0.1, |s| s.sensors.current_noise = f64::NAN]),
        ("sensors.current_offset", &[|s| s.sensors.current_offset[2] = f64::NAN]),
        ("sensors.current_gain", &[|s| s.sensors.current_gain[1] = 0.0]),
        ("sensors.angle_offset", &[|s| s.sensors.angle_offset = f64::INFINITY]),
        ("sensors.adc_range", &[|s| s.sensors.adc = Some(Adc { bits: 12, range: 0.0 })]),
        (
            "sensors.adc_bits",
            &[|s| s.sensors.adc = Some(Adc { bits: 1, range: 50.0 }), |s| s.sensors.adc = Some(Adc { bits: 33, range: 50.0 })],
        ),
        ("sensors.encoder_steps", &[|s| s.sensors.encoder_steps = Some(15)]),
        ("sensors.angle_delay", &[|s| s.sensors.angle_delay = f64::NAN]),
        ("sensors.u_dc_gain", &[|s| s.sensors.u_dc_gain = 0.0]),
        // Half the sample rate is 5 kHz.
        ("log.current_filter", &[|s| s.logging.current_filter = Some(0.0), |s| s.logging.current_filter = Some(5001.0)]),
        ("log.voltage_filter", &[|s| s.logging.voltage_filter = Some(f64::NAN)]),
        ("log.speed_filter", &[|s| s.logging.speed_filter = Some(-20.0)]),
        // 9001 samples.
        ("log.every", &[|s| s.logging.every = 0, |s| s.logging.every = 9002]),
    ];
    for (key, changes) in rows {
        for (index, change) in changes.iter().enumerate() {
            let error = refused(*change);
            assert_eq!(error.key(), Some(*key), "change {index} of {key}: {error}");
        }
    }
}

#[test]
fn what_is_just_within_its_range_is_accepted() {
    let changes: &[Change] = &[
        |_| (),
        |s| s.duration = 1.1e-4,
        |s| motor(s, 5.25e-3, 12e-3, 0.18),
        |s| free(s, 3e-3, 0.0),
        |s| s.inverter.ripple_frequency = 10_000.0,
        |s| s.inverter.dead_time = 49e-6,
        |s| s.control.current_bandwidth = 397.0,
        |s| s.control.speed_bandwidth = 66.0,
        |s| (s.control.speed_bandwidth, s.sensors.encoder_steps) = (24.9, Some(16)),
        |s| s.control.trip_current = 20.1,
        |s| inject(s, 5000.0, 178.9),
        |s| s.sensors.adc = Some(Adc { bits: 2, range: 20.0 }),
        |s| s.sensors.adc = Some(Adc { bits: 32, range: 20.0 }),
        |s| dyno(s, 100.0),
        |s| s.motor.rs_drift = -0.9,
        |s| s.motor.harmonics.seventh = -0.2,
        |s| s.logging.speed_filter = Some(5000.0),
    ];
    for (index, change) in changes.iter().enumerate() {
        // The dead time costs voltage, which is not the question here.
        let scenario =
            Scenario { inverter: fluxfit_drive::scenario::Inverter { u_dc: 400.0, ..changed(*change).inverter }, ..changed(*change) };
        assert_eq!(scenario.check(), Ok(()), "change {index}");
    }
}

#[test]
fn samples_too_slow_for_the_winding_or_the_encoder_are_refused_with_a_carrier_that_would_do() {
    // The shorter time constant is that of d: 5.25 mH / 0.958 ohm = 5.480 ms, which takes 182.5 samples a second, two per carrier.
    let error = refused(|s| s.inverter.carrier = 91.0);
    assert!(matches!(error, Error::SlowSampling { carrier: 92.0, .. }), "{error:?}");
    assert!(!matches!(refused(|s| s.inverter.carrier = 92.0), Error::SlowSampling { .. }));
    let error = refused(|s| (s.inverter.carrier, s.inverter.update) = (182.0, Update::Single));
    assert!(matches!(error, Error::SlowSampling { carrier: 183.0, .. }), "{error:?}");
    // With lq the smaller one it is that of q.
    let error = refused(|s| (motor(s, 12e-3, 5.25e-3, 0.18), s.inverter.carrier = 91.0).1);
    assert!(matches!(error, Error::SlowSampling { carrier: 92.0, .. }), "{error:?}");
    // An observer of 2 pi 100 Hz and half a radian per sample: 1256.6 samples a second, 628.3 carrier periods.
    let slow: Change = |s| (s.inverter.carrier, s.control.current_bandwidth, s.control.speed_bandwidth) = (628.0, 40.0, 5.0);
    assert!(matches!(changed(slow).check(), Ok(())));
    let mut scenario = changed(slow);
    scenario.sensors.encoder_steps = Some(4096);
    assert_eq!(scenario.check(), Err(Error::SlowObserver { carrier: 629.0 }));
    scenario.inverter.carrier = 629.0;
    assert_eq!(scenario.check(), Ok(()));
}

/// The paper's rig on a dynamometer at no current needs `p w psi_f`; what the inverter has at each of its losses.
#[test]
fn the_voltage_within_reach_is_what_ripple_dead_time_and_drops_leave() {
    let whole = 310.0 / 3.0_f64.sqrt();
    let rows: [(Change, f64); 5] = [
        (|_| (), whole),
        (|s| (s.inverter.ripple, s.inverter.ripple_frequency) = (30.0, 300.0), 280.0 / 3.0_f64.sqrt()),
        // Along the current 4/pi of what each leg loses: 310 V for 4 us of every 200 us; the larger drop.
        (|s| s.inverter.dead_time = 4e-6, whole - 4.0 / PI * 310.0 * 4.0 / 200.0),
        (|s| s.inverter.switch_drop = 2.0, whole - 4.0 / PI * 2.0),
        (|s| (s.inverter.switch_drop, s.inverter.diode_drop) = (1.0, 3.0), whole - 4.0 / PI * 3.0),
    ];
    for (change, available) in rows {
        let at_share = |share: f64| {
            let mut scenario = changed(change);
            dyno(&mut scenario, -share * available / (4.0 * 0.1827));
            scenario.check()
        };
        assert_eq!(at_share(0.9999), Ok(()));
        let Err(Error::VoltageLimit { needed, available: found, .. }) = at_share(1.0001) else { panic!("{:?}", at_share(1.0001)) };
        assert!((found / available - 1.0).abs() < 1e-12 && (needed / available - 1.0001).abs() < 1e-12, "{found} {available}");
    }
}

/// `u = R i + j w psi(i)`, worked out by hand for i_d = -3 A, i_q = 5 A at 200 rad/s electrical.
#[test]
fn the_voltage_that_is_needed_is_that_of_current_and_rotation() {
    let error = refused(|s| {
        dyno(s, 50.0);
        (s.schedule.id, s.schedule.iq, s.inverter.u_dc) = (Profile::constant(-3.0), Profile::constant(5.0), 50.0);
    });
    let (d, q): (f64, f64) = (0.958 * -3.0 - 200.0 * 12e-3 * 5.0, 0.958 * 5.0 + 200.0 * (0.1827 + 5.25e-3 * -3.0));
    assert!(matches!(error, Error::VoltageLimit { t: 0.0, needed, .. } if (needed - d.hypot(q)).abs() < 1e-9), "{error:?}");
    // The remedy names what is not there yet.
    let remedy = |allowed: bool| {
        let mut scenario = Scenario::paper();
        dyno(&mut scenario, 1000.0);
        (scenario.inverter.u_dc, scenario.inverter.carrier, scenario.control.field_weakening) = (100.0, 20e3, allowed);
        scenario.check().unwrap_err().to_string()
    };
    assert!(remedy(false).contains("control.field_weakening") && remedy(true).contains("control.max_current"));
}

/// Load and friction, divided by the torque per ampere `3/2 p (psi_f + (L_d - L_q) i_d)`.
#[test]
fn the_current_that_is_needed_carries_load_friction_and_reluctance() {
    for (id, friction) in [(0.0, 0.0), (0.0, 0.05), (-4.0, 0.05)] {
        let per_ampere: f64 = 6.0 * (0.1827 + (5.25e-3 - 12e-3) * id);
        let speed: f64 = 1000.0 * TAU / 60.0;
        let needed = |load: f64| f64::hypot(id, (load + friction * speed) / per_ampere);
        let check = |load: f64, current: f64| {
            let mut scenario = Scenario::paper();
            free(&mut scenario, 3e-3, friction);
            scenario.inverter.u_dc = 600.0;
            (scenario.schedule.id, scenario.schedule.load) = (Profile::constant(id), at(0.2, load, 0.0));
            (scenario.control.max_current, scenario.control.trip_current) = (current, 2.0 * current);
            scenario.check()
        };
        assert_eq!(check(8.0, 1.0001 * needed(8.0)), Ok(()), "{id} {friction}");
        let error = check(8.0, 0.9999 * needed(8.0)).unwrap_err();
        assert!(matches!(error, Error::TorqueLimit { t: 0.2, torque, .. } if (torque - 8.0 - friction * speed).abs() < 1e-9), "{error:?}");
    }
}

#[test]
fn currents_out_of_reach_are_refused_wherever_a_move_begins_or_ends() {
    // 15 A and 14 A make 20.5 A; each alone is within 20 A.
    let scheduled = |id: Profile, iq: Profile| {
        let mut scenario = Scenario::paper();
        dyno(&mut scenario, 10.0);
        (scenario.schedule.id, scenario.schedule.iq) = (id, iq);
        scenario.check()
    };
    assert_eq!(scheduled(Profile::constant(-14.0), Profile::constant(14.0)), Ok(()));
    assert!(matches!(scheduled(Profile::constant(-15.0), at(0.3, 14.0, 0.2)), Err(Error::CurrentLimit { needed, .. }) if needed > 20.0));
    assert!(matches!(scheduled(at(0.3, -21.0, 0.0), Profile::default()), Err(Error::CurrentLimit { t: 0.3, .. })));
    // A ramp to 30 A that is cut short at 0.5 s, at its highest 25 A: the step down does not hide it.
    let cut = Profile::new(vec![Ramp { at: 0.0, to: 30.0, over: 0.6 }, Ramp { at: 0.5, to: 0.0, over: 0.0 }]);
    let error = scheduled(Profile::default(), cut).unwrap_err();
    assert!(matches!(error, Error::CurrentLimit { t: 0.5, needed, .. } if (needed - 25.0).abs() < 1e-6), "{error:?}");
    // A ramp whose end lies behind the simulation's: what it reaches by then counts.
    assert_eq!(scheduled(Profile::default(), at(0.0, 30.0, 1.8)), Ok(()));
    assert!(matches!(scheduled(Profile::default(), at(0.0, 50.0, 1.8)), Err(Error::CurrentLimit { t: 0.9, .. })));
}

#[test]
fn converter_torque_and_rotation_have_their_own_refusals() {
    // 10 N m and 0.84 N m of friction take 9.886 A.
    let error = refused(|s| s.sensors.adc = Some(Adc { bits: 12, range: 9.8 }));
    assert!(matches!(error, Error::ConverterRange { t: 0.2, needed, range: 9.8 } if (needed - 9.886).abs() < 1e-3), "{error:?}");
    // A magnetless motor without i_d, and one whose reluctance outweighs its magnet: psi_f + (ld - lq) i_d < 0.
    assert!(matches!(refused(|s| motor(s, 20e-3, 5e-3, 0.0)), Error::NoTorque { id: 0.0, .. }));
    let reversed: Change = |s| (motor(s, 20e-3, 5e-3, 0.1), s.schedule.id = Profile::constant(-10.0)).1;
    assert!(matches!(refused(reversed), Error::NoTorque { id: -10.0, .. }));
    // Half a radian per sample of 0.1 ms is 5000 rad/s electrical, 1250 mechanical.
    let fast = |speed: f64| {
        let mut scenario = Scenario::paper();
        dyno(&mut scenario, speed);
        scenario.inverter.u_dc = 2000.0;
        scenario.check()
    };
    assert_eq!(fast(-1249.0), Ok(()));
    let error = fast(-1300.0).unwrap_err();
    assert!(matches!(error, Error::FastRotation { t: 0.0, turn, carrier: 5200.0, .. } if (turn - 0.52).abs() < 1e-12), "{error:?}");
}

/// A map of fluxes over a grid of 10 A.
fn map(psi: impl Fn(Dq) -> Dq) -> Result<FluxMap, Error> {
    let currents = [-20.0, -10.0, 0.0, 10.0, 20.0, 30.0];
    let points: Vec<_> = currents.iter().flat_map(|d| currents.map(|q| Dq { d: *d, q })).map(|i| (i, psi(i))).collect();
    FluxMap::new(&points)
}

#[test]
fn maps_that_no_motor_has_are_refused() {
    assert!(map(|i| Dq { d: 0.1 + 5e-3 * i.d + 3e-3 * i.q, q: 10e-3 * i.q + 3e-3 * i.d }).is_ok());
    for (name, psi) in [
        ("psi_d falls", (|i| Dq { d: -5e-3 * i.d, q: 10e-3 * i.q }) as fn(Dq) -> Dq),
        ("psi_q falls", |i| Dq { d: 5e-3 * i.d, q: -10e-3 * i.q }),
        // Cross inductances of opposite signs make a positive determinant of any diagonal.
        ("psi_q falls behind its cross inductances", |i| Dq { d: 5e-3 * i.d + 8e-3 * i.q, q: -1e-3 * i.q - 8e-3 * i.d }),
        ("psi_d falls behind its cross inductances", |i| Dq { d: -1e-3 * i.d + 8e-3 * i.q, q: 5e-3 * i.q - 8e-3 * i.d }),
        // Both rise along their own currents, but 5 mH times 10 mH is less than the square of 8 mH.
        ("determinant", |i| Dq { d: 5e-3 * i.d + 8e-3 * i.q, q: 10e-3 * i.q + 8e-3 * i.d }),
        // 20 mH up to 10 A, 1 mH beyond. The slope at 0 A is 20 mH, at 10 A the mean 10.5 mH, at 20 A 1 mH: over the cell from 10 A the
        // chord is 1 mH, and a cubic's least slope there is 1 - (10.5 - 1)/3 < 0.
        ("knee along d", |i| Dq { d: 20e-3 * i.d.min(10.0) + 1e-3 * (i.d - 10.0).max(0.0), q: 10e-3 * i.q }),
        ("knee along q", |i| Dq { d: 5e-3 * i.d, q: 20e-3 * i.q.min(10.0) + 1e-3 * (i.q - 10.0).max(0.0) }),
    ] {
        let found = map(psi);
        assert!(matches!(found, Err(Error::MapInductance { .. })), "{name}: {found:?}");
    }
    // The knee rises at every node: what falls lies in the cell from 10 A to 20 A, and is told at the node where that begins.
    let Err(Error::MapInductance { id, .. }) = map(|i| Dq { d: 20e-3 * i.d.min(10.0) + 1e-3 * (i.d - 10.0).max(0.0), q: 10e-3 * i.q })
    else {
        panic!("accepted");
    };
    assert_eq!(id, 10.0);
}

#[test]
fn a_map_must_hold_the_currents_that_are_asked_for() {
    let mapped = |ids: [f64; 3], iqs: [f64; 3]| {
        let points = ids.map(|d| iqs.map(|q| (Dq { d, q }, Dq { d: 0.005 * d + 0.18, q: 0.012 * q })));
        let mut scenario = Scenario::paper();
        scenario.motor.magnetics = Magnetics::Map(FluxMap::new(&points.concat()).unwrap());
        simulate(&scenario, 0, || ())
    };
    assert!(mapped([-21.0, 0.0, 21.0], [-21.0, 0.0, 21.0]).is_ok());
    // The load needs 10 A of i_q; the second mode -2 A of i_d; and every drive begins without current.
    assert!(matches!(mapped([-21.0, 0.0, 21.0], [-5.0, 0.0, 5.0]), Err(Error::OutsideMap { iq_range: [-5.0, 5.0], .. })));
    assert!(matches!(mapped([-1.0, 0.0, 1.0], [-21.0, 0.0, 21.0]), Err(Error::OutsideMap { id_range: [-1.0, 1.0], .. })));
    for (ids, iqs) in [([1.0, 5.0, 21.0], [-21.0, 0.0, 21.0]), ([-21.0, 0.0, 21.0], [1.0, 5.0, 21.0])] {
        assert!(matches!(mapped(ids, iqs), Err(Error::OutsideMap { t: 0.0, id: 0.0, iq: 0.0, .. })));
    }
}

#[test]
fn a_true_current_above_the_trip_level_stops_the_drive() {
    // Sensors that read a fifth: the drive makes five times the current that it means to.
    let trip = simulate(&changed(|s| s.sensors.current_gain = [0.2; 3]), 0, || ()).unwrap_err();
    assert!(matches!(trip, Error::Trip { current, limit: 30.0, .. } if current > 30.0), "{trip}");
    // Within one sample the current moves by 179 V 0.1 ms / 5.25 mH = 3.4 A at most: the trip comes as soon as it can.
    assert!(matches!(trip, Error::Trip { current, .. } if current < 33.5), "{trip}");
    // The load takes 9.886 A: a limit just above the largest current asked for lets it pass.
    let passes = changed(|s| (s.control.max_current, s.control.trip_current, s.inverter.u_dc) = (14.0, 15.0, 400.0));
    assert!(simulate(&passes, 0, || ()).is_ok());
}

/// A rotor of a thirty-thousandth of the rig's inertia, far too light for its samples: whatever happens, no number is logged that is none.
#[test]
fn a_drive_gone_wild_ends_in_an_error_or_in_numbers() {
    let mut scenario = Scenario { duration: 0.3, ..Scenario::paper() };
    free(&mut scenario, 1e-7, 0.0);
    scenario.schedule.load = at(0.2, 2.0, 0.0);
    if let Ok(recording) = simulate(&scenario, 0, || ()) {
        for (name, column) in recording.named() {
            assert!(column.iter().all(|value| value.is_finite()), "{name}");
        }
    }
}

/// A sensor that reads nothing makes a command that is no number: here past the check, which would have refused it.
#[test]
fn a_command_that_is_no_number_is_an_error() {
    let scenario = changed(|s| s.sensors.current_gain[0] = f64::NAN);
    assert_eq!(Drive::new(&scenario, 0).step(), Err(Error::Diverged { t: 0.0 }));
}

/// Samples at 0 and after each period, the one at the end among them, however the product rounds.
#[test]
fn the_rows_are_counted_with_the_last() {
    for (duration, carrier, update, rows) in [
        (0.9, 5e3, Update::Double, 9001),
        (0.3, 5e3, Update::Double, 3001),
        // 0.29 times 100 rounds to 28.999999999999996.
        (0.29, 100.0, Update::Single, 30),
        (0.57, 100.0, Update::Single, 58),
        (0.000_15, 5e3, Update::Double, 2),
        (0.000_199, 5e3, Update::Double, 2),
        (0.1, 3e3, Update::Single, 301),
    ] {
        let mut scenario = Scenario { duration, ..Scenario::paper() };
        (scenario.inverter.carrier, scenario.inverter.update) = (carrier, update);
        assert_eq!(scenario.rows(), rows, "{duration} {carrier}");
    }
}
