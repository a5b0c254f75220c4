//! Every n-th voltage of a drive that does not turn its voltages on for their delay: in the frame of its row it leads what acts by
//! `omega_e T`.
//!
//! The data are equation (2) at operating points, with noise; nothing of the program makes them.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{ColumnFinding, Columns, Log, Motor, Parameter, Request, check_columns, frames::Dq, identify, optimizer::Draws};

const SERVO: Motor = Motor { rs: 0.45, ld: 3.2e-3, lq: 3.9e-3, psi_f: 0.11 };

/// One and a half periods of 16 kHz, s.
const LAG: f64 = 94e-6;

/// Rows of an operating point at 500 rows a second.
const ROWS: usize = 200;

/// A log of points at (i_d, i_q, omega_e), with 10 mA of noise.
fn log(points: &[(f64, f64, f64)], seed: u64) -> Columns {
    let mut draws = Draws::seeded(seed, 0);
    let mut columns = Columns::default();
    for (row, &(d, q, omega_e)) in points.iter().flat_map(|point| [point; ROWS]).enumerate() {
        let u = SERVO.steady_voltage(Dq { d, q }, omega_e);
        let (sin, cos) = (omega_e * LAG).sin_cos();
        columns.t.push(row as f64 * 2e-3);
        columns.ud.push(cos * u.d - sin * u.q);
        columns.uq.push(sin * u.d + cos * u.q);
        columns.id.push(d + 0.01 * draws.normal());
        columns.iq.push(q + 0.01 * draws.normal());
        columns.omega_e.push(omega_e);
    }
    columns
}

/// Two loads at one speed: currents exchanged with another sign of u_d explain them nearly as well.
#[test]
fn a_lag_is_not_called_exchanged_axes() {
    let columns = log(&[(0.0, 3.0, 1256.6), (0.0, 9.0, 1256.6)], 1);
    assert_eq!(check_columns(&Log::new(columns.clone()).unwrap()), []);
    let mut exchanged = columns;
    std::mem::swap(&mut exchanged.ud, &mut exchanged.uq);
    std::mem::swap(&mut exchanged.id, &mut exchanged.iq);
    let found = check_columns(&Log::new(exchanged).unwrap());
    assert!(matches!(found[..], [ColumnFinding::Axes { .. }]), "{found:?}");
}

/// Nine points told nothing but a flux 8 % off within ±40 %.
#[test]
fn points_of_voltages_that_turn_with_the_speed_tell_the_motor() {
    let currents = [(0.0, 3.0), (-3.0, 6.0), (-6.0, 9.0)];
    let points: Vec<(f64, f64, f64)> =
        [400.0, 900.0, 1400.0].into_iter().flat_map(|omega_e| currents.map(|(d, q)| (d, q, omega_e))).collect();
    for seed in 1..=5 {
        let found = identify(&Log::new(log(&points, seed)).unwrap(), &Request::default()).unwrap();
        let told = Parameter::ALL.map(|parameter| {
            let judgement = found.parameter(parameter);
            let off = (judgement.raw - SERVO.get(parameter)).abs();
            let half_width = judgement.uncertainty.half_width;
            assert!(off <= 1.5 * half_width, "{seed}: {judgement:?}");
            half_width / SERVO.get(parameter)
        });
        assert!(told.iter().zip([0.05, 0.1, 0.02, 0.005]).all(|(told, most)| *told < most), "{seed}: {told:?}");
    }
}
