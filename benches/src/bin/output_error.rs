//! The output error's times on a log whose voltages are centred, one thread: a run of the paper's method with its 15 050 evaluations, one
//! evaluation, and the part of it that is matrix exponentials. `output_error [LOG.csv]`, by default the paper's rig with noise.
// The figures on standard output are what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit::{
    log::Log,
    motor::{Motor, PARAMETERS},
    objective::{
        acting_voltage::{VoltageFrame, VoltageTiming},
        output_error::OutputError,
        transition::Transition,
    },
    optimizer::{Bounds, Method, Objective, Optimizer, SearchSettings},
    paper,
};
use fluxfit_log::{LogOptions, read_log};
use std::{error::Error, hint::black_box, path::PathBuf, time::Instant};

const LOG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/logs/paper_rig_pwm_noise.csv");

/// Calls timed; the median counts.
const REPEATS: usize = 201;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(LOG), PathBuf::from);
    let log = read_log(&path, &LogOptions::default())?.log;
    let objective = OutputError::of(&log, VoltageTiming::Centered)?;
    let delayed = of_delayed(&log)?;
    let segment = log.segments().first().ok_or("the log has no segment")?;
    let omega_e = log.columns().omega_e[segment.rows.start];

    let evaluation = median_seconds(|| objective.cost(black_box(&paper::MOTOR)));
    let transition = median_seconds(|| Transition::of(black_box(&paper::MOTOR), omega_e, segment.sample_period));
    println!("rows                       {}", objective.rows());
    println!("one evaluation, us         {:.1}", 1e6 * evaluation);
    println!("  of delayed voltages, us  {:.1}", 1e6 * median_seconds(|| delayed.cost(black_box(&paper::MOTOR))));
    let near: Vec<f64> = (0..64).flat_map(|k| paper::MOTOR.to_array().map(|value| value * (1.0 + 1e-3 * f64::from(k)))).collect();
    let mut costs = vec![0.0; 64];
    println!("of 64, us a candidate      {:.2}", 1e6 / 64.0 * median_seconds(|| objective.evaluate(black_box(&near), &mut costs)));
    println!("  of delayed voltages, us  {:.2}", 1e6 / 64.0 * median_seconds(|| delayed.evaluate(black_box(&near), &mut costs)));
    println!("one matrix exponential, us {:.2}", 1e6 * transition);

    let bounds = Bounds::new(vec![0.0; PARAMETERS], paper::SEARCH_BOX.to_vec())?;
    let start = Instant::now();
    let report = Optimizer::start(Method::default(), SearchSettings::default(), bounds, &objective)?.run(&objective);
    println!("one run of tGFPA, s        {:.2}", start.elapsed().as_secs_f64());
    println!("evaluations                {}", report.evaluations);
    println!("ends at                    {:?}", Motor::from(<[f64; PARAMETERS]>::try_from(report.best.as_slice())?));
    Ok(())
}

/// With two linear unknowns instead of four: the difference is what two cost.
fn of_delayed(log: &Log) -> Result<OutputError, fluxfit::error::Error> {
    OutputError::of(log, VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Middle })
}

/// Median wall time of a call, s.
fn median_seconds<T>(mut call: impl FnMut() -> T) -> f64 {
    let mut seconds = [0.0; REPEATS];
    for seconds in &mut seconds {
        let start = Instant::now();
        black_box(call());
        *seconds = start.elapsed().as_secs_f64();
    }
    seconds.sort_unstable_by(f64::total_cmp);
    seconds[REPEATS / 2]
}
