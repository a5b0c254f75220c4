//! Columns that contradict each other: the logs of an independent simulator, damaged as people damage them, and mended by what is proposed.

use super::{fluxfit, root};
use std::{fs, path::Path};

const LOGS: [&str; 3] =
    ["examples/logs/paper_rig_ideal.csv", "examples/logs/paper_rig_pwm_noise.csv", "examples/logs/id_zero_two_loads.csv"];

/// The channels of a log, in the order of its file: the names, and the values of each row.
const NAMES: [&str; 7] = ["t", "ud", "uq", "id", "iq", "omega_e", "theta_e"];

type Row = [f64; 7];

fn rows(log: &str) -> Vec<Row> {
    let text = fs::read_to_string(root().join(log)).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let places = NAMES.map(|name| names.iter().position(|other| *other == name).unwrap());
    lines
        .map(|line| {
            let values: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
            places.map(|place| values[place])
        })
        .collect()
}

/// Writes a log without the channels from `channels` on.
fn write(path: &Path, rows: &[Row], channels: usize) {
    let line = |row: &Row| row[..channels].iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n";
    fs::write(path, format!("{}\n", NAMES[..channels].join(",")) + &rows.iter().map(line).collect::<String>()).unwrap();
}

/// The same motor, turning the other way: speed, angle and the q axis are negative.
fn other_way(rows: &[Row]) -> Vec<Row> {
    rows.iter().map(|[t, ud, uq, id, iq, omega, theta]| [*t, *ud, -uq, *id, -iq, -omega, -theta]).collect()
}

/// What `inspect` warns of: the code, and the whole sentence with the lines to paste.
fn finding(path: &Path, options: &[String]) -> Option<(String, String)> {
    let mut arguments = vec!["inspect", path.to_str().unwrap()];
    arguments.extend(options.iter().map(String::as_str));
    let run = fluxfit(&arguments);
    assert_eq!(run.status, 0, "{}", run.err);
    let start = run.err.find("warning [")?;
    let text = &run.err[start..];
    let code = text.split(['[', ']']).nth(1).unwrap().to_owned();
    assert!(run.out.starts_with("Readable, but the columns contradict each other"), "{}", run.out);
    Some((code, text.to_owned()))
}

/// What a finding proposes: options, or a mapping file.
fn proposed(told: &str, directory: &Path) -> Vec<String> {
    if let Some((_, options)) = told.split_once("; add ") {
        return options.lines().next().unwrap().split(' ').map(str::to_owned).collect();
    }
    let lines: Vec<&str> = told.lines().skip(1).take_while(|line| line.starts_with("    ")).map(str::trim).collect();
    assert!(!lines.is_empty(), "nothing is proposed: {told}");
    let mapping = directory.join("mapping.toml");
    fs::write(&mapping, format!("[columns]\n{}\n", lines.join("\n"))).unwrap();
    vec!["--mapping".to_owned(), mapping.to_str().unwrap().to_owned()]
}

/// What people do to a row, its name, and how it is found.
type Damage = (&'static str, fn(&Row) -> Row, usize, &'static str);

const DAMAGES: [Damage; 21] = [
    ("mechanical speed", |r| with(r, 5, r[5] / 4.0), 7, "speed-unit"),
    ("speed in r/min", |r| with(r, 5, r[5] * 60.0 / std::f64::consts::TAU), 7, "speed-unit"),
    ("mechanical r/min", |r| with(r, 5, r[5] * 15.0 / std::f64::consts::TAU), 7, "speed-unit"),
    ("speed in Hz", |r| with(r, 5, r[5] / std::f64::consts::TAU), 7, "speed-unit"),
    ("speed in r/min, no angle", |r| with(r, 5, r[5] * 60.0 / std::f64::consts::TAU), 6, "speed-unit"),
    ("angle in degrees", |r| with(r, 6, r[6].to_degrees()), 7, "speed-unit"),
    ("speed reversed", |r| with(r, 5, -r[5]), 7, "speed-sign"),
    ("angle reversed", |r| with(r, 6, -r[6]), 7, "speed-sign"),
    ("time in ms", |r| with(r, 0, 1e3 * r[0]), 7, "time-unit"),
    ("time in us", |r| with(r, 0, 1e6 * r[0]), 7, "time-unit"),
    ("speed reversed, no angle", |r| with(r, 5, -r[5]), 6, "column-signs"),
    ("generator convention", |r| with(&with(r, 3, -r[3]), 4, -r[4]), 7, "column-signs"),
    ("voltages reversed", |r| with(&with(r, 1, -r[1]), 2, -r[2]), 7, "column-signs"),
    ("south pole", |r| [r[0], -r[1], -r[2], -r[3], -r[4], r[5], r[6]], 7, "column-signs"),
    ("q lags d", |r| with(&with(r, 2, -r[2]), 4, -r[4]), 7, "column-signs"),
    ("u_d reversed", |r| with(r, 1, -r[1]), 7, "column-signs"),
    ("u_q reversed", |r| with(r, 2, -r[2]), 7, "column-signs"),
    ("i_q reversed", |r| with(r, 4, -r[4]), 7, "column-signs"),
    ("voltages exchanged", |r| with(&with(r, 1, r[2]), 2, r[1]), 7, "column-signs"),
    ("currents exchanged", |r| with(&with(r, 3, r[4]), 4, r[3]), 7, "column-signs"),
    ("axes exchanged", |r| [r[0], r[2], r[1], r[4], r[3], r[5], r[6]], 7, "column-signs"),
];

