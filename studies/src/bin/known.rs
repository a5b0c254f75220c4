//! Logs whose truth is known, identified: a table of the errors and half-widths of a folder's logs.
//!
//! `known FOLDER`; what the folder holds stands in `src/known.rs`.
// A table on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_studies::known::{Outcome, read, table};
use std::{error::Error, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder] = &arguments[..] else { return Err("give a folder of logs, each with its truth: known FOLDER".into()) };
    let outcomes: Vec<Outcome> = read(Path::new(folder))?.into_iter().map(|log| log.identified()).collect::<Result<_, _>>()?;
    print!("{}", table(&outcomes));
    Ok(())
}
