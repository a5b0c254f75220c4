//! Logs of a motor that turned with shorted terminals: currents by the formula of the steady short circuit, voltages zero.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    ErrorKind, Known, Model, Parameter, Reason, Remedy, Request, Verdict,
    evidence::ModelReason,
    identify,
    log::{Columns, Log},
    motor::Motor,
    optimizer::Draws,
    validate,
};

const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Steady short-circuit currents by the formula, at two speeds, with noise; times `factor`.
fn shorted(factor: f64) -> Columns {
    let mut draws = Draws::seeded(5, 0);
    let mut columns = Columns::default();
    for k in 0..4000 {
        let omega_e = if k < 2000 { 100.0 } else { 400.0 };
        let Motor { rs, ld, lq, psi_f } = MOTOR;
        let over = psi_f / (rs * rs + omega_e * omega_e * ld * lq);
        columns.t.push(f64::from(k) * 1e-4);
        columns.ud.push(0.0);
        columns.uq.push(0.0);
        columns.id.push(-factor * omega_e * omega_e * lq * over + 0.02 * draws.normal());
        columns.iq.push(-factor * omega_e * rs * over + 0.02 * draws.normal());
        columns.omega_e.push(omega_e + 0.1 * draws.normal());
    }
    columns
}

#[test]
fn a_short_circuit_tells_ratios_alone() {
    let log = Log::new(shorted(1.0)).unwrap();
    for known in [Known::Nothing, Known::Prior { value: MOTOR.rs, standard_error: 0.01 }] {
        let mut request = Request::default();
        request.known[Parameter::Rs as usize] = known;
        let found = identify(&log, &request).unwrap().identification;
        for judgement in &found.parameters {
            assert_eq!((judgement.verdict, judgement.value()), (Verdict::NotIdentifiable, None));
            assert_eq!((&judgement.reason, &judgement.remedy), (&Some(Reason::ShortCircuit), &Some(Remedy::FixOne)));
        }
        assert_eq!(found.model.reason, ModelReason::ShortCircuit);
        let stated = identify(&log, &Request { model: Some(Model::OutputError), ..request }).unwrap_err();
        assert_eq!(*stated.kind(), ErrorKind::ShortCircuit);
        assert!(matches!(validate(&log, &MOTOR.into(), &Request::default()).unwrap_err().kind(), ErrorKind::AllZero { .. }));
    }
}

#[test]
fn one_parameter_that_is_known_exactly_gives_the_others() {
    let log = Log::new(shorted(1.0)).unwrap();
    for given in [Parameter::Rs, Parameter::PsiF] {
        let mut request = Request::default();
        request.known[given as usize] = Known::Fixed(MOTOR.get(given));
        let found = identify(&log, &request).unwrap().identification;
        for parameter in Parameter::ALL {
            let judgement = found.parameter(parameter);
            let [low, high] = judgement.interval().unwrap();
            assert!(
                judgement.verdict == Verdict::Identified && low <= MOTOR.get(parameter) && MOTOR.get(parameter) <= high,
                "{judgement:?}"
            );
            assert!(high - low < 0.01 * MOTOR.get(parameter), "{judgement:?}");
        }
    }
}

#[test]
fn zeros_in_place_of_voltages_are_refused() {
    let refused =
        |columns: Columns| matches!(Log::new(columns).unwrap_err().kind(), ErrorKind::AllZero { what } if what.contains("voltages"));
    // Noise alone, and a motor that drives.
    assert!(refused(shorted(0.0)));
    assert!(refused(shorted(-1.0)));
    // Backward, i_q has the other sign.
    let mut backward = shorted(1.0);
    backward.omega_e.iter_mut().chain(&mut backward.iq).for_each(|value| *value = -*value);
    assert!(Log::new(backward).is_ok());
}
