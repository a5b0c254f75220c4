//! Tables of a test bench. The truth is a motor's whose currents come from Cramer's rule on equation (2), not from the program.

use super::{fluxfit, json, shared};
use std::{fmt::Write, fs, path::Path};

const RS: f64 = 0.012;
const LD: f64 = 0.2e-3;
const LQ: f64 = 0.45e-3;
const PSI_F: f64 = 0.06;
const PAIRS: f64 = 3.0;
const SPEEDS: [f64; 14] = [20.0, 50.0, 100.0, 150.0, 200.0, 300.0, 400.0, 600.0, 800.0, 1000.0, 1500.0, 2000.0, 3000.0, 4000.0];

/// Numbers from -1 to 1 that look random.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn open_circuit(folder: &Path, noise: &mut Noise) -> String {
    open_circuit_named(folder, noise, "Spannung verkettet eff. [V]", 1.0)
}

/// With a column's name, and what it holds over the voltage line to line.
fn open_circuit_named(folder: &Path, noise: &mut Noise, name: &str, factor: f64) -> String {
    let mut text = format!("Drehzahl [1/min];{name}\n");
    for rpm in SPEEDS {
        let omega_e = PAIRS * rpm * std::f64::consts::TAU / 60.0;
        let voltage = omega_e * PSI_F * 3.0_f64.sqrt() / 2.0_f64.sqrt() * (1.0 + 2e-3 * noise.next());
        let voltage = factor * voltage;
        writeln!(text, "{rpm};{voltage:.5}").unwrap();
    }
    written(folder, "open.csv", &text)
}

/// With a drag of 0.3 N m, and 0.0002 N m more for each r/min.
fn short_circuit(folder: &Path, noise: &mut Noise, with_torque: bool) -> String {
    let mut text = format!("speed_rpm,Iu_rms [A],Iv_rms [A],Iw_rms [A]{}\n", if with_torque { ",shaft torque [Nm]" } else { "" });
    for rpm in SPEEDS {
        let omega_e = PAIRS * rpm * std::f64::consts::TAU / 60.0;
        let [id, iq] = short_circuit_current(omega_e);
        let mut phase = || id.hypot(iq) / 2.0_f64.sqrt() * (1.0 + 2e-3 * noise.next());
        write!(text, "{rpm},{:.4},{:.4},{:.4}", phase(), phase(), phase()).unwrap();
        if with_torque {
            let torque = 1.5 * PAIRS * (PSI_F * iq + (LD - LQ) * id * iq);
            write!(text, ",{:.4}", torque - 0.3 - 2e-4 * rpm + 0.05 * noise.next()).unwrap();
        }
        text.push('\n');
    }
    written(folder, "short.csv", &text)
}

/// A, in dq: R i_d - omega L_q i_q = 0, omega L_d i_d + R i_q = -omega psi_f.
fn short_circuit_current(omega_e: f64) -> [f64; 2] {
    let determinant = RS * RS + omega_e * LD * omega_e * LQ;
    [-omega_e * PSI_F * omega_e * LQ / determinant, -omega_e * PSI_F * RS / determinant]
}

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// The command stands on a line of its own, with what was given, so that it can be pasted however long the path is.
#[test]
fn an_inspection_of_a_table_says_the_command_that_comes_next() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(
        folder.path(),
        "open circuit of the motor with a long name, at 20 degrees.csv",
        "speed_rpm,U_ll [V]\n100,1\n200,2\n300,3\n",
    );
    let run = fluxfit(&["inspect", &path, "--pole-pairs", "3"]);
    assert_eq!(run.status, 0, "{}", run.err);
    let command = format!("    fluxfit identify '{path}' --pole-pairs 3");
    assert!(run.out.lines().any(|line| line == command), "{}", run.out);
}

#[test]
fn both_tables_together_tell_the_whole_motor() {
    let folder = tempfile::tempdir().unwrap();
    let (mut held, mut drawn) = (0, 0);
    for seed in 1..=12 {
        let noise = &mut Noise(seed);
        let (open, short) = (open_circuit(folder.path(), noise), short_circuit(folder.path(), noise, seed % 2 == 0));
        let (status, document) = json(&["identify", &open, &short, "--pole-pairs", "3"]);
        for (key, truth, most) in [("rs", RS, 0.02), ("ld", LD, 0.005), ("lq", LQ, 0.03), ("psi_f", PSI_F, 0.002)] {
            let parameter = &document["parameters"][key];
            let (value, ci95) = (parameter["value"].as_f64().unwrap(), [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap()));
            assert!((value / truth - 1.0).abs() < most, "seed {seed}: {key} {value}");
            assert_eq!(parameter["verdict"], "identified", "seed {seed}: {key} {ci95:?}");
            drawn += 1;
            held += usize::from((ci95[0]..=ci95[1]).contains(&truth));
        }
        assert_eq!(status, 0);
    }
    // Of 48 intervals of 95 %, fewer than 42 hold with a probability of 1 in 100.
    assert!(held >= 42, "{held} of {drawn}");
}

