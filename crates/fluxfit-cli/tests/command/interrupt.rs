//! Ctrl-C: the best so far where there is one, one sentence where there is none, and never half a file.
//!
//! A signal is sent once `--verbose` has said that the work in question begins, and that work would take seconds.

use super::{json, root};
use serde_json::Value;
use std::{
    fs,
    io::{BufRead, BufReader, Read},
    path::Path,
    process::{Child, ChildStderr, ChildStdout, Command, Stdio},
    thread::JoinHandle,
};

const LOG: &str = "examples/logs/paper_rig_pwm_noise.csv";

/// A command at work.
struct Running {
    child: Child,
    err: BufReader<ChildStderr>,
    /// Read meanwhile, or a full pipe would hold the command up.
    out: JoinHandle<String>,
}

impl Running {
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_fluxfit"))
            .args(arguments)
            .arg("--verbose")
            .current_dir(root())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (err, out) = (BufReader::new(child.stderr.take().unwrap()), child.stdout.take().unwrap());
        Self { child, err, out: std::thread::spawn(move || whole(out)) }
    }

    /// Waits for a line on standard error with these words.
    fn wait_for(&mut self, words: &str) {
        let mut seen = String::new();
        while !seen.lines().last().is_some_and(|line| line.contains(words)) {
            assert_ne!(self.err.read_line(&mut seen).unwrap(), 0, "'{words}' never came:\n{seen}");
        }
    }

    fn send(&self, signal: &str) {
        assert!(Command::new("kill").args(["-s", signal, &self.child.id().to_string()]).status().unwrap().success());
    }

    /// Exit status, standard output and the rest of standard error.
    fn end(mut self) -> (Option<i32>, String, String) {
        let mut err = String::new();
        self.err.read_to_string(&mut err).unwrap();
        (self.child.wait().unwrap().code(), self.out.join().unwrap(), err)
    }
}

fn whole(mut out: ChildStdout) -> String {
    let mut text = String::new();
    out.read_to_string(&mut text).unwrap();
    text
}

#[test]
fn a_study_shows_the_runs_that_are_finished_and_they_are_those_of_the_whole_study() {
    let study = ["compare", LOG, "--runs", "20", "--iterations", "4000", "--methods"];
    let mut running = Running::start(&[&study[..], &["tgfpa,fpa,lpso,apso", "--json"]].concat());
    running.wait_for("FPA: 20 runs begin");
    // The first such line is tGFPA's own.
    running.wait_for("FPA: 20 runs begin");
    running.send("INT");
    let (status, out, err) = running.end();
    assert_eq!(status, Some(130), "{err}");
    assert!(err.contains("interrupted: comparing ends with the best so far"), "{err}");
    assert!(err.contains("warning [interrupted]: of 20 runs of each method these are finished: tGFPA 20, FPA "), "{err}");
    let document: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(document["interrupted"], true);
    assert!(document["methods"].as_array().unwrap().len() < 4);
    let (status, mut alone) = json(&[&study[..], &["tgfpa"]].concat());
    assert_eq!((status, &alone["interrupted"]), (0, &Value::Bool(false)));
    let mut first = document["methods"][0].clone();
    for method in [&mut first, &mut alone["methods"][0]] {
        method["seconds_per_run"] = Value::Null;
    }
    assert_eq!(first, alone["methods"][0]);
}

#[test]
fn a_study_without_a_finished_run_is_an_empty_one() {
    for shown in [&["--json"][..], &[]] {
        // As long as is allowed: hours.
        let study = ["compare", LOG, "--methods", "lpso", "--runs", "3", "--population", "3000", "--iterations", "1000000"];
        let mut running = Running::start(&[&study[..], shown].concat());
        running.wait_for("LPSO: 3 runs begin");
        running.send("TERM");
        let (status, out, err) = running.end();
        assert_eq!(status, Some(143), "{err}");
        assert!(err.contains("LPSO 0;") && !out.contains("NaN"), "{err}{out}");
        if !shown.is_empty() {
            let document: Value = serde_json::from_str(&out).unwrap();
            assert_eq!((&document["interrupted"], document["methods"].as_array().unwrap().len()), (&Value::Bool(true), 0));
        }
    }
}

#[test]
fn a_second_signal_ends_at_once() {
    // One iteration takes seconds.
    let study =
        ["compare", LOG, "--model", "output-error", "--voltage-timing", "centered", "--population", "60000", "--runs", "2", "--json"];
    let mut running = Running::start(&study);
    running.wait_for("tGFPA: 2 runs begin");
    running.send("INT");
    running.wait_for("once more ends it at once");
    running.send("INT");
    let (status, out, err) = running.end();
    assert_eq!((status, out.as_str()), (Some(130), ""), "{err}");
    assert!(err.contains("interrupted: while comparing"), "{err}");
}

