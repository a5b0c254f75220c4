//! Gains of the current controllers: linear in the bandwidth, as sharp as the parameters, and short of phase where the delay says so.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Model, Request, Verdict,
    current_loop::{CurrentLoop, Gain},
    evidence::{Identification, Provenance, Resolved},
    frames::Dq,
    identify,
    log::{Columns, Log},
    motor::{Motor, Parameter},
};
use proptest::prelude::*;
use std::{f64::consts::TAU, sync::LazyLock};

const PAPER: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

const RATE: Resolved<f64> = Resolved { value: 10e3, provenance: Provenance::Stated };

/// What operating points at these (i_d, i_q) tell of the paper's motor.
fn found(points: &[(f64, f64)]) -> Identification {
    let mut columns = Columns::default();
    for (w, &(d, q)) in points.iter().enumerate() {
        let u = PAPER.steady_voltage(Dq { d, q }, 400.0);
        for k in 0..100 {
            let Columns { t, ud, uq, id, iq, omega_e, .. } = &mut columns;
            for (column, value) in [(t, (100 * w + k) as f64 * 1e-3), (ud, u.d), (uq, u.q), (id, d), (iq, q), (omega_e, 400.0)] {
                column.push(value);
            }
        }
    }
    identify(&Log::new(columns).unwrap(), &Request { model: Some(Model::Steady), ..Request::default() }).unwrap().identification
}

static FOUND: LazyLock<Identification> = LazyLock::new(|| found(&[(0.0, 9.0), (-2.0, 8.5), (-4.0, 5.0)]));

fn gains(bandwidth: f64) -> [Gain; 3] {
    let found = CurrentLoop::of(&FOUND.parameters, bandwidth, RATE).unwrap();
    [found.kp_d, found.kp_q, found.ki].map(Option::unwrap)
}

#[test]
fn gains_by_hand() {
    // 500 Hz are 3141.592653589793 rad/s: times 5.25 mH, 12 mH and 0.958 ohm.
    let by_hand = [16.493_361_431_346_414, 37.699_111_843_077_52, 3_009.645_762_139_022];
    for (gain, expected) in gains(500.0).into_iter().zip(by_hand) {
        // Free of noise, and too coarse for a correction of the zero-order hold: the motor comes back.
        assert!((gain.value / expected - 1.0).abs() < 1e-6, "{gain:?} {expected}");
        assert_eq!(gain.verdict, Verdict::Identified);
    }
}

#[test]
fn the_phase_margin_is_what_the_delay_leaves() {
    // 1.5 periods of 100 us are 150 us, at 500 Hz 0.075 turns or 27 degrees.
    let at = |bandwidth| CurrentLoop::of(&FOUND.parameters, bandwidth, RATE).unwrap();
    assert!((at(500.0).phase_margin() - 63.0).abs() < 1e-9);
    assert!((at(500.0).highest_bandwidth() - 10e3 / 18.0).abs() < 1e-9);
    assert_eq!(at(555.0).warning(), None);
    let warning = at(1000.0).warning().unwrap();
    assert_eq!(warning.code(), "phase-margin");
    assert_eq!(
        warning.to_string(),
        "a bandwidth of 1000 Hz leaves a phase margin of 36 degrees, less than 60, with 1.5 periods of delay at 10000 Hz; ask for at \
         most 555 Hz"
    );
    // Without phase from a sixth of the rate on.
    assert!(at(1700.0).warning().unwrap().to_string().starts_with("a bandwidth of 1700 Hz makes the loop unstable, with"));
    let assumed = CurrentLoop::of(&FOUND.parameters, 1000.0, Resolved { provenance: Provenance::Assumed, ..RATE }).unwrap();
    assert!(assumed.warning().unwrap().to_string().contains("taken from the log; state the control rate"));
}

#[test]
fn a_parameter_that_the_log_does_not_hold_gives_no_gain() {
    let at_zero = found(&[(0.0, 9.0), (0.0, 5.0)]);
    assert_eq!(at_zero.parameter(Parameter::Ld).verdict, Verdict::NotIdentifiable);
    let gains = CurrentLoop::of(&at_zero.parameters, 500.0, RATE).unwrap();
    assert!(gains.kp_d.is_none() && gains.kp_q.is_some() && gains.ki.is_some(), "{gains:?}");
}

#[test]
fn frequencies_are_positive_numbers() {
    for wrong in [0.0, -500.0, f64::NAN, f64::INFINITY] {
        assert!(CurrentLoop::of(&FOUND.parameters, wrong, RATE).unwrap_err().to_string().starts_with("the bandwidth"), "{wrong}");
        let rate = Resolved { value: wrong, ..RATE };
        assert!(CurrentLoop::of(&FOUND.parameters, 500.0, rate).unwrap_err().to_string().starts_with("the control rate"), "{wrong}");
    }
}

proptest! {
    /// Twice the bandwidth is twice the gain, to the last digits of the interval.
    #[test]
    fn gains_are_linear_in_the_bandwidth(bandwidth in 1.0..5e3, factor in 0.01_f64..100.0) {
        for (one, other) in gains(bandwidth).into_iter().zip(gains(factor * bandwidth)) {
            let pairs: [(f64, f64); 3] =
                [(one.value, other.value), (one.interval[0], other.interval[0]), (one.interval[1], other.interval[1])];
            for (a, b) in pairs {
                prop_assert!((b - factor * a).abs() <= 1e-12 * b.abs());
            }
        }
    }

    /// A gain is as uncertain as its parameter, and by the same factor larger.
    #[test]
    fn a_gains_interval_is_its_parameters_scaled(bandwidth in 1.0..5e3) {
        for (gain, parameter) in gains(bandwidth).into_iter().zip([Parameter::Ld, Parameter::Lq, Parameter::Rs]) {
            let half_width = FOUND.parameter(parameter).uncertainty.half_width;
            prop_assert!(half_width > 0.0);
            prop_assert!(((gain.interval[1] - gain.interval[0]) / (2.0 * TAU * bandwidth * half_width) - 1.0).abs() < 1e-9);
            prop_assert!(gain.interval[0] < gain.value && gain.value < gain.interval[1]);
        }
    }
}
