//! `--report FILE.html`: a whole page beside the answer, or no page and a sentence.

use super::{fluxfit, root};
use std::{fs, path::Path};
use tempfile::TempDir;

const LOG: &str = "examples/logs/paper_rig_pwm_noise.csv";
const TRUTH: &str = "examples/logs/paper_rig_pwm_noise.truth.json";

fn directory() -> (TempDir, String) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("my report.html").display().to_string();
    (directory, path)
}

fn files(directory: &TempDir) -> usize {
    fs::read_dir(directory.path()).unwrap().count()
}

#[test]
fn identify_writes_a_page_beside_the_same_answer() {
    let (directory, path) = directory();
    let run = fluxfit(&["identify", LOG, "--model", "steady", "--report", &path]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(run.err.contains(&format!("report: {path}")), "{}", run.err);
    assert_eq!(run.out, fluxfit(&["identify", LOG, "--model", "steady"]).out);
    let page = fs::read_to_string(&path).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
    for expected in ["Four of four parameters identified", "0.9610", "Warning: no-redundancy", "'"] {
        assert!(page.contains(expected), "{expected} is not in the page");
    }
    assert_eq!(files(&directory), 1);
}

#[test]
fn compare_writes_a_page_and_json_stays_one_document() {
    let (directory, path) = directory();
    let run = fluxfit(&["compare", LOG, "--truth", TRUTH, "--runs", "3", "--iterations", "20", "--json", "--report", &path]);
    assert_eq!(run.status, 0, "{}", run.err);
    let document: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(document["schema"], "fluxfit.study/1");
    let page = fs::read_to_string(&path).unwrap();
    for expected in ["Fig. 4 of the paper", "Fig. 5 of the paper", "0.9639", "--truth"] {
        assert!(page.contains(expected), "{expected} is not in the page");
    }
    assert_eq!(files(&directory), 1);
}

#[test]
fn the_command_on_the_page_makes_the_same_page() {
    let (_directory, path) = directory();
    fluxfit(&["identify", LOG, "--prior", "rs=0.96±1%", "--seed", "5", "--report", &path]);
    let page = fs::read_to_string(&path).unwrap();
    let (_, command) = page.split_once("<pre><code>").unwrap();
    let (command, _) = command.split_once("</code>").unwrap();
    let command = command.replace("<span>", "").replace("</span>", "");
    assert_eq!(command, format!("fluxfit identify {LOG} --prior rs=0.96±1% --seed 5 --report '{path}'"));
    fs::remove_file(&path).unwrap();
    let shell = command.replacen("fluxfit", env!("CARGO_BIN_EXE_fluxfit"), 1);
    assert!(std::process::Command::new("sh").args(["-c", &shell]).current_dir(root()).output().unwrap().status.success());
    assert_eq!(fs::read_to_string(&path).unwrap(), page);
}

#[test]
fn a_page_that_cannot_be_written_costs_the_status_and_not_the_answer() {
    let (directory, path) = directory();
    let missing = Path::new(&path).with_file_name("no").join("r.html").display().to_string();
    let run = fluxfit(&["identify", LOG, "--model", "steady", "--report", &missing]);
    assert_eq!(run.status, 2);
    assert_eq!(run.out, fluxfit(&["identify", LOG, "--model", "steady"]).out);
    let sentence = run.err.lines().last().unwrap();
    assert!(sentence.starts_with(&format!("error: {missing}: ")) && sentence.contains("does not exist; create it"), "{}", run.err);
    assert_eq!(files(&directory), 0);
    let run = fluxfit(&["compare", LOG, "--runs", "1", "--iterations", "1", "--report", &directory.path().display().to_string()]);
    assert!(run.status == 2 && run.out.contains("Table 2") && run.err.contains("this is a directory"), "{}", run.err);
}

#[test]
fn a_page_never_takes_the_place_of_the_answer_or_of_what_is_read() {
    let run = fluxfit(&["identify", LOG, "--report", "-"]);
    assert_eq!((run.status, run.out.as_str()), (2, ""));
    assert_eq!(run.err, "error: --report needs the name of a file: standard output is for the answer\n");
    let before = fs::read(root().join(LOG)).unwrap();
    for arguments in [&["identify", LOG, "--report", LOG][..], &["compare", LOG, "--truth", TRUTH, "--report", TRUTH]] {
        let run = fluxfit(arguments);
        assert!(run.status == 2 && run.out.is_empty() && run.err.contains("this file is read; name another one"), "{}", run.err);
    }
    assert_eq!(fs::read(root().join(LOG)).unwrap(), before);
}
