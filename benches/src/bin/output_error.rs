//! The output error's times on a log, as JSON: of batches of candidates, of one alone, and of a run of the paper's method.
//!
//! `output_error [LOG.csv]`, by default the paper's rig with noise. `output_error.py` calls it, on one thread and on all, and evaluates the
//! same candidates by other means.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use fluxfit::{
    log::Log,
    motor::PARAMETERS,
    objective::{
        acting_voltage::{VoltageFrame, VoltageTiming},
        output_error::OutputError,
    },
    optimizer::{Bounds, Method, Objective, Optimizer, SearchSettings},
    paper,
};
use fluxfit_log::{LogOptions, read_log};
use serde::Serialize;
use std::{error::Error, hint::black_box, path::PathBuf, time::Instant};

const LOG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/logs/paper_rig_pwm_noise.csv");

/// Candidates of a batch: about a population.
const BATCH: usize = 64;

/// Relative distance of a candidate from the next.
const APART: f64 = 1e-3;

/// Calls timed; the median counts.
const REPEATS: usize = 51;

/// Runs of the paper's method timed; the median counts.
const RUNS: usize = 5;

#[derive(Serialize)]
struct Figures {
    rows: usize,
    threads: usize,
    candidates: Vec<[f64; PARAMETERS]>,
    delayed: Times,
    centred: Times,
    /// With centred voltages, in the paper's box.
    search: Search,
}

#[derive(Serialize)]
struct Search {
    evaluations: u64,
    wall_seconds: f64,
    /// Of all threads together.
    cpu_seconds: f64,
}

/// Of the processor, so that other work on the machine does not count.
#[derive(Serialize)]
struct Times {
    /// Of each candidate, A².
    costs: Vec<f64>,
    /// Microseconds per candidate of a batch.
    in_batch: f64,
    /// The same of a candidate alone.
    alone: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(LOG), PathBuf::from);
    let log = read_log(&path, &LogOptions::default())?.log;
    let candidates: Vec<[f64; PARAMETERS]> =
        (0..BATCH).map(|k| paper::MOTOR.to_array().map(|value| value * (1.0 + APART * k as f64))).collect();
    let centred = OutputError::of(&log, VoltageTiming::Centered)?;
    let delayed = VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Middle };
    let figures = Figures {
        rows: centred.rows(),
        threads: rayon::current_num_threads(),
        delayed: times(&log, delayed, &candidates)?,
        centred: times(&log, VoltageTiming::Centered, &candidates)?,
        candidates,
        search: search(&centred)?,
    };
    println!("{}", serde_json::to_string_pretty(&figures)?);
    Ok(())
}

/// Evaluates the candidates together and one alone.
fn times(log: &Log, timing: VoltageTiming, candidates: &[[f64; PARAMETERS]]) -> Result<Times, Box<dyn Error>> {
    let objective = OutputError::of(log, timing)?;
    let candidates = candidates.as_flattened();
    let mut costs = vec![0.0; BATCH];
    let (_, batch) = median_seconds(REPEATS, || objective.evaluate(black_box(candidates), black_box(&mut costs)));
    let (_, alone) = median_seconds(REPEATS, || black_box(objective.cost(black_box(&paper::MOTOR))));
    Ok(Times { costs, in_batch: 1e6 * batch / BATCH as f64, alone: 1e6 * alone })
}

/// A run of the paper's method with its own settings.
fn search(objective: &OutputError) -> Result<Search, Box<dyn Error>> {
    let bounds = Bounds::new(vec![0.0; PARAMETERS], paper::SEARCH_BOX.to_vec())?;
    let run = || -> Result<u64, fluxfit::error::Error> {
        let mut search = Optimizer::start(Method::default(), SearchSettings::default(), bounds.clone(), objective)?;
        Ok(search.run(objective).evaluations)
    };
    let evaluations = run()?;
    let (wall_seconds, cpu_seconds) = median_seconds(RUNS, run);
    Ok(Search { evaluations, wall_seconds, cpu_seconds })
}

/// Median times of a call, s: that passes, and of the processor.
fn median_seconds<T>(calls: usize, mut call: impl FnMut() -> T) -> (f64, f64) {
    let times = (0..calls).map(|_| {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        black_box(call());
        (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64())
    });
    let (mut wall, mut cpu): (Vec<f64>, Vec<f64>) = times.unzip();
    wall.sort_unstable_by(f64::total_cmp);
    cpu.sort_unstable_by(f64::total_cmp);
    (wall[calls / 2], cpu[calls / 2])
}
