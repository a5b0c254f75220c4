//! The real command, run as a user runs it.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[path = "command/accuracy.rs"]
mod accuracy;
#[path = "command/bad_input.rs"]
mod bad_input;
#[path = "command/bad_scenario.rs"]
mod bad_scenario;
#[path = "command/characteristics.rs"]
mod characteristics;
#[path = "command/compare.rs"]
mod compare;
#[path = "command/computed_torque.rs"]
mod computed_torque;
#[path = "command/craft.rs"]
mod craft;
#[path = "command/edges.rs"]
mod edges;
#[path = "command/export.rs"]
mod export;
#[path = "command/findings.rs"]
mod findings;
#[path = "command/fleet.rs"]
mod fleet;
#[path = "command/identify.rs"]
mod identify;
#[cfg(unix)]
#[path = "command/interrupt.rs"]
mod interrupt;
#[cfg(target_os = "linux")]
#[path = "command/live.rs"]
mod live;
#[path = "command/pages.rs"]
mod pages;
#[path = "command/reading.rs"]
mod reading;
#[path = "command/recorder.rs"]
mod recorder;
#[path = "command/report.rs"]
mod report;
#[path = "command/schema.rs"]
mod schema;
#[path = "command/simulate.rs"]
mod simulate;
#[path = "command/track.rs"]
mod track;
#[path = "command/validate.rs"]
mod validate;

use serde_json::Value;
use std::{
    io::Write,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// What a run left behind.
struct Run {
    status: i32,
    out: String,
    err: String,
}

/// Runs `fluxfit` in the repository's root, with this on its standard input.
fn fluxfit_with_input(arguments: &[&str], input: &[u8]) -> Run {
    let mut child = Command::new(env!("CARGO_BIN_EXE_fluxfit"))
        .args(arguments)
        .current_dir(root())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that refuses its arguments may be gone before it reads.
    let _ = child.stdin.take().unwrap().write_all(input);
    let output = child.wait_with_output().unwrap();
    Run {
        status: output.status.code().expect("ended by a signal"),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

fn fluxfit(arguments: &[&str]) -> Run {
    fluxfit_with_input(arguments, b"")
}

/// Runs `fluxfit ... --json` and reads its document, which fits its schema.
fn json(arguments: &[&str]) -> (i32, Value) {
    let run = fluxfit(&[arguments, &["--json"]].concat());
    let document = serde_json::from_str(&run.out).unwrap_or_else(|error| panic!("{error}: {} {}", run.out, run.err));
    schema::assert_fits(&document);
    (run.status, document)
}

/// A text without its line breaks: words are wrapped wherever a line ends.
fn unwrapped(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A log of the shared data that may not be copied; tests that need one are skipped, with a word, where it is absent.
fn shared(name: &str) -> Option<String> {
    let path = root().join("../shared/data").join(name);
    if !path.exists() {
        println!("skipped: {name} is not here");
        return None;
    }
    Some(path.display().to_string())
}
