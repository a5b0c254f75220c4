//! Whatever a log came in, the answer is the same; what is understood of it can be looked at.

use super::{fluxfit, fluxfit_with_input, json, root};
use serde_json::Value;
use std::{fs, process::Command};

/// A log of 160 rows in the corpus, by independent writers.
const LOGS: &str = "crates/fluxfit-log/tests/corpus/logs";

/// The same in every container and dialect that loses nothing.
const SAME: [&str; 15] = [
    "tab.tsv",
    "decimal_comma.csv",
    "shuffled.csv",
    "utf16_le.csv",
    "gzip.csv.gz",
    "none.parquet",
    "snappy.parquet",
    "zstd.parquet",
    "byte_stream_split.parquet",
    "vectors_v5_compressed.mat",
    "struct_v5.mat",
    "simulink_v5.mat",
    "vectors_v73_deflate.mat",
    "one_group.mf4",
    "one_group_compressed.mf4",
];

/// The answer, without the words about its columns.
fn answer(file: &str) -> Value {
    let (_, mut document) = json(&["identify", &format!("{LOGS}/{file}")]);
    let log = document["log"].as_object_mut().unwrap();
    assert!(log.remove("columns").is_some_and(|columns| columns[0].as_str().unwrap().contains("ud = ")));
    assert!(log.remove("notes").is_some());
    document
}

#[test]
fn the_same_log_gives_the_same_bits_of_answer() {
    let expected = answer("canonical.csv");
    assert!(expected["parameters"]["rs"]["value"].is_f64());
    for file in SAME {
        assert_eq!(answer(file), expected, "{file}");
    }
}

#[test]
fn a_pipe_gives_the_same_answer_as_the_file() {
    let bytes = fs::read(root().join(LOGS).join("gzip.csv.gz")).unwrap();
    let run = fluxfit_with_input(&["identify", "-", "--json"], &bytes);
    let through_pipe: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(through_pipe["parameters"], answer("canonical.csv")["parameters"]);
}

#[test]
fn an_inspection_shows_columns_and_writes_a_mapping_that_identify_takes() {
    let folder = tempfile::tempdir().unwrap();
    let (log, mapping) = (folder.path().join("bench.csv"), folder.path().join("bench.toml"));
    let canonical = fs::read_to_string(root().join(LOGS).join("slow.csv")).unwrap();
    fs::write(
        &log,
        canonical.replacen("t,ud,uq,id,iq,omega_e", "time [s],Bench Vd,Bench Vq,Bench Id,Bench Iq,Bench Speed [rad/s-elec]", 1),
    )
    .unwrap();
    let (log, mapping) = (log.to_str().unwrap(), mapping.to_str().unwrap());
    let run = fluxfit(&["inspect", log, "-o", mapping]);
    assert_eq!(run.status, 2, "{}", run.err);
    assert!(run.out.contains("Bench Vd") && run.out.contains("ud?"), "{}", run.out);
    let guessed = fs::read_to_string(mapping).unwrap();
    assert!(guessed.contains("ud = { column = \"Bench Vd\" }"), "{guessed}");
    let run = fluxfit(&["identify", log, "--mapping", mapping]);
    assert_eq!(run.status, 2, "its unit is unknown: {}", run.err);
    assert!(guessed.contains("unit = \"?\" }  # by its name; check it, and state its unit"), "{guessed}");
    fs::write(mapping, guessed.replace("unit = \"?\"", "unit = \"rad/s\"")).unwrap();
    let (_, document) = json(&["identify", log, "--mapping", mapping]);
    assert_eq!(document["parameters"], answer("slow.csv")["parameters"]);
}

