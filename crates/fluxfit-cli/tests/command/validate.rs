//! `fluxfit validate`: the right motor is accepted, a wrong one named, what is no motor refused.

use super::{fluxfit, json, root};
use std::{fs, path::PathBuf};
use tempfile::TempDir;

const NOISY: &str = "examples/logs/paper_rig_pwm_noise.csv";
const TWO_LOADS: &str = "examples/logs/id_zero_two_loads.csv";
const MOTOR: &str = "examples/paper_motor.toml";

/// A motor file of the paper's motor with these changes, and its directory.
fn motor(changes: &[(&str, &str)]) -> (TempDir, String) {
    let text = fs::read_to_string(root().join(MOTOR)).unwrap();
    file("motor.toml", &changes.iter().fold(text, |text, (from, to)| text.replace(from, to)))
}

fn file(name: &str, text: &str) -> (TempDir, String) {
    let directory = tempfile::tempdir().unwrap();
    let path: PathBuf = directory.path().join(name);
    fs::write(&path, text).unwrap();
    (directory, path.display().to_string())
}

#[test]
fn the_papers_motor_agrees_with_logs_of_an_independent_simulator() {
    for log in [NOISY, TWO_LOADS, "examples/logs/paper_rig_ideal.csv"] {
        for model in ["output-error", "steady"] {
            let (status, document) = json(&["validate", log, "--motor", MOTOR, "--model", model]);
            assert_eq!((status, &document["outcome"]), (0, &"agrees".into()), "{log}, {model}: {document}");
            assert!(document["share"].as_f64().unwrap() < 1e-3, "{document}");
        }
    }
}

#[test]
fn three_percent_of_lq_are_named() {
    let (_directory, path) = motor(&[("12 mH", "12.36 mH")]);
    let (status, document) = json(&["validate", NOISY, "--motor", &path]);
    assert_eq!((status, &document["schema"], &document["outcome"]), (1, &"fluxfit.validation/1".into(), &"contradicts".into()));
    // 12 / 12.36 - 1 is -2.913 %; the log's own error is a hundredth of it.
    let percent = |key: &str| document["parameters"][key]["difference_percent"].as_f64().unwrap();
    assert!((percent("lq") + 2.913).abs() < 0.05, "{}", percent("lq"));
    for key in ["rs", "ld", "psi_f"] {
        assert!(document["parameters"][key]["standard_errors"].as_f64().unwrap().abs() < 4.0, "{key}");
    }
    assert!(document["parameters"]["lq"]["standard_errors"].as_f64().unwrap() < -50.0);
    for channel in ["id", "iq"] {
        assert!(document["channels"][channel]["ratio"].as_f64().unwrap() > 2.0, "{document}");
    }
    let run = fluxfit(&["validate", NOISY, "--motor", &path]);
    assert!(
        run.status == 1 && super::unwrapped(&run.out).contains("The log asks for L_q 2.9") && run.out.contains("% lower"),
        "{}",
        run.out
    );
}

#[test]
fn a_person_sees_the_verdict_both_motors_and_the_channels() {
    let run = fluxfit(&["validate", TWO_LOADS, "--motor", MOTOR, "--model", "steady"]);
    assert_eq!(run.status, 0, "{}", run.err);
    for expected in ["Agrees within the noise", "This log cannot tell L_d: it is taken as given.", "in standard", "missed by", "explained"]
    {
        assert!(super::unwrapped(&run.out).contains(expected), "{expected} is not in\n{}", run.out);
    }
}

#[test]
fn what_identify_found_on_one_log_is_held_against_another() {
    let found = fluxfit(&["identify", NOISY, "--json"]);
    let (_directory, path) = file("found.json", &found.out);
    let (status, document) = json(&["validate", TWO_LOADS, "--motor", &path]);
    assert_eq!((status, &document["outcome"]), (0, &"agrees".into()), "{document}");
    assert!(document["parameters"]["lq"]["given_standard_error"].as_f64().unwrap() > 0.0);
    let truth = "examples/logs/paper_rig_pwm_noise.truth.json";
    assert_eq!(json(&["validate", NOISY, "--motor", truth]).0, 0);
    let piped = super::fluxfit_with_input(&["validate", TWO_LOADS, "--motor", "-", "--json"], found.out.as_bytes());
    assert_eq!(serde_json::from_str::<serde_json::Value>(&piped.out).unwrap(), document);
}

