//! `--export TARGET=FILE` and `--bandwidth`: every file says the motor that the answer says, in its tool's own way, and its tool's
//! own checker takes it; where the answer does not carry one there is none.

use super::{fluxfit, json, root};
use serde_json::Value;
use std::{
    collections::HashMap,
    f64::consts::{PI, TAU},
    fs,
    process::Command,
};
use tempfile::TempDir;

const LOG: &str = "examples/logs/paper_rig_pwm_noise.csv";
/// Its L_d is in no equation of the operating points.
const NO_LD: &str = "examples/logs/id_zero_two_loads.csv";
const POLE_PAIRS: f64 = 4.0;
const TARGETS: [(&str, &str); 4] = [("vesc", "motor.xml"), ("moteus", "motor.cfg"), ("mcsdk", "motor.h"), ("matlab", "motor.m")];

/// Digits that a file has: nine.
const ROUNDING: f64 = 5e-9;

/// All four files of a log, and the document of the same answer.
struct Exported {
    directory: TempDir,
    document: Value,
}

impl Exported {
    fn of(log: &str, more: &[&str]) -> Self {
        let directory = tempfile::tempdir().unwrap();
        let exports = TARGETS.map(|(target, file)| format!("{target}={}", directory.path().join(file).display()));
        let mut arguments = vec!["identify", log, "--model", "steady", "--pole-pairs", "4"];
        exports.iter().for_each(|export| arguments.extend(["--export", export]));
        arguments.extend(more);
        let (status, document) = json(&arguments);
        assert_eq!(status, 0, "{document}");
        Self { directory, document }
    }

    fn text(&self, file: &str) -> String {
        fs::read_to_string(self.path(file)).unwrap()
    }

    fn path(&self, file: &str) -> String {
        self.directory.path().join(file).display().to_string()
    }

    /// R_s, L_d, L_q, psi_f of the answer.
    fn motor(&self) -> [f64; 4] {
        ["rs", "ld", "lq", "psi_f"].map(|key| self.document["parameters"][key]["value"].as_f64().unwrap())
    }

    /// What a gain should be: one of the parameters times 500 Hz.
    fn assert_gain(&self, written: f64, parameter: f64) {
        assert_close(written, TAU * 500.0 * parameter);
    }
}

fn assert_close(written: f64, expected: f64) {
    assert!((written / expected - 1.0).abs() < ROUNDING, "{written} is not {expected}");
}

/// Values by name, from lines that a pattern takes apart.
fn values(text: &str, of_line: impl Fn(&str) -> Option<(String, f64)>) -> HashMap<String, f64> {
    text.lines().filter_map(of_line).collect()
}

fn vesc(text: &str) -> HashMap<String, f64> {
    values(text, |line| {
        let (key, rest) = line.trim().strip_prefix('<')?.split_once('>')?;
        Some((key.to_owned(), rest.strip_suffix(&format!("</{key}>"))?.parse().ok()?))
    })
}

fn moteus(text: &str) -> HashMap<String, f64> {
    values(text, |line| {
        let (key, value) = line.strip_prefix("conf set ")?.split_once(' ')?;
        Some((key.to_owned(), value.parse().unwrap()))
    })
}

fn mcsdk(text: &str) -> HashMap<String, f64> {
    values(text, |line| {
        let mut words = line.strip_prefix("#define ")?.split_whitespace();
        Some((words.next()?.to_owned(), words.next()?.parse().ok()?))
    })
}

fn matlab(text: &str) -> HashMap<String, f64> {
    values(text, |line| {
        let (key, rest) = line.split_once(" = ").filter(|_| !line.starts_with('%'))?;
        Some((key.to_owned(), rest.split_once(';')?.0.parse().unwrap()))
    })
}