/// Rows of low speed tell L_q nearly alone, and a table of shorted terminals has nothing beside it: where one of them is wrong, the
/// intervals reach as far as the numbers move without any of them.
#[test]
fn numbers_that_hang_on_one_row_have_wide_intervals() {
    let folder = tempfile::tempdir().unwrap();
    let short = short_circuit(folder.path(), &mut Noise(4), true);
    let mut lines: Vec<String> = fs::read_to_string(&short).unwrap().lines().map(str::to_owned).collect();
    // Not settled: 3 % too little current in all phases.
    let fields = lines[2].split(',').enumerate().map(|(k, field)| match k {
        1..=3 => format!("{:.4}", 0.97 * field.parse::<f64>().unwrap()),
        _ => field.to_owned(),
    });
    lines[2] = fields.collect::<Vec<_>>().join(",");
    let answer = |lines: &[String]| {
        fs::write(&short, lines.join("\n")).unwrap();
        json(&["identify", &short, "--pole-pairs", "3"]).1
    };
    let whole = answer(&lines);
    for row in 1..=4 {
        let rest = answer(&[&lines[..row], &lines[row + 1..]].concat());
        for key in ["rs", "ld", "lq", "psi_f"] {
            let [low, high] = [0, 1].map(|end| whole["parameters"][key]["ci95"][end].as_f64().unwrap());
            let value = rest["parameters"][key]["value"].as_f64().unwrap();
            assert!((low..=high).contains(&value), "{key} without row {row}: {value}, and with it from {low} to {high}");
        }
    }
}

/// The flux follows from the electrical speed alone; beside a table of the shaft the pole pairs are needed.
#[test]
fn electrical_speeds_need_no_pole_pairs() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(9);
    let rows = SPEEDS.map(|rpm| {
        let omega_e = PAIRS * rpm * std::f64::consts::TAU / 60.0;
        let voltage = omega_e * PSI_F * 3.0_f64.sqrt() / 2.0_f64.sqrt() * (1.0 + 2e-3 * noise.next());
        format!("{},{voltage:.5}\n", omega_e / std::f64::consts::TAU)
    });
    let open = written(folder.path(), "hertz.csv", &format!("f_el [Hz],U_ll_rms [V]\n{}", rows.concat()));
    let (status, document) = json(&["identify", &open]);
    assert_eq!((status, &document["pole_pairs"]), (1, &serde_json::Value::Null));
    let psi_f = &document["parameters"]["psi_f"];
    assert!((psi_f["value"].as_f64().unwrap() / PSI_F - 1.0).abs() < 0.003 && psi_f["verdict"] == "identified", "{psi_f}");
    assert!(document["times_pole_pairs"]["psi_f"]["value"].is_null());
    let run = fluxfit(&["identify", &open]);
    assert!(!run.out.contains("p psi_f") && !run.out.contains("--pole-pairs"), "{}", run.out);
    let short = short_circuit(folder.path(), noise, false);
    let run = fluxfit(&["identify", &open, &short]);
    assert!(run.status == 2 && run.err.contains("--pole-pairs N"), "{}", run.err);
}

#[test]
fn without_pole_pairs_the_values_are_times_these() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(5);
    let (open, short) = (open_circuit(folder.path(), noise), short_circuit(folder.path(), noise, true));
    let (status, document) = json(&["identify", &open, &short]);
    assert_eq!(status, 1);
    assert!(document["parameters"]["psi_f"]["value"].is_null());
    assert!((document["times_pole_pairs"]["psi_f"]["value"].as_f64().unwrap() / (PAIRS * PSI_F) - 1.0).abs() < 0.01);
    let run = fluxfit(&["identify", &open, &short]);
    assert!(run.out.contains("p psi_f") && run.out.contains("--pole-pairs"), "{}", run.out);
    assert!(run.out.lines().all(|line| line.chars().count() <= 80), "{}", run.out);
}

#[test]
fn a_table_alone_tells_what_it_can() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(7);
    let open = open_circuit(folder.path(), noise);
    let (status, document) = json(&["identify", &open, "--pole-pairs", "3"]);
    assert_eq!(status, 1);
    assert_eq!(document["parameters"]["psi_f"]["verdict"], "identified");
    assert!(["rs", "ld", "lq"].iter().all(|key| document["parameters"][key]["value"].is_null()));
    let short = short_circuit(folder.path(), noise, false);
    let run = fluxfit(&["identify", &short]);
    assert!(run.status == 2 && run.err.contains("add its torque, or an open-circuit table"), "{}", run.err);
    let log = "examples/logs/paper_rig_pwm_noise.csv";
    let run = fluxfit(&["identify", &open, log]);
    assert!(run.status == 2 && run.err.contains("--prior psi_f="), "{}", run.err);
}

