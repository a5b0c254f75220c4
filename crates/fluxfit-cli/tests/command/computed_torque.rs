//! A torque that a drive computes from its current.

use super::fluxfit;
use std::{fs, path::Path};

/// 0.2731 N m for each A, less what the bench takes.
fn table(folder: &Path, name: &str, drag: f64) -> String {
    let row = |k: i32| format!("{k},{:.6}\n", 0.2731 * f64::from(k) - drag);
    let path = folder.join(name);
    fs::write(&path, format!("q_A,torque_Nm\n{}", (1..15).map(row).collect::<String>())).unwrap();
    path.display().to_string()
}

/// A drive that logs a torque multiplies the current with its own setting.
#[test]
fn a_torque_that_the_drive_computes_is_no_measurement() {
    let folder = tempfile::tempdir().unwrap();
    let computed = table(folder.path(), "drive.csv", 0.0);
    for verb in ["identify", "inspect"] {
        let run = fluxfit(&[verb, &computed]);
        assert!(run.status == 2 && run.err.contains("exactly but for rounding"), "{}", run.err);
    }
    let measured = table(folder.path(), "bench.csv", 0.02);
    assert!(fluxfit(&["identify", &measured, "--pole-pairs", "4"]).status < 2);
}
