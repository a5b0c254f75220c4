//! Whatever is wrong is refused in one sentence that names it and the remedy, with exit status 2; or judged, with exit status 1.

use super::{fluxfit, fluxfit_with_input};

const HEADER: &str = "t,ud,uq,id,iq,omega_e";

/// A log of `rows` rows in which everything stands still; row `k` can be changed.
fn log(rows: usize, change: impl Fn(usize) -> Option<String>) -> String {
    let row = |k: usize| change(k).unwrap_or_else(|| format!("{:.4},-45,80,-2,9,418", k as f64 * 1e-4));
    let rows: Vec<String> = (0..rows).map(row).collect();
    format!("{HEADER}\n{}\n", rows.join("\n"))
}

/// With row 3 (line 5) replaced.
fn with_row(text: &str) -> String {
    log(100, |k| (k == 3).then(|| text.to_owned()))
}

#[test]
fn unreadable_logs() {
    let table: Vec<(&str, Vec<u8>, &[&str])> = vec![
        (
            "missing column",
            log(100, |_| None).replace("omega_e", "load_speed").into(),
            &["line 1", "omega_e", "missing", "--map omega_e=load_speed"],
        ),
        ("text in a number", with_row("0.0003,-45,8O,-2,9,418").into(), &["line 5", "column 'uq'", "8O"]),
        ("empty cell", with_row("0.0003,-45,,-2,9,418").into(), &["line 5", "column 'uq'"]),
        ("NaN", with_row("0.0003,-45,NaN,-2,9,418").into(), &["line 5", "column 'uq'", "NaN"]),
        ("inf", with_row("0.0003,-45,80,-inf,9,418").into(), &["line 5", "column 'id'", "inf"]),
        ("1e300", with_row("0.0003,-45,80,-2,1e300,418").into(), &["line 5", "column 'iq'", "1e300"]),
        ("too few cells", with_row("0.0003,-45,80").into(), &["line 5", "3", "6"]),
        ("too many cells", with_row("0.0003,-45,80,-2,9,418,1,2").into(), &["line 5", "8", "6"]),
        ("duplicated header", log(100, |_| None).replace("uq,id", "uq,uq").into(), &["line 1", "uq"]),
        ("duplicated time", with_row("0.0002,-45,80,-2,9,418").into(), &["line 5", "increase"]),
        ("backward time", with_row("0.0001,-45,80,-2,9,418").into(), &["line 5", "increase"]),
        ("empty file", Vec::new(), &["empty"]),
        ("header only", HEADER.into(), &["row"]),
        ("one row", log(1, |_| None).into(), &["row"]),
        ("binary", b"\x7fELF\x02\x00\x00\x01 \xff\xfe\n".to_vec(), &["text"]),
        ("all zeros", log(100, |k| Some(format!("{:.4},0,0,0,0,0", k as f64 * 1e-4))).into(), &["zero"]),
        ("no speed", log(100, |k| Some(format!("{:.4},1,1,1,1,0", k as f64 * 1e-4))).into(), &["omega_e", "zero"]),
        (
            "few rows",
            log(26, |k| Some(format!("{:.2},{},{},0,{k},418", k as f64 * 1e-2, -0.418 * k as f64, 20.9 + 0.5 * k as f64))).into(),
            &["26 rows without a gap", "log longer"],
        ),
        (
            "never steady",
            log(100, |k| Some(format!("{:.2},{},{},0,{k},418", k as f64 * 1e-2, -0.418 * k as f64, 20.9 + 0.5 * k as f64))).into(),
            &["no steady stretch", "--window"],
        ),
    ];
    for (name, text, expected) in table {
        let file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
        std::fs::write(file.path(), &text).unwrap();
        let path = file.path().to_str().unwrap();
        for verb in ["identify", "compare"] {
            refused(&format!("{verb} {name}"), &fluxfit(&[verb, path]), &[expected, &[path]].concat());
            refused(
                &format!("{verb} {name} from a pipe"),
                &fluxfit_with_input(&[verb, "-"], &text),
                &[expected, &["standard input"]].concat(),
            );
        }
    }
}

#[test]
fn places_that_hold_no_log() {
    refused("directory", &fluxfit(&["identify", "examples"]), &["examples", "directory"]);
    refused("nothing there", &fluxfit(&["identify", "no_such.csv"]), &["no_such.csv"]);
    refused("standard input twice", &fluxfit(&["identify", "-", "-"]), &["standard input"]);
}

/// One current, one speed: readable, and judged.
#[test]
fn a_constant_log_is_judged() {
    let run = fluxfit_with_input(&["identify", "-"], log(100, |_| None).as_bytes());
    assert_eq!(run.status, 1, "{}{}", run.out, run.err);
    assert!(run.out.contains("not identifiable"), "{}", run.out);
    assert!(!run.out.contains("NaN") && !run.out.contains("inf"), "{}", run.out);
}

