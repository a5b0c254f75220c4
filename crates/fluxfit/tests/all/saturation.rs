//! Saturation is named where the motor saturates, and nowhere else; warnings of low speed and of the voltage's limit.
//!
//! The data are the steady equations with a flux that is written down here, sampled so coarsely that no zero-order-hold correction applies.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Known, Model, Request,
    evidence::Identification,
    frames::Dq,
    identify,
    log::{Columns, Log},
    motor::{Motor, Parameter},
    objective::acting_voltage::{VoltageFrame, VoltageTiming},
    optimizer::Draws,
};
use std::f64::consts::FRAC_PI_3;

const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Four loads and two speeds: i_d, i_q (A), omega_e (rad/s).
const POINTS: [(f64, f64, f64); 5] = [(0.0, 3.0, 400.0), (0.0, 9.0, 400.0), (-3.0, 6.0, 400.0), (-2.0, 12.0, 300.0), (0.0, -12.0, 400.0)];

const ROWS: usize = 100;

fn settings() -> Request {
    let timing = VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle };
    Request { model: Some(Model::Steady), voltage_timing: Some(timing), ..Request::default() }
}

/// Rows of a drive at these points; `flux` (Wb) at a current, and what its inverter takes: a constant voltage of each phase against its
/// Rows of a drive at these points; `flux` (Wb) at a current, and what the inverter takes: a constant voltage of each phase against its
/// current's angle in the stator.
fn columns(points: &[(f64, f64, f64)], flux: impl Fn(Dq) -> Dq, loss: f64, noise: f64, seed: u64) -> Columns {
    let mut draws = Draws::seeded(seed, 0);
    let mut columns = Columns::default();
    for (w, &(d, q, omega_e)) in points.iter().enumerate() {
        let psi = flux(Dq { d, q });
        let u = Dq { d: MOTOR.rs * d - omega_e * psi.q, q: MOTOR.rs * q + omega_e * psi.d };
        for k in 0..ROWS {
            let t = (2 * w * ROWS + k) as f64 * 0.002;
            let in_stator = q.atan2(d) + omega_e * t;
            let taken = (in_stator / FRAC_PI_3).round() * FRAC_PI_3 - omega_e * t;
            columns.t.push(t);
            columns.ud.push(u.d + FRAC_PI_3 * loss * taken.cos() + noise * draws.normal());
            columns.uq.push(u.q + FRAC_PI_3 * loss * taken.sin() + noise * draws.normal());
            columns.id.push(d + 0.02 * noise * draws.normal());
            columns.iq.push(q + 0.02 * noise * draws.normal());
            columns.omega_e.push(omega_e);
        }
    }
    columns
}

fn found(columns: Columns, settings: &Request) -> Identification {
    identify(&Log::new(columns).unwrap(), settings).unwrap().identification
}

fn constant(i: Dq) -> Dq {
    Dq { d: MOTOR.ld * i.d + MOTOR.psi_f, q: MOTOR.lq * i.q }
}

/// Apparent L_q falls from 12 mH at no current as 12 / (1 + |i_q| / 30 A): 10.9 mH at 3 A, 8.57 mH at 12 A.
fn saturated(i: Dq) -> Dq {
    Dq { q: MOTOR.lq * i.q / (1.0 + i.q.abs() / 30.0), ..constant(i) }
}

fn warns(found: &Identification, code: &str) -> bool {
    found.warnings.iter().any(|warning| warning.code() == code)
}