#[test]
fn voltages_of_a_phase_are_told_by_their_name_or_by_the_torque_or_left_open() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(3);
    let of_phase = 1.0 / 3.0_f64.sqrt();
    let short = short_circuit(folder.path(), noise, true);
    let without_torque = {
        let folder = folder.path().join("currents");
        fs::create_dir(&folder).unwrap();
        short_circuit(&folder, noise, false)
    };
    for (name, factor, voltages) in [
        ("phase voltage [V]", of_phase, "stated"),
        ("U [V]", of_phase, "phase-by-torque"),
        ("U [V]", 1.0, "lines-by-torque"),
        ("U_ll_peak [V]", 2.0_f64.sqrt(), "stated"),
    ] {
        let open = open_circuit_named(folder.path(), noise, name, factor);
        let (status, document) = json(&["identify", &open, &short, "--pole-pairs", "3"]);
        assert_eq!((status, document["voltages"].as_str()), (0, Some(voltages)), "{name}");
        for (key, truth) in [("rs", RS), ("psi_f", PSI_F)] {
            let value = document["parameters"][key]["value"].as_f64().unwrap();
            assert!((value / truth - 1.0).abs() < 0.02, "{name}: {key} {value}");
        }
    }
    // Nothing tells: no number, but both in a sentence. psi_f would be 60 mWb line to line, 0.104 Wb of a phase.
    let open = open_circuit_named(folder.path(), noise, "U [V]", 1.0);
    for tables in [vec![open.as_str()], vec![&open, &without_torque]] {
        let (status, document) = json(&[&["identify", "--pole-pairs", "3"], tables.as_slice()].concat());
        assert_eq!((status, document["voltages"].as_str()), (1, Some("ambiguous")));
        assert!(document["parameters"]["psi_f"]["value"].is_null());
        let run = fluxfit(&[&["identify", "--pole-pairs", "3"], tables.as_slice()].concat());
        let line = run.out.split_whitespace().collect::<Vec<_>>().join(" ");
        let value = |from: &str| -> f64 { line.split(from).nth(1).unwrap().split("psi_f ").nth(1).unwrap()[..5].parse().unwrap() };
        assert!((value("Line to line:") / 60.0 - 1.0).abs() < 0.005, "{line}");
        assert!((value("Of a phase:") / 0.103_92 - 1.0).abs() < 0.01, "{line}");
    }
    // What the name states, and the torque contradicts.
    let open = open_circuit_named(folder.path(), noise, "U_ll [V]", of_phase);
    let run = fluxfit(&["identify", &open, &short]);
    assert!(run.status == 2 && run.err.contains("1.7321 times as large"), "{}", run.err);
}

/// Torque that rises with the current, at speeds that do not matter: a motor that drives a load.
#[test]
fn the_table_of_a_driven_motor_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "speed_rpm,current_A,torque_Nm\n".to_owned();
    (1..15).for_each(|k| writeln!(text, "{},{k},{}", 1000 + k, 0.5 * f64::from(k) - 0.1).unwrap());
    let run = fluxfit(&["identify", &written(folder.path(), "load.csv", &text)]);
    assert!(run.status == 2 && run.err.contains("drives a load"), "{}", run.err);
}

/// A traction motor: R 6.87 mohm, p L_d 0.454 mH, p L_q 1.155 mH, p psi_f 0.253 Wb by the data's own description.
#[test]
fn a_traction_motor_on_its_bench() {
    let Some(folder) = shared("real") else { return };
    let file = |name: &str| format!("{folder}/{name}");
    let tables = [file("ev_sbwcwso_open_circuit_20C.csv"), file("ev_sbwcwso_active_short_circuit_20C.csv")];
    let (_, document) = json(&["identify", &tables[0], &tables[1]]);
    for (key, value, most) in [("rs", 6.87e-3, 0.02), ("ld", 0.454e-3, 0.01), ("lq", 1.155e-3, 0.04), ("psi_f", 0.253, 0.01)] {
        let found = document["times_pole_pairs"][key]["value"].as_f64().unwrap();
        assert!((found / value - 1.0).abs() < most, "{key} {found}");
    }
}

/// Writes a row of `columns` for each of some numbers.
fn table_of(folder: &Path, name: &str, header: &str, rows: impl Iterator<Item = Vec<f64>>) -> String {
    let row = |row: Vec<f64>| row.iter().map(|value| format!("{value:.6}")).collect::<Vec<_>>().join(",") + "\n";
    written(folder, name, &format!("{header}\n{}", rows.map(row).collect::<String>()))
}

