//! How fast logs are read, beside the parquet crate's own decoding: `reading FILE..`, each of them read several times; prints JSON.
//!
//! `reading.py` calls it, on one thread and on all, and sets it beside pandas and polars.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_log::{LogOptions, read_log};
use parquet::{
    column::reader::ColumnReader,
    file::reader::{FileReader, SerializedFileReader},
};
use serde::Serialize;
use std::{error::Error, fs::File, path::Path, time::Instant};

/// Readings of each file; the fastest counts.
const REPEATS: usize = 3;

/// Columns that a log is made of here.
const COLUMNS: [&str; 8] = ["t", "ud", "uq", "id", "iq", "omega_e", "theta_e", "u_dc"];

/// Values that are decoded at a time.
const BATCH: usize = 1 << 16;

#[derive(Serialize)]
struct Figures {
    file: String,
    bytes: u64,
    threads: usize,
    own: Times,
    /// The parquet crate alone, the same columns, on one thread.
    of_crate: Option<Times>,
}

/// Times of the fastest reading, s.
#[derive(Serialize)]
struct Times {
    /// Of all threads together: other work on the machine does not count.
    cpu: f64,
    wall: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut figures = Vec::new();
    for file in std::env::args().skip(1) {
        let path = Path::new(&file);
        let is_parquet = path.extension().is_some_and(|ending| ending == "parquet");
        let (mut own, mut of_crate) = (Times::longest(), Times::longest());
        // In turns, so that both see the same machine.
        for _ in 0..REPEATS {
            own.measure(|| Ok(read_log(path, &LogOptions::default())?.log.rows()))?;
            if is_parquet {
                of_crate.measure(|| decode(path))?;
            }
        }
        let bytes = std::fs::metadata(path)?.len();
        figures.push(Figures { file, bytes, threads: rayon::current_num_threads(), own, of_crate: is_parquet.then_some(of_crate) });
    }
    println!("{}", serde_json::to_string_pretty(&figures)?);
    Ok(())
}

impl Times {
    fn longest() -> Self {
        Self { cpu: f64::INFINITY, wall: f64::INFINITY }
    }

    /// Does the work once more.
    fn measure(&mut self, work: impl FnOnce() -> Result<usize, Box<dyn Error>>) -> Result<(), Box<dyn Error>> {
        let (cpu, wall) = (cpu_time::ProcessTime::now(), Instant::now());
        std::hint::black_box(work()?);
        self.cpu = self.cpu.min(cpu.elapsed().as_secs_f64());
        self.wall = self.wall.min(wall.elapsed().as_secs_f64());
        Ok(())
    }
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
