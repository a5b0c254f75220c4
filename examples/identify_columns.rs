//! From columns in memory to parameters with intervals: the library without files.
//!
//! `cargo run --release -p fluxfit --example identify_columns`
#![allow(clippy::print_stdout)] // An example speaks.

use fluxfit::{Columns, Log, Motor, Request, frames::Dq, identify};

fn main() -> Result<(), fluxfit::Error> {
    // A drone motor at two operating points, as a log at 1 kHz would have it; a real one brings noise.
    let motor = Motor { rs: 0.035, ld: 18e-6, lq: 22e-6, psi_f: 1.9e-3 };
    let mut columns = Columns::default();
    for k in 0..2000 {
        let (i, omega_e) = if k < 1000 { (Dq { d: 0.0, q: 20.0 }, 3000.0) } else { (Dq { d: -10.0, q: 18.0 }, 3000.0) };
        let u = motor.steady_voltage(i, omega_e);
        columns.t.push(f64::from(k) * 1e-3);
        columns.ud.push(u.d);
        columns.uq.push(u.q);
        columns.id.push(i.d);
        columns.iq.push(i.q);
        columns.omega_e.push(omega_e);
    }
    let found = identify(&Log::new(columns)?, &Settings::default())?;
    for judgement in &found.parameters {
        println!(
            "{:6} {:?} {} within {:?}: {}",
            judgement.parameter.key(),
            judgement.value(),
            judgement.parameter.unit(),
            judgement.interval(),
            judgement.verdict.key()
        );
    }
    for warning in &found.warnings {
        println!("{}: {}", warning.code, warning.message);
    }
    Ok(())
}
