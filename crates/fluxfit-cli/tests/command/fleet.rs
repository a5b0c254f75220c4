//! Many motors: one row each, whatever happens.

use super::{Run, fluxfit};
use std::{
    fmt::Write,
    fs,
    path::Path,
    process::{Command, Stdio},
    time::Duration,
};

const HEADER: &str = "motor_id,t,ud,uq,id,iq,omega_e\n";

/// The log of a motor at three operating points, by the motor's equations: R_s is `rs` ohm.
fn motor(id: &str, rs: f64) -> String {
    let (ld, lq, psi_f, omega) = (5.25e-3, 12e-3, 0.1827, 400.0);
    (0..300).fold(String::new(), |mut text, row| {
        let (d, q) = [(0.0, 9.0), (-2.0, 8.5), (0.0, 4.0)][row / 100];
        let (ud, uq) = (rs * d - omega * lq * q, rs * q + omega * (ld * d + psi_f));
        let _ = writeln!(text, "{id},{},{ud},{uq},{d},{q},{omega}", row as f64 * 1e-3);
        text
    })
}

fn resistance(number: usize) -> f64 {
    0.5 + number as f64 * 0.01
}

fn table(motors: usize) -> String {
    (0..motors).fold(HEADER.to_owned(), |text, number| text + &motor(&format!("m{number:03}"), resistance(number)))
}

/// The rows of the results: cells by the names of the columns.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn place(path: &Path, column: &str) -> usize {
    let text = fs::read_to_string(path).unwrap();
    text.lines().next().unwrap().split(',').position(|name| name == column).unwrap()
}

fn fleet(log: &Path, output: &Path, more: &[&str]) -> Run {
    let arguments = [&["fleet", log.to_str().unwrap(), "--by", "motor_id", "-o", output.to_str().unwrap()], more].concat();
    fluxfit(&arguments)
}

#[test]
fn every_motor_has_its_row_with_its_values() {
    let directory = tempfile::tempdir().unwrap();
    let (log, output) = (directory.path().join("fleet.csv"), directory.path().join("results.csv"));
    fs::write(&log, table(20)).unwrap();
    let run = fleet(&log, &output, &[]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert_eq!(run.out, "20 motors, 20 rows: 20 with all 4 parameters identified, 0 with fewer, 0 without an answer.\n");
    let (rs, verdict) = (place(&output, "rs"), place(&output, "rs_verdict"));
    for (number, row) in rows(&output).iter().enumerate() {
        assert_eq!((row[0].as_str(), row[verdict].as_str()), (format!("m{number:03}").as_str(), "identified"));
        let found: f64 = row[rs].parse().unwrap();
        assert!((found / resistance(number) - 1.0).abs() < 0.01, "{found}");
    }
    assert!(!directory.path().join("results.csv.journal").exists());
    let again = directory.path().join("again.csv");
    fleet(&log, &again, &["--jobs", "3"]);
    assert_eq!(fs::read(&again).unwrap(), fs::read(&output).unwrap());
    // A row has the numbers of the document.
    let single = directory.path().join("m007.csv");
    fs::write(&single, HEADER.to_owned() + &motor("m007", resistance(7))).unwrap();
    let document: serde_json::Value = serde_json::from_str(&fluxfit(&["identify", single.to_str().unwrap(), "--json"]).out).unwrap();
    assert_eq!(rows(&output)[7][rs].parse::<f64>().unwrap(), document["parameters"]["rs"]["value"].as_f64().unwrap());
}

#[test]
fn what_fails_is_a_row_with_its_reason() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let (log, output) = (at("fleet.csv"), at("results.csv"));
    let standing = motor("standing", 1.0).replace(",400\n", ",0\n");
    let broken = motor("broken", 1.0).replacen(",9,", ",nine,", 1);
    let nameless = motor("", 1.0);
    let text = [HEADER.to_owned(), motor("a", 1.0), standing, broken, nameless, motor("b", 2.0), motor("a", 1.0), motor("c", 3.0)];
    fs::write(&log, text.concat()).unwrap();
    fs::write(at("damaged.parquet"), b"PAR1 and then nothing").unwrap();
    fs::write(at("empty.csv"), "").unwrap();
    let damaged = at("damaged.parquet");
    let names = [&log, &damaged, &at("empty.csv"), &at("missing.csv")].map(|path| path.to_str().unwrap().to_owned());
    let files: Vec<&str> = names.iter().map(String::as_str).collect();
    let run = fluxfit(&[&["fleet"], &files[..], &["--by", "motor_id", "-o", output.to_str().unwrap()]].concat());
    assert_eq!(run.status, 1, "{}", run.err);
    let text = fs::read_to_string(&output).unwrap();
    let line = |motor: &str| row_of(&output, motor);
    for (motor, reason) in [
        ("standing", "omega_e is zero"),
        ("broken", "is not a number"),
        ("", "have no motor_id"),
        ("a", "stand in several places"),
        (files[1], "cannot be read"),
        (files[2], "the file is empty"),
        (files[3], "there is no such file"),
    ] {
        assert!(line(motor).contains(reason), "{motor}: {}", line(motor));
    }
    for motor in ["b", "c"] {
        assert!(line(motor).contains(",identified,"), "{}", line(motor));
    }
    assert_eq!(text.lines().count(), 1 + 9);
}

