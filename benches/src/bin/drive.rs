//! How fast the drive is simulated: the paper's rig, one second, averaged and switched, on one thread; and many noise draws of a
//! short scenario on one thread and on all. Prints JSON; `drive.py` sets an independent simulator beside it.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_drive::{Scenario, scenario::Modulation, simulate};
use rayon::prelude::*;
use serde_json::json;
use std::{error::Error, hint::black_box, time::Instant};

/// Repetitions of the second; the median counts.
const REPEATS: usize = 21;
/// Noise draws, and how long each is, s.
const DRAWS: u64 = 1000;
const DRAW_SECONDS: f64 = 0.2;

fn main() -> Result<(), Box<dyn Error>> {
    let (averaged, switched) = (milliseconds(Modulation::Averaged)?, milliseconds(Modulation::Switched)?);
    let threads = std::thread::available_parallelism()?.get();
    let (one, all) = (draws_seconds(1)?, draws_seconds(threads)?);
    let figures = json!({
        "averaged_ms_per_second": averaged,
        "switched_ms_per_second": switched,
        "draws": DRAWS,
        "threads": threads,
        "draws_seconds_one_thread": one,
        "draws_seconds_all_threads": all,
    });
    println!("{figures:#}");
    Ok(())
}

/// Time, ms, for one simulated second.
fn milliseconds(modulation: Modulation) -> Result<f64, Box<dyn Error>> {
    let mut scenario = Scenario { duration: 1.0, ..Scenario::paper() };
    scenario.inverter.modulation = modulation;
    let mut times = Vec::new();
    for _ in 0..REPEATS {
        let start = Instant::now();
        black_box(simulate(&scenario, 0, || ())?);
        times.push(1e3 * start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    Ok(times[REPEATS / 2])
}

/// Time, s, for all draws.
fn draws_seconds(threads: usize) -> Result<f64, Box<dyn Error>> {
    let mut scenario = Scenario { duration: DRAW_SECONDS, ..Scenario::paper() };
    scenario.sensors.current_noise = 0.05;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let start = Instant::now();
    let lengths: Result<Vec<usize>, _> =
        pool.install(|| (0..DRAWS).into_par_iter().map(|draw| simulate(&scenario, draw, || ()).map(|r| r.columns.t.len())).collect());
    black_box(lengths?);
    Ok(start.elapsed().as_secs_f64())
}