#[test]
fn every_file_gives_the_motor_back() {
    let exported = Exported::of(LOG, &["--bandwidth", "500Hz"]);
    let [rs, ld, lq, psi_f] = exported.motor();
    let mechanical = TAU * POLE_PAIRS * 1000.0 / 60.0; // electrical rad/s at 1000 r/min

    let file = vesc(&exported.text("motor.xml"));
    assert_eq!(file.len(), 6);
    assert_close(file["foc_motor_r"], rs);
    // As the firmware takes them apart again.
    assert_close(file["foc_motor_l"] - file["foc_motor_ld_lq_diff"] / 2.0, ld);
    assert_close(file["foc_motor_l"] + file["foc_motor_ld_lq_diff"] / 2.0, lq);
    assert_close(file["foc_motor_flux_linkage"], psi_f);
    exported.assert_gain(file["foc_current_kp"], (ld + lq) / 2.0);
    exported.assert_gain(file["foc_current_ki"], rs);

    let file = moteus(&exported.text("motor.cfg"));
    assert_eq!(file.len(), 5);
    assert_close(file["motor.resistance_ohm"], rs);
    assert_close(file["motor.inductance_d_H"], ld);
    assert_close(file["motor.inductance_q_H"], lq);
    // As the firmware makes its flux of Kv: volts per turn in a second, over pi times the number of poles.
    let v_per_hz = 60.0 / (file["motor.Kv"] * 3.0_f64.sqrt());
    assert_close(v_per_hz / (PI * 2.0 * POLE_PAIRS), psi_f);
    assert_close(file["servo.pid_dq_hz"], 500.0);

    let file = mcsdk(&exported.text("motor.h"));
    assert_eq!(file.len(), 4);
    assert_close(file["RS"], rs);
    assert_close(file["LS"], lq);
    assert_close(file["POLE_PAIR_NUM"], POLE_PAIRS);
    // As the SDK makes the peak phase voltage of it: times sqrt 2, over sqrt 3.
    assert_close(file["MOTOR_VOLTAGE_CONSTANT"] * 2.0_f64.sqrt() / 3.0_f64.sqrt(), mechanical * psi_f);

    let file = matlab(&exported.text("motor.m"));
    assert_eq!(file.len(), 9);
    for (key, value) in [("pmsm.p", POLE_PAIRS), ("pmsm.Rs", rs), ("pmsm.Ld", ld), ("pmsm.Lq", lq), ("pmsm.FluxPM", psi_f)] {
        assert_close(file[key], value);
    }
    assert_close(file["pmsm.Ke"] / (3.0_f64.sqrt() * TAU * 1000.0 * POLE_PAIRS / 60.0), psi_f);
    for (key, parameter) in [("current_loop.Kp_d", ld), ("current_loop.Kp_q", lq), ("current_loop.Ki", rs)] {
        exported.assert_gain(file[key], parameter);
    }
}

#[test]
fn every_file_says_where_it_comes_from_and_how_sharp_it_is() {
    let exported = Exported::of(LOG, &[]);
    let [low, high] = [0, 1].map(|end| exported.document["parameters"]["psi_f"]["ci95"][end].as_f64().unwrap());
    for (_, file) in TARGETS {
        let text = exported.text(file);
        for expected in ["identified by fluxfit", "paper_rig_pwm_noise.csv", "95 % within", "https://", "no-redundancy"] {
            assert!(text.contains(expected), "{file} lacks {expected}:\n{text}");
        }
        assert!(!text.contains("examples/"), "{file} tells where the log lay");
    }
    let text = exported.text("motor.m");
    let (_, interval) = text.split_once("% pmsm.FluxPM = ").unwrap().1.lines().next().unwrap().split_once("within ").unwrap();
    let (from, to) = interval.strip_suffix(" Wb").unwrap().split_once(" .. ").unwrap();
    for (shown, expected) in [(from, low), (to, high)] {
        assert!((shown.parse::<f64>().unwrap() - expected).abs() < 0.01 * (high - low), "{shown} {expected}");
    }
    // The same log, the same bytes.
    let again = Exported::of(LOG, &[]);
    assert!(TARGETS.iter().all(|(_, file)| again.text(file) == exported.text(file)));
}

