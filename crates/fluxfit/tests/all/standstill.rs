//! A rotor that stands: a winding and a filter of its current are two lags one after the other.

#![allow(clippy::unwrap_used)]

use fluxfit::{Columns, Log, Parameter, Request, Swarm, identify, motor::Motor, optimizer::Draws};

const MOTOR: Motor = Motor { rs: 0.06, ld: 18e-6, lq: 18e-6, psi_f: 0.0 };
const PERIOD: f64 = 1.0 / 24e3;

/// Voltages held for 40 rows each. The winding's currents are the exact ones, of which a filter of 0.53 ms, longer than the winding's
/// 0.3 ms, takes samples.
fn log(filter: f64) -> Log {
    let mut draws = Draws::seeded(1, 0);
    let of_winding = (-PERIOD * MOTOR.rs / MOTOR.ld).exp();
    let of_filter = (-PERIOD / filter).exp();
    let mut columns = Columns::default();
    let (mut u, mut i, mut filtered) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for row in 0..3000 {
        if row % 40 == 0 {
            u = [0.6, 0.6].map(|volts| volts * draws.normal());
        }
        for axis in 0..2 {
            let sample = i[axis] + 0.1 * draws.normal();
            filtered[axis] = of_filter * filtered[axis] + (1.0 - of_filter) * sample;
            i[axis] = of_winding * i[axis] + (1.0 - of_winding) * u[axis] / MOTOR.rs;
        }
        columns.t.push(f64::from(row) * PERIOD);
        columns.ud.push(u[0]);
        columns.uq.push(u[1]);
        columns.id.push(filtered[0]);
        columns.iq.push(filtered[1]);
        columns.omega_e.push(0.0);
        columns.theta_e.get_or_insert_default().push(0.3);
    }
    Log::new(columns).unwrap()
}

/// The search begins with the motor alone, takes the longer lag for the winding, and L was 77 % too large, ±1.5.
#[test]
fn a_filter_slower_than_the_winding_is_not_taken_for_it() {
    let request = Request { swarm: Swarm::Off, ..Request::default() };
    let found = identify(&log(0.53e-3), &request).unwrap().identification;
    for parameter in [Parameter::Rs, Parameter::Ld, Parameter::Lq] {
        let value = found.parameter(parameter).value().unwrap();
        assert!((value / MOTOR.get(parameter) - 1.0).abs() < 0.03, "{parameter:?}: {value}");
    }
}