#[test]
fn an_identification_keeps_its_answer_when_its_swarm_is_cut() {
    let arguments = ["identify", LOG, "--voltage-timing", "centered"];
    let mut running = Running::start(&[&arguments[..], &["--method", "tgfpa", "--json"]].concat());
    running.wait_for("searching");
    running.send("INT");
    let (status, out, err) = running.end();
    assert_eq!(status, Some(130), "{err}");
    assert!(err.contains("warning [interrupted]: the swarm made"), "{err}");
    let document: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(document["search"]["stop_reason"], "interrupted");
    assert_eq!(document["parameters"], json(&arguments).1["parameters"]);
}

#[test]
fn what_has_no_best_so_far_says_what_was_interrupted() {
    let mut running = Running::start(&["identify", LOG, "--json"]);
    running.wait_for("trying the timings of the voltages");
    running.send("INT");
    let (status, out, err) = running.end();
    assert_eq!((status, out.as_str()), (Some(130), ""), "{err}");
    assert!(err.contains("interrupted: while "), "{err}");
}

/// People get what the operating points say, marked as rough: 1 % of the truth, where the whole answer has a tenth of that.
#[test]
fn people_get_a_rough_answer_where_there_is_one() {
    let mut running = Running::start(&["identify", LOG]);
    running.wait_for("trying the timings of the voltages");
    running.send("INT");
    let (status, out, err) = running.end();
    assert_eq!(status, Some(130), "{err}");
    assert!(out.starts_with("Rough answer: ") && !out.contains("identified"), "{out}{err}");
    for (symbol, truth) in [("R_s", 0.958), ("L_d", 5.25), ("L_q", 12.0), ("psi_f", 0.1827)] {
        let line = out.lines().find(|line| line.trim_start().starts_with(symbol)).unwrap();
        let value: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
        assert!((value / truth - 1.0).abs() < 0.01, "{line}");
    }
}

#[test]
fn people_are_told_that_there_is_no_answer_yet() {
    // The first 0.09 s: the speed rises throughout, and there is no operating point.
    let text = fs::read_to_string(root().join(LOG)).unwrap();
    let ramp: Vec<&str> = text.lines().take(900).collect();
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), ramp.join("\n")).unwrap();
    let mut running = Running::start(&["identify", file.path().to_str().unwrap(), "--model", "output-error"]);
    running.wait_for("trying the timings of the voltages");
    running.send("INT");
    let (status, out, err) = running.end();
    assert_eq!(status, Some(130), "{err}");
    assert!(out.starts_with("There is no answer yet"), "{out}{err}");
}

/// The paper's rig for a hundred seconds.
fn long_scenario(directory: &Path) -> String {
    let template = super::fluxfit(&["simulate", "--template"]).out;
    let long: Vec<&str> = template.lines().map(|line| if line.starts_with("duration") { "duration = \"100 s\"" } else { line }).collect();
    assert!(long.contains(&"duration = \"100 s\""), "{template}");
    let path = directory.join("long.toml");
    fs::write(&path, long.join("\n")).unwrap();
    path.to_str().unwrap().to_owned()
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().to_str().unwrap().to_owned()).collect();
    names.sort();
    names
}

/// Whether SIGHUP, the first signal, is in the mask of those that this process and its children ignore; Linux tells.
fn hang_up_is_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() & 1 == 1)
}

#[test]
fn a_simulation_leaves_no_file() {
    let directory = tempfile::tempdir().unwrap();
    let scenario = long_scenario(directory.path());
    let log = directory.path().join("log.csv");
    // Of a terminal that is closed it is HUP; who starts a command with nohup, these tests for one, wants it to go on.
    let hang_up = (!hang_up_is_ignored()).then_some(("HUP", 129));
    for (signal, expected) in std::iter::once(("INT", 130)).chain(hang_up) {
        let mut running = Running::start(&["simulate", &scenario, "-o", log.to_str().unwrap()]);
        running.wait_for("simulating");
        running.send(signal);
        let (status, out, err) = running.end();
        assert_eq!((status, out.as_str()), (Some(expected), ""), "{err}");
        assert!(err.contains("interrupted: while simulating"), "{err}");
        assert_eq!(names(directory.path()), ["long.toml"]);
    }
}

#[test]
fn a_log_that_is_being_written_is_whole_or_was_never_there() {
    let directory = tempfile::tempdir().unwrap();
    let scenario = long_scenario(directory.path());
    let log = directory.path().join("log.csv");
    fs::write(&log, "old").unwrap();
    let mut running = Running::start(&["simulate", &scenario, "-o", log.to_str().unwrap()]);
    running.wait_for("writing ");
    running.send("TERM");
    let (status, _, err) = running.end();
    let (names, is_old) = (names(directory.path()), fs::read(&log).unwrap() == b"old");
    // A machine on which this test sleeps while a million rows are written sees the whole log.
    match is_old {
        true => assert!(status == Some(143) && names == ["log.csv", "long.toml"], "{status:?} {names:?} {err}"),
        false => assert!(names == ["log.csv", "log.truth.json", "long.toml"], "{status:?} {names:?} {err}"),
    }
}