/// The row of a motor in the results.
fn row_of(output: &Path, motor: &str) -> String {
    let text = fs::read_to_string(output).unwrap();
    let found: Vec<&str> = text.lines().filter(|line| line.starts_with(&format!("{motor},"))).collect();
    assert_eq!(found.len(), 1, "{motor}: {text}");
    found[0].to_owned()
}

/// A log of one motor whose speed column is named `name` and has `speed` in every row, where the motor turns at 400 rad/s.
fn log_with_speed(name: &str, speed: &str) -> String {
    (HEADER.replace("omega_e", name) + &motor("m", 1.0)).replace(",400\n", &format!(",{speed}\n"))
}

/// 400 rad/s of a motor with four pole pairs: 400 / 4 * 60 / (2 pi) mechanical r/min.
const RPM: &str = "954.9296585513721";

#[test]
fn files_in_different_units_are_read_each_in_its_own_and_an_unclear_unit_is_a_row() {
    let directory = tempfile::tempdir().unwrap();
    let output = directory.path().join("results.csv");
    let files = [
        ("electrical.csv", log_with_speed("omega_e", "400")),
        ("rpm.csv", log_with_speed("n [rpm]", RPM)),
        ("unclear.csv", log_with_speed("speed", RPM)),
        ("last.csv", log_with_speed("omega_e [rad/s]", "400")),
    ];
    let paths = files.each_ref().map(|(name, _)| directory.path().join(name).to_str().unwrap().to_owned());
    for (path, (_, text)) in paths.iter().zip(&files) {
        fs::write(path, text).unwrap();
    }
    let names = paths.each_ref().map(String::as_str);
    let run = |more: &[&str]| fluxfit(&[&["fleet", "-o", output.to_str().unwrap()], more, &names].concat());
    assert_eq!(run(&["--pole-pairs", "4"]).status, 1);
    // The motor is the same in all files: psi_f is 0.1827 Wb, whatever its file's unit. Read as rad/s it would be 0.0765.
    let psi_f = |name: &str| row_of(&output, name).split(',').nth(place(&output, "psi_f")).unwrap().parse::<f64>().unwrap();
    for name in [names[0], names[1], names[3]] {
        assert!((psi_f(name) / 0.1827 - 1.0).abs() < 1e-3, "{name}: {}", psi_f(name));
    }
    assert!(row_of(&output, names[2]).contains("nothing states the unit of this speed"), "{}", row_of(&output, names[2]));
    // Without the pole pairs the unit of the shaft cannot be converted: that file's row says so, and the others stay.
    assert_eq!(run(&[]).status, 1);
    assert!(row_of(&output, names[1]).contains("takes the number of pole pairs"), "{}", row_of(&output, names[1]));
    assert!((psi_f(names[0]) / 0.1827 - 1.0).abs() < 1e-3);
}