/// A torque sensor that reads 50 mN m too little, and errs by up to 20 mN m; with i_d of minus 0.4 i_q or without.
fn torque_of_current(folder: &Path, noise: &mut Noise, ratio: f64) -> String {
    let rows = (1..16).map(|k| {
        let iq = 2.0 * f64::from(k);
        let id = ratio * iq;
        vec![id, iq, 1.5 * PAIRS * (PSI_F * iq + (LD - LQ) * id * iq) - 0.05 + 0.02 * noise.next()]
    });
    table_of(folder, "torque.csv", "Id [A],Iq [A],shaft torque [Nm]", rows)
}

/// Between two terminals, and 20 mV of a contact.
fn direct_current(folder: &Path, noise: &mut Noise) -> String {
    let currents = [5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0];
    let rows = currents.iter().map(|current| vec![2.0 * RS * current + 0.02 + 0.003 * noise.next(), *current]);
    table_of(folder, "direct.csv", "U_ll [V],I [A]", rows)
}

/// Of space vector modulation, whose switches lose 0.3 V.
fn duty_cycle(folder: &Path, noise: &mut Noise) -> String {
    let rows = (0..80).map(|k| {
        let (omega_e, iq) = (300.0 + 900.0 * (0.07 * f64::from(k)).sin().abs(), 60.0 + 50.0 * (0.31 * f64::from(k)).sin());
        let voltage = (RS * iq + omega_e * PSI_F).hypot(omega_e * LQ * iq) + 0.3;
        let duty = voltage * 3.0_f64.sqrt() / 180.0 + 5e-4 * noise.next();
        vec![0.1 * f64::from(k), omega_e / PAIRS * 60.0 / std::f64::consts::TAU, duty, 180.0, iq]
    });
    table_of(folder, "duty.csv", "t,speed_rpm,duty,input voltage [V],motor current [A]", rows)
}

#[test]
fn torque_direct_current_and_duty_cycle_tell_their_parts_within_their_intervals() {
    let folder = tempfile::tempdir().unwrap();
    let (mut held, mut drawn) = (0, 0);
    for seed in 1..=12 {
        let noise = &mut Noise(seed);
        let tables = [
            (torque_of_current(folder.path(), noise, 0.0), &["psi_f"][..]),
            (torque_of_current(folder.path(), noise, -0.4), &["psi_f"]),
            (direct_current(folder.path(), noise), &["rs"]),
            (duty_cycle(folder.path(), noise), &["psi_f", "lq"]),
        ];
        for (table, keys) in tables {
            let (_, document) = json(&["identify", &table, "--pole-pairs", "3"]);
            for key in ["rs", "ld", "lq", "psi_f"] {
                let parameter = &document["parameters"][key];
                let truth = [("rs", RS), ("ld", LD), ("lq", LQ), ("psi_f", PSI_F)].into_iter().find(|(name, _)| *name == key).unwrap().1;
                if keys.contains(&key) {
                    let ci95 = [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap());
                    assert!((ci95[1] - ci95[0]) / truth < 0.1, "{table}: {key} {ci95:?}");
                    (held, drawn) = (held + usize::from((ci95[0]..=ci95[1]).contains(&truth)), drawn + 1);
                } else if !table.contains("duty") {
                    assert!(parameter["value"].is_null(), "{table}: {key}");
                }
            }
        }
    }
    // Of 60 intervals of 95 %, fewer than 52 hold with a probability of 1 in 200.
    assert!(drawn == 60 && held >= 52, "{held} of {drawn}");
}

/// A dynamometer's map: 4 speeds and 9 currents, voltages that err by up to 50 mV and of which the inverter loses 0.4 V.
fn operating_points(folder: &Path, noise: &mut Noise, with_id: bool) -> String {
    points_of(folder, noise, with_id, (&|_| RS, 0.4), 1.0)
}

/// The same of a resistance that depends on the current and so many V lost, and with a torque that is so many times that of the motor.
fn points_of(folder: &Path, noise: &mut Noise, with_id: bool, (rs, lost): (&dyn Fn(f64) -> f64, f64), of_torque: f64) -> String {
    let points = (0..36).map(|k| {
        let (speed, size, angle) = ([500.0, 1000.0, 2000.0, 3000.0][k / 9], [20.0, 50.0, 90.0][k % 3], [0.0, 0.4, 0.9][k / 3 % 3]);
        let (omega_e, angle) = (speed * std::f64::consts::TAU / 60.0 * PAIRS, if with_id { angle } else { 0.0 });
        let (id, iq) = (-size * f64::sin(angle), size * f64::cos(angle));
        let (ud, uq) = (rs(size) * id - omega_e * LQ * iq, rs(size) * iq + omega_e * (LD * id + PSI_F));
        let torque = of_torque * 1.5 * PAIRS * (PSI_F * iq + (LD - LQ) * id * iq) - 0.1;
        vec![speed, id, iq, ud + lost * id / size + 0.05 * noise.next(), uq + lost * iq / size + 0.05 * noise.next(), torque]
    });
    table_of(folder, "points.csv", "n [rpm],Id [A],Iq [A],Ud [V],Uq [V],M [Nm]", points)
}

