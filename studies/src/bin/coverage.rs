//! Root-mean-square errors of the output error against their bound, and how often its 95 % intervals hold the truth, as a table.
//!
//! `coverage [DRAWS]`; 2000 draws of noise unless told otherwise: 200 could not tell 93 from 97 %. Of them a twentieth also find out by
//! themselves what the voltage columns mean.
// The table on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit::{motor::Parameter, objective::acting_voltage::VoltageTiming};
use fluxfit_studies::coverage::{Case, Tally};
use std::error::Error;

const DRAWS: usize = 2000;

/// To find what the voltages mean takes seven times as long.
const FEWER: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let draws = match std::env::args().nth(1) {
        None => DRAWS,
        Some(draws) => draws.parse().ok().filter(|draws| *draws > 0).ok_or("give a number of draws: coverage [DRAWS]")?,
    };
    println!(
        "| log | timing | draws | with a fault | parameter | bound, % | rms error / bound | bias / bound | 95 % intervals that hold, % |"
    );
    println!("|---|---|--:|--:|---|--:|--:|--:|--:|");
    for case in Case::all() {
        show(&case, "stated", &case.tally(Some(VoltageTiming::Centered), draws)?);
        show(&case, "found", &case.tally(None, draws.div_ceil(FEWER))?);
    }
    Ok(())
}

fn show(case: &Case, timing: &str, tally: &Tally) {
    for (parameter, figures) in Parameter::ALL.into_iter().zip(&tally.parameters) {
        println!(
            "| {} | {timing} | {} | {} | {} | {:.4} | {:.3} | {:+.3} | {:.1} |",
            case.name,
            tally.draws,
            tally.with_fault,
            parameter.symbol(),
            100.0 * figures.bound,
            figures.ratio,
            figures.bias,
            100.0 * figures.covered as f64 / tally.draws as f64,
        );
    }
}