#[test]
fn a_file_given_twice_is_one_row_that_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let (one, other) = (directory.path().join("one.csv"), directory.path().join("other.csv"));
    for path in [&one, &other] {
        fs::write(path, log_with_speed("omega_e", "400")).unwrap();
    }
    let output = directory.path().join("results.csv");
    let [one, other] = [&one, &other].map(|path| path.to_str().unwrap());
    assert_eq!(fluxfit(&["fleet", one, other, one, "-o", output.to_str().unwrap()]).status, 1);
    assert!(row_of(&output, one).contains("is given twice"), "{}", row_of(&output, one));
    assert!(row_of(&output, other).contains(",identified,"), "{}", row_of(&output, other));
}

#[test]
fn a_table_without_rows_is_a_row_with_its_reason() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (empty, filled, output) = (at("empty.csv"), at("filled.csv"), at("results.csv"));
    fs::write(&empty, HEADER).unwrap();
    fs::write(&filled, table(2)).unwrap();
    let run = |by: &[&str]| fluxfit(&[&["fleet", &empty, &filled, "-o", &output], by].concat());
    for by in [&["--by", "motor_id"][..], &[]] {
        assert_eq!(run(by).status, 1);
        assert!(row_of(Path::new(&output), &empty).contains("there is no row below the header"), "{by:?}");
    }
    run(&["--by", "motor_id"]);
    assert!(["m000", "m001"].iter().all(|motor| row_of(Path::new(&output), motor).contains(",identified,")));
}

#[test]
fn each_log_is_a_motor_without_a_column() {
    let directory = tempfile::tempdir().unwrap();
    let output = directory.path().join("results.parquet");
    let logs = ["examples/logs/id_zero_two_loads.csv", "missing.csv"];
    let run = fluxfit(&[&["fleet", "--model", "steady", "-o", output.to_str().unwrap()], &logs[..]].concat());
    assert_eq!((run.status, run.out.starts_with("2 motors, 2 rows: 0 with all 4")), (1, true), "{}{}", run.out, run.err);
    assert!(fs::read(&output).unwrap().starts_with(b"PAR1"));
}

#[test]
fn windows_show_what_changes() {
    let directory = tempfile::tempdir().unwrap();
    let (log, output) = (directory.path().join("fleet.csv"), directory.path().join("results.csv"));
    // The same motor in two hours, the second time with a warmer winding.
    let later: String = motor("m", 1.2)
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.splitn(3, ',').collect();
            format!("m,{},{}\n", 3600.0 + cells[1].parse::<f64>().unwrap(), cells[2])
        })
        .collect();
    fs::write(&log, HEADER.to_owned() + &motor("m", 1.0) + &later).unwrap();
    assert_eq!(fleet(&log, &output, &["--every", "1h"]).status, 0);
    let (rs, start) = (place(&output, "rs"), place(&output, "window_start"));
    let found: Vec<(f64, f64)> = rows(&output).iter().map(|row| (row[start].parse().unwrap(), row[rs].parse().unwrap())).collect();
    assert_eq!(found.iter().map(|(start, _)| *start).collect::<Vec<_>>(), [0.0, 3600.0]);
    assert!((found[0].1 - 1.0).abs() < 0.01 && (found[1].1 - 1.2).abs() < 0.01, "{found:?}");
}

#[test]
fn the_page_is_that_of_the_results_whether_they_are_new_or_finished() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let (log, csv, page) = (at("fleet.csv"), at("results.csv"), at("fleet.html"));
    let one_point: String = motor("point", 1.0).lines().take(100).map(|line| format!("{line}\n")).collect();
    fs::write(&log, table(12) + &motor("standing", 1.0).replace(",400\n", ",0\n") + &one_point).unwrap();
    let run = fleet(&log, &csv, &["--report", page.to_str().unwrap(), "--figures", at("figures").to_str().unwrap()]);
    assert_eq!(run.status, 1, "{}", run.err);
    let first = shown(&page);
    assert!(first.contains("14 motors: 12 with all 4 parameters identified, 1 with fewer, 1 without an answer."), "{first}");
    assert!(first.contains("is zero in every row") && at("figures/distributions.png").exists());
    // The same page from finished results of either format.
    let parquet = at("results.parquet");
    fleet(&log, &parquet, &[]);
    for results in [&csv, &parquet] {
        let again = at("again.html");
        let run = fluxfit(&["fleet", results.to_str().unwrap(), "--report", again.to_str().unwrap()]);
        assert_eq!((run.status, run.out.contains("14 motors, 14 rows")), (1, true), "{}{}", run.out, run.err);
        assert!(shown(&again) == first, "{}", results.display());
    }
    // A run that is started again for its page goes on where it was: the page is no reason to begin anew.
    let journal = |words: &[&str]| {
        let output = at("other.csv");
        let mut child = Command::new(env!("CARGO_BIN_EXE_fluxfit"));
        child.args(["-q", "fleet", log.to_str().unwrap(), "--by", "motor_id", "-o", output.to_str().unwrap()]).args(words);
        child.output().unwrap()
    };
    fs::write(at("other.csv.journal"), "").unwrap();
    assert_eq!(journal(&["--report", at("other.html").to_str().unwrap()]).status.code(), Some(1));
    assert!(shown(&at("other.html")) == first);
}