fn with(row: &Row, place: usize, value: f64) -> Row {
    let mut row = *row;
    row[place] = value;
    row
}

#[test]
fn what_people_do_to_columns_is_found_and_what_is_proposed_mends_it() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    for log in LOGS {
        let rows = rows(log);
        for (way, rows) in [("forward", rows.clone()), ("backward", other_way(&rows))] {
            write(&path, &rows, 7);
            assert_eq!(finding(&path, &[]), None, "{log}, {way}: a healthy log");
            // Each damage in one log each way, a few in all of them: an inspection takes a third of a second.
            let damages = DAMAGES.iter().filter(|(name, ..)| log == LOGS[1] || ["mechanical speed", "axes exchanged"].contains(name));
            for &(name, damage, channels, code) in damages {
                let damaged: Vec<Row> = rows.iter().map(damage).collect();
                write(&path, &damaged, channels);
                let (found, told) = finding(&path, &[]).unwrap_or_else(|| panic!("{log}, {way}, {name}: nothing is found"));
                assert_eq!(found, code, "{log}, {way}, {name}: {told}");
                let options = proposed(&told, directory.path());
                assert_eq!(finding(&path, &options), None, "{log}, {way}, {name}: still after {options:?}\n{told}");
            }
        }
    }
}

/// Rows of one turn, in which an angle in turns does not wind around: it turns 1 / (2 pi) times as fast as the speed.
#[test]
fn an_angle_in_turns_is_found_before_it_winds_around() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    let rows = rows(LOGS[1]);
    let winds: Vec<usize> = (1..rows.len()).filter(|row| rows[*row][6] < rows[row - 1][6] - 3.0).collect();
    let turn: Vec<Row> = rows[winds[20]..winds[21]].to_vec();
    write(&path, &turn, 7);
    assert_eq!(finding(&path, &[]), None);
    write(&path, &turn.iter().map(|row| with(row, 6, row[6] / std::f64::consts::TAU)).collect::<Vec<Row>>(), 7);
    let (code, told) = finding(&path, &[]).unwrap();
    assert!(code == "speed-unit" && told.contains("the angle is in turns"), "{told}");
    assert_eq!(finding(&path, &proposed(&told, directory.path())), None);
}

/// Of three phases b and c are exchanged. The simulator's dq quantities become phases by the inverse transforms, written out here.
/// Speed and angle of the shaft agree with each other; the slopes of the currents do not agree with them.
#[test]
fn speed_and_angle_of_the_shaft_are_found_and_mended() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    for rows in [rows(LOGS[1]), other_way(&rows(LOGS[1]))] {
        let (mut turned, mut last) = (0.0, rows[0][6]);
        let of_shaft = rows.iter().map(|row| {
            let step = row[6] - last;
            turned += step - (step / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            last = row[6];
            with(&with(row, 5, row[5] / 4.0), 6, ((rows[0][6] + turned) / 4.0).rem_euclid(std::f64::consts::TAU))
        });
        write(&path, &of_shaft.collect::<Vec<Row>>(), 7);
        let (found, told) = finding(&path, &[]).unwrap();
        assert!(found == "speed-unit" && told.contains("and the angle with it") && told.contains("the shaft's, 4 pole pairs"), "{told}");
        let refused = fluxfit(&["identify", path.to_str().unwrap()]);
        assert!(refused.status == 2 && refused.err.contains("both may be the shaft's"), "{}{}", refused.out, refused.err);
        let options = proposed(&told, directory.path());
        assert_eq!(options.last().map(String::as_str), Some("4"), "{told}");
        assert_eq!(finding(&path, &options), None, "still after {options:?}\n{told}");
    }
}

