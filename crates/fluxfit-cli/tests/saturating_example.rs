//! A motor that saturates, by the model that `identify` chooses itself. Simulated currents with every fault of the drive take a minute in a
//! debug build, so `./check --thorough` runs this; tests/command/simulate.rs has the same scenario by its operating points.

#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::{path::Path, process::Command};

#[test]
fn no_constant_of_the_saturating_example_is_identified() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("rig.csv").display().to_string();
    let fluxfit = |arguments: &[&str]| Command::new(env!("CARGO_BIN_EXE_fluxfit")).args(arguments).current_dir(&root).output().unwrap();
    assert!(fluxfit(&["simulate", "examples/scenarios/pm_syrm.toml", "-o", &log]).status.success());
    let run = fluxfit(&["identify", &log, "--json"]);
    assert_eq!(run.status.code(), Some(1));
    let document: Value = serde_json::from_slice(&run.stdout).unwrap();
    for (key, parameter) in document["parameters"].as_object().unwrap() {
        assert!(parameter["verdict"] != "identified", "{key}: {parameter}");
    }
    // psi_f may have a wide interval; the inductances fall to half, and have no value.
    for key in ["ld", "lq"] {
        assert!(document["parameters"][key]["value"].is_null(), "{key}");
    }
    assert!(document["warnings"].as_array().unwrap().iter().any(|warning| warning["code"] == "saturation"));
}
