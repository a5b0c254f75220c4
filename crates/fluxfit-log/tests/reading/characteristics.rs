//! Tables of a test bench: what is taken for one, and what a file is that is none. No log is taken for one.

use fluxfit_log::{Inspection, LogOptions, inspect, read_characteristic};
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

fn with_file<T>(text: &str, act: impl Fn(&Path) -> T) -> T {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("table.csv");
    fs::write(&path, text).unwrap();
    act(&path)
}

fn inspected(text: &str) -> Inspection {
    with_file(text, |path| inspect(path, &LogOptions::default()).unwrap())
}

/// What an identification refuses, an inspection does not call a table to identify from.
#[test]
fn an_inspection_checks_a_table_as_an_identification_does() {
    let propeller = [2.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0].map(|speed: f64| format!("{speed},{},{}\n", speed.powi(2), speed.powi(2)));
    let refused = [
        (format!("RPM,Torque_Nm,Current_A\n{}", propeller.concat()), "propeller"),
        ("rpm,I [A]\n1000,15\n".to_owned(), "too few speeds (1"),
        ("rpm,U_ll [V]\n3000,5\n3060,5\n3120,5.01\n".to_owned(), "same at all speeds"),
    ];
    for (text, sentence) in refused {
        let inspected = inspected(&text);
        let refusal = inspected.log.unwrap_err().to_string();
        assert!(inspected.is_table && inspected.table.is_none() && refusal.contains(sentence), "{text}: {refusal}");
    }
    // Another table may make up for what one lacks.
    let shorted = "rpm,I [A]\n100,1\n200,2\n400,3.8\n800,7\n1600,11\n3200,14\n";
    let table = inspected(shorted).table.unwrap().table;
    assert!(table.needs_another() && table.describe() == "short-circuit characteristic of 6 speeds");
}
