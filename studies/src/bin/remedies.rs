//! Remedies carried out on the simulator: how many reach the width that they promise, as tables.
//!
//! `remedies [LOGS]`: the judged situations of the bicycle's motor and of a dozen others, then `LOGS` drawn logs (300 unless told
//! otherwise). `--list` adds a line for each remedy.
// Tables on standard output are what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_studies::{
    rated::typical,
    remedies::{
        Carried, Case, drawn, judged,
        situation::BICYCLE,
        survey,
        table::{list, table},
    },
};
use std::error::Error;

/// Drawn logs unless told otherwise.
const LOGS: u64 = 300;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let lists = arguments.iter().any(|word| word == "--list");
    arguments.retain(|word| word != "--list");
    let logs = match &arguments[..] {
        [] => LOGS,
        [logs] => logs.parse().map_err(|_| format!("{logs} is not a number of logs; give a whole number"))?,
        _ => return Err("give a number of logs: remedies [LOGS] [--list]".into()),
    };
    let show = |title: &str, cases: &[Case]| {
        let carried: Vec<Carried> = survey(cases);
        println!("## {title}: {} logs\n\n{}", cases.len(), table(&carried));
        if lists {
            println!("{}", list(&carried));
        }
    };
    show("The judged situations", &judged(&BICYCLE));
    show("The same with other motors", &typical().iter().flat_map(judged).collect::<Vec<_>>());
    show("Drawn logs", &drawn(logs, &typical()));
    Ok(())
}