#[test]
fn exchanged_phases_are_found_and_mended() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("phases.csv");
    let third = std::f64::consts::TAU / 3.0;
    let phase = |d: f64, q: f64, angle: f64| d * angle.cos() - q * angle.sin();
    let mut text = "t,ua,ub,uc,ia,ib,ic,omega_e,theta_e\n".to_owned();
    for [t, ud, uq, id, iq, omega, theta] in rows(LOGS[1]) {
        let u = [0.0, 1.0, 2.0].map(|k| phase(ud, uq, theta - k * third));
        let i = [0.0, 1.0, 2.0].map(|k| phase(id, iq, theta - k * third));
        text += &format!("{t},{},{},{},{},{},{},{omega},{theta}\n", u[0], u[2], u[1], i[0], i[2], i[1]);
    }
    fs::write(&path, text).unwrap();
    let (code, told) = finding(&path, &[]).unwrap();
    assert_eq!(code, "phase-order", "{told}");
    let options = proposed(&told, directory.path());
    assert_eq!(options, ["--map", "ib=ic,ic=ib,ub=uc,uc=ub"]);
    assert_eq!(finding(&path, &options), None);
}

/// 100 V turn in a circle at 200 V; in mV they seem a thousand times too large.
#[test]
fn voltages_that_cannot_be_are_found() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    let rows = rows(LOGS[1]);
    for (scale, code) in [(1.0, None), (1e3, Some("voltage-scale"))] {
        let line = |r: &Row| format!("{},{},{},{},{},{},200\n", r[0], scale * r[1], scale * r[2], r[3], r[4], r[5]);
        fs::write(&path, "t,ud,uq,id,iq,omega_e,u_dc\n".to_owned() + &rows.iter().map(line).collect::<String>()).unwrap();
        let found = finding(&path, &[]);
        assert_eq!(found.as_ref().map(|(code, _)| code.as_str()), code, "{found:?}");
        if let Some((_, told)) = found {
            assert_eq!(finding(&path, &proposed(&told, directory.path())), None);
        }
    }
}

/// The paper's rig at 310 V, its voltages as shares of half the DC voltage and of all of it: 180 times too small in V. The truth is that of
/// the independent simulator.
#[test]
fn shares_of_the_dc_voltage_are_found_and_mended() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    let rows = rows(LOGS[1]);
    let write = |names: &str, whole: f64| {
        let line = |r: &Row| format!("{},{},{},{},{},{},310\n", r[0], r[1] / whole, r[2] / whole, r[3], r[4], r[5]);
        fs::write(&path, format!("t,{names},id,iq,omega_e,u_dc\n") + &rows.iter().map(line).collect::<String>()).unwrap();
    };
    for whole in [310.0, 155.0] {
        write("ud,uq", whole);
        let (code, told) = finding(&path, &[]).unwrap();
        let needed = "uq = { column = \"uq\", scale = 0.5, times = \"u_dc\" }";
        assert!(code == "voltage-share" && told.contains(needed) && told.contains("electrical r/min"), "{told}");
        let refused = fluxfit(&["identify", path.to_str().unwrap()]);
        assert!(refused.status == 2 && refused.out.is_empty() && refused.err.contains("shares of u_dc"), "{}", refused.err);
    }
    let (_, told) = finding(&path, &[]).unwrap();
    let options = proposed(&told, directory.path());
    assert_eq!(finding(&path, &options), None);
    let mended =
        fluxfit(&[&["identify", path.to_str().unwrap(), "--json"], &options.iter().map(String::as_str).collect::<Vec<_>>()[..]].concat());
    let answer: serde_json::Value = serde_json::from_str(&mended.out).unwrap();
    let psi_f = answer["parameters"]["psi_f"]["value"].as_f64().unwrap();
    assert!((psi_f / 0.1827 - 1.0).abs() < 0.01, "{psi_f}");
    // Who states that they are V is warned and answered.
    let stated = fluxfit(&["identify", path.to_str().unwrap(), "--unit", "ud=V,uq=V"]);
    assert!(stated.status < 2 && stated.err.starts_with("warning [voltage-share]"), "{}", stated.err);
}

