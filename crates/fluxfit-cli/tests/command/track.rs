//! `fluxfit track`: from a file, standard input, a growing file and a socket; alarms, states, what is refused.

use super::{fluxfit, fluxfit_with_input, json, root, schema, unwrapped};
use serde_json::Value;
use std::{
    fs::{self, File},
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const NOISY: &str = "examples/logs/paper_rig_pwm_noise.csv";
const TWO_LOADS: &str = "examples/logs/id_zero_two_loads.csv";
const TRUTH: [(&str, f64); 4] = [("rs", 0.958), ("ld", 5.25e-3), ("lq", 12e-3), ("psi_f", 0.1827)];

fn log(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap()
}

/// The documents of a run, each of which fits its schema.
fn documents(out: &str) -> Vec<Value> {
    let read = |line: &str| {
        let document: Value = serde_json::from_str(line).unwrap();
        schema::assert_fits(&document);
        document
    };
    out.lines().map(read).collect()
}

/// Part of a value that its interval spans at most. After a gap block least squares differs by 2 % from the filter in L_d, which i_d tells
/// in one step alone, and the interval holds both.
const NARROW: f64 = 0.12;

fn assert_holds_the_truth(document: &Value) {
    for (key, truth) in TRUTH {
        let ends: Vec<f64> = document[key]["ci95"].as_array().unwrap().iter().map(|end| end.as_f64().unwrap()).collect();
        assert!(ends[0] < truth && truth < ends[1] && ends[1] - ends[0] < NARROW * truth, "{key}: {ends:?}");
    }
}

#[test]
fn a_log_is_followed_from_a_file_and_from_standard_input_to_the_same_lines() {
    let of_file = fluxfit(&["track", NOISY, "--json"]);
    let of_input = fluxfit_with_input(&["track", "-", "--json"], log(NOISY).as_bytes());
    assert_eq!((of_file.status, of_input.status), (0, 0), "{}", of_input.err);
    assert_eq!(of_file.out, of_input.out);
    let lines = documents(&of_file.out);
    // Every 100 ms of 0.9 s, and the end.
    assert_eq!(lines.len(), 10);
    assert_eq!(lines.iter().filter(|line| line["last"] == true).count(), 1);
    let last = lines.last().unwrap();
    assert_eq!((&last["rows"], &last["last"], &last["voltage_timing"]), (&9000.into(), &true.into(), &"centered".into()));
    assert_holds_the_truth(last);
}

#[test]
fn the_table_at_the_end_fits_80_columns_and_says_what_is_not_identifiable() {
    let run = fluxfit(&["track", TWO_LOADS]);
    assert_eq!(run.status, 1, "{}", run.err);
    assert!(run.out.lines().all(|line| line.chars().count() <= 80), "{}", run.out);
    assert!(unwrapped(&run.out).contains("L_d - not identifiable now"), "{}", run.out);
}

#[test]
fn lines_of_csv_have_the_columns_of_their_header() {
    let run = fluxfit(&["track", NOISY, "--csv", "--every", "50ms", "--method", "rls"]);
    let mut lines = run.out.lines();
    let columns = lines.next().unwrap().split(',').count();
    assert_eq!(columns, 1 + 4 * 4 + 2);
    assert!(lines.clone().count() == 19 && lines.all(|line| line.split(',').count() == columns), "{}", run.out);
}

#[test]
fn an_alarm_has_its_own_status_and_says_when() {
    // Of the true 0.958 ohm, 0.8 ohm plus 10 % is exceeded; plus 30 % is not.
    let start = ["track", NOISY, "--voltage-timing", "centered", "--start", "rs=0.8,ld=5mH,lq=12mH,psi_f=0.18", "--alarm"];
    let rung = fluxfit(&[&start[..], &["rs=+10%"]].concat());
    assert_eq!(rung.status, 3, "{}", rung.err);
    assert!(rung.err.contains("[alarm]: R_s is 0.9") && rung.err.contains("from 0.8000, at t = 0."), "{}", rung.err);
    let quiet = fluxfit(&[&start[..], &["rs=+30%,rs=-10%"]].concat());
    assert_eq!(quiet.status, 0, "{}", quiet.err);
}

#[test]
fn a_saved_state_goes_on_to_the_same_bits() {
    let text = log(NOISY);
    let lines: Vec<&str> = text.lines().collect();
    let part = |rows: &[&str]| format!("{}\n{}\n", lines[0], rows.join("\n"));
    let folder = tempfile::tempdir().unwrap();
    let state = folder.path().join("state.json").display().to_string();
    let first = fluxfit_with_input(&["track", "-", "--save-state", &state], part(&lines[1..4001]).as_bytes());
    assert_eq!(first.status, 1, "{}", first.err);
    let second = fluxfit_with_input(&["track", "-", "--resume", &state, "--json"], part(&lines[4001..]).as_bytes());
    let whole = fluxfit(&["track", NOISY, "--json"]);
    assert_eq!(second.out.lines().last(), whole.out.lines().last());
    for text in ["{}", "t,ud,uq\n", r#"{"schema": "fluxfit.track-state/0", "tracker": {}}"#] {
        fs::write(&state, text).unwrap();
        let refused = fluxfit(&["track", NOISY, "--resume", &state]);
        let sentence =
            "this is not a state that this version of fluxfit track has saved; save one with: fluxfit track LOG --save-state state.json";
        assert!(refused.status == 2 && unwrapped(&refused.err).contains(sentence), "{}", refused.err);
    }
}

#[test]
fn temperatures_are_told_from_a_motor_file() {
    // A nameplate of 0.8 ohm at 20 degC: 0.958 ohm are (0.958 / 0.8 - 1) / 0.00393 = 50.3 K above.
    let folder = tempfile::tempdir().unwrap();
    let motor = folder.path().join("motor.toml");
    fs::write(&motor, "[motor]\nrs = 0.8\npsi_f = 0.19\nmagnet_coefficient = \"-0.12 %/K\"\n").unwrap();
    let run = fluxfit(&["track", NOISY, "--motor", &motor.display().to_string(), "--reference-temperature", "20", "--json"]);
    let last = documents(&run.out).pop().unwrap();
    let winding = last["winding_temperature"]["value"].as_f64().unwrap();
    // (0.1827 / 0.19 - 1) / -0.0012 = 32.0 K above.
    let magnets = last["magnet_temperature"]["value"].as_f64().unwrap();
    assert!((winding - 70.3).abs() < 4.0 && (magnets - 52.0).abs() < 2.0, "{winding} {magnets}");
}

#[test]
fn wrong_usage_is_refused_in_a_sentence() {
    for (arguments, sentence) in [
        (&["track", NOISY, "--method", "kalman"][..], "no estimator 'kalman'; there are ekf-tracking, ekf, rls"),
        (&["track", NOISY, "--fix", "rs=1", "--prior", "rs=1±1%"], "rs is given twice among --start, --prior and --fix"),
        (&["track", NOISY, "--every", "0"], "the time must be above zero"),
        (&["track", NOISY, "--voltage-timing", "averaged"], "track knows centered, 0, 1, 2"),
        (&["track", "nothing.csv"], "there is no such file"),
        (&["track", "nothing.csv", "--follow"], "there is no such file"),
        (&["track", NOISY, "--alarm", "rs"], "is not understood"),
    ] {
        let run = fluxfit(arguments);
        assert_eq!(run.status, 2, "{arguments:?}");
        assert!(run.err.contains(sentence), "{arguments:?}: {}", run.err);
    }
    let no_speed = fluxfit_with_input(&["track", "-"], b"t,ud,uq,id,iq\n0,1,2,3,4\n1,1,2,3,4\n2,1,2,3,4\n");
    assert_eq!(no_speed.status, 2);
    assert!(no_speed.err.contains("omega_e is missing"), "{}", no_speed.err);
    let empty = fluxfit_with_input(&["track", "-"], b"");
    assert_eq!(empty.status, 2, "{}", empty.err);
}

#[test]
fn cut_lines_and_garbage_are_left_out_and_counted() {
    let mut lines: Vec<String> = log(NOISY).lines().map(str::to_owned).collect();
    lines[5000].truncate(20);
    lines[6000] = lines[6000].replacen(',', ",nan", 1);
    lines[7000] = "rubbish".to_owned();
    let run = fluxfit_with_input(&["track", "-", "--json"], (lines.join("\n") + "\n").as_bytes());
    let last = documents(&run.out).pop().unwrap();
    assert_eq!(last["left_out"]["not_numbers"], 3, "{}", run.err);
    assert!(run.err.contains("3 with a value that is no number or cut off"), "{}", run.err);
    assert_holds_the_truth(&last);
}

/// A command that runs on, with its lines.
struct Running {
    child: Child,
    out: BufReader<std::process::ChildStdout>,
    err: BufReader<std::process::ChildStderr>,
}

impl Running {
    fn of(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_fluxfit"))
            .args(arguments)
            .current_dir(root())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (out, err) = (BufReader::new(child.stdout.take().unwrap()), BufReader::new(child.stderr.take().unwrap()));
        Self { child, out, err }
    }

    fn line(&mut self) -> Value {
        let mut line = String::new();
        self.out.read_line(&mut line).unwrap();
        documents(&line).pop().unwrap()
    }

    /// The lines up to the one at this time.
    fn until(&mut self, t: f64) -> Value {
        loop {
            let line = self.line();
            if line["t"].as_f64().unwrap() > t - 1e-6 {
                return line;
            }
        }
    }

    #[cfg(unix)]
    fn interrupted(mut self) -> (i32, String, String) {
        let interrupt = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status().unwrap();
        assert!(interrupt.success());
        let (mut out, mut err) = (String::new(), String::new());
        self.out.read_to_string(&mut out).unwrap();
        self.err.read_to_string(&mut err).unwrap();
        (self.child.wait().unwrap().code().unwrap(), out, err)
    }
}

/// Rows that arrive one by one are told at once: the limit is ten times the 10 ms that an idle machine keeps.
#[test]
fn lines_are_written_as_rows_arrive() {
    let text = log(NOISY);
    let mut running = Running::of(&["track", "-", "--json", "--every", "10ms", "--voltage-timing", "centered"]);
    let mut input = running.child.stdin.take().unwrap();
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    // The row at 0.3 s is the 3001st below the header.
    input.write_all(lines[..3001].concat().as_bytes()).unwrap();
    running.until(0.29);
    let begun = Instant::now();
    input.write_all(lines[3001].as_bytes()).unwrap();
    assert!((running.line()["t"].as_f64().unwrap() - 0.3).abs() < 1e-9);
    assert!(begun.elapsed() < Duration::from_millis(100), "{:?}", begun.elapsed());
    drop(input);
    assert_eq!(running.until(0.3).get("last"), Some(&true.into()));
    assert!(running.child.wait().is_ok());
}

/// The first voltage, of which centred voltages do not tell, is no reason for another inductance.
#[test]
fn a_stream_may_begin_in_the_middle_of_a_drive() {
    let text = log(NOISY);
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    for first in [1000, 1200, 1500, 1700] {
        let rest = format!("{}{}", lines[0], lines[first..].concat());
        let run = fluxfit_with_input(&["track", "-", "--json", "--voltage-timing", "centered"], rest.as_bytes());
        assert_holds_the_truth(&documents(&run.out).pop().unwrap());
    }
}

#[cfg(unix)]
#[test]
fn a_growing_file_is_followed_through_rotation_and_truncation() {
    let text = log(NOISY);
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let part = |rows: std::ops::Range<usize>| format!("{}{}", lines[0], lines[rows].concat());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    fs::write(&path, part(1..2002)).unwrap();
    let state = folder.path().join("state.json").display().to_string();
    let name = path.display().to_string();
    let mut running = Running::of(&["track", &name, "--follow", "--json", "--voltage-timing", "centered", "--save-state", &state]);
    running.until(0.2);
    // A line arrives in two pieces.
    let mut file = File::options().append(true).open(&path).unwrap();
    let (one, two) = lines[2002].split_at(30);
    file.write_all(one.as_bytes()).unwrap();
    std::thread::sleep(Duration::from_millis(30));
    file.write_all((two.to_owned() + &lines[2003..4002].concat()).as_bytes()).unwrap();
    running.until(0.4);
    fs::rename(&path, folder.path().join("drive.csv.1")).unwrap();
    fs::write(&path, part(4002..6002)).unwrap();
    running.until(0.6);
    fs::write(&path, part(6002..7002)).unwrap();
    running.until(0.7);
    let mut file = File::options().append(true).open(&path).unwrap();
    file.write_all(lines[7002..].concat().as_bytes()).unwrap();
    running.until(0.8);
    std::thread::sleep(Duration::from_millis(200));
    let (status, out, err) = running.interrupted();
    assert_eq!(status, 130, "{err}");
    assert!(err.contains("the file was replaced") && err.contains("the file was truncated"), "{err}");
    // Nothing is lost: the state at the end is that of the whole log in one piece.
    let last: Value = documents(&out).pop().unwrap();
    assert_eq!((&last["rows"], &last["left_out"]["not_numbers"]), (&9000.into(), &0.into()));
    let (_, whole) = (0, fluxfit(&["track", NOISY, "--json", "--voltage-timing", "centered"]));
    assert_eq!(out.lines().last(), whole.out.lines().last());
    assert!(fs::read_to_string(state).unwrap().contains("fluxfit.track-state/1"));
}

#[cfg(unix)]
#[test]
fn a_socket_that_is_closed_is_waited_for_again() {
    let text = log(NOISY);
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let mut running = Running::of(&["track", "--listen", "127.0.0.1:0", "--json", "--voltage-timing", "centered"]);
    let mut said = String::new();
    running.err.read_line(&mut said).unwrap();
    let address = said.trim().rsplit(' ').next().unwrap().to_owned();
    // The first connection ends within the last number of a line, of which a smaller one is left.
    let cut = &lines[3002][..lines[3002].len() - 4];
    assert!(cut.ends_with(|c: char| c.is_ascii_digit()) && cut.split(',').count() == lines[0].split(',').count(), "{cut}");
    for (rows, rest, t) in [(1..3002, cut, 0.3), (3002..9001, "", 0.8)] {
        let mut socket = TcpStream::connect(&address).unwrap();
        socket.write_all(lines[0].as_bytes()).unwrap();
        socket.write_all((lines[rows].concat() + rest).as_bytes()).unwrap();
        drop(socket);
        running.until(t);
    }
    std::thread::sleep(Duration::from_millis(200));
    let (status, out, err) = running.interrupted();
    assert_eq!(status, 130, "{err}");
    assert!(err.contains("the connection was closed"), "{err}");
    let last = documents(&out).pop().unwrap();
    assert_eq!((&last["rows"], &last["left_out"]["not_numbers"]), (&9001.into(), &1.into()));
    assert_holds_the_truth(&last);
}

#[test]
fn all_estimators_stand_beside_the_batch_answer() {
    let (status, document) = json(&["compare", NOISY, "--online", "--truth", "examples/logs/paper_rig_pwm_noise.truth.json"]);
    assert_eq!((status, &document["schema"]), (0, &"fluxfit.online/1".into()));
    let estimators = document["estimators"].as_array().unwrap();
    assert_eq!(estimators.len(), 14);
    let of = |key: &str| estimators.iter().find(|estimator| estimator["method"] == key).unwrap();
    assert!(of("ekf")["rs"]["error_percent"].as_f64().unwrap().abs() < 1.0);
    assert_eq!((&of("mras")["has_covariance"], &of("mras")["rs"]["standard_error"]), (&false.into(), &Value::Null));
    let folder = tempfile::tempdir().unwrap();
    let (report, figures) = (folder.path().join("online.html"), folder.path().join("figures"));
    let run = fluxfit(&["compare", NOISY, "--online", "--report", report.to_str().unwrap(), "--figures", figures.to_str().unwrap()]);
    assert!(
        fs::read_to_string(report).unwrap().contains("Estimators on a stream") && figures.join("estimators.png").exists(),
        "{}",
        run.err
    );
    assert!(run.out.lines().all(|line| line.chars().count() <= 80) && run.out.contains("adaline"), "{}", run.out);
}

/// The faults of an answer are undone: an angle that is said to be 90 degrees too large makes d of q, and no motor is found so.
#[test]
fn known_faults_are_undone_and_others_named() {
    let folder = tempfile::tempdir().unwrap();
    let answer = folder.path().join("answer.json");
    let with = |nuisance: &str| {
        fs::write(&answer, format!(r#"{{"schema": "fluxfit.identification/1", "nuisance": {nuisance}}}"#)).unwrap();
        fluxfit(&["track", NOISY, "--json", "--faults", answer.to_str().unwrap()])
    };
    let none = with(r#"{"voltage_timing": null}"#);
    assert_eq!(none.out, fluxfit(&["track", NOISY, "--json"]).out);
    assert_holds_the_truth(documents(&none.out).last().unwrap());
    let turned = with(r#"{"angle_offset": {"value": 0.1}, "speed_lag": {"value": 0.001}}"#);
    let lq = documents(&turned.out).last().unwrap()["lq"]["value"].as_f64().unwrap();
    assert!((lq / 12e-3 - 1.0).abs() > 0.02, "{lq}");
    assert!(unwrapped(&turned.err).contains("--faults: what a stream is not freed of: speed_lag"), "{}", turned.err);
    let phase = with(r#"{"dead_time_voltage": {"value": 3}, "dead_time_phase": {"value": 0.1}}"#);
    assert!(phase.status == 2 && unwrapped(&phase.err).contains("found without an electrical angle"), "{}", phase.err);
    for text in [r#"{"schema": "fluxfit.track/1"}"#, "t,ud,uq\n", "{\"schema\": ", "[1]", ""] {
        fs::write(&answer, text).unwrap();
        let other = fluxfit(&["track", NOISY, "--faults", answer.to_str().unwrap()]);
        let sentence = "this is not an answer of fluxfit identify; make one with: fluxfit identify LOG --json > answer.json";
        assert!(other.status == 2 && unwrapped(&other.err).contains(sentence), "{text}: {}", other.err);
    }
}
