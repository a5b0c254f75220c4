//! The paper's rig against motulator 0.5.0, an independent simulator: `examples/logs/paper_rig_ideal.csv`.
//!
//! Its controllers, from its source and its log: current loop 200 Hz, speed loop 20 Hz, both as ours; up to speed in 0.15 s, loaded
//! at 0.2 s, i_d stepped at 0.6 s. One difference: its integrators follow the centred realized voltage of the period before, ours
//! the limited command of the same sample, so its i_d settles 1.6 mA off its reference and its transient comes one sample later.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit_drive::{Recording, Scenario, scenario::Modulation, simulate};
use std::path::Path;

/// Columns of the independent log after `t`, as ours are named.
const COLUMNS: [&str; 8] = ["ud", "uq", "id", "iq", "omega_e", "theta_e", "ud_ref", "uq_ref"];

fn theirs() -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/logs/paper_rig_ideal.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    (1..=COLUMNS.len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}

fn ours() -> Recording {
    let mut scenario = Scenario::paper();
    scenario.inverter.modulation = Modulation::Averaged;
    simulate(&scenario, 0, || ()).unwrap()
}

fn column(recording: &Recording, name: &str) -> Vec<f64> {
    recording.named().into_iter().find(|(other, _)| *other == name).map(|(_, values)| values.to_vec()).unwrap()
}

#[test]
fn steady_means_agree() {
    let (theirs, ours) = (theirs(), ours());
    for rows in [4800..5950, 7800..8950] {
        let mean = |values: &[f64]| values[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let pairs: Vec<(f64, f64)> = COLUMNS.iter().zip(&theirs).map(|(name, theirs)| (mean(&column(&ours, name)), mean(theirs))).collect();
        let magnitude = |d: usize| pairs[d].1.hypot(pairs[d + 1].1);
        for (d, vector) in [(0, "u"), (2, "i"), (6, "u_ref")] {
            for axis in [d, d + 1] {
                let off = (pairs[axis].0 - pairs[axis].1).abs() / magnitude(d);
                println!("{}: {off:.1e} of |{vector}|", COLUMNS[axis]);
                assert!(off < 1e-3, "{}: {:?}", COLUMNS[axis], pairs[axis]);
            }
        }
        assert!((pairs[4].0 / pairs[4].1 - 1.0).abs() < 1e-6);
    }
}

#[test]
fn the_step_of_id_agrees() {
    let (theirs, ours) = (theirs(), ours());
    let (id, iq) = (column(&ours, "id"), column(&ours, "iq"));
    let rows = 5990..6400;
    let off = |lag: usize| {
        let squares = rows.clone().map(|k| (id[k] - theirs[2][k + lag]).powi(2) + (iq[k] - theirs[3][k + lag]).powi(2));
        (squares.sum::<f64>() / rows.len() as f64).sqrt() / theirs[2][5900].hypot(theirs[3][5900])
    };
    println!("rms of the current vector: {:.2e} as it stands, {:.2e} with the start aligned", off(0), off(1));
    assert!(off(1) < 0.02);
}