/// Runs a checker, or says why not.
fn check(program: &str, arguments: &[&str]) -> Option<String> {
    let Ok(output) = Command::new(program).args(arguments).output() else {
        println!("skipped: {program} is not here");
        return None;
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{program} {arguments:?}: {text}{}", String::from_utf8_lossy(&output.stderr));
    Some(text)
}

#[test]
fn the_tools_own_checkers_take_the_files_whatever_the_log_is_called() {
    let directory = tempfile::tempdir().unwrap();
    let log = directory.path().join("a--->b*∕%{.csv");
    fs::copy(root().join(LOG), &log).unwrap();
    let exported = Exported::of(&log.display().to_string(), &["--bandwidth", "0.5 kHz"]);
    let [rs, ..] = exported.motor();
    let user = exported.path("user.c");
    fs::write(&user, "double rs = RS, ls = LS, ke = MOTOR_VOLTAGE_CONSTANT; int p = POLE_PAIR_NUM;\n").unwrap();
    check("cc", &["-fsyntax-only", "-Wall", "-Wextra", "-pedantic", "-Werror", "-include", &exported.path("motor.h"), &user]);
    let program = "import sys, xml.etree.ElementTree as e\nr = e.parse(sys.argv[1]).getroot()\nassert r.tag == 'MCConfiguration'\nprint(r.find('foc_motor_r').text)";
    if let Some(text) = check("python3", &["-c", program, &exported.path("motor.xml")]) {
        assert_close(text.trim().parse().unwrap(), rs);
    }
    let script = format!("run('{}'); printf('%.17g', pmsm.Rs)", exported.path("motor.m"));
    if let Some(text) = check("octave-cli", &["--norc", "--no-history", "--quiet", "--eval", &script]) {
        assert_close(text.trim().parse().unwrap(), rs);
    }
    // What is for moteus fits its line of 100 characters and has a name and a number.
    let commands = exported.text("motor.cfg");
    let commands: Vec<&str> = commands.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(commands.iter().all(|line| line.len() <= 100 && line.starts_with("conf set ") && line.split(' ').count() == 4), "{commands:?}");
}

#[test]
fn what_is_not_identified_is_not_exported() {
    let directory = tempfile::tempdir().unwrap();
    let path = |file: &str| directory.path().join(file).display().to_string();
    let [xml, header] = [format!("vesc={}", path("a.xml")), format!("mcsdk={}", path("a.h"))];
    let run = fluxfit(&["identify", NO_LD, "--model", "steady", "--pole-pairs", "4", "--export", &xml, "--export", &header]);
    assert_eq!(run.status, 1);
    assert_eq!(run.out, fluxfit(&["identify", NO_LD, "--model", "steady", "--pole-pairs", "4"]).out);
    let sentence = run.err.lines().find(|line| line.contains("a.xml")).unwrap();
    assert!(
        sentence.starts_with(&format!("error: {} is not written: L_d is not identified, and VESC Tool would take", path("a.xml")))
            && sentence.contains("; add 0.2 s at i_d = -2 A"),
        "{sentence}"
    );
    // ST's header has no L_d.
    assert!(fs::read_to_string(path("a.h")).unwrap().contains("#define LS "));
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn pole_pairs_are_asked_for_before_anything_is_computed() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("motor").display().to_string();
    for (target, what) in [("moteus", "Kv"), ("mcsdk", "the voltage constant"), ("matlab", "pmsm.p")] {
        let run = fluxfit(&["identify", LOG, "--export", &format!("{target}={path}")]);
        assert!(run.status == 2 && run.out.is_empty(), "{}", run.err);
        assert!(
            run.err.contains(&format!("needs the pole pairs for {what}")) && run.err.contains("(--pole-pairs N, or --motor FILE"),
            "{}",
            run.err
        );
    }
    let run = fluxfit(&["identify", LOG, "--model", "steady", "--export", &format!("vesc={path}")]);
    assert!(run.status == 0 && run.err.contains(&format!("export: {path}")), "{}", run.err);
}

#[test]
fn an_export_never_takes_the_place_of_something_else() {
    let directory = tempfile::tempdir().unwrap();
    let path = |file: &str| directory.path().join(file).display().to_string();
    let log = path("log.csv");
    fs::copy(root().join(LOG), &log).unwrap();
    let refused = |arguments: &[&str], expected: &str| {
        let run = fluxfit(&[&["identify", &log], arguments].concat());
        assert!(run.status == 2 && run.out.is_empty() && run.err.contains(expected), "{arguments:?}: {}", run.err);
    };
    let [own, twice, page, nowhere] = ["log.csv", "a.xml", "a.html", "no/a.xml"].map(|file| format!("vesc={}", path(file)));
    refused(&["--export", "vesc=-"], "standard output is for the answer");
    refused(&["--export", &own], "this file is read; name another one");
    refused(&["--export", &twice, "--export", &twice], "this file is written already; name another one");
    refused(&["--export", &page, "--report", &path("a.html")], "this file is written already; name another one");
    refused(&["--export", &nowhere], "does not exist; create it");
    refused(&["--export", "vsec=a.xml"], "no target of --export; there are vesc, moteus, mcsdk and matlab; did you mean vesc?");
    refused(&["--export", "a.xml"], "write TARGET=FILE, as in vesc=motor.xml");
    refused(&["--bandwidth", "0"], "above zero");
    refused(&["--control-rate", "20kHz"], "--bandwidth");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    assert_eq!(fs::read(&log).unwrap(), fs::read(root().join(LOG)).unwrap());
}

#[test]
fn gains_are_shown_with_their_spread_and_a_bandwidth_too_high_is_warned_of() {
    let (status, document) = json(&["identify", LOG, "--model", "steady", "--bandwidth", "500Hz"]);
    let (gains, parameters) = (&document["current_loop"], &document["parameters"]);
    assert_eq!(status, 0);
    for (gain, parameter) in [(&gains["d"]["kp"], "ld"), (&gains["q"]["kp"], "lq"), (&gains["d"]["ki"], "rs"), (&gains["q"]["ki"], "rs")] {
        let pairs = [(&gain["value"], &parameters[parameter]["value"]), (&gain["ci95"][0], &parameters[parameter]["ci95"][0])];
        for (gain, parameter) in pairs {
            assert!((gain.as_f64().unwrap() / (1000.0 * PI * parameter.as_f64().unwrap()) - 1.0).abs() < 1e-12);
        }
    }
    // 10 kHz: 500 Hz for 150 us are 27 degrees.
    assert!((gains["phase_margin_deg"].as_f64().unwrap() - 63.0).abs() < 1e-3, "{gains}");
    assert!(json(&["identify", LOG, "--model", "steady"]).1.get("current_loop").is_none());

    let run = fluxfit(&["identify", LOG, "--model", "steady", "--bandwidth", "1 kHz"]);
    assert!(run.status == 0 && run.err.contains("[phase-margin]: 1000 Hz leaves a phase margin of 36 degrees"), "{}", run.err);
    for expected in ["Current controllers for 1000 Hz: phase margin 36 degrees", "K_p d", "K_p q", "K_i d, q", "V/(A s)", "L_q identified"]
    {
        assert!(run.out.contains(expected), "{expected} is not in\n{}", run.out);
    }
    let run = fluxfit(&["identify", LOG, "--model", "steady", "--bandwidth", "1 kHz", "--control-rate", "20 kHz"]);
    assert!(!run.err.contains("phase-margin") && run.out.contains("at 20000 Hz\n"), "{} {}", run.err, run.out);
    let run = fluxfit(&["identify", NO_LD, "--model", "steady", "--bandwidth", "500"]);
    assert!(run.status == 1 && run.out.contains("L_d not identifiable"), "{}", run.out);
}
