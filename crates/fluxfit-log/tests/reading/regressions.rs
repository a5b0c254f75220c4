//! Files that once broke a promise of a reader, as fuzzing found them: `regressions/READER/NAME`. None breaks one again, and neither
//! do the logs of the corpus with damage.

use crate::promises::{self, READERS};
use std::{fs, path::Path};

#[test]
fn what_once_broke_a_promise_keeps_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions");
    for entry in fs::read_dir(&folder).unwrap() {
        let entry = entry.unwrap();
        let reader = entry.file_name().into_string().unwrap();
        if !entry.file_type().unwrap().is_dir() {
            continue;
        }
        let (_, promise) = READERS.into_iter().find(|(name, _)| *name == reader).unwrap_or_else(|| panic!("{reader} is no reader"));
        for file in fs::read_dir(entry.path()).unwrap() {
            let path = file.unwrap().path();
            // Told before, because a panic says only what broke, not on which file.
            println!("{}", path.display());
            promise(&fs::read(&path).unwrap());
        }
    }
}

/// A log may be cut off anywhere, and any byte of it may be wrong.
#[test]
fn damaged_logs_keep_the_promises() {
    const PLACES: usize = 12;
    for file in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/logs")).unwrap() {
        let path = file.unwrap().path();
        println!("{}", path.display());
        let bytes = fs::read(&path).unwrap();
        promises::log(&bytes);
        // The first places are in the header, where most can break; the others are spread.
        let spread = (0..PLACES).flat_map(|place| [place * place, bytes.len() * place / PLACES]);
        for at in spread.filter(|at| *at < bytes.len()) {
            promises::log(&bytes[..at]);
            let mut wrong = bytes.clone();
            wrong[at] ^= 1 << (at % 8);
            promises::log(&wrong);
        }
    }
}
