//! A log with the winding's temperature: R_s and psi_f at 20 degC, by the formulas of copper and of magnets.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{Answer, AtTemperature, Columns, ErrorKind, Known, Log, Model, Motor, Parameter, Request, UnseenError, frames::Dq, identify};

/// The paper's motor.
const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Rows of an operating point.
const ROWS: usize = 100;

/// Points (i_d, i_q, omega_e), with voltages of equation (2) and no noise, so slow that nothing is corrected.
fn columns(points: &[(f64, f64, f64)], temperature: Option<&[f64]>) -> Columns {
    let mut columns = Columns { temperature: temperature.map(|_| Vec::new()), ..Columns::default() };
    for (point, (d, q, omega_e)) in points.iter().enumerate() {
        let u = MOTOR.steady_voltage(Dq { d: *d, q: *q }, *omega_e);
        for _ in 0..ROWS {
            columns.t.push(0.01 * columns.t.len() as f64);
            let row = [(&mut columns.ud, u.d), (&mut columns.uq, u.q), (&mut columns.id, *d), (&mut columns.iq, *q)];
            row.into_iter().for_each(|(column, value)| column.push(value));
            columns.omega_e.push(*omega_e);
            columns.temperature.as_mut().into_iter().for_each(|column| column.push(temperature.unwrap()[point]));
        }
    }
    columns
}

const POINTS: [(f64, f64, f64); 3] = [(0.0, 9.0, 400.0), (-4.0, 6.0, 400.0), (-2.0, 3.0, 200.0)];

/// By exact voltages: of a hundred rows a second, three points tell nothing of R_s beside an angle that may be off.
fn answer(columns: Columns, request: &Request) -> Answer {
    identify(&Log::new(columns).unwrap(), &Request { model: Some(Model::Steady), voltage_accuracy: 0.0, ..request.clone() }).unwrap()
}

fn of(points: &[(f64, f64, f64)], temperature: &[f64], request: &Request) -> AtTemperature {
    answer(columns(points, Some(temperature)), request).identification.temperature.unwrap()
}

fn same(value: f64, expected: f64) -> bool {
    (value / expected - 1.0).abs() < 1e-9
}

/// Copper: R_20 = R (235 + 20) / (235 + 75). Magnets that lose 0.12 % per kelvin of what they have at 20 degrees:
/// psi_20 = psi / (1 - 0.066).
#[test]
fn parameters_at_20_degrees_follow_from_the_materials() {
    let request = Request { magnet_coefficient: Some(-0.0012), ..Request::default() };
    let answer = answer(columns(&POINTS, Some(&[75.0; 3])), &request);
    let found = answer.identification.temperature.unwrap();
    assert_eq!((found.lowest, found.highest, found.copper_gain), (75.0, 75.0, 0.0));
    assert!(same(found.mean, 75.0));
    let (rs, psi_f) = (found.rs.unwrap(), found.psi_f.unwrap());
    for (referred, judgement, factor) in [(rs, answer.rs(), 255.0 / 310.0), (psi_f, answer.psi_f(), 1.0 / 0.934)] {
        assert!(same(referred.value, factor * judgement.raw));
        let [low, high] = judgement.interval().unwrap().map(|end| factor * end);
        assert!(same(referred.interval[0], low) && same(referred.interval[1], high), "the same part of the value");
    }
    let words = "the winding was at 75 degC in the rows used; at 20 degC R_s = 0.788 ohm ±";
    assert!(found.to_string().starts_with(words), "{found}");
}

/// R_s is told by the rows with current, by its square: 81 at the first point, 16 + 36 at the second, 4 + 9 at the third.
#[test]
fn the_mean_is_that_of_the_rows_that_tell_the_resistance() {
    let found = of(&POINTS, &[80.0, 60.0, 40.0], &Request::default());
    assert!(same(found.mean, (81.0 * 80.0 + 52.0 * 60.0 + 13.0 * 40.0) / 146.0), "{found:?}");
    assert_eq!((found.lowest, found.highest), (40.0, 80.0));
    // From 40 to 80 degrees copper's resistance grows by 40 K of 275 K.
    assert!(same(found.copper_gain, 40.0 / 275.0));
    // Half of that range is 20 K of the 235 K + mean.
    let rs = found.rs.unwrap();
    let half_width = 0.5 * (rs.interval[1] - rs.interval[0]) / rs.value;
    let of_value = answer(columns(&POINTS, None), &Request::default()).rs().uncertainty.half_width / MOTOR.rs;
    assert!((half_width / of_value.hypot(20.0 / (235.0 + found.mean)) - 1.0).abs() < 1e-6, "{half_width} {of_value}");
    assert!(found.to_string().contains(", from 40 to 80 degC, where copper's resistance grows by 15 %; at 20 degC"), "{found}");
}

#[test]
fn what_is_not_identified_or_given_is_not_referred() {
    let stated = Request { magnet_coefficient: Some(-0.0012), ..Request::default() };
    let plain = of(&POINTS, &[75.0; 3], &Request::default());
    assert!(plain.rs.is_some() && plain.psi_f.is_none(), "the magnets' coefficient is not known");
    let fixed = of(&POINTS, &[75.0; 3], &stated.clone().with_known(Parameter::Rs, Known::Fixed(0.958)));
    assert!(fixed.rs.is_none() && fixed.psi_f.is_some(), "a resistance that was given has a temperature of its own");
    // One point at i_d = 0 tells neither R_s nor psi_f.
    let open = of(&POINTS[..1], &[75.0], &stated);
    assert!(open.rs.is_none() && open.psi_f.is_none(), "{open:?}");
    assert_eq!(open.to_string(), "the winding was at 75 degC in the rows used");
}

/// Without the column nothing is said, but that no log shows it.
#[test]
fn a_log_without_temperature_leaves_it_open() {
    let is_open = |answer: &Answer| answer.identification.unseen.iter().any(|unseen| unseen.error == UnseenError::Temperature);
    let without = answer(columns(&POINTS, None), &Request::default());
    assert!(without.identification.temperature.is_none() && is_open(&without));
    let with = answer(columns(&POINTS, Some(&[20.0; 3])), &Request::default());
    assert!(!is_open(&with));
    let rs = with.identification.temperature.unwrap().rs.unwrap();
    assert!(same(rs.value, with.rs().raw), "at 20 degrees nothing is to be changed");
}

#[test]
fn of_several_logs_all_must_have_the_temperature() {
    let log = |temperature: Option<&[f64]>| Log::new(columns(&POINTS, temperature)).unwrap();
    let both = Log::join([log(Some(&[60.0; 3])), log(Some(&[80.0; 3]))]).unwrap();
    assert_eq!(both.columns().temperature.as_ref().unwrap().len(), 6 * ROWS);
    assert!(Log::join([log(Some(&[60.0; 3])), log(None)]).unwrap().columns().temperature.is_none());
}

#[test]
fn impossible_temperatures_and_coefficients_are_refused() {
    let refusal = Log::new(columns(&POINTS, Some(&[20.0, 999.0, 20.0]))).unwrap_err();
    let expected = ErrorKind::Implausible { column: "temperature", row: ROWS, value: 999.0, limit: 230.0 };
    assert_eq!(refusal.kind(), &expected);
    for coefficient in [-0.12, f64::NAN] {
        let request = Request { magnet_coefficient: Some(coefficient), ..Request::default() };
        let refusal = identify(&Log::new(columns(&POINTS, None)).unwrap(), &request).unwrap_err().to_string();
        assert!(refusal.contains("the magnets' coefficient is") && refusal.contains("from -0.004 to 0.004"), "{refusal}");
    }
}