#[test]
fn a_saturating_motor_is_named_with_its_range_and_its_flux() {
    let mut settings = settings();
    settings.known[Parameter::Rs as usize] = Known::Fixed(MOTOR.rs);
    let found = found(columns(&POINTS, saturated, 0.0, 0.1, 1), &settings);
    let saturation = found.saturation.as_ref().expect("a quarter of L_q is lost");
    let message = &found.warnings.iter().find(|warning| warning.code() == "saturation").unwrap().to_string();
    assert!(message.contains("apparent L_q falls from 10.9 to 8.57 mH between i_q = 3.00 and"), "{message}");
    let points = saturation.fluxes.iter().flatten().zip(POINTS);
    assert_eq!(points.clone().count(), POINTS.len());
    for (flux, (d, q, _)) in points {
        let truth = saturated(Dq { d, q });
        // 0.1 V in 100 rows, 10 mV, over 300 rad/s; 1e-4 of some 80 V about as much.
        assert!((flux.psi.d - truth.d).abs() < 4.0 * flux.uncertainty.d && flux.uncertainty.d < 1e-4, "{flux:?}");
        assert!((flux.psi.q - truth.q).abs() < 4.0 * flux.uncertainty.q && flux.uncertainty.q < 1e-4, "{flux:?}");
    }
    let lq = found.parameter(Parameter::Lq);
    let (raw, half) = (lq.raw, lq.uncertainty.half_width);
    for (_, q, _) in POINTS {
        let apparent = saturated(Dq { d: 0.0, q }).q / q;
        assert!((raw - apparent).abs() <= half, "{apparent} is not in {raw} ± {half}");
    }
}

/// A flux map that no terms of saturation describe: both axes saturate by the size of the current, as `L i / (1 + (|i| / i_s)^e)`.
fn crossed(i: Dq, [saturates_at, exponent]: [f64; 2]) -> Dq {
    let part = 1.0 / (1.0 + (i.d.hypot(i.q) / saturates_at).powf(exponent));
    Dq { d: MOTOR.psi_f + MOTOR.ld * i.d * part.sqrt(), q: MOTOR.lq * i.q * part }
}

/// Logs that were drawn, of how many R_s is the answer, whose interval holds it, is below a tenth; fluxes, and how many hold.
#[derive(Debug, Default)]
struct Drawn {
    told: usize,
    held: usize,
    within_a_tenth: usize,
    fluxes: usize,
    fluxes_held: usize,
}

/// 200 motors with such a map and an inverter that takes up to 1.5 V along the current, or none, at these currents, A, held to 30 mA, and
/// speeds, rad/s.
fn drawn(currents: &[(f64, f64)], speeds: &[f64]) -> Drawn {
    let mut count = Drawn::default();
    for seed in 0..200 {
        let mut draws = Draws::seeded(1000 + seed, 0);
        let map = [8.0 + 20.0 * draws.uniform(), 1.0 + draws.uniform()];
        let loss = (2.0 * draws.uniform() - 0.5).max(0.0);
        let at = speeds.iter().flat_map(|omega_e| currents.iter().map(move |i| (i, *omega_e)));
        let points: Vec<_> = at.map(|((d, q), omega_e)| (d + 0.03 * draws.uniform(), q + 0.03 * draws.uniform(), omega_e)).collect();
        let found = found(columns(&points, |i| crossed(i, map), loss, 0.1, seed), &settings());
        let Some(saturation) = &found.saturation else { continue };
        let rs = found.parameter(Parameter::Rs);
        if saturation.tells_rs && rs.value().is_some() {
            count.told += 1;
            count.held += usize::from((rs.raw - MOTOR.rs).abs() <= rs.uncertainty.half_width);
            count.within_a_tenth += usize::from(rs.uncertainty.half_width < 0.1 * MOTOR.rs);
        }
        for flux in saturation.fluxes.iter().flatten() {
            let truth = crossed(flux.current, map);
            let holds =
                [(flux.psi.d - truth.d).abs() <= 2.0 * flux.uncertainty.d, (flux.psi.q - truth.q).abs() <= 2.0 * flux.uncertainty.q];
            count.fluxes += holds.len();
            count.fluxes_held += holds.iter().filter(|holds| **holds).count();
        }
    }
    count
}

/// The least that 95 % of so many are, three standard deviations of a binomial count below.
fn least_of(count: usize) -> usize {
    (0.95 * count as f64 - 3.0 * (0.95 * 0.05 * count as f64).sqrt()) as usize
}

/// However the flux goes, its voltage grows with the speed and that of R_s does not.
#[test]
fn points_of_one_current_at_several_speeds_tell_rs_whatever_the_flux() {
    let currents = [(0.0, 3.0), (-2.0, 8.0), (-5.0, 12.0)];
    for speeds in [&[200.0, 400.0][..], &[150.0, 300.0, 500.0]] {
        let Drawn { told, held, within_a_tenth, fluxes, fluxes_held } = drawn(&currents, speeds);
        assert!(told >= 190 && within_a_tenth >= 190, "{told} told, {within_a_tenth} within a tenth");
        assert!(held >= least_of(told) && fluxes_held >= least_of(fluxes), "{held} of {told}, {fluxes_held} of {fluxes}");
    }
}