#[test]
fn operating_points_tell_the_motor_within_their_intervals() {
    let folder = tempfile::tempdir().unwrap();
    let (mut held, mut drawn) = (0, 0);
    for seed in 1..=20 {
        let table = operating_points(folder.path(), &mut Noise(seed), true);
        let (status, document) = json(&["identify", &table, "--pole-pairs", "3"]);
        assert_eq!((status, document["tables"][0]["kind"].as_str()), (0, Some("operating-points")), "{document}");
        for (key, truth) in [("rs", RS), ("ld", LD), ("lq", LQ), ("psi_f", PSI_F)] {
            let ci95 = [0, 1].map(|end| document["parameters"][key]["ci95"][end].as_f64().unwrap());
            (held, drawn) = (held + usize::from((ci95[0]..=ci95[1]).contains(&truth)), drawn + 1);
        }
    }
    // Of 80 intervals of 95 %, fewer than 71 hold with a probability of 1 in 100.
    assert!(drawn == 80 && held >= 71, "{held} of {drawn}");
    // Without a current of the d axis nothing depends on its inductance.
    let (_, document) = json(&["identify", &operating_points(folder.path(), &mut Noise(1), false), "--pole-pairs", "3"]);
    assert!(document["parameters"]["ld"]["value"].is_null(), "{document}");
    let lq = document["parameters"]["lq"]["value"].as_f64().unwrap();
    assert!((lq / LQ - 1.0).abs() < 0.01, "{lq}");
}

/// Rms values have half the power. A winding that warms by the square of the current, up to 20 %, passes for an inverter that adds voltage;
/// without, its resistance is somewhere between.
#[test]
fn operating_points_are_compared_with_their_torque_and_gain_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let table = points_of(folder.path(), &mut Noise(3), true, (&|_| RS, 0.4), 2.0);
    let refused = fluxfit(&["identify", &table, "--pole-pairs", "3"]);
    assert!(refused.status == 2 && refused.err.contains("the torque is 1.9") && refused.err.contains("rms"), "{}", refused.err);
    let intervals = (1..=8).filter_map(|seed| {
        let table = points_of(folder.path(), &mut Noise(seed), true, (&|i| RS * (1.0 + 0.2 * (i / 90.0).powi(2)), 0.0), 1.0);
        let (_, document) = json(&["identify", &table, "--pole-pairs", "3"]);
        Some([0, 1].map(|end| document["parameters"]["rs"]["ci95"][end].as_f64().unwrap_or(f64::NAN))).filter(|ends| ends[0] > 0.0)
    });
    let intervals: Vec<[f64; 2]> = intervals.collect();
    assert!(intervals.len() >= 4 && intervals.iter().all(|[low, high]| *low < 1.2 * RS && *high > RS), "{intervals:?}");
}

/// u_dc / 2 is sqrt 3 / 2 of u_dc / sqrt 3: by so much all voltages, and all parameters with them, are smaller, 13.4 %.
#[test]
fn what_a_duty_of_1_may_stand_for_is_told_below_the_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let table = duty_cycle(folder.path(), &mut Noise(1));
    let (_, document) = json(&["identify", &table, "--pole-pairs", "3"]);
    let unseen = document["unseen"].as_array().unwrap();
    let of_duty = unseen.iter().find(|one| one["instrument"] == "duty-scale").unwrap();
    let change = of_duty["changes"]["psi_f"].as_f64().unwrap();
    assert!((change + 0.134).abs() < 1e-3, "{change}");
    let shown = fluxfit(&["identify", &table, "--pole-pairs", "3"]).out;
    let below = shown.split("  psi_f").nth(1).unwrap().lines().nth(2).unwrap();
    assert!(
        below.starts_with("Not in the intervals") && shown.contains("a duty of 1 that is u_dc / 2") && shown.contains("-13.4 %"),
        "{shown}"
    );
}