/// The same voltages in digits of 12 bits below a thousand; a header that says V is believed.
#[test]
fn whole_numbers_are_warned_of_unless_the_unit_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    let rows = rows(LOGS[1]);
    for (names, code) in [("ud,uq", Some("voltage-scale")), ("ud [V],uq [V]", None)] {
        let line = |r: &Row| format!("{},{:.0},{:.0},{},{},{}\n", r[0], 3.0 * r[1], 3.0 * r[2], r[3], r[4], r[5]);
        fs::write(&path, format!("t,{names},id,iq,omega_e\n") + &rows.iter().map(line).collect::<String>()).unwrap();
        let run = fluxfit(&["inspect", path.to_str().unwrap()]);
        assert_eq!(run.err.contains("whole numbers"), code.is_some(), "{}", run.err);
        assert_eq!(run.out.starts_with("Readable, but the voltages may be no volts."), code.is_some(), "{}", run.out);
    }
}

#[test]
fn identify_refuses_what_means_nothing_unless_a_model_is_stated() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    let slow: Vec<Row> = rows(LOGS[1]).iter().map(|row| with(row, 5, row[5] / 4.0)).collect();
    write(&path, &slow, 7);
    let path = path.to_str().unwrap();
    let run = fluxfit(&["identify", path]);
    assert!(run.status == 2 && run.out.is_empty(), "{}", run.out);
    let sentence =
        "theta_e turns 4.000 times as fast as omega_e: mechanical speed, 4 pole pairs; add --unit omega_e=rad/s-mech --pole-pairs 4";
    assert!(run.err.lines().next().unwrap().contains(sentence), "{}", run.err);
    // What the command gives already is replaced: given twice, it would be refused.
    let run = fluxfit(&["identify", path, "--unit", "omega=rad/s", "--unit", "id=A"]);
    let sentence = "replace --unit omega=rad/s by --unit omega_e=rad/s-mech --pole-pairs 4";
    assert!(run.status == 2 && run.err.contains(sentence), "{}", run.err);
    let mended = fluxfit(&["identify", path, "--unit", "omega_e=rad/s-mech", "--pole-pairs", "4"]);
    assert!(mended.status == 0 && mended.out.starts_with("All 4 identified."), "{}{}", mended.out, mended.err);
    let all_the_same = fluxfit(&["identify", path, "--model", "steady"]);
    assert!(all_the_same.status < 2 && all_the_same.err.starts_with("warning [speed-unit]: theta_e turns"), "{}", all_the_same.err);
}

/// A speed that is a little off, as by another number of pole pairs, suits the operating points as well: inductances and flux are as much
/// too small or too large. The slopes of the currents and the simulated currents do not follow it.
#[test]
fn a_speed_of_other_pole_pairs_is_told_and_gives_no_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    let identified = |rows: &[Row], options: &[&str]| {
        write(&path, rows, 6);
        fluxfit(&[&["identify", path.to_str().unwrap()], options].concat())
    };
    assert!(identified(&rows(LOGS[1]), &[]).out.starts_with("All 4 identified."));
    for (log, factor) in [(LOGS[0], 0.75), (LOGS[0], 1.25), (LOGS[1], 0.5), (LOGS[2], 1.5)] {
        let scaled: Vec<Row> = rows(log).iter().map(|row| with(row, 5, factor * row[5])).collect();
        let run = identified(&scaled, &[]);
        let told = run.out.replace("\n  ", " ");
        let way = if factor > 1.0 { "high" } else { "low" };
        assert!(run.status == 1 && told.starts_with("None of 4 identified."), "{log}, {factor}: {told}");
        assert!(told.contains(&format!("times too {way} for the slopes of the currents")), "{log}, {factor}: {told}");
    }
    // In r/min of the shaft, three times too high: the number of pole pairs that the rig's motor has is proposed.
    let of_shaft = |row: &Row| with(row, 5, row[5] / 4.0 * 30.0 / std::f64::consts::PI);
    let of_shaft: Vec<Row> = rows(LOGS[0]).iter().map(of_shaft).collect();
    let run = identified(&of_shaft, &["--unit", "omega_e=rpm-mech", "--pole-pairs", "12"]);
    assert!(run.err.contains("4 pole pairs would suit it; replace --pole-pairs 12 by --pole-pairs 4"), "{}", run.err);
}

