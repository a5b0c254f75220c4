//! On a terminal: the plots of `fluxfit track` that are redrawn in place, and long answers and messages. `script` makes the terminal,
//! `vt100` reads what it shows.

use super::root;
use std::{
    io::{Read, Write},
    num::NonZeroU16,
    process::{Child, Command, Stdio},
};

const NOISY: &str = "examples/logs/paper_rig_pwm_noise.csv";

/// Runs a command line of `fluxfit` on a terminal of this size.
fn on_terminal(size: [u16; 2], command: &str) -> Child {
    let [columns, lines] = size;
    let shell = format!("stty columns {columns} rows {lines}; exec {} {command}", env!("CARGO_BIN_EXE_fluxfit"));
    Command::new("script")
        .args(["--quiet", "--return", "--flush", "--command", &shell, "/dev/null"])
        .current_dir(root())
        .env("TERM", "xterm-256color")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

/// What stands on the terminal at the end, with what was scrolled away, and whether the cursor can be seen.
fn shown(columns: u16, bytes: &[u8]) -> (String, bool) {
    let [lines, columns] = [300, columns].map(|size| NonZeroU16::new(size).unwrap());
    let mut terminal = vt100::Parser::new(lines, columns, 0);
    terminal.process(bytes);
    (terminal.screen().contents(), !terminal.screen().hide_cursor())
}

fn whole(mut child: Child) -> (i32, Vec<u8>) {
    let mut bytes = Vec::new();
    child.stdout.take().unwrap().read_to_end(&mut bytes).unwrap();
    (child.wait().unwrap().code().unwrap(), bytes)
}

fn dots(line: &str) -> usize {
    line.chars().filter(|letter| ('\u{2801}'..='\u{28ff}').contains(letter)).count()
}

#[test]
fn four_courses_are_redrawn_in_place_above_the_table() {
    let (status, bytes) = whole(on_terminal([80, 24], &format!("track {NOISY} --every 10ms")));
    let (screen, has_cursor) = shown(80, &bytes);
    assert!(status == 0 && has_cursor, "{screen}");
    let lines: Vec<&str> = screen.lines().collect();
    for (symbol, truth) in [("R_s", 0.958), ("L_d", 5.25), ("L_q", 12.0), ("psi_f", 0.1827)] {
        // Once in the plot, once in the table.
        let places: Vec<usize> = (0..lines.len()).filter(|line| lines[*line].trim_start().starts_with(symbol)).collect();
        assert_eq!(places.len(), 2, "{symbol}:\n{screen}");
        let plot = &lines[places[0]..places[0] + 3];
        assert!(plot.iter().map(|line| dots(line)).sum::<usize>() > 20, "{symbol}:\n{screen}");
        let end = |line: &str| line.split('│').next().unwrap().split_whitespace().last().unwrap().parse::<f64>().unwrap();
        let (high, low) = (end(plot[0]), end(plot[2]));
        assert!(low < truth && truth < high && high - low < 0.1 * truth, "{symbol} {low} {high}:\n{screen}");
    }
    assert!(screen.contains("0.9 s") || screen.contains("0.8999 s"), "{screen}");
}

#[test]
fn a_small_terminal_gets_a_line_and_a_quiet_command_nothing() {
    let (_, bytes) = whole(on_terminal([50, 24], &format!("track {NOISY}")));
    let (screen, _) = shown(50, &bytes);
    assert!(dots(&screen) == 0 && screen.contains("s  R_s 0.9"), "{screen}");
    let (_, bytes) = whole(on_terminal([80, 24], &format!("track {NOISY} --quiet")));
    assert!(!String::from_utf8(bytes).unwrap().contains("\x1b[K"));
}

#[test]
fn ctrl_c_leaves_the_last_plots_and_the_table() {
    let mut child = on_terminal([80, 24], &format!("track {NOISY} --follow"));
    let (mut seen, mut piece) = (Vec::new(), [0; 4096]);
    // The drawing begins.
    while !String::from_utf8_lossy(&seen).contains("psi_f") {
        let count = child.stdout.as_mut().unwrap().read(&mut piece).unwrap();
        assert!(count > 0, "{}", String::from_utf8_lossy(&seen));
        seen.extend(&piece[..count]);
    }
    child.stdin.as_mut().unwrap().write_all(b"\x03").unwrap();
    let (status, rest) = whole(child);
    let (screen, has_cursor) = shown(80, &[seen, rest].concat());
    assert!(status == 130 && has_cursor && screen.contains("interrupted:"), "{status}\n{screen}");
    assert_eq!(screen.matches("psi_f").count(), 2, "{screen}");
    assert!(screen.find("interrupted:") < screen.find("psi_f") && screen.contains("rows to t ="), "{screen}");
}

/// What stands at the top of an answer that is longer than the screen is said again below it; of a shorter one not.
#[test]
fn a_long_answer_ends_with_its_first_sentence_and_its_values() {
    let command = "identify examples/logs/id_zero_two_loads.csv --model steady";
    for (lines, times) in [(12, 2), (60, 1)] {
        let (_, bytes) = whole(on_terminal([80, lines], command));
        let (screen, _) = shown(80, &bytes);
        assert_eq!(screen.matches("3 of 4 identified.").count(), times, "{lines}:\n{screen}");
        let lines_of_end: Vec<&str> = screen.trim_end().lines().rev().take_while(|line| !line.trim().is_empty()).collect();
        let end = lines_of_end.last().unwrap();
        assert_eq!(end.starts_with("3 of 4 identified."), times == 2, "{lines}:\n{screen}");
        // With the values below it.
        assert_eq!(lines_of_end[0].starts_with("R_s 0.9"), times == 2, "{lines}:\n{screen}");
    }
}

/// `stty columns 0`: a terminal that does not know its width has that of the narrowest in use.
#[test]
fn messages_are_wrapped_on_a_terminal_that_does_not_know_its_width() {
    let (_, bytes) = whole(on_terminal([0, 0], "inspect examples/logs/no_such_log_of_any_drive_at_all.csv"));
    let (screen, _) = shown(200, &bytes);
    assert!(screen.contains("error: ") && screen.lines().all(|line| line.trim_end().chars().count() <= 80), "{screen}");
}