#[test]
fn tables_of_several_kinds_are_one_identification() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(11);
    let short = short_circuit(folder.path(), noise, false);
    let direct = direct_current(folder.path(), noise);
    // Currents of a short circuit tell all but the scale, which the resistance gives.
    let (status, document) = json(&["identify", &short, &direct, "--pole-pairs", "3"]);
    for (key, truth) in [("rs", RS), ("ld", LD), ("lq", LQ), ("psi_f", PSI_F)] {
        let value = document["parameters"][key]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.03, "{key} {value}");
    }
    assert_eq!((status, document["tables"][1]["kind"].as_str()), (0, Some("direct-current")));
    // The torque of a current tells between which points voltages were measured.
    let open = open_circuit_named(folder.path(), noise, "U [V]", 1.0 / 3.0_f64.sqrt());
    let torque = torque_of_current(folder.path(), noise, -0.4);
    let (_, document) = json(&["identify", &open, &torque]);
    assert_eq!(document["voltages"], "phase-by-torque");
}

#[test]
fn a_table_is_shown_as_what_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let table = short_circuit(folder.path(), &mut Noise(2), true);
    let run = fluxfit(&["inspect", &table]);
    assert!(run.status == 0 && run.out.starts_with("A table of a test bench: short-circuit characteristic"), "{}", run.out);
    let (status, document) = json(&["inspect", &table]);
    assert_eq!((status, document["table"].as_str(), document["error"].is_null()), (0, Some("short-circuit characteristic"), true));
}

/// Positions, speeds and voltages of a drive over time are no open-circuit table; no unit of them is guessed.
#[test]
fn what_only_looks_like_a_table_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let wave = |k: i32| (0.3 * f64::from(k)).sin();
    let log = table_of(folder.path(), "wave.csv", "speed_rpm,voltage [V]", (1..40).map(|k| vec![100.0 * wave(k), wave(2 * k)]));
    assert!(fluxfit(&["identify", &log]).err.contains("are missing"));
    let load =
        table_of(folder.path(), "load.csv", "speed_rpm,U_ll [V]", (1..40).map(|k| vec![100.0 + f64::from(k), 20.0 + 19.0 * wave(7 * k)]));
    let run = fluxfit(&["identify", &load]);
    assert!(run.status == 2 && run.err.contains("do not grow with the speed"), "{}", run.err);
}

/// A MATLAB workspace may hold what only MATLAB can read besides.
#[test]
fn a_table_beside_a_timetable_is_read() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fluxfit-log/tests/corpus/logs/table_beside_timetable.mat");
    let (_, document) = json(&["identify", workspace.to_str().unwrap(), "--pole-pairs", "3"]);
    let value = document["parameters"]["psi_f"]["value"].as_f64().unwrap();
    assert!((value / 0.06 - 1.0).abs() < 1e-6, "{value}");
}

/// Resistance and what contacts drop are one number at one current, in one direction or in both; three rows of it do not help, also
/// where the last digits of voltage and current happen to rise together and gave 44.5 mohm in place of 12, ±4 %.
#[test]
fn a_direct_current_of_one_size_asks_for_a_second_one() {
    let folder = tempfile::tempdir().unwrap();
    for currents in [[10.0, 10.01, 9.99], [10.0, -10.0, 10.0]] {
        // Of a meter with three digits.
        let rows = currents.iter().zip([0.2, 0.9, -0.4]).map(|(current, digit): (&f64, f64)| {
            let voltage: f64 = 0.024 * current + 0.02 * current.signum() + 1e-3 * digit;
            vec![voltage, *current]
        });
        let table = table_of(folder.path(), "direct.csv", "U_ll [V],I [A]", rows);
        let (status, document) = json(&["identify", &table, "--pole-pairs", "3"]);
        let rs = &document["parameters"]["rs"];
        assert!(status == 1 && rs["value"].is_null(), "{rs}");
        assert!(rs["reason"].as_str().unwrap().starts_with("all currents are about 10.0 A, where the resistance and a constant"), "{rs}");
        assert_eq!(rs["remedy"], "measure at a second current too, such as 5.00 A");
        let run = fluxfit(&["identify", &table]);
        let words = run.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("For R_s: measure at a second current too, such as 5.00 A."), "{words}");
        assert!(words.contains("For p L_d, p L_q: add a short-circuit table of the same motor, or operating points with i_d."), "{words}");
    }
    let one = table_of(folder.path(), "one.csv", "U_ll [V],I [A]", [vec![0.26, 10.0]].into_iter());
    let run = fluxfit(&["identify", &one]);
    assert!(run.status == 2 && run.err.contains("too few currents (1; at least 3 are needed)"), "{}", run.err);
}

