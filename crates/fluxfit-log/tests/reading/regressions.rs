//! Files that once made a reader fail, found by fuzzing: `regressions/READER/NAME`; and damaged logs of the corpus.

use crate::promises::{self, READERS};
use std::{fs, path::Path};

#[test]
fn files_that_once_made_a_reader_fail_are_handled() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions");
    for entry in fs::read_dir(&folder).unwrap() {
        let entry = entry.unwrap();
        let reader = entry.file_name().into_string().unwrap();
        if !entry.file_type().unwrap().is_dir() {
            continue;
        }
        let (_, promise) = READERS.into_iter().find(|(name, _)| *name == reader).unwrap_or_else(|| panic!("{reader} is not a reader"));
        for file in fs::read_dir(entry.path()).unwrap() {
            let path = file.unwrap().path();
            // Printed before, because a panic does not name the file.
            println!("{}", path.display());
            promise(&fs::read(&path).unwrap());
        }
    }
}

/// A log may be cut off anywhere, and any byte of it may be wrong.
#[test]
fn damaged_logs_do_not_make_the_reader_fail() {
    const PLACES: usize = 6;
    for file in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/logs")).unwrap() {
        let path = file.unwrap().path();
        println!("{}", path.display());
        let bytes = fs::read(&path).unwrap();
        promises::log(&bytes);
        // The first offsets are in the header, where most can go wrong; the others are spread over the file.
        let spread = (0..PLACES).flat_map(|place| [place * place, bytes.len() * place / PLACES]);
        for at in spread.filter(|at| *at < bytes.len()) {
            promises::log(&bytes[..at]);
            let mut wrong = bytes.clone();
            wrong[at] ^= 1 << (at % 8);
            promises::log(&wrong);
        }
    }
}
