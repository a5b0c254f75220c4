//! How fast logs are read, beside the parquet crate's own decoding: `reading FILE..`, each of them read several times; prints JSON.
//!
//! `reading.py` calls it, and sets it beside pandas. Times are CPU seconds of the one thread that reads: other work on the machine
//! does not count.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_log::{LogOptions, read_log};
use parquet::{
    column::reader::ColumnReader,
    file::reader::{FileReader, SerializedFileReader},
};
use serde::Serialize;
use std::{error::Error, fs::File, path::Path};

/// Readings of each file; the fastest counts.
const REPEATS: usize = 7;

/// Columns that a log is made of here.
const COLUMNS: [&str; 8] = ["t", "ud", "uq", "id", "iq", "omega_e", "theta_e", "u_dc"];

/// Values that are decoded at a time.
const BATCH: usize = 1 << 16;

#[derive(Serialize)]
struct Figures {
    file: String,
    bytes: u64,
    seconds: f64,
    /// The parquet crate alone, the same columns.
    seconds_of_crate: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut figures = Vec::new();
    for file in std::env::args().skip(1) {
        let path = Path::new(&file);
        let is_parquet = path.extension().is_some_and(|ending| ending == "parquet");
        let (mut own, mut of_crate) = (f64::INFINITY, f64::INFINITY);
        // In turns, so that both see the same machine.
        for _ in 0..REPEATS {
            own = own.min(seconds(|| Ok(read_log(path, &LogOptions::default())?.log.rows()))?);
            if is_parquet {
                of_crate = of_crate.min(seconds(|| decode(path))?);
            }
        }
        let bytes = std::fs::metadata(path)?.len();
        figures.push(Figures { file, bytes, seconds: own, seconds_of_crate: is_parquet.then_some(of_crate) });
    }
    println!("{}", serde_json::to_string_pretty(&figures)?);
    Ok(())
}

/// CPU time of this thread.
fn seconds(work: impl FnOnce() -> Result<usize, Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let start = cpu_time::ThreadTime::now();
    std::hint::black_box(work()?);
    Ok(start.elapsed().as_secs_f64())
}

/// The columns as vectors, by the crate alone.
fn decode(path: &Path) -> Result<usize, Box<dyn Error>> {
    let reader = SerializedFileReader::new(File::open(path)?)?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); COLUMNS.len()];
    let mut levels = Vec::new();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        for (column, name) in columns.iter_mut().zip(COLUMNS) {
            let place = (0..group.num_columns()).find(|place| group.metadata().column(*place).column_path().string() == name);
            let ColumnReader::DoubleColumnReader(mut values) = group.get_column_reader(place.ok_or(name)?)? else {
                return Err(format!("{name} is no column of doubles").into());
            };
            loop {
                levels.clear();
                let (read, ..) = values.read_records(BATCH, Some(&mut levels), None, column)?;
                if read == 0 {
                    break;
                }
            }
        }
    }
    Ok(columns[0].len())
}