/// The numbers are those of the file, by eye: `t` from 0 to 0.199, with a gap after the first hundred rows in the other one.
#[test]
fn the_document_of_an_inspection_has_columns_and_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gap.csv");
    let row = |k: u32| format!("{:.3},1.5,20,0,{},400\n", f64::from(k + if k < 100 { 0 } else { 500 }) * 1e-3, 3 + k % 2);
    fs::write(&path, format!("t,ud,uq,id,iq,omega_e\n{}", (0..200).map(row).collect::<String>())).unwrap();
    let (status, document) = json(&["inspect", path.to_str().unwrap()]);
    assert_eq!((status, &document["schema"], &document["layout"]), (0, &"fluxfit.inspection/1".into(), &"canonical".into()));
    let iq = &document["columns"][4];
    assert_eq!((&iq["name"], &iq["channel"], &iq["range"]), (&"iq".into(), &"iq".into(), &serde_json::json!([3.0, 4.0])));
    assert_eq!((&document["log"]["rows"], &document["log"]["interpolated"]), (&200.into(), &false.into()));
    assert_eq!(document["log"]["gaps"], serde_json::json!([{ "t0": 0.099, "t1": 0.6 }]));
    assert_eq!(document["error"], Value::Null);

    fs::write(&path, "t,Bench Vd,uq,id,iq,omega_e\n0,1,20,0,3,400\n1,1,20,0,3,400\n").unwrap();
    let (status, document) = json(&["inspect", path.to_str().unwrap()]);
    assert_eq!((status, &document["log"], &document["columns"][1]["resembles"]), (2, &Value::Null, &"ud".into()));
    assert!(document["error"].as_str().unwrap().contains("the column ud is missing"), "{document}");

    let run = fluxfit(&["inspect", path.to_str().unwrap(), "--json", "-o", "-"]);
    assert_eq!((run.status, run.out.as_str()), (2, ""));
}

#[test]
fn layouts_are_listed() {
    let run = fluxfit(&["formats"]);
    assert_eq!(run.status, 0);
    for name in ["VESC Tool", "phobia", "ST MCSDK", "Tritium", "Paderborn"] {
        assert!(run.out.contains(name), "{name}");
    }
}

/// Five million rows are read in half of what their numbers alone would take.
#[cfg(target_os = "linux")]
#[test]
fn a_long_log_is_read_in_bounded_memory() {
    use std::io::Write;
    const ROWS: u32 = 5_000_000;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.csv");
    let mut file = std::io::BufWriter::new(fs::File::create(&path).unwrap());
    writeln!(file, "t,ud,uq,id,iq,omega_e").unwrap();
    for row in 0..ROWS {
        writeln!(file, "{}.{:04},{},80,-1.{},9,400", row / 10_000, row % 10_000, 40 - i64::from(row % 3), row % 7).unwrap();
    }
    drop(file);
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_fluxfit")).arg("inspect").arg(&path).stdout(std::process::Stdio::null()).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut most = 0;
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let held = text.lines().find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse::<u64>().ok());
        most = most.max(held.unwrap_or(0));
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let numbers = 6 * u64::from(ROWS) * 8 / 1024;
    assert!(most > 0 && most < numbers / 2, "{most} kB");
}

/// A speed without a unit: both units that it mostly has, with the pole pairs that the second takes, and either is taken by the name that
/// the column has.
#[test]
fn a_speed_without_a_unit_is_read_in_the_second_call() {
    let log = fs::read_to_string(root().join("examples/logs/paper_rig_pwm_noise.csv")).unwrap().replacen("omega_e", "speed", 1);
    let identify = |options: &[&str]| fluxfit_with_input(&[&["inspect", "-"], options].concat(), log.as_bytes());
    let run = identify(&[]);
    assert!(run.err.contains("(--unit omega_e=rad/s, or --unit omega_e=rpm-mech --pole-pairs N)"), "{}", run.err);
    let run = identify(&["--unit", "speed=rpm-mech", "--pole-pairs", "4"]);
    assert!(run.out.contains("mechanical r/min") && !run.err.contains("error"), "{} {}", run.out, run.err);
}