/// Every tenth sample of a motor that is held at three points, the last of them at half the load: what the drive does between the rows is
/// not logged, and the currents are followed better at a lower speed. The speed of the scenario is right, and so are its numbers.
const DECIMATED: &str = r#"
duration = "3.39 s"
seed = 1
[motor]
rs = "0.51228 ohm"
ld = "1.83023 mH"
lq = "1.83023 mH"
psi_f = "86.338 mWb"
pole_pairs = 3
[mechanics]
kind = "dyno"
[inverter]
u_dc = "572 V"
carrier = "6.925 kHz"
[control]
current_bandwidth = "165 Hz"
max_current = "13 A"
[schedule]
speed = [{ at = "0 s", to = "152.13 rad/s" }]
iq = [{ at = "0.05 s", to = "3.735 A" }, { at = "2.89 s", to = "1.87 A" }]
id = [{ at = "1.445 s", to = "-2.988 A" }, { at = "2.89 s", to = "0 A" }]
[sensors]
current_noise = "60 mA"
adc_bits = 12
adc_range = "18 A"
angle_offset = "0.5 deg"
[log]
every = 10
theta_e = false
"#;

/// What is answered to the log of a scenario with an option.
fn answer_with(option: &str, scenario: &str) -> String {
    let directory = tempfile::tempdir().unwrap();
    let [file, log] = ["scenario.toml", "log.csv"].map(|name| directory.path().join(name).to_str().unwrap().to_owned());
    fs::write(&file, scenario).unwrap();
    assert_eq!(fluxfit(&["simulate", &file, "-o", &log]).status, 0);
    let run = fluxfit(&["identify", &log, option]);
    run.out + &run.err
}

fn answer(scenario: &str) -> serde_json::Value {
    let text = answer_with("--json", scenario);
    serde_json::from_str(&text[..=text.rfind('}').unwrap()]).unwrap()
}

/// That these parameters are told to a tenth, and right: a number is wrong from one and a half half-widths on.
fn assert_right(answer: &serde_json::Value, truths: &[(&str, f64)]) {
    for (parameter, truth) in truths {
        let interval = &answer["parameters"][parameter]["ci95"];
        let [low, high] = [0, 1].map(|end| interval[end].as_f64().unwrap_or(f64::NAN));
        let [middle, half] = [0.5 * (low + high), 0.5 * (high - low)];
        assert!((truth - middle).abs() < 1.5 * half && half < 0.1 * truth, "{parameter}: {interval}");
    }
}

#[test]
fn a_right_speed_of_a_decimated_log_is_not_called_wrong() {
    assert_right(&answer(DECIMATED), &[("rs", 0.51228), ("ld", 1.83023e-3), ("lq", 1.83023e-3), ("psi_f", 86.338e-3)]);
}

/// Means of four periods of a small motor, of which it decays little in one: what voltages do within such rows looks like a filter of the
/// phase currents, 2 % of the residual.
const MEANS: &str = r#"
duration = "0.67 s"
seed = 1
[motor]
rs = "10 ohm"
ld = "8.4 mH"
lq = "8.4 mH"
psi_f = "72 mWb"
pole_pairs = 3
[mechanics]
kind = "dyno"
[inverter]
u_dc = "350 V"
carrier = "24 kHz"
[control]
current_bandwidth = "800 Hz"
max_current = "2.2 A"
[schedule]
speed = [{ at = "0 s", to = "150 rpm" }, { at = "0.33 s", to = "450 rpm", over = "20 ms" }]
iq = [{ at = "20 ms", to = "0.4 A" }, { at = "0.17 s", to = "1.3 A" }, { at = "0.5 s", to = "0.7 A" }]
id = [{ at = "0.25 s", to = "-0.4 A" }, { at = "0.42 s", to = "0 A" }, { at = "0.58 s", to = "-0.4 A" }]
[sensors]
current_noise = "5 mA"
adc_bits = 12
adc_range = "3 A"
[log]
every = 4
rows = "mean"
"#;

#[test]
fn a_filter_faster_than_means_that_explains_little_is_not_taken() {
    let steps = answer_with("-v", MEANS);
    assert!(steps.contains("filter of the phase currents: is faster than the rows"), "{steps}");
    assert_right(&answer(MEANS), &[("rs", 10.0), ("ld", 8.4e-3), ("lq", 8.4e-3), ("psi_f", 72e-3)]);
}

