//! `--report FILE.html` and `--figures DIR`: a whole page and its figures beside the answer, or none and a sentence.

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
    for expected in ["All 4 identified", "0.961", "Warning: no-redundancy", "'"] {
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

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn figures_are_files_in_a_directory_that_is_made() {
    let (directory, _) = directory();
    let path = directory.path().join("new/figures");
    let run = fluxfit(&["identify", LOG, "--model", "steady", "--figures", &path.display().to_string()]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(run.err.contains(&format!("figures: {}", path.display())), "{}", run.err);
    assert_eq!(run.out, fluxfit(&["identify", LOG, "--model", "steady"]).out);
    // Two points have as many equations as unknowns: no residuals to draw.
    let expected = ["intervals", "joint-region", "log", "operating-points"];
    assert_eq!(names(&path), expected.iter().flat_map(|name| [format!("{name}.png"), format!("{name}.svg")]).collect::<Vec<_>>());
    for name in expected {
        assert!(fs::read(path.join(format!("{name}.png"))).unwrap().starts_with(b"\x89PNG\r\n"));
        assert!(fs::read_to_string(path.join(format!("{name}.svg"))).unwrap().starts_with("<svg xmlns="));
    }
    let run = fluxfit(&["compare", LOG, "--runs", "2", "--iterations", "5", "--figures", &path.display().to_string()]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(names(&path).contains(&"convergence.svg".to_owned()) && names(&path).len() == 12, "{:?}", names(&path));
    let other = directory.path().join("other");
    let run = fluxfit(&["validate", LOG, "--motor", TRUTH, "--model", "steady", "--figures", &other.display().to_string()]);
    assert!(run.status < 2, "{}", run.err);
    assert_eq!(names(&other), ["prediction.png", "prediction.svg"]);
}

#[test]
fn figures_need_a_directory() {
    let (directory, path) = directory();
    fs::write(&path, "mine").unwrap();
    for (given, problem) in [(path.as_str(), "this is a file"), ("-", "standard output is for the answer")] {
        let run = fluxfit(&["identify", LOG, "--figures", given]);
        assert_eq!((run.status, run.out.as_str()), (2, ""));
        assert_eq!(run.err, format!("error: --figures {given}: {problem}; name a directory\n"));
    }
    assert_eq!((fs::read_to_string(&path).unwrap().as_str(), files(&directory)), ("mine", 1));
}

#[test]
fn what_was_held_out_is_on_the_page() {
    let (_directory, path) = directory();
    let run = fluxfit(&["identify", LOG, LOG, "--model", "steady", "--hold-out", "--report", &path]);
    assert!(run.status < 2, "{}", run.err);
    let page = fs::read_to_string(&path).unwrap();
    assert!(page.contains("Held-out data") && page.contains("were not used for the answer above"));
}
