//! The edges: names that steer a terminal or a shell, files in place of a verb, large and strange files.

use super::{fluxfit, fluxfit_with_input};
use std::{fs, process::Command};

fn said(arguments: &[&str]) -> (i32, String) {
    let run = fluxfit(arguments);
    (run.status, run.err)
}

#[test]
fn a_log_in_place_of_a_verb_gets_the_verb() {
    let (status, err) = said(&["examples/logs/paper_rig_pwm_noise.csv"]);
    assert_eq!(status, 2);
    assert!(err.contains("fluxfit identify examples/logs/paper_rig_pwm_noise.csv"), "{err}");
    let (_, err) = said(&["my log.csv"]);
    assert!(err.contains("fluxfit identify 'my log.csv'"), "{err}");
}

#[test]
fn a_report_is_a_page_and_nothing_else() {
    let (status, err) = said(&["identify", "examples/logs/paper_rig_pwm_noise.csv", "--report", "x.pdf"]);
    assert!(status == 2 && err.contains("HTML page, not pdf"), "{err}");
}

#[test]
fn names_of_columns_neither_steer_the_terminal_nor_the_shell() {
    let rows = "0,1,2,3,4,5\n".repeat(3);
    for (name, shown) in [
        ("speed $(reboot)", "--map 'omega_e=speed $(reboot)'"),
        ("speed `reboot`", "--map 'omega_e=speed `reboot`'"),
        ("load speed\\", "--map 'omega_e=load speed\\'"),
        ("load speed\u{202e}", "speed\\u{202e}"),
        ("load speed\u{1b}[2J", "speed\\u{1b}[2J"),
    ] {
        let run = fluxfit_with_input(&["identify", "-"], format!("t,ud,uq,id,iq,{name}\n{rows}").as_bytes());
        assert_eq!(run.status, 2);
        let first = run.err.lines().next().unwrap_or_default();
        assert!(first.contains(shown), "{first}");
        assert!(!run.err.contains(['\u{202e}', '\u{1b}', '\u{7}']), "{}", run.err);
    }
}

#[test]
fn a_log_of_ten_rows_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ten.csv");
    let log = fs::read_to_string(super::root().join("examples/logs/paper_rig_pwm_noise.csv")).unwrap();
    fs::write(&path, log.lines().take(11).map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    let (status, err) = said(&["identify", path.to_str().unwrap()]);
    assert!(status == 2 && err.contains("ten.csv: the log has 10 rows"), "{err}");
}

#[test]
fn a_million_columns_and_one_endless_line_are_refused() {
    let names: Vec<String> = (0..1_000_000).map(|k| format!("c{k}")).collect();
    let run = fluxfit_with_input(&["inspect", "-"], format!("{}\n1\n", names.join(",")).as_bytes());
    assert!(run.status == 2 && run.err.contains("more than 20000 columns"), "{}", run.err);
    let run = fluxfit_with_input(&["inspect", "-"], &vec![b'a'; 40_000_000]);
    assert!(run.status == 2 && run.err.contains("single column"), "{}", run.err);
    let run = fluxfit_with_input(&["inspect", "-"], &[b"{\"t\": 1, \"x\": \"".to_vec(), vec![b'a'; 40_000_000]].concat());
    assert!(run.status == 2 && run.err.contains("more than 16 MiB"), "{}", run.err);
}

#[cfg(unix)]
#[test]
fn outputs_through_links_keep_the_links_and_leftovers_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    let (link, left) = (folder.path().join("map.toml"), folder.path().join(".fluxfit-killed.tmp"));
    std::os::unix::fs::symlink("real.toml", &link).unwrap();
    fs::write(&left, "half").unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    let run = fluxfit(&["inspect", "examples/logs/paper_rig_pwm_noise.csv", "-o", link.to_str().unwrap()]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink() && folder.path().join("real.toml").is_file());
    assert!(!left.exists());
}

/// As `fluxfit identify LOG --report page.html | head -1`, whose `head` is gone before the answer comes.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_exit_status_2_and_the_report_is_written_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let mut child = Command::new(env!("CARGO_BIN_EXE_fluxfit"))
        .args(["identify", "examples/logs/paper_rig_pwm_noise.csv", "--model", "steady", "--report"])
        .arg(&page)
        .current_dir(super::root())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
    assert!(fs::read_to_string(page).is_ok_and(|page| page.contains("</html>")));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_exit_status_2() {
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_fluxfit")).arg("formats").stdout(full()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    // What goes into other files is not lost with it.
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let identify = ["identify", "examples/logs/paper_rig_pwm_noise.csv", "--model", "steady", "--report"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_fluxfit"));
    let output = command.args(identify).arg(&page).current_dir(super::root()).stdout(full()).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), told.matches("could not be written").count()), (Some(2), 1), "{told}");
    assert!(fs::read_to_string(page).is_ok_and(|page| page.contains("</html>")));
}
