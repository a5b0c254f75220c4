//! Recorder logs: a few averaged rows a second, with voltages that turn with speed against the currents. The truth is that of the
//! simulator, whose rows are changed here as a recorder changes them; and a real log.

use super::{fluxfit, json, shared};
use serde_json::Value;
use std::{fs, path::Path};

/// An e-bike motor on a dynamometer: ramps without current, and loads at three speeds. 20 rows a second, each the mean of 1000 samples.
const SCENARIO: &str = r#"
duration = "12 s"
[motor]
rs = "45 mohm"
ld = "90 uH"
lq = "120 uH"
psi_f = "11 mWb"
pole_pairs = 10
[mechanics]
kind = "dyno"
[inverter]
modulation = "averaged"
u_dc = "48 V"
carrier = "10 kHz"
[control]
current_bandwidth = "500 Hz"
max_current = "60 A"
[schedule]
speed = [{ at = "0 s", to = "800 rpm", over = "1 s" }, { at = "6 s", to = "1200 rpm", over = "0.5 s" }, { at = "9 s", to = "400 rpm", over = "1.5 s" }]
iq = [{ at = "1.2 s", to = "10 A" }, { at = "2.5 s", to = "30 A" }, { at = "4 s", to = "45 A" }, { at = "5 s", to = "0 A" }, { at = "6.6 s", to = "20 A" }, { at = "8 s", to = "40 A" }, { at = "9 s", to = "0 A" }, { at = "10.8 s", to = "25 A" }]
[sensors]
current_noise = "0.2 A"
[log]
every = 1000
rows = "mean"
theta_e = false
"#;

const RS: f64 = 0.045;
const LQ: f64 = 120e-6;
const PSI_F: f64 = 11e-3;
const PERIOD: f64 = 0.05;

/// Below this, A, the simulated drive has no current.
const NO_CURRENT: f64 = 0.3;

/// A row: t, u_d, u_q, i_d, i_q, omega_e.
type Row = [f64; 6];

/// The rows of the scenario.
fn simulated(scenario: &str) -> Vec<Row> {
    let folder = tempfile::tempdir().unwrap();
    let (file, log) = (folder.path().join("s.toml"), folder.path().join("s.csv"));
    fs::write(&file, scenario).unwrap();
    let run = fluxfit(&["simulate", file.to_str().unwrap(), "-o", log.to_str().unwrap()]);
    assert_eq!(run.status, 0, "{}", run.err);
    let text = fs::read_to_string(&log).unwrap();
    text.lines().skip(1).map(|line| std::array::from_fn(|c| line.split(',').nth(c).unwrap().parse().unwrap())).collect()
}

/// The voltages seen in a frame that is late by this time, s.
fn late(rows: &[Row], lag: f64) -> Vec<Row> {
    let turn = |&[t, ud, uq, id, iq, omega_e]: &Row| {
        let (sin, cos) = (omega_e * lag).sin_cos();
        [t, cos * ud + sin * uq, cos * uq - sin * ud, id, iq, omega_e]
    };
    rows.iter().map(turn).collect()
}

/// Voltages and currents seen in a frame ahead of the rotor's, by an angle, rad, and by a time, s.
fn in_frame_ahead(rows: &[Row], angle: f64, time: f64) -> Vec<Row> {
    let turn = |&[t, ud, uq, id, iq, omega_e]: &Row| {
        let (sin, cos) = (angle + omega_e * time).sin_cos();
        [t, cos * ud + sin * uq, cos * uq - sin * ud, cos * id + sin * iq, cos * iq - sin * id, omega_e]
    };
    rows.iter().map(turn).collect()
}

/// The rows with other voltages where there is no current.
fn coasting(rows: Vec<Row>, voltage: impl Fn(f64, f64, f64) -> [f64; 2]) -> Vec<Row> {
    let change = |[t, ud, uq, id, iq, omega_e]: Row| {
        let [ud, uq] = if id.hypot(iq) < NO_CURRENT { voltage(ud, uq, omega_e) } else { [ud, uq] };
        [t, ud, uq, id, iq, omega_e]
    };
    rows.into_iter().map(change).collect()
}