/// Means of four periods of 120 kHz, read as the drive's own: with i_d held at zero, its noise passes for what L_d would do.
const MEANS_OF_A_FAST_DRIVE: &str = r#"
duration = "0.38 s"
seed = 1
[motor]
rs = "20 ohm"
ld = "3.2 mH"
lq = "3.2 mH"
psi_f = "25 mWb"
pole_pairs = 3
[mechanics]
kind = "dyno"
[inverter]
u_dc = "350 V"
carrier = "120 kHz"
[control]
current_bandwidth = "2800 Hz"
max_current = "0.84 A"
[schedule]
speed = [{ at = "0 s", to = "530 rpm" }, { at = "0.15 s", to = "1950 rpm", over = "20 ms" }]
iq = [{ at = "8 ms", to = "0.16 A" }, { at = "76 ms", to = "0.42 A" }, { at = "0.267 s", to = "0.21 A" }]
[sensors]
current_noise = "3.5 mA"
adc_bits = 12
adc_range = "1.12 A"
[log]
every = 4
rows = "mean"
"#;

/// With more noise an observer corrects away from the measured current, with less a simulator's rule explains as much: L_d 32 % off.
#[test]
fn an_inductance_without_current_is_not_told_by_means_of_noise() {
    for noise in ["3.5 mA", "2 mA"] {
        let found = answer(&MEANS_OF_A_FAST_DRIVE.replace("3.5 mA", noise));
        assert!(found["parameters"]["ld"]["value"].is_null(), "{noise}: {}", found["parameters"]["ld"]);
        assert_right(&found, &[("rs", 20.0), ("lq", 3.2e-3), ("psi_f", 25e-3)]);
    }
}

/// The same of 40 kHz: a voltage that is held in the stator and one that is held in the rotor's frame are followed as well, and their L_q
/// differ by 1.3 %. So does what the means are of.
#[test]
fn of_means_every_reading_that_follows_counts() {
    let of_40_khz = MEANS_OF_A_FAST_DRIVE.replace("120 kHz", "40 kHz").replace("2800 Hz", "2000 Hz").replace("3.5 mA", "5 mA");
    let found = answer(&of_40_khz);
    assert_right(&found, &[("rs", 20.0), ("lq", 3.2e-3), ("psi_f", 25e-3)]);
    let timing = found["diagnostics"]["systematic"]["lq"]["timing"].as_f64().unwrap();
    assert!(timing > 0.003 * 3.2e-3, "{timing}");
}

/// Two points at the slow end of a 14.5 kHz drive whose angle is late and whose logged currents are filtered.
const LATE_ANGLE_BESIDE_A_FILTER: &str = r#"
duration = "0.275 s"
seed = 7665
[motor]
rs = "1.855 ohm"
ld = "3.656 mH"
lq = "3.656 mH"
psi_f = "65.6 mWb"
pole_pairs = 5
[mechanics]
kind = "dyno"
[inverter]
u_dc = "381 V"
carrier = "14.5 kHz"
[control]
current_bandwidth = "347 Hz"
max_current = "6.5 A"
[schedule]
speed = [{ at = "0 s", to = "325 rpm" }]
iq = [{ at = "5.5 ms", to = "2.14 A" }]
id = [{ at = "0.1377 s", to = "-1.71 A" }]
[sensors]
current_noise = "30 mA"
adc_bits = 12
adc_range = "8.62 A"
angle_delay = "52 us"
[log]
current_filter = "2080 Hz"
filter_frame = "dq"
theta_e = true
u_dc = true
"#;

/// A late angle looks like the delay of a drive that does not compensate it, and the search went on from there: L_d came out 1.9 % off.
#[test]
fn a_late_angle_is_not_taken_for_a_delay_that_is_not_compensated() {
    assert_right(&answer(LATE_ANGLE_BESIDE_A_FILTER), &[("rs", 1.855), ("ld", 3.656e-3), ("lq", 3.656e-3), ("psi_f", 65.6e-3)]);
}

/// Names of columns that a motor may have, but no time: there is no log, and a plot all the same.
#[test]
fn a_file_that_is_no_log_yet_is_plotted_too() {
    let text = "ud,uq,id,iq,speed_rpm\n".to_owned() + &(0..600).map(|k| format!("{k},20,0,{},500\n", k % 7)).collect::<String>();
    let file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
    fs::write(file.path(), text).unwrap();
    let run = fluxfit(&["inspect", file.path().to_str().unwrap()]);
    assert_eq!(run.status, 2, "{}", run.out);
    assert!(run.out.starts_with("Not a log yet") && run.out.contains("ud = ud, V\n") && run.out.contains('⠤'), "{}", run.out);
}