/// At one speed R_s and what the inverter takes stay unknown; the fluxes hold with what they may be, which the terms of saturation and the
/// voltage along the current bend to together.
#[test]
fn fluxes_of_one_speed_hold_beside_what_the_inverter_takes() {
    let currents = [(0.0, 3.0), (-2.0, 8.0), (-5.0, 12.0), (-2.0, 4.0), (0.0, 9.0)];
    // The same points again tell no more.
    for (currents, count) in [(currents.to_vec(), 2000), ([currents, currents].concat(), 4000)] {
        let Drawn { told, fluxes, fluxes_held, .. } = drawn(&currents, &[400.0]);
        assert!(told == 0 && fluxes == count && fluxes_held >= least_of(fluxes), "{told} told, {fluxes_held} of {fluxes}");
    }
}

/// A voltage along the current follows the current as well: it is found beside the motor, and is no saturation.
#[test]
fn a_loss_along_the_current_is_found_and_is_not_called_saturation() {
    let found = found(columns(&POINTS, constant, 2.0, 0.05, 2), &settings());
    let steady = found.steady.as_ref().unwrap();
    let (volts, error) = steady.estimate.loss.unwrap();
    assert!((volts - 2.0).abs() < 4.0 * error && error < 0.5, "{volts} ± {error} V");
    assert_eq!((steady.misfit, &found.saturation), (None, &None));
    for judgement in &found.parameters {
        let truth = MOTOR.get(judgement.parameter);
        assert!((judgement.raw - truth).abs() <= 1.5 * judgement.uncertainty.half_width, "{judgement:?}");
    }
}

/// Contradiction is proven at one in a thousand: of 100 draws at most two, whose probability is above 0.9998 if that holds.
#[test]
fn constant_parameters_raise_no_alarm() {
    let alarm = |seed: u64| found(columns(&POINTS, constant, 0.0, 0.3, seed), &settings()).saturation.is_some();
    let alarms = (100..200).filter(|seed| alarm(*seed)).count();
    assert!(alarms <= 2, "{alarms} of 100");
}

/// Two points are as many equations as unknowns: nothing can be seen, and that is said.
#[test]
fn two_points_of_a_saturating_motor_say_that_they_prove_nothing() {
    let found = found(columns(&[POINTS[1], POINTS[2]], saturated, 0.0, 0.0, 3), &settings());
    assert!(warns(&found, "no-redundancy") && !warns(&found, "saturation"));
}

/// At 10 rad/s the magnet makes 1.8 V, and of 300 V half a percent, 1.5 V, is lost unseen; at 400 rad/s 73 V.
#[test]
fn low_speed_is_said_where_the_inverter_takes_what_the_magnet_gives() {
    for (slower, expected) in [(40.0, true), (1.0, false)] {
        let points = POINTS.map(|(d, q, omega_e)| (d, q, omega_e / slower));
        let mut columns = columns(&points, constant, 0.0, 0.01, 4);
        columns.u_dc = Some(vec![300.0; columns.t.len()]);
        assert_eq!(warns(&found(columns, &settings()), "low-speed"), expected, "{slower}");
    }
}

/// The largest voltage of these points is sqrt((0.958 12)² + ...) below 110 V, so 200 V / sqrt 3 = 115 V is enough and 150 V / sqrt
/// 3 = 87 V not.
#[test]
fn more_voltage_than_there_is_is_said() {
    for (u_dc, expected) in [(150.0, true), (200.0, false)] {
        let mut columns = columns(&POINTS, constant, 0.0, 0.01, 5);
        columns.u_dc = Some(vec![u_dc; columns.t.len()]);
        assert_eq!(warns(&found(columns, &settings()), "voltage-limit"), expected, "{u_dc}");
    }
    assert!(!warns(&found(columns(&POINTS, constant, 0.0, 0.01, 5), &settings()), "voltage-limit"));
}
