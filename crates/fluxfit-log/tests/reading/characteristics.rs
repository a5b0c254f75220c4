//! No log is taken for a table of a test bench.

use fluxfit_log::{LogOptions, read_characteristic};
use std::{fs, path::Path};

/// The one file of the corpus that is such a table, and no log.
const TABLE: &str = "table_beside_timetable.mat";

#[test]
fn no_log_of_the_corpus_is_a_characteristic() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/logs");
    let mut seen = 0;
    for file in fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.ends_with(TABLE) {
            assert!(read_characteristic(&path, &LogOptions { pole_pairs: Some(3), ..LogOptions::default() }).unwrap().is_some());
            continue;
        }
        assert_eq!(read_characteristic(&path, &LogOptions::default()), Ok(None), "{}", path.display());
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}
