//! Scenarios that no drive has are refused in one sentence on one line, with exit status 2, and leave no file behind.

use super::{Run, fluxfit, root};
use std::{fs, path::Path};

/// Writes the scenario beside the flux map of the examples, and simulates it into an empty folder, which must stay empty.
fn simulated(name: &str, text: &str) -> Run {
    let (folder, output) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let map = "baldor_ecs101_flux_map.csv";
    fs::copy(root().join("examples/scenarios").join(map), folder.path().join(map)).unwrap();
    let path = folder.path().join("s.toml");
    fs::write(&path, text).unwrap();
    let run = fluxfit(&["simulate", path.to_str().unwrap(), "-o", output.path().join("log.csv").to_str().unwrap()]);
    assert_eq!(fs::read_dir(output.path()).unwrap().count(), 0, "{name} left a file");
    run
}

fn refused(name: &str, run: &Run, expected: &[&str]) {
    assert_eq!(run.status, 2, "{name}: {}{}", run.out, run.err);
    assert_eq!(run.out, "", "{name}: {}", run.err);
    // Below the sentence stands at most the file's line.
    let (sentence, excerpt) = run.err.split_once('\n').unwrap();
    assert!(sentence.starts_with("error: ") && !run.err.contains("panicked"), "{name}: {}", run.err);
    assert!(excerpt.lines().count() <= 3 && excerpt.lines().all(|line| line.contains(" |")), "{name}: {}", run.err);
    for expected in expected {
        assert!(sentence.contains(expected), "{name}: {expected} is not in {sentence}");
    }
}

fn example(name: &str) -> String {
    fs::read_to_string(root().join("examples/scenarios").join(name)).unwrap()
}

#[test]
fn impossible_rigs() {
    let rig = example("paper_rig.toml");
    let table: &[(&str, &str, &str, &[&str])] = &[
        ("unknown key", "u_dc = \"310 V\"", "udc = \"310 V\"", &["line 24, key 'udc'", "did you mean u_dc?"]),
        ("unknown table", "[inverter]", "[inverters]", &["line 22, key 'inverters'", "did you mean inverter?"]),
        ("voltage", "\"1000 rpm\"", "\"5000 rpm\"", &["t = 0.15 s", "5000 r/min", "398.1 V", "179 V", "or allow control.field_weakening"]),
        (
            "voltage in spite of a weaker field",
            "# field_weakening = true\n\n[schedule]                            # zero before the first ramp; a ramp begins at `at` and takes `over`\nspeed = [{ at = \"0 s\", to = \"1000 rpm\"",
            "field_weakening = true\n[schedule]\nspeed = [{ at = \"0 s\", to = \"9000 rpm\"",
            &["9000 r/min", "with control.max_current"],
        ),
        ("current", "\"10 N m\"", "\"100 N m\"", &["t = 0.2 s", "100.8 N m", "91.99 A", "control.max_current is 20 A"]),
        ("reference", "\"-2 A\"", "\"-22 A\"", &["t = 0.6 s", "a current of 22 A", "control.max_current is 20 A"]),
        ("too few samples", "\"5 kHz\"", "\"50 Hz\"", &["line 27", "every 10 ms", "L/R of 5.48 ms", "inverter.carrier", "92 Hz"]),
        ("current loop", "\"200 Hz\"", "\"1 kHz\"", &["line 34", "control.current_bandwidth is 1000 Hz", "at most 397 Hz"]),
        ("speed loop", "\"20 Hz\"", "\"100 Hz\"", &["line 35", "control.speed_bandwidth is 100 Hz", "at most 66.6 Hz"]),
        ("no inertia", "\"0.003 kg m2\"", "0", &["line 19, key 'inertia'", "\"0\" is out of range", "above zero"]),
        ("negative inductance", "\"5.25 mH\"", "\"-5.25 mH\"", &["line 9, key 'ld'", "\"-5.25 mH\" is out of range"]),
        ("missing key", "rs = \"0.958 ohm\"\n", "", &["line 7", "the key rs is missing; write rs = \"0.958 ohm\" below [motor]"]),
        ("wrong unit", "\"0.958 ohm\"", "\"0.958 H\"", &["line 8, key 'rs'", "\"0.958 H\" is not a resistance"]),
        ("text", "\"0.958 ohm\"", "\"about one\"", &["line 8, key 'rs'", "\"about one\" is not a resistance"]),
        ("list", "\"0.958 ohm\"", "[1]", &["line 8, key 'rs'", "not a number"]),
        ("time before the start", "at = \"0.2 s\"", "at = \"-0.2 s\"", &["line 42", "schedule.load", "-0.2 s", "zero or more"]),
        (
            "i_q with a rotor of its own",
            "load = [",
            "iq = [{ at = 0, to = 1 }] # [",
            &["line 42", "schedule.iq", "mechanics.kind = \"dyno\""],
        ),
        ("inertia on a dynamometer", "# kind = \"dyno\"", "kind = \"dyno\" #", &["line 19", "mechanics.inertia", "leave it out"]),
        (
            "trip below the current",
            "# trip_current = \"30 A\"",
            "trip_current = \"10 A\"",
            &["line 37, key 'trip_current'", "control.max_current"],
        ),
        ("a year", "\"0.9 s\"", "\"31e6 s\"", &["line 4", "3.1e11 rows", "shorten duration"]),
        ("an instant", "\"0.9 s\"", "\"1 us\"", &["line 4, key 'duration'", "one sample to the next"]),
        ("rounding", "# current_gain = [1, 1, 1.02]", "current_gain = [1, 1, -0.30000000000000004]", &["line 55", "is -0.3; it must be"]),
        ("no TOML", "[motor]", "[motor", &["line 7", "this is not TOML"]),
        ("no map", "ld = \"5.25 mH\"\nlq = \"12 mH\"\npsi_f = \"0.1827 Wb\"", "flux_map = \"none.csv\"\n", &["none.csv", "no such file"]),
    ];
    for (name, from, to, expected) in table {
        assert!(rig.contains(from), "{name}: {from} is not in the rig");
        refused(name, &simulated(name, &rig.replacen(from, to, 1)), &[&["s.toml"][usize::from(*name == "no map")..], expected].concat());
    }
    refused("empty", &simulated("empty", ""), &["s.toml", "empty"]);
}

