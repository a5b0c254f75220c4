//! Whole identifications of short logs with what breaks programs: spikes, zeros, constants, gaps, huge and tiny values.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../promises/mod.rs"]
mod promises;

use fluxfit::optimizer::Draws;
use promises::READERS;

/// Bytes as a fuzzer makes them: any, and those of a sound log with a few rows changed.
#[test]
fn any_bytes_make_a_log_that_is_identified_or_refused() {
    let (_, promise) = READERS[0];
    for seed in 0..60 {
        let mut draws = Draws::seeded(seed, 0);
        let mut byte = || (256.0 * draws.uniform()) as u8;
        let mut any: Vec<u8> = (0..60).map(|_| byte()).collect();
        // Of the operating points; the fuzzer lets simulate currents as well, which takes long.
        any[1] = (any[1] & !3) | 2;
        promise(&any);
        // 160 rows at 10 kHz, two stretches, voltages by the equation; currents of some A, 400 rad/s.
        let sound = [158, 0, 100, 1, 3, 0, 0, 0, 0, 0, 0, 7, 0x90, 9, 7, 0x70, 9, 5, 0x30, 11];
        let changed: Vec<u8> = sound.into_iter().chain((0..12).map(|_| byte())).collect();
        promise(&changed);
    }
}

/// The fuzzer limits their time, too.
#[test]
fn what_the_fuzzer_found_is_identified_or_refused() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/regressions/identification");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(!files.is_empty(), "{folder} is empty");
    files.iter().for_each(|file| READERS[0].1(&std::fs::read(file).unwrap()));
}