/// Of every number without a value it is said why, and what to do.
#[test]
fn every_number_without_a_value_has_its_reason_and_its_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(6);
    // Torques that err by a quarter of the largest: within what is taken for such a table, and too much for the flux.
    let torques = table_of(
        folder.path(),
        "noisy.csv",
        "Iq [A],torque [Nm]",
        (1..7).map(|k| vec![f64::from(k), 0.27 * f64::from(k) + 0.4 * noise.next()]),
    );
    let held = table_of(folder.path(), "held.csv", "Iq [A],torque [Nm]", (0..6).map(|_| vec![8.0, 2.16 + 0.02 * noise.next()]));
    let open = open_circuit_named(folder.path(), noise, "U [V]", 1.0);
    for (tables, pole_pairs) in [(&torques, "3"), (&held, "3"), (&open, "3"), (&torques, ""), (&open, "")] {
        let pairs: &[&str] = if pole_pairs.is_empty() { &[] } else { &["--pole-pairs", pole_pairs] };
        let (status, document) = json(&[&["identify", tables.as_str()], pairs].concat());
        assert_eq!(status, 1);
        for (of, key) in ["parameters", "times_pole_pairs"].into_iter().flat_map(|of| ["rs", "ld", "lq", "psi_f"].map(|key| (of, key))) {
            let entry = &document[of][key];
            for sentence in ["reason", "remedy"] {
                assert_eq!(entry[sentence].is_null(), !entry["value"].is_null(), "{tables}: {key} {entry}");
            }
        }
    }
    let psi_f = &json(&["identify", &torques, "--pole-pairs", "3"]).1["parameters"]["psi_f"];
    assert!(psi_f["reason"].as_str().unwrap().contains("torques"), "{psi_f}");
    let run = fluxfit(&["identify", &held, "--pole-pairs", "3"]);
    let words = run.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("psi_f: all i_q are about 8.00 A") && words.contains("For psi_f: measure at a second i_q too"), "{words}");
}

/// What is unclear of a table is asked for at once, and what is asked for can be pasted: then it is read. `inspect` says the same.
#[test]
fn all_that_is_unclear_of_a_table_is_asked_for_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let shorted = SPEEDS.map(|rpm| {
        let hertz = rpm * PAIRS / 60.0;
        let [id, iq] = short_circuit_current(hertz * std::f64::consts::TAU);
        let (current, torque) = (id.hypot(iq) / 2.0_f64.sqrt(), 1.5 * PAIRS * (PSI_F * iq + (LD - LQ) * id * iq));
        vec![hertz, current, 1.001 * current, torque, 1.002 * torque]
    });
    let shorted = table_of(folder.path(), "short.csv", "f [Hz],I_1 [A],I_4 [A],M1 [Nm],M2 [Nm]", shorted.into_iter());
    let direct = (1..9).map(|k| 10.0 * f64::from(k)).map(|i| vec![2.0 * RS * i, 2.01 * RS * i, i, 1.01 * i]);
    let direct = table_of(folder.path(), "direct.csv", "U1 [V],U2 [V],I1 [A],I2 [A]", direct);
    let torques = (1..9).map(f64::from).map(|i| vec![i, 0.27 * i - 0.02, 0.28 * i - 0.02]);
    let torques = table_of(folder.path(), "torque.csv", "Iq [A],M1 [Nm],M2 [Nm]", torques);
    let mapped = "speed=f [Hz],current=I_1 [A],torque=M1 [Nm]";
    for (table, said, options) in [
        (&shorted, ["'I_1 [A]' and 'I_4 [A]'", "'M1 [Nm]' and 'M2 [Nm]'"], &format!("--map '{mapped}' --pole-pairs N")[..]),
        (
            &direct,
            ["'U1 [V]' and 'U2 [V]'", "put 'll'"],
            "--map 'current=I1 [A],voltage_ll=U1 [V]', or --map 'current=I1 [A],voltage_phase=U1 [V]'",
        ),
        (&torques, ["'M1 [Nm]' and 'M2 [Nm]'", "the torque"], "--map 'torque=M1 [Nm]'"),
    ] {
        let run = fluxfit(&["identify", table]);
        assert!(run.status == 2 && said.iter().all(|words| run.err.contains(words)) && run.err.contains(options), "{}", run.err);
        let inspected = fluxfit(&["inspect", table]);
        assert!(inspected.status == 2 && inspected.out.starts_with("A table of a test bench, but nothing"), "{}", inspected.out);
        let sentence = run.err.lines().find(|line| line.starts_with("error:")).unwrap();
        assert!(inspected.err.contains(sentence) && !inspected.out.contains("omega_e"), "{}\n{}", inspected.out, inspected.err);
        assert!(!inspected.out.contains("not stated"), "{}", inspected.out);
        let mapping = folder.path().join("mapping.toml");
        let run = fluxfit(&["inspect", table, "-o", mapping.to_str().unwrap()]);
        assert!(run.status == 2 && run.err.contains("takes no mapping file") && !mapping.exists(), "{}", run.err);
    }
    for (table, map) in [(&shorted, mapped), (&torques, "torque=M1 [Nm]")] {
        let (status, document) = json(&["identify", table, "--pole-pairs", "3", "--map", map]);
        assert!(status < 2 && !document["parameters"]["psi_f"]["value"].is_null(), "{document}");
        assert_eq!(fluxfit(&["inspect", table, "--pole-pairs", "3", "--map", map]).status, 0);
    }
    // What is mapped to channels of a log is read as one.
    let run = fluxfit(&["identify", &torques, "--map", "ud=M1 [Nm]"]);
    assert!(run.status == 2 && run.err.contains("are missing"), "{}", run.err);
}