#[test]
fn absurd_settings() {
    let log = "examples/logs/paper_rig_pwm_noise.csv";
    let table: &[(&[&str], &[&str])] = &[
        (&["compare", log, "--population", "1"], &["population of 1", "tGFPA", "at least 4"]),
        (&["compare", log, "--population", "0"], &["population of 0"]),
        (&["compare", log, "--runs", "0"], &["runs", "at least 1"]),
        (&["compare", log, "--runs", "1000000000"], &["runs", "at most"]),
        (&["compare", log, "--population", "1000000000"], &["the population is 1.00e9; it must be at most 1000000"]),
        (&["compare", log, "--iterations", "18446744073709551615"], &["the number of iterations", "at most 1000000"]),
        (&["compare", log, "--tolerance", "NaN"], &["--tolerance"]),
        (&["compare", log, "--methods", "ga"], &["ga", "tgfpa"]),
        (&["compare", log, "--bounds", "rs=NaN:5"], &["rs", "NaN"]),
        (&["compare", log, "--bounds", "ld=50mH:1mH"], &["ld"]),
        (&["compare", log, "--bounds", "rs=0:inf"], &["rs", "inf"]),
        (&["compare", log, "--bounds", "rs=0:5", "--bounds", "rs=0:6"], &["--bounds", "rs", "twice"]),
        (&["compare", log, "--truth", log], &[log]),
        (&["identify", log, "--window", "5:6"], &["5:6", "0.8999", "at least 30"]),
        (&["identify", log, "--window", "0.6:0.5"], &["0.6"]),
        (&["identify", log, "--window", "now"], &["now"]),
        (&["identify", log, "--fix", "rs=-inf"], &["rs", "inf"]),
        (&["identify", log, "--fix", "rm=1"], &["rm", "rs"]),
        (&["identify", log, "--prior", "rs=0.96±0%"], &["0"]),
        (&["identify", log, "--fix", "rs=1", "--prior", "rs=1±1%"], &["rs", "--fix", "--prior"]),
        (&["identify", log, "--fix", "rs=1,ld=1mH,lq=1mH,psi_f=1"], &["all four", "leave at least one"]),
        (&["identify", log, "--voltage-accuracy", "NaN"], &["--voltage-accuracy", "NaN"]),
        (&["identify", log, "--voltage-accuracy", "2"], &["voltage accuracy", "2"]),
        (&["identify", log, "--current-accuracy", "1 A"], &["--current-accuracy", "1 A", "1%"]),
        (&["identify", log, "--current-accuracy", "1"], &["accuracy of the current sensors", "from 0 up to 1"]),
        (&["identify", log, "--bus-accuracy", "120%"], &["accuracy of the bus voltage", "1.2"]),
        (&["identify", log, "--map", "ud=nothing"], &["nothing"]),
        (&["identify", log, "--map", "voltage=ud"], &["voltage"]),
        (&["identify", log, "--unit", "omega=furlong"], &["furlong", "rpm-mech"]),
        (&["identify", log, "--unit", "omega=rpm-mech"], &["--pole-pairs"]),
        (&["identify", log, "--pole-pairs", "0"], &["0", "1..=1000"]),
        (&["identify", log, "--motor", "README.md"], &["README.md"]),
        (&["identify"], &["LOG"]),
    ];
    for (arguments, expected) in table {
        let run = fluxfit(arguments);
        assert_eq!(run.status, 2, "{arguments:?}: {}{}", run.out, run.err);
        assert_eq!(run.out, "", "{arguments:?}");
        assert!(!run.err.contains("panicked"), "{}", run.err);
        for expected in *expected {
            assert!(run.err.contains(expected), "{arguments:?}: {expected} is not in {}", run.err);
        }
    }
}

/// Status 2, nothing answered, and one line that says these things; below it, at most the file's line.
fn refused(name: &str, run: &super::Run, expected: &[&str]) {
    assert_eq!(run.status, 2, "{name}: {}{}", run.out, run.err);
    assert_eq!(run.out, "", "{name}");
    let (sentence, excerpt) = run.err.split_once('\n').unwrap();
    assert!(sentence.starts_with("error: "), "{name}: {}", run.err);
    assert!(excerpt.lines().count() <= 3 && excerpt.lines().all(|line| line.contains(" |")), "{name}: {}", run.err);
    for expected in expected {
        assert!(sentence.contains(expected), "{name}: {expected} is not in {sentence}");
    }
}

#[test]
fn files_of_its_own_that_are_no_logs_are_told_with_what_they_are_for() {
    for (file, what) in [
        (
            "examples/scenarios/id_zero.toml",
            "is a scenario, not a log; simulate it first (fluxfit simulate examples/scenarios/id_zero.toml -o",
        ),
        ("examples/paper_motor.toml", "is a motor file, not a log; name it beside the log: --motor examples/paper_motor.toml"),
    ] {
        for verb in ["identify", "inspect"] {
            let run = fluxfit(&[verb, file]);
            assert!(run.status == 2 && run.err.contains(what) && run.err.lines().count() == 1, "{verb}: {}", run.err);
        }
    }
}