#[test]
fn a_table_that_is_no_result_is_refused_as_one() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (log, results, page) = (at("fleet.csv"), at("results.csv"), at("fleet.html"));
    fs::write(&log, table(1)).unwrap();
    fleet(Path::new(&log), Path::new(&results), &[]);
    let text = fs::read_to_string(&results).unwrap();
    fs::write(at("word.csv"), text.replacen(",identified,", ",splendid,", 1)).unwrap();
    fs::write(at("short.csv"), text.trim_end().rsplit_once(',').unwrap().0).unwrap();
    fs::write(at("damaged.parquet"), "PAR1 and then nothing").unwrap();
    for (words, sentence) in [
        (&[log.as_str()][..], "these are no results of a fleet: there is no column motor; to identify motors, name the results with -o"),
        (&[&at("word.csv")], "\"splendid\" is not one of the values"),
        (&[&at("short.csv")], "the row has"),
        (&[&at("damaged.parquet")], "damaged.parquet: this is not Parquet"),
        (&[&results, "--every", "1h"], "name their results with -o"),
        (&[&results, "--report", "fleet.pdf"], "writes an HTML page"),
    ] {
        let report = if words.contains(&"--report") { vec![] } else { vec!["--report", &page] };
        let run = fluxfit(&[&["fleet"], words, &report].concat());
        assert!(run.status == 2 && run.err.contains(sentence), "{sentence}: {}", run.err);
        assert!(!Path::new(&page).exists());
    }
    let run = fluxfit(&["fleet", &log]);
    assert!(run.status == 2 && run.err.contains("--output"), "{}", run.err);
}

#[test]
fn misuse_is_refused_before_the_work() {
    let directory = tempfile::tempdir().unwrap();
    let (log, output) = (directory.path().join("fleet.csv"), directory.path().join("results.csv"));
    fs::write(&log, table(1)).unwrap();
    for (more, sentence) in [
        (&["--json"][..], "--json is for one motor"),
        (&["--every", "0s"], "longer than zero"),
        (&["--export", "vesc=x.xml"], "--export is for one motor"),
        (&["--fix", "rs=1", "--prior", "rs=1±1%"], "give one of them"),
    ] {
        let run = fleet(&log, &output, more);
        let refused = run.status == 2 && run.err.contains(sentence);
        // What contradicts itself is the reason of every row.
        assert!(refused || fs::read_to_string(&output).is_ok_and(|text| text.contains(sentence)), "{}", run.err);
    }
    let run = fluxfit(&["fleet", log.to_str().unwrap(), "-o", "results.xlsx"]);
    assert!(run.status == 2 && run.err.contains("name them .csv or .parquet"), "{}", run.err);
}

/// What a page says of its fleet: how it was made differs, and so does the heading.
fn shown(page: &Path) -> String {
    let text = fs::read_to_string(page).unwrap();
    let (_, body) = text.split_once("<p class=\"found\">").unwrap();
    body.split_once("id=\"reproduce\"").unwrap().0.to_owned()
}

