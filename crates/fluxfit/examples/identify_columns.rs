//! From columns in memory to parameters with intervals, with R_s known to 2 %, and remedies in one's own words.
//!
//! `cargo run --release -p fluxfit --example identify_columns`
#![allow(clippy::print_stdout)] // An example prints.

use fluxfit::{Columns, Known, Log, Measurement, Motor, Parameter, Place, Promised, Remedy, Request, frames::Dq, identify};

fn main() -> Result<(), fluxfit::Error> {
    // A drone motor at i_d = 0 and two speeds, as a log at 1 kHz would have it; a real log has noise.
    let motor = Motor { rs: 0.035, ld: 18e-6, lq: 22e-6, psi_f: 1.9e-3 };
    let mut columns = Columns::default();
    for row in 0..2000 {
        let (i, omega_e) = (Dq { d: 0.0, q: 20.0 }, if row < 1000 { 3000.0 } else { 1500.0 });
        let u = motor.steady_voltage(i, omega_e);
        let values = [f64::from(row) * 1e-3, u.d, u.q, i.d, i.q, omega_e];
        let Columns { t, ud, uq, id, iq, omega_e, .. } = &mut columns;
        [t, ud, uq, id, iq, omega_e].into_iter().zip(values).for_each(|(column, value)| column.push(value));
    }
    let request = Request::default().with_known(Parameter::Rs, Known::Prior { value: 0.0352, standard_error: 0.0007 });
    let answer = identify(&Log::new(columns)?, &request)?;
    for judgement in answer.parameters() {
        let (parameter, verdict) = (judgement.parameter, judgement.verdict);
        println!("{parameter:6} {:?} {}: {verdict}", judgement.interval(), parameter.unit());
        if let Some(reason) = &judgement.reason {
            println!("       {reason}");
        }
        match &judgement.remedy {
            Some(Remedy::Measure(Promised {
                measurement: Measurement::Stretch { seconds, place: Place::Id(id), .. }, half_width, ..
            })) => {
                println!("       hold i_d at {id:.1} A for {seconds} s: then it is known to {:.1} %", 100.0 * half_width);
            }
            Some(remedy) => println!("       {remedy}"),
            None => {}
        }
    }
    answer.warnings().iter().for_each(|warning| println!("{}: {warning}", warning.code()));
    Ok(())
}
