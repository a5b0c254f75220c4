//! Our side of the comparison: times fluxfit on the log that `peers.py` wrote, one thread, and prints the figures as JSON.
//!
//! `fluxfit-benches LOG.csv [METHOD..]`, the paper's four methods unless others are named; `peers.py` and `methods.py` call it and set the
//! figures beside those of other programs.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

mod exact;
mod fitness;
mod swarm;
mod timing;

use fluxfit::{
    log::Log,
    motor::{Motor, PARAMETERS},
    objective::voltage_error::{IdZero, VoltageError},
    optimizer::{Bounds, Method},
    paper,
    steady::zero_order_hold::ZeroOrderHold,
};
use fluxfit_log::{LogOptions, read_log};
use serde::Serialize;
use std::{error::Error, ops::Range, path::Path};

/// What is measured. Times in the unit that the name says.
#[derive(Serialize)]
struct Figures {
    /// `F_LS` and where it is: for the peers to check that they minimize the same function.
    cost_least_squares: f64,
    motor_least_squares: Motor,
    nanoseconds_per_evaluation: f64,
    least_squares: exact::Figures,
    swarms: Vec<swarm::Figures>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("usage: fluxfit-benches LOG.csv [METHOD..]")?;
    let keys: Vec<String> = std::env::args().skip(2).collect();
    let named = |key: &String| Method::named(key).ok_or_else(|| format!("no method '{key}'"));
    let asked = keys.iter().map(named).collect::<Result<Vec<Method>, _>>()?;
    let methods = if asked.is_empty() { paper::METHODS.to_vec() } else { asked };
    let log = read_log(Path::new(&path), &LogOptions::default())?.log;
    // As the peers have them: without a correction.
    let modes = modes(&log)?.map(|rows| (rows, ZeroOrderHold::NONE));
    let bounds = Bounds::new(vec![0.0; PARAMETERS], paper::SEARCH_BOX.to_vec())?;
    let objective = VoltageError::of_samples(&log, &modes, IdZero::Measured);
    let figures = Figures {
        cost_least_squares: objective.least_squares().cost,
        motor_least_squares: objective.least_squares().motor,
        nanoseconds_per_evaluation: fitness::nanoseconds_per_evaluation(&objective, &bounds),
        least_squares: exact::measure(&log, &modes),
        swarms: methods.into_iter().map(|method| swarm::measure(method, &bounds, &objective)).collect::<Result<_, _>>()?,
    };
    println!("{}", serde_json::to_string_pretty(&figures)?);
    Ok(())
}

/// The two modes of fitness (11): all of each segment.
fn modes(log: &Log) -> Result<[Range<usize>; 2], String> {
    match log.segments() {
        [zero, negative] => Ok([zero.rows.clone(), negative.rows.clone()]),
        other => Err(format!("the log has {} segments, not one for each of two modes", other.len())),
    }
}
