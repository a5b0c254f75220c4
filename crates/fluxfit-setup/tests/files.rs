//! Files of the examples, whole and damaged.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test may fail")]

mod promises;

use fluxfit::motor::Motor;
use fluxfit_setup::{Truth, read_truth};
use promises::READERS;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Files of the examples, with the reader for each.
const EXAMPLES: [(&str, &str); 6] = [
    ("motor_file", "paper_motor.toml"),
    ("given_motor", "paper_motor.toml"),
    ("given_motor", "logs/paper_rig_ideal.truth.json"),
    ("truth", "logs/paper_rig_ideal.truth.json"),
    ("scenario_file", "scenarios/traction.toml"),
    ("flux_map", "scenarios/baldor_ecs101_flux_map.csv"),
];

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)
}

#[test]
fn the_truth_of_an_example_is_read() {
    let motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
    assert_eq!(read_truth(&example("logs/paper_rig_ideal.truth.json")), Ok(Truth { motor, pole_pairs: Some(4) }));
}

/// A file may be cut off anywhere, and any byte of it may be wrong.
#[test]
fn damaged_files_do_not_make_a_reader_fail() {
    const PLACES: usize = 40;
    for (reader, name) in EXAMPLES {
        let (_, promise) = READERS.into_iter().find(|(other, _)| *other == reader).unwrap();
        let mut bytes = fs::read(example(name)).unwrap();
        // The first rows of a flux map are enough.
        bytes.truncate(4000);
        for place in 0..PLACES {
            let at = bytes.len() * place / PLACES;
            // Printed before, because a panic does not name the file.
            println!("{name}, byte {at}");
            promise(&bytes[..at]);
            let mut wrong = bytes.clone();
            wrong[at] ^= 1 << (at % 8);
            promise(&wrong);
        }
    }
}