/// What a refusal or an answer says to map is read so: line to line the flux is 60 mWb, and of a phase sqrt 3 times as much; in series the
/// resistance is half of that from a terminal to the star point. Of several tables a column has to be in one.
#[test]
fn between_which_points_voltages_were_measured_can_be_said_without_editing_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let noise = &mut Noise(8);
    let open = open_circuit_named(folder.path(), noise, "U [V]", 1.0);
    let shown = fluxfit(&["identify", &open, "--pole-pairs", "3"]).out;
    let direct = (1..9).map(|k| 10.0 * f64::from(k)).map(|current| vec![2.0 * RS * current, current]);
    let direct = table_of(folder.path(), "direct.csv", "U_DC [V],I_DC [A]", direct);
    let refused = fluxfit(&["identify", &direct]).err;
    for (name, factor) in [("voltage_ll", 1.0), ("voltage_phase", 3.0_f64.sqrt())] {
        let map = format!("{name}=U [V]");
        assert!(shown.lines().any(|line| line == format!("    --map '{map}'")), "{shown}");
        let (_, document) = json(&["identify", &open, "--pole-pairs", "3", "--map", &map]);
        let psi_f = document["parameters"]["psi_f"]["value"].as_f64().unwrap();
        assert!((psi_f / (factor * PSI_F) - 1.0).abs() < 0.003 && document["voltages"] == "stated", "{psi_f}");
        let map = format!("{name}=U_DC [V]");
        assert!(refused.contains(&format!("--map '{map}'")), "{refused}");
        let (_, document) = json(&["identify", &direct, "--map", &map]);
        let rs = document["parameters"]["rs"]["value"].as_f64().unwrap();
        assert!((rs / if name == "voltage_ll" { RS } else { 2.0 * RS } - 1.0).abs() < 1e-6, "{rs}");
    }
    let short = short_circuit(folder.path(), noise, false);
    let (status, document) = json(&["identify", &open, &short, "--pole-pairs", "3", "--map", "voltage_ll=U [V]"]);
    let rs = document["parameters"]["rs"]["value"].as_f64().unwrap();
    assert!(status == 0 && (rs / RS - 1.0).abs() < 0.02, "{document}");
    let run = fluxfit(&["identify", &open, &short, "--map", "voltage_ll=no"]);
    assert!(run.status == 2 && run.err.contains("which the file does not have"), "{}", run.err);
}

/// A file of a few columns may be a table under other names: the refusal says how they are mapped, and what is mapped is a table.
#[test]
fn a_small_file_that_is_no_log_can_be_mapped_as_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let rows = SPEEDS.map(|rpm| vec![rpm, 1.5_f64.sqrt() * PAIRS * rpm * std::f64::consts::TAU / 60.0 * PSI_F]);
    let open = table_of(folder.path(), "open.csv", "Umdrehungen,Messgeraet 2", rows.into_iter());
    let run = fluxfit(&["identify", &open]);
    assert!(run.status == 2 && run.err.contains("if it is a table of a test bench"), "{}", run.err);
    assert!(run.err.contains("--map speed=COLUMN,voltage=COLUMN,current=COLUMN,torque=COLUMN"), "{}", run.err);
    let map = "speed=Umdrehungen,voltage_ll=Messgeraet 2";
    let run = fluxfit(&["identify", &open, "--map", map]);
    assert!(run.status == 2 && run.err.contains("--unit speed=UNIT"), "{}", run.err);
    let (_, document) = json(&["identify", &open, "--map", map, "--unit", "speed=rpm-mech", "--pole-pairs", "3"]);
    let psi_f = document["parameters"]["psi_f"]["value"].as_f64().unwrap();
    assert!((psi_f / PSI_F - 1.0).abs() < 1e-6, "{psi_f}");
    let run = fluxfit(&["identify", &open, "--map", map, "--unit", "speed=rpm-mech,ud=mV"]);
    assert!(run.status == 2 && run.err.contains("the unit of ud is stated, and of a table"), "{}", run.err);
    let run = fluxfit(&["identify", &open, "--map", "speed=Umdrehungen,torque=Messgeraet 2"]);
    assert!(run.status == 2 && run.err.contains("make no table of a test bench"), "{}", run.err);
}