#[test]
fn finished_results_that_are_longer_than_a_block_have_the_page_of_their_rows() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let (log, few, many) = (at("fleet.csv"), at("few.csv"), at("many.csv"));
    fs::write(&log, table(2)).unwrap();
    fleet(&log, &few, &[]);
    let text = fs::read_to_string(&few).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    // 10 000 motors, some 5 MB; the names have the comma, the quote and the end of a line that cells are quoted for.
    let name = |motor: usize| format!("\"m{motor:05}, \"\"a\"\"\nb\"");
    let first = rows.lines().next().unwrap().strip_prefix("m000").unwrap();
    let content = (0..10_000).fold(header.to_owned() + "\n", |text, motor| text + &name(motor) + first + "\n");
    assert!(content.len() > 3 << 20);
    fs::write(&many, &content).unwrap();
    let page = at("fleet.html");
    let run = |results: &Path| fluxfit(&["fleet", results.to_str().unwrap(), "--report", page.to_str().unwrap()]);
    let found = run(&many);
    assert_eq!(
        (found.status, found.out.as_str()),
        (0, "10000 motors, 10000 rows: 10000 with all 4 parameters identified, 0 with fewer, 0 without an answer.\n"),
        "{}",
        found.err
    );
    assert!(shown(&page).contains("10000 motors, each with all 4 parameters identified."));
    // An error far below says its line: each motor takes two, and the header one.
    let at_motor = |motor: usize, from: &str, to: &str| {
        let (above, below) = content.split_at(content.find(&name(motor)).unwrap());
        above.to_owned() + &below.replacen(from, to, 1)
    };
    for (wrong, sentence) in [
        (at_motor(9000, ",identified,", ",splendid,"), "line 18002, column 'rs_verdict': \"splendid\" is not one of the values"),
        (at_motor(9000, ",identified,", ",identified,,"), "line 18002: the row has"),
        (at_motor(9000, ",identified,", "\0"), "line 18003: this is not"),
    ] {
        fs::write(at("wrong.csv"), wrong).unwrap();
        let found = run(&at("wrong.csv"));
        assert!(found.status == 2 && found.err.contains(sentence), "{sentence}: {}", found.err);
    }
}

#[cfg(unix)]
#[test]
fn killed_at_any_instant_and_started_again_every_motor_is_there_once() {
    let directory = tempfile::tempdir().unwrap();
    let (log, output) = (directory.path().join("fleet.csv"), directory.path().join("results.csv"));
    let motors = 120;
    fs::write(&log, table(motors)).unwrap();
    let expected = directory.path().join("expected.csv");
    assert_eq!(fleet(&log, &expected, &[]).status, 0);
    let mut killed = 0;
    for round in 0..10 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_fluxfit"))
            .args(["-q", "fleet", log.to_str().unwrap(), "--by", "motor_id", "-o", output.to_str().unwrap()])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(7 + 13 * round));
        // Results are there as a whole or not at all.
        killed += usize::from(child.try_wait().unwrap().is_none());
        let _ = child.kill();
        let _ = child.wait();
        if output.exists() {
            assert_eq!(fs::read(&output).unwrap(), fs::read(&expected).unwrap());
        }
    }
    assert!(killed > 0);
    // A file that is younger than a tenth of a second may be one that another run is about to lock, so it is not removed.
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(fleet(&log, &output, &[]).status, 0);
    assert_eq!(fs::read(&output).unwrap(), fs::read(&expected).unwrap());
    assert_eq!(rows(&output).len(), motors);
    let left: Vec<_> = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 3, "{left:?}");
}