#[test]
fn what_is_no_motor_is_refused_in_a_sentence() {
    let (_one, incomplete) = motor(&[("ld = ", "# ld = "), ("psi_f = ", "# psi_f = ")]);
    let untold = fluxfit(&["identify", TWO_LOADS, "--model", "steady", "--json"]);
    let (_two, untold) = file("found.json", &untold.out);
    let (_three, study) = file("study.json", r#"{"schema": "fluxfit.study/1"}"#);
    for (path, sentence) in [
        (incomplete.as_str(), "the parameters ld and psi_f are missing; validation needs all four"),
        (&untold, "the parameter ld has no value, because the log could not determine it"),
        (&study, "which contains no motor; give a motor file"),
        ("nowhere.toml", "there is no such file"),
    ] {
        let run = fluxfit(&["validate", NOISY, "--motor", path]);
        assert!(run.status == 2 && run.out.is_empty(), "{path}: {}", run.out);
        assert!(
            run.err.starts_with(&format!("error: {path}")) && run.err.contains(sentence) && run.err.lines().count() == 1,
            "{}",
            run.err
        );
    }
    let run = fluxfit(&["validate", NOISY]);
    assert!(run.status == 2 && run.err.contains("--motor"), "{}", run.err);
    let run = fluxfit(&["validate", "-", "--motor", "-"]);
    assert!(run.status == 2 && run.err.contains("standard input can be read only once"), "{}", run.err);
    let run = fluxfit(&["validate", NOISY, "--motor", MOTOR, "--voltage-accuracy", "-1"]);
    assert!(run.status == 2 && run.err.contains("\"-1\" is out of range; it must be zero or more"), "{}", run.err);
    let run = fluxfit(&["validate", NOISY, "--motor", MOTOR, "--window", "5:6"]);
    assert!(run.status == 2 && run.err.contains("the window 5:6 s holds 0 consecutive rows"), "{}", run.err);
}

#[test]
fn a_page_is_written_beside_the_same_answer() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("validation.html").display().to_string();
    let run = fluxfit(&["validate", NOISY, "--motor", MOTOR, "--report", &path]);
    assert_eq!((run.status, &run.out), (0, &fluxfit(&["validate", NOISY, "--motor", MOTOR]).out));
    let page = fs::read_to_string(&path).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("Agrees within the noise") && page.contains("measured − predicted, mA"));
    // Thinned to the figure's columns, the page is not the log again.
    assert!(page.len() < 1_000_000, "{}", page.len());
    let run = fluxfit(&["validate", NOISY, "--motor", MOTOR, "--report", MOTOR]);
    assert!(run.status == 2 && run.err.contains("this file is read; name another one"), "{}", run.err);
}

#[test]
fn the_last_log_is_held_out_and_validated() {
    let (status, document) = json(&["identify", NOISY, TWO_LOADS, "--hold-out"]);
    let (_, alone) = json(&["identify", NOISY]);
    assert_eq!((status, &document["parameters"]), (0, &alone["parameters"]));
    let validation = &document["validation"];
    assert_eq!((&validation["outcome"], &validation["log"]["rows"]), (&"agrees".into(), &10_000.into()), "{validation}");
    let run = fluxfit(&["identify", NOISY, TWO_LOADS, "--hold-out"]);
    assert!(run.out.contains("This answer on what was held out") && run.out.contains("Agrees within the noise"), "{}", run.out);
    assert!(fluxfit(&["identify", NOISY, TWO_LOADS]).err.contains("--hold-out"));

    let untold = fluxfit(&["identify", TWO_LOADS, NOISY, "--hold-out", "--model", "steady"]);
    assert!(untold.status == 1 && untold.err.contains("what was held out is not predicted"), "{}", untold.err);
    let run = fluxfit(&["identify", NOISY, "--hold-out"]);
    assert!(run.status == 2 && run.err.contains("holding out needs several logs"), "{}", run.err);
}
