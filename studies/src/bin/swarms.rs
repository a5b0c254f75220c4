//! All search methods on fitness (11), the output error and BBOB: the tables of docs/swarms.md.
//!
//! `swarms`; or `swarms errors DIMENSION INSTANCES METHOD..`: which targets of BBOB these methods reach, as CSV for `benches/bbob.py`.
// Tables on standard output are what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit::{
    Model,
    optimizer::{METHODS, Method},
};
use fluxfit_studies::swarms::{
    invariance::{on_spheres, sensitivity},
    on_bbob::{EXACT, ROUGH, runs},
    on_logs::compare_all,
    table::Results,
};
use std::{error::Error, path::Path};

/// Runs on fitness (11) and on the spheres; on the output error, whose evaluation takes ten thousand times as long.
const RUNS: usize = 25;
const RUNS_OF_OUTPUT_ERROR: usize = 11;

/// Dimensions and instances of BBOB.
const DIMENSIONS: [usize; 3] = [2, 5, 10];
const INSTANCES: u64 = 5;

const IDEAL: &str = "examples/logs/paper_rig_ideal.csv";
const NOISY: &str = "examples/logs/paper_rig_pwm_noise.csv";

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match &words[..] {
        [] => tables(),
        ["errors", dimension, instances, methods @ ..] => errors(dimension.parse()?, instances.parse()?, methods),
        _ => Err("usage: swarms [errors DIMENSION INSTANCES METHOD..]".into()),
    }
}

fn tables() -> Result<(), Box<dyn Error>> {
    let methods = || METHODS.iter().map(|facts| facts.default);
    let results = Results {
        ideal: compare_all(Path::new(IDEAL), Model::Steady, RUNS)?,
        noisy: compare_all(Path::new(NOISY), Model::Steady, RUNS)?,
        output_error: compare_all(Path::new(NOISY), Model::OutputError, RUNS_OF_OUTPUT_ERROR)?,
        bbob: methods().map(|method| runs(method, &DIMENSIONS, INSTANCES)).collect::<Result<_, _>>()?,
        sensitivity: methods().map(sensitivity).collect::<Result<_, _>>()?,
        spheres: methods().map(|method| on_spheres(method, RUNS)).collect::<Result<_, _>>()?,
    };
    println!("{}\n{}\n{}", results.table(), results.sensitive(), results.spheres());
    DIMENSIONS.into_iter().for_each(|dimension| println!("{}", results.running_times(dimension)));
    Ok(())
}

/// Method, function, instance, whether it reached 1e-1 and 1e-8.
fn errors(dimension: usize, instances: u64, keys: &[&str]) -> Result<(), Box<dyn Error>> {
    for key in keys {
        let method = Method::named(key).ok_or_else(|| format!("no method '{key}'"))?;
        for run in runs(method, &[dimension], instances)? {
            let [rough, exact] = [ROUGH, EXACT].map(|target| u8::from(run.reached[target].is_some()));
            println!("{key},{},{},{rough},{exact}", run.function, run.instance);
        }
    }
    Ok(())
}
