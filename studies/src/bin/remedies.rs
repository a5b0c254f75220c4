//! Remedies carried out on the simulator: how many reach the width that they promise, as tables.
//!
//! `remedies [judged | motors | drawn [LOGS]] [--list]`: the judged situations of the bicycle's motor, of a dozen others, or drawn logs,
//! 300 unless told otherwise; without a word all of them. `--list` writes a line for each remedy, as they come.
// Tables on standard output are what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_studies::{
    rated::typical,
    remedies::{
        Case, drawn, judged,
        situation::BICYCLE,
        survey,
        table::{list, table},
    },
};
use std::error::Error;

/// Drawn logs unless told otherwise.
const LOGS: u64 = 300;

/// Logs between two writings of the list.
const SOME: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let lists = arguments.iter().any(|word| word == "--list");
    let words: Vec<&str> = arguments.iter().map(String::as_str).filter(|word| *word != "--list").collect();
    let (kinds, logs): (&[&str], u64) = match &words[..] {
        [] => (&["judged", "motors", "drawn"], LOGS),
        ["drawn", logs] => (&["drawn"], logs.parse().map_err(|_| format!("{logs} is not a number of logs; give a whole number"))?),
        [_] => (&words, LOGS),
        _ => return Err("give a kind of logs: remedies [judged | motors | drawn [LOGS]] [--list]".into()),
    };
    for kind in kinds {
        let (title, cases): (&str, Vec<Case>) = match *kind {
            "judged" => ("The judged situations", judged(&BICYCLE)),
            "motors" => ("The same with other motors", typical().iter().flat_map(judged).collect()),
            "drawn" => ("Drawn logs", drawn(logs, &typical())),
            other => return Err(format!("{other} is no kind of logs; give judged, motors or drawn").into()),
        };
        let mut carried = Vec::new();
        for some in cases.chunks(SOME) {
            let of_some = survey(some);
            if lists {
                print!("{}", list(&of_some));
            }
            carried.extend(of_some);
        }
        println!("## {title}: {} logs\n\n{}", cases.len(), table(&carried));
    }
    Ok(())
}
