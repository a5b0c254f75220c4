//! Logs of real drives, which are not part of the project and may be absent.

use crate::fixtures::refusal;
use fluxfit_log::{LogOptions, read_log};
use std::path::{Path, PathBuf};

/// A file that is not part of the project and may be absent.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    if !path.exists() {
        eprintln!("skipped: ../shared/data/{name} is absent");
    }
    path.exists().then_some(path)
}

#[test]
fn real_logs_without_voltages_are_refused_clearly() {
    let Some(path) = shared("capo01_odrive_dyno_loss.csv") else { return };
    let bytes = std::fs::read(path).unwrap();
    let sentence = refusal(&bytes, &LogOptions::default());
    assert!(
        sentence.starts_with("drive.csv, line 2: the columns t, ud, uq, id, iq and omega_e are missing; the file has 'Input voltage', ")
    );
    assert!(
        sentence.ends_with(
            "by their names, 'Test motor d-axis current' may be id, 'Test motor q-axis current' may be iq and 'Output Speed' may be omega_e: \
             map them if they are; no column resembles t, ud and uq"
        ),
        "{sentence}"
    );

    let Some(path) = shared("paderborn_lea_subset_no_uq.csv") else { return };
    let bytes = std::fs::read(path).unwrap();
    let sentence = refusal(&bytes, &LogOptions::default());
    assert!(sentence.starts_with("drive.csv, line 1: the column uq is missing; the file has 'coolant', "), "{sentence}");
}

#[test]
fn real_logs_are_read() {
    let Some(path) = shared("emrax228hv_coastdown_dyno.csv") else { return };
    let read = read_log(&path, &LogOptions { pole_pairs: Some(10), ..LogOptions::default() }).unwrap();
    assert_eq!((read.log.rows(), read.layout.map(|layout| layout.name)), (14_595, Some("Tritium, names with units")));
    let notes = [
        "omega_e: column 'motor_velocity_rpm' read as mechanical r/min with 10 pole pairs",
        "27 gaps, the longest of 4.19 s at t = 654.604 s: nothing is computed across them",
    ];
    assert_eq!(read.log.source().notes[1..], notes);
    let expected = -637.188 * std::f64::consts::TAU / 60.0 * 10.0;
    assert!((read.log.columns().omega_e[0] - expected).abs() < 1e-9);

    let Some(path) = shared("stm32_mcsdk_dewalt_excerpt.csv") else { return };
    let read = read_log(&path, &LogOptions { pole_pairs: Some(2), ..LogOptions::default() }).unwrap();
    assert_eq!((read.log.rows(), read.log.columns().t[1]), (26, 829.061));

    let Some(path) = shared("a_ideal_averaged.csv") else { return };
    let read = read_log(&path, &LogOptions::default()).unwrap();
    assert_eq!((read.log.rows(), read.notes.len()), (9001, 0));
    // From row to row the angle increases by speed times period, apart from whole turns.
    let columns = read.log.columns();
    let angle = columns.theta_e.as_ref().unwrap();
    let turns = (angle[8001] - angle[8000] - columns.omega_e[8000] * (columns.t[8001] - columns.t[8000])) / std::f64::consts::TAU;
    assert!((turns - turns.round()).abs() < 1e-5, "{turns}");
}

/// Dead time, filters, jitter, coarse converters, coasting, gaps: whatever a drive does, it is no spike.
#[test]
fn no_row_of_a_drive_is_taken_for_a_spike() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/logs");
    let mut read = 0;
    for folder in [Some(examples), shared("drives"), shared(".")].into_iter().flatten() {
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let options = LogOptions { pole_pairs: Some(10), ..LogOptions::default() };
            // Some files beside them are no logs.
            let Ok(found) = read_log(&path, &options) else { continue };
            assert!(found.log.spikes().is_empty(), "{}: {}", path.display(), found.log.spikes());
            read += 1;
        }
    }
    assert!(read >= 3, "{read}");
}
