//! What a request may ask for, and what comes back where it cannot be answered.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Columns, ErrorKind, Known, Log, Model, Motor, Nameplate, Parameter, Reason, Request, TimeWindow, Verdict, Warning, frames::Dq, identify,
};

const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Two operating points, with the speed logged in another unit: multiplied by `factor`.
fn log(factor: f64) -> Log {
    let mut columns = Columns::default();
    for row in 0..200 {
        let (i, omega_e) = (if row < 100 { Dq { d: 0.0, q: 9.0 } } else { Dq { d: -2.0, q: 8.5 } }, 400.0);
        let u = MOTOR.steady_voltage(i, omega_e);
        let Columns { t, ud, uq, id, iq, omega_e: speed, .. } = &mut columns;
        for (column, value) in [(t, f64::from(row) * 1e-3), (ud, u.d), (uq, u.q), (id, i.d), (iq, i.q), (speed, factor * omega_e)] {
            column.push(value);
        }
    }
    Log::new(columns).unwrap()
}

#[test]
fn with_known_sets_one_parameter() {
    let request = Request::default().with_known(Parameter::Lq, Known::Fixed(0.012));
    assert_eq!(request.known, [Known::Nothing, Known::Nothing, Known::Fixed(0.012), Known::Nothing]);
    assert_eq!(identify(&log(1.0), &request).unwrap().lq().value(), Some(0.012));
}

#[test]
fn a_known_value_that_no_motor_has_is_refused() {
    for parameter in Parameter::ALL {
        for value in [-1e-3, -0.5, f64::NAN, f64::INFINITY] {
            for known in [Known::Fixed(value), Known::Prior { value, standard_error: 0.1 }] {
                let error = identify(&log(1.0), &Request::default().with_known(parameter, known)).unwrap_err();
                let ErrorKind::KnownValue { parameter: refused, value: given } = error.kind() else { panic!("{error}") };
                assert_eq!((*refused, given.to_bits()), (parameter, value.to_bits()));
            }
        }
    }
    let of_zero = |parameter| identify(&log(1.0), &Request::default().with_known(parameter, Known::Fixed(0.0)));
    assert_eq!(of_zero(Parameter::Ld).unwrap_err().to_string(), "the known value of L_d is 0; it must be a finite number, above zero");
    assert!(of_zero(Parameter::Lq).is_err());
    assert!(of_zero(Parameter::Rs).is_ok() && of_zero(Parameter::PsiF).is_ok());
}

#[test]
fn the_standard_error_of_a_known_value_is_above_zero() {
    for standard_error in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let request = Request::default().with_known(Parameter::Rs, Known::Prior { value: 0.958, standard_error });
        let error = identify(&log(1.0), &request).unwrap_err();
        assert!(matches!(error.kind(), ErrorKind::KnownError { parameter: Parameter::Rs, .. }), "{error}");
    }
}

/// The two points tell L_q to some 0.4 % (the period of the drive is not known), so a prior of 1 % is contradicted from 3.3 % on; the value
/// by the log alone is the motor's.
#[test]
fn a_prior_that_the_log_contradicts_is_named_with_both_numbers() {
    for (value, contradicts) in [(1.05 * MOTOR.lq, true), (0.96 * MOTOR.lq, true), (1.02 * MOTOR.lq, false)] {
        let given = Known::Prior { value, standard_error: 0.01 * MOTOR.lq };
        let request = Request { model: Some(Model::Steady), ..Request::default() }.with_known(Parameter::Lq, given);
        let answer = identify(&log(1.0), &request).unwrap();
        let found = answer.warnings().iter().find_map(|warning| match warning {
            Warning::PriorContradicted { parameter: Parameter::Lq, prior, log } => Some((*prior, *log)),
            _ => None,
        });
        assert_eq!(found.is_some(), contradicts, "{value}: {:?}", answer.warnings());
        let judgement = answer.parameter(Parameter::Lq);
        let is_the_reason = judgement.reason == Some(Reason::PriorContradicted { parameter: Parameter::Lq });
        assert_eq!((judgement.verdict == Verdict::Weak, is_the_reason), (contradicts, contradicts), "{judgement:?}");
        if let Some((prior, (alone, error))) = found {
            assert_eq!(prior, (value, 0.01 * MOTOR.lq));
            assert!((alone - MOTOR.lq).abs() < 3.0 * error && error < 0.006 * MOTOR.lq, "{alone} ± {error}");
        }
    }
}

/// The log holds nothing in the window asked for. Its speed is that of the shaft of a motor with four pole pairs, which the flux shows.
#[test]
fn an_error_says_what_may_be_behind_it() {
    let nameplate = Nameplate { values: MOTOR.to_array().map(Some), pole_pairs: Some(4), ..Nameplate::default() };
    let request = Request { windows: vec![TimeWindow { from: 10.0, to: 11.0 }], nameplate, ..Request::default() };
    let error = identify(&log(0.25), &request).unwrap_err();
    assert!(matches!(error.kind(), ErrorKind::Window { from: 10.0, to: 11.0, .. }), "{error}");
    let Some(Warning::Convention(convention)) = &error.suspected_units else { panic!("{error:?}") };
    assert_eq!(convention.ratios.len(), 1);
    // At a quarter of the speed too little is taken off for the inductances, so the flux looks more than four times as large.
    assert!((4.0..5.0).contains(&convention.ratios[0].ratio), "{convention:?}");
    assert_eq!(identify(&log(1.0), &request).unwrap_err().suspected_units, None);
    // Whoever does not care has the plain error.
    assert_eq!(fluxfit::Error::from(error.clone()).to_string(), error.to_string());
}