/// A start of 1.5 s in open loop before the rows: 14 A that the columns call i_q, with the rotor's d axis on them.
fn after_open_loop(rows: &[Row]) -> Vec<Row> {
    let (count, current) = (30, 14.0);
    let start = (0..count).map(|k| {
        let omega_e = 50.0 * f64::from(k) / f64::from(count);
        // A magnet's voltage at right angles to the current; a ripple, so that no channel is frozen.
        let current = current + 0.01 * f64::from(k % 3);
        [f64::from(k) * PERIOD, -omega_e * PSI_F, RS * current, 0.0, current, omega_e]
    });
    start.chain(rows.iter().map(|&[t, ud, uq, id, iq, omega_e]| [t + f64::from(count) * PERIOD, ud, uq, id, iq, omega_e])).collect()
}

fn written(folder: &Path, rows: &[Row]) -> String {
    let lines = rows.iter().map(|row| row.map(|value| value.to_string()).join(","));
    let text = std::iter::once("t,ud,uq,id,iq,omega_e".to_owned()).chain(lines).collect::<Vec<_>>().join("\n");
    let path = folder.join("recorder.csv");
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn identified(rows: &[Row]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    json(&["identify", &written(folder.path(), rows)]).1
}

fn codes(document: &Value) -> Vec<&str> {
    document["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

/// The lag that was found, s.
fn lag(document: &Value) -> f64 {
    document["nuisance"]["frame_lag"]["value"].as_f64().unwrap()
}

/// Whether a parameter is identified with the truth in its interval.
fn is_right(document: &Value, key: &str, truth: f64) -> bool {
    let parameter = &document["parameters"][key];
    let [low, high] = [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap_or(f64::NAN));
    parameter["verdict"] == "identified" && low <= truth && truth <= high
}

/// The rows as a recorder writes them that is faster than the drive's messages: five for each row. Voltages, currents and speed each keep
/// their values until their own next message, so many rows later.
fn repeated(rows: &[Row], [voltages, currents, speed]: [usize; 3]) -> Vec<Row> {
    const PER_ROW: usize = 5;
    let latest = |k: usize, every: usize| rows[k / PER_ROW / every * every];
    let row = |k: usize| {
        let [_, ud, uq, ..] = latest(k, voltages);
        let [_, _, _, id, iq, _] = latest(k, currents);
        let [.., omega_e] = latest(k, speed);
        [k as f64 * PERIOD / PER_ROW as f64, ud, uq, id, iq, omega_e]
    };
    (0..PER_ROW * rows.len()).map(row).collect()
}

/// Values of different instants contradict each other, and a motor that saturates bends to them: that is not concluded from them. The speed
/// rises all the time here, and looks steady where the recorder repeats it, for 0.8 s or 1.5 s.
#[test]
fn values_that_a_recorder_repeats_are_not_taken_for_saturation() {
    let (before, after) = SCENARIO.split_once("speed = [").unwrap();
    let (_, after) = after.split_once("}]\n").unwrap();
    let rising = format!(
        r#"{before}speed = [{{ at = "0 s", to = "300 rpm", over = "1 s" }}, {{ at = "1 s", to = "1500 rpm", over = "11 s" }}]
{after}"#
    );
    let rows = simulated(&rising);
    let short = identified(&repeated(&rows, [4, 5, 16]));
    for (key, truth) in [("lq", LQ), ("psi_f", PSI_F)] {
        let [low, high] = [0, 1].map(|end| short["parameters"][key]["ci95"][end].as_f64().unwrap());
        assert!(low <= truth && truth <= high, "{key}: {low} .. {high}");
    }
    let long = identified(&repeated(&rows, [7, 11, 30]));
    assert!(codes(&long).contains(&"misfit") && !codes(&long).contains(&"saturation"), "{:?}", codes(&long));
    for key in ["rs", "lq", "psi_f"] {
        let parameter = &long["parameters"][key];
        assert!(parameter["remedy"].as_str().unwrap().contains("the recorder repeats a value"), "{key}: {parameter}");
    }
}

/// Whatever the voltages of the coasting drive are, the loads tell the lag, and no number is wrong. Those that are not the terminals'
/// are not used: each of them would say another lag or another flux.
#[test]
fn a_lag_is_found_and_moves_no_parameter() {
    let rows = simulated(SCENARIO);
    for seconds in [50e-6, -60e-6, 150e-6] {
        let turned = || late(&rows, seconds);
        let measured = turned();
        let dividers = coasting(turned(), |ud, uq, _| [0.95 * ud, 0.95 * uq]);
        let zero = coasting(turned(), |_, _, _| [0.0, 0.0]);
        let commanded = coasting(turned(), |_, _, omega_e| [0.0, 1.03 * PSI_F * omega_e]);
        let constant_angle = coasting(turned(), |_, _, omega_e| [0.07 * PSI_F * omega_e, 0.89 * PSI_F * omega_e]);
        for (name, log) in [
            ("measured", measured),
            ("through dividers", dividers),
            ("zero", zero),
            ("commanded", commanded),
            ("constant angle", constant_angle),
            ("open loop", after_open_loop(&turned())),
        ] {
            let document = identified(&log);
            assert!((lag(&document) - seconds).abs() < 2e-6, "{name}: {} s", lag(&document));
            assert!(codes(&document).contains(&"frame-lag"), "{name}: {:?}", codes(&document));
            for (key, truth) in [("rs", RS), ("lq", LQ), ("psi_f", PSI_F)] {
                assert!(is_right(&document, key, truth), "{name}, {seconds} s: {key} {}", document["parameters"][key]);
            }
            assert!(document["parameters"]["ld"]["value"].is_null());
        }
    }
}

/// An encoder that is off, or late, turns currents and voltages together: taken for voltages that turn alone, one degree moved R_s by 5 %.
#[test]
fn an_angle_that_is_off_or_late_moves_no_parameter() {
    let schedule = r#"[schedule]
speed = [{ at = "0 s", to = "800 rpm", over = "1 s" }, { at = "6 s", to = "1200 rpm", over = "0.5 s" }, { at = "12 s", to = "400 rpm", over = "1.5 s" }]
iq = [{ at = "1.2 s", to = "10 A" }, { at = "2.5 s", to = "30 A" }, { at = "4 s", to = "45 A" }, { at = "6.6 s", to = "20 A" }, { at = "9 s", to = "40 A" }, { at = "14 s", to = "25 A" }]
id = [{ at = "3.2 s", to = "-20 A" }, { at = "4 s", to = "0 A" }, { at = "8 s", to = "-30 A" }, { at = "10 s", to = "0 A" }, { at = "16 s", to = "-15 A" }]
"#;
    let (start, rest) = SCENARIO.split_once("[schedule]").unwrap();
    let end = rest.split_once("[sensors]").unwrap().1;
    let rows = simulated(&format!("{}{schedule}[sensors]{end}", start.replace("12 s", "18 s")));
    let truths = [("rs", RS), ("ld", 90e-6), ("lq", LQ), ("psi_f", PSI_F)];
    for (angle, time) in [(0.0, 0.0), (0.017, 0.0), (-0.03, 0.0), (0.0, 30e-6), (0.0, -30e-6), (0.02, -20e-6)] {
        let document = identified(&in_frame_ahead(&rows, angle, time));
        for (key, truth) in truths {
            let parameter = &document["parameters"][key];
            let [low, high] = [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap_or(f64::NAN));
            assert!(low <= truth && truth <= high, "{angle} rad, {time} s: {key} {parameter}");
        }
        for key in ["lq", "psi_f"] {
            assert_eq!(document["parameters"][key]["verdict"], "identified", "{angle} rad, {time} s: {key}");
        }
    }
}

/// The columns of an open loop are not in the rotor's frame: taken for it, they would say that the flux is zero.
#[test]
fn an_open_loop_is_named() {
    let rows = late(&simulated(SCENARIO), 50e-6);
    assert!(!codes(&identified(&rows)).contains(&"open-loop"));
    let document = identified(&after_open_loop(&rows));
    let warning = document["warnings"].as_array().unwrap().iter().find(|warning| warning["code"] == "open-loop").unwrap();
    assert!(warning["message"].as_str().unwrap().starts_with("at 0."), "{warning}");
}

/// Where the current follows the speed, a lag acts like L_q: `psi_f omega_e T / i_q` of it, here 11 mWb 838 rad/s 100 us / 10 A = 92 uH.
#[test]
fn where_nothing_tells_the_lag_lq_is_in_doubt() {
    let proportional = SCENARIO.split("[schedule]").next().unwrap().to_owned()
        + r#"[schedule]
speed = [{ at = "0 s", to = "400 rpm", over = "0.2 s" }, { at = "4 s", to = "600 rpm", over = "0.2 s" }, { at = "8 s", to = "800 rpm", over = "0.2 s" }]
iq = [{ at = "0 s", to = "5 A", over = "0.2 s" }, { at = "4 s", to = "7.5 A", over = "0.2 s" }, { at = "8 s", to = "10 A", over = "0.2 s" }]
[log]
every = 1000
rows = "mean"
theta_e = false
"#;
    let rows = simulated(&proportional);
    for seconds in [0.0, 80e-6, -80e-6] {
        let document = identified(&late(&rows, seconds));
        let lq = &document["parameters"]["lq"];
        assert_ne!(lq["verdict"], "identified", "{lq}");
        let raw = document["diagnostics"]["raw"]["lq"].as_f64().unwrap();
        let error = document["diagnostics"]["raw_standard_error"]["lq"].as_f64().unwrap();
        assert!((raw - LQ).abs() < 1.96 * error, "{seconds} s: {raw} ± {error}");
    }
}

/// A drive measured without a lag, too: 12 rows a second for a skateboard's motor of 46 V. Coasting rows alone say 8.3 mWb with a scatter
/// of 2.5 %, loaded ones 8.7 mWb; 43 us turn the voltages of both. With any sign of any column no L_q is sold, for none is told.
#[test]
fn real_log_of_a_skateboard_names_its_lag_and_sells_no_inductance() {
    let Some(log) = shared("real/vesc_tool_dkertson_short_log.csv") else { return };
    let columns =
        [("id", "d_axis_current"), ("iq", "q_axis_current"), ("ud", "d_axis_voltage"), ("uq", "q_axis_voltage"), ("omega_e", "erpm")];
    for flips in 0..1 << columns.len() {
        let mapping = tempfile::NamedTempFile::new().unwrap();
        let mut text = "[columns]\nt = { column = \"ms_today\", unit = \"ms\" }\nu_dc = \"input_voltage\"\n".to_owned();
        for (k, (name, column)) in columns.into_iter().enumerate() {
            let unit = if name == "omega_e" { ", unit = \"erpm\"" } else { "" };
            let sign = if flips >> k & 1 == 1 { -1 } else { 1 };
            text += &format!("{name} = {{ column = \"{column}\", sign = {sign}{unit} }}\n");
        }
        fs::write(mapping.path(), text).unwrap();
        let (_, document) = json(&["identify", &log, "--mapping", mapping.path().to_str().unwrap(), "--model", "steady"]);
        assert_ne!(document["parameters"]["lq"]["verdict"], "identified", "{flips:b}");
        assert!((40e-6..50e-6).contains(&lag(&document).abs()), "{flips:b}: {}", lag(&document));
        if flips == 0 {
            let psi_f = &document["parameters"]["psi_f"];
            let [value, low, high] = [&psi_f["value"], &psi_f["ci95"][0], &psi_f["ci95"][1]].map(|value| value.as_f64().unwrap());
            assert!((8.0e-3..9.0e-3).contains(&value) && high - low > 2.0 * 0.025 * value, "{psi_f}");
            assert!(codes(&document).contains(&"frame-lag") && codes(&document).contains(&"open-loop"), "{:?}", codes(&document));
            assert!(!document.to_string().contains("check signs"), "{document}");
        }
    }
}