#[test]
fn a_map_that_does_not_cover_the_current() {
    let text = example("pm_syrm.toml").replace("\"-12 A\"", "\"-22 A\"").replace("\"25 A\"", "\"30 A\"");
    let expected = ["s.toml", "at t = 1.2 s", "near i_d = -22 A, i_q = 16 A", "covers i_d -20 .. 20 A and i_q -26 .. 26 A", "wider map"];
    refused("map", &simulated("map", &text), &expected);
}

/// The dynamometer jumps to a speed whose voltage arrives before the current controller does.
#[test]
fn a_drive_that_trips_says_when_and_why() {
    let rig = example("paper_rig.toml");
    let text = rig
        .replace("# kind = \"dyno\"", "kind = \"dyno\" #")
        .replace("inertia =", "# ")
        .replace("friction =", "# ")
        .replace("load =", "# ")
        .replace("310 V", "560 V")
        .replace("max_current = \"20 A\"", "max_current = \"5 A\"")
        .replace("at = \"0 s\", to = \"1000 rpm\", over = \"150 ms\"", "at = \"0.1 s\", to = \"3000 rpm\"");
    let expected = ["s.toml: the drive trips at t = 0.1005 s", "control.trip_current = 7.5 A", "at 3000 r/min", "raise the limit"];
    refused("trip", &simulated("trip", &text), &expected);
}

#[test]
fn places_that_hold_no_scenario_or_take_no_log() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    fs::write(at("s.toml"), example("paper_rig.toml")).unwrap();
    let (log, rig) = (at("log.csv"), "examples/scenarios/paper_rig.toml");
    refused("directory", &fluxfit(&["simulate", "examples", "-o", &log]), &["examples: this is a directory"]);
    refused("nothing there", &fluxfit(&["simulate", "none.toml", "-o", &log]), &["none.toml: there is no such file"]);
    refused("no folder", &fluxfit(&["simulate", rig, "-o", &at("no/log.csv")]), &["log.csv", "does not exist; create it"]);
    refused("a folder", &fluxfit(&["simulate", rig, "-o", &at("")]), &["this is a directory"]);
    refused("itself", &fluxfit(&["simulate", &at("s.toml"), "-o", &at("s.toml")]), &["is read, and would be overwritten", "-o"]);
    assert_eq!(fluxfit(&["simulate", rig]).status, 2);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Neither the log nor the truth may replace what was read: a scenario, a measured map.
#[test]
fn what_is_read_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    fs::copy(root().join("examples/scenarios/baldor_ecs101_flux_map.csv"), at("baldor_ecs101_flux_map.csv")).unwrap();
    fs::write(at("s.truth.json"), example("pm_syrm.toml")).unwrap();
    for output in ["baldor_ecs101_flux_map.csv", "s.csv", "s.truth.json"] {
        let before = fs::read(at("s.truth.json")).unwrap();
        let run = fluxfit(&["simulate", &at("s.truth.json"), "-o", &at(output)]);
        refused(output, &run, &["is read, and would be overwritten"]);
        assert_eq!(fs::read(at("s.truth.json")).unwrap(), before);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// Where the truth cannot be written, neither is the log.
#[test]
fn both_files_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = folder.path().join("log.truth.json");
    fs::create_dir(&blocked).unwrap();
    let run = fluxfit(&["simulate", "-o", Path::new(folder.path()).join("log.csv").to_str().unwrap()]);
    refused("blocked truth", &run, &["log.truth.json: this is a directory"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
