//! Runs one of the kernels whose instructions `instructions.py` counts: `kernels NAME CALLS`. Preparations are the same for any number of
//! calls, so that the difference of two runs is the calls alone.

use fluxfit::{
    motor::PARAMETERS,
    objective::{
        acting_voltage::VoltageTiming,
        output_error::OutputError,
        voltage_error::{IdZero, VoltageError},
    },
    optimizer::Objective,
    paper,
    steady::zero_order_hold::ZeroOrderHold,
};
use fluxfit_drive::{Scenario, simulate};
use fluxfit_log::{LogOptions, read_log};
use std::{error::Error, hint::black_box, path::Path};

/// The paper's rig with switched inverter and noise, 9000 rows.
const LOG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/logs/paper_rig_pwm_noise.csv");

/// Candidates of a batch of the output error, and of a population on fitness (11).
const BATCH: usize = 64;
const POPULATION: usize = 50;

/// Relative distance of a candidate from the next.
const APART: f64 = 1e-3;

/// Rows of one mode of fitness (11); its time does not depend on them.
const ROWS: usize = 1000;

fn main() -> Result<(), Box<dyn Error>> {
    let usage = "usage: kernels output-error|fitness|csv|simulation CALLS";
    let mut arguments = std::env::args().skip(1);
    let (name, calls) = (arguments.next().ok_or(usage)?, arguments.next().ok_or(usage)?.parse::<usize>()?);
    let read = || read_log(Path::new(LOG), &LogOptions::default());
    match name.as_str() {
        "output-error" => {
            let objective = OutputError::of(&read()?.log, VoltageTiming::Centered)?;
            evaluate(&objective, BATCH, calls);
        }
        "fitness" => {
            let modes = [(0..ROWS, ZeroOrderHold::NONE), (ROWS..2 * ROWS, ZeroOrderHold::NONE)];
            evaluate(&VoltageError::of_samples(&read()?.log, &modes, IdZero::Measured), POPULATION, calls);
        }
        "csv" => {
            for _ in 0..calls {
                black_box(read()?);
            }
        }
        "simulation" => {
            let second = Scenario { duration: 1.0, ..Scenario::paper() };
            for _ in 0..calls {
                black_box(simulate(&second, 0, || ())?);
            }
        }
        _ => return Err(usage.into()),
    }
    Ok(())
}

/// Evaluates as many candidates around the paper's motor at once.
fn evaluate(objective: &impl Objective, candidates: usize, calls: usize) {
    let near = |k: usize| paper::MOTOR.to_array().map(|value| value * (1.0 + APART * k as f64));
    let candidates: Vec<[f64; PARAMETERS]> = (0..candidates).map(near).collect();
    let mut costs = vec![0.0; candidates.len()];
    for _ in 0..calls {
        objective.evaluate(black_box(candidates.as_flattened()), black_box(&mut costs));
    }
}