#[test]
fn a_motor_of_many_rows_among_others_is_that_of_a_file_of_its_own() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    // More than half a million rows, of which the reader selects some: a third operating point comes at the end alone.
    let count = 560_000;
    let (rs, ld, lq, psi_f, omega) = (0.7, 5.25e-3, 12e-3, 0.1827, 400.0);
    let noise = |row: usize| ((row * 7919 + row * row * 31) % 201) as f64 * 1e-4 - 0.01;
    let log = (0..count).fold(String::new(), |mut text, row| {
        let (d, q) = [(0.0, 9.0), (-2.0, 8.5), (0.0, 4.0)][if row > count - 6000 { 2 } else { row / 3000 % 2 }];
        let (ud, uq) = (rs * d - omega * lq * q, rs * q + omega * (ld * d + psi_f));
        let _ = writeln!(text, "{},{ud},{uq},{},{},{omega}", row as f64 * 1e-4, d + noise(row), q + noise(row + 77));
        text
    });
    fs::write(at("huge"), HEADER.replace("motor_id,", "") + &log).unwrap();
    let named = log.lines().fold(String::new(), |text, line| text + "huge," + line + "\n");
    fs::write(at("fleet.csv"), HEADER.to_owned() + &motor("a", 1.0) + &named + &motor("z", 2.0)).unwrap();
    let (among, alone) = (at("among.csv"), at("alone.csv"));
    assert_eq!(fleet(&at("fleet.csv"), &among, &[]).status, 0);
    assert_eq!(fluxfit(&["fleet", at("huge").to_str().unwrap(), "-o", alone.to_str().unwrap()]).status, 0);
    let source = place(&among, "source");
    let values = |row: &[String]| (row[1..source].to_vec(), row[source + 1..].to_vec());
    let (found, expected) = (rows(&among), rows(&alone));
    assert_eq!(found.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["a", "huge", "z"]);
    assert_eq!(values(&found[1]), values(&expected[0]));
    let selected: usize = found[1][place(&among, "rows")].parse().unwrap();
    let resistance: f64 = found[1][place(&among, "rs")].parse().unwrap();
    assert!((400_000..count).contains(&selected) && (resistance / rs - 1.0).abs() < 0.01, "{selected} {resistance}");
}

/// A run of these words, which says nothing.
#[cfg(unix)]
fn child(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fluxfit"));
    command.arg("-q").args(words).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Lines of a journal that are whole, without the first one, which says what the run does.
#[cfg(unix)]
fn finished(journal: &Path) -> usize {
    let bytes = fs::read(journal).unwrap_or_default();
    bytes.iter().filter(|byte| **byte == b'\n').count().saturating_sub(1)
}

#[cfg(unix)]
#[test]
fn a_run_that_was_killed_in_the_middle_has_the_page_of_one_that_was_not() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let log = at("fleet.csv");
    let motors = 150;
    // Some fail and one has one operating point, so that the page has reasons.
    let standing = motor("standing", 1.0).replace(",400\n", ",0\n");
    let one_point: String = motor("point", 1.0).lines().take(100).map(|line| format!("{line}\n")).collect();
    fs::write(&log, table(motors - 2) + &standing + &one_point).unwrap();
    let words = |output: &Path, page: &Path| {
        let [log, output, page] = [&log, output, page].map(|path| path.to_str().unwrap().to_owned());
        ["fleet", &log, "--by", "motor_id", "-o", &output, "--jobs", "1", "--report", &page].map(str::to_owned)
    };
    let run = |words: &[String]| child(&words.iter().map(String::as_str).collect::<Vec<_>>());
    let (whole, expected) = (at("whole.csv"), at("whole.html"));
    assert_eq!(run(&words(&whole, &expected)).status().unwrap().code(), Some(1));
    let (output, page) = (at("killed.csv"), at("killed.html"));
    let journal = at("killed.csv.journal");
    // Twice: after a third of the motors and after two thirds. The journal says when, and the last run that it goes on from there.
    let mut before = 0;
    for part in [motors / 3, 2 * motors / 3] {
        let mut running = run(&words(&output, &page)).spawn().unwrap();
        while finished(&journal) < part {
            assert!(running.try_wait().unwrap().is_none(), "the run ended at {} motors", finished(&journal));
            std::thread::sleep(Duration::from_millis(1));
        }
        running.kill().unwrap();
        assert_eq!(std::os::unix::process::ExitStatusExt::signal(&running.wait().unwrap()), Some(9));
        let now = finished(&journal);
        assert!(before < now && now < motors && !output.exists() && !page.exists(), "{now} motors");
        before = now;
    }
    let last = fluxfit(&words(&output, &page).each_ref().map(String::as_str));
    assert!(last.status == 1 && last.err.contains(&format!("{before} motors are finished already")), "{before}: {}", last.err);
    let names: Vec<String> = rows(&output).iter().map(|row| row[0].clone()).collect();
    let mut once = names.clone();
    once.dedup();
    assert_eq!((names.len(), once.len()), (motors, motors));
    assert_eq!(fs::read(&output).unwrap(), fs::read(&whole).unwrap());
    assert!(shown(&page).contains("150 motors: 148 with all 4 parameters identified, 1 with fewer, 1 without an answer."));
    assert!(shown(&page) == shown(&expected) && !journal.exists());
}
