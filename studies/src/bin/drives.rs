//! Logs as drives make them, identified, and how many of the numbers are wrong, as tables.
//!
//! `drives [LOGS | FIRST..END] [--motors MOTORS.csv]` draws logs over motors, faults, courses and kinds of logs; the first 200 and a dozen
//! motors of our own unless told otherwise; with `--clean` first, of drives without a fault. With `--list` last, a line for each log comes
//! first. `drives [--clean] --show N [--motors MOTORS.csv]` writes log number N as CSV, and its scenario to standard error.
// Tables on standard output are what this program is for.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use fluxfit_setup::write_recording;
use fluxfit_studies::{
    drives::{
        Drawn, survey,
        table::{list, tables},
    },
    rated::{Rated, read, typical},
};
use std::{error::Error, ops::Range, path::Path};

/// Logs unless told otherwise: a few minutes.
const LOGS: u64 = 200;

/// Draws the log of a number.
type Draw = fn(u64, &[Rated]) -> Option<Drawn>;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let lists = arguments.iter().any(|word| word == "--list");
    let words: Vec<&str> = arguments.iter().map(String::as_str).filter(|word| *word != "--list").collect();
    let (words, motors): (&[&str], Vec<Rated>) = match &words[..] {
        [rest @ .., "--motors", path] => (rest, read(Path::new(path))?),
        all => (all, typical()),
    };
    let (words, draw): (&[&str], Draw) = match words {
        ["--clean", rest @ ..] => (rest, Drawn::without_fault),
        all => (all, Drawn::new),
    };
    match words {
        [] => print(0..LOGS, &motors, draw, lists),
        ["--show", index] => show(&draw(number(index)?, &motors).ok_or("the file has no motors")?)?,
        [logs] => print(range(logs)?, &motors, draw, lists),
        _ => return Err("give a number of logs: drives [--clean] [LOGS | FIRST..END | --show N] [--motors MOTORS.csv] [--list]".into()),
    }
    Ok(())
}

fn number(word: &str) -> Result<u64, String> {
    word.parse().map_err(|_| format!("{word} is not a number of logs; give a whole number"))
}

/// So many logs from the first one on, or those from one number to before another.
fn range(word: &str) -> Result<Range<u64>, String> {
    match word.split_once("..") {
        Some((first, end)) => Ok(number(first)?..number(end)?),
        None => Ok(0..number(word)?),
    }
}

fn print(logs: Range<u64>, motors: &[Rated], draw: Draw, lists: bool) {
    println!("logs {} to before {} of {} motors", logs.start, logs.end, motors.len());
    let found = survey(logs, motors, draw);
    if lists {
        print!("{}", list(&found));
    }
    print!("{}", tables(&found));
}

/// For a closer look at one log.
fn show(drawn: &Drawn) -> Result<(), Box<dyn Error>> {
    eprintln!("{drawn:#?}");
    write_recording(&mut std::io::stdout().lock(), &drawn.record()?)?;
    Ok(())
}
