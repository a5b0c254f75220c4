//! What a command owes a person beside its answer: help that fits, errors that show the line, words that can be switched off or on,
//! completions and a manual.

use super::{fluxfit, fluxfit_with_input, json};

const LOG: &str = "examples/logs/paper_rig_pwm_noise.csv";
const VERBS: [&str; 9] = ["identify", "track", "fleet", "validate", "compare", "simulate", "demo", "completions", "man"];

#[test]
fn the_first_help_fits_a_screen_and_names_every_verb() {
    let run = fluxfit(&["--help"]);
    assert_eq!(run.status, 0);
    let lines: Vec<&str> = run.out.trim_end().lines().collect();
    assert!(lines.len() <= 24, "{} lines\n{}", lines.len(), run.out);
    for line in &lines {
        assert!(line.chars().count() <= 80, "{line}");
    }
    for verb in VERBS {
        let line = lines.iter().find(|line| line.trim_start().starts_with(verb));
        assert!(line.is_some_and(|line| line.split_whitespace().count() > 2), "{verb}: {}", run.out);
    }
}

#[test]
fn what_is_mistyped_is_answered_with_what_is_alike() {
    for (arguments, alike) in [(&["identfy", LOG][..], "'identify'"), (&["identify", LOG, "--windw", "0:1"], "'--window'")] {
        let run = fluxfit(arguments);
        assert!(run.status == 2 && run.err.contains(alike), "{}", run.err);
    }
}

/// The sentence, then the line, then the marks.
fn excerpt(file: &str, text: &str) -> Vec<String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join(file);
    std::fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let run = match file.rsplit_once('.').unwrap().1 {
        "csv" => fluxfit(&["identify", path, "--quiet"]),
        _ => fluxfit(&["identify", LOG, "--motor", path]),
    };
    assert_eq!(run.status, 2, "{}", run.err);
    run.err.lines().map(str::to_owned).collect()
}

#[test]
fn errors_show_the_line_and_mark_the_cell() {
    let log = "# drive 7\nt;ud;uq;id;iq;omega_e\n0;1;2;3;4;5\n0,1;1;8O;3;4;8O\n";
    assert_eq!(excerpt("a.csv", log)[1..], ["  |", "4 | 0,1;1;8O;3;4;8O", "  |       ^^"]);
    let empty = log.replace("8O;3", ";3").replace("8O", "5");
    assert_eq!(excerpt("a.csv", &empty)[2..], ["4 | 0,1;1;;3;4;5", "  |       ^"]);
    let motor = "[motor]\nrs = \"0.9 Om\"\n";
    assert_eq!(excerpt("a.toml", motor)[2..], ["2 | rs = \"0.9 Om\"", "  |       ^^^^^^"]);
    let mut rows = String::new();
    (0..200).for_each(|k| rows += &format!(",c{k}"));
    let wide = format!("t,ud,uq,id,iq,omega_e{rows}\n0,1,2,3,4,5{}\n1,1,2,3,4,x\u{1b}[2J{}\n", ",0".repeat(200), ",0".repeat(200));
    let lines = excerpt("wide.csv", &wide);
    assert!(lines.iter().skip(1).all(|line| line.chars().count() <= 80 && !line.contains('\u{1b}')), "{lines:?}");
}

#[test]
fn what_came_through_a_pipe_is_not_looked_for_in_a_file() {
    let run = fluxfit_with_input(&["identify", "-"], b"t,ud,uq,id,iq,omega_e\n0,1,2,3,4,5\n1,1,2,x,4,5\n");
    assert!(run.status == 2 && run.err.lines().count() == 1 && run.err.contains("line 3"), "{}", run.err);
}

#[test]
fn quiet_leaves_the_warnings_and_verbose_tells_the_decisions() {
    let (plain, quiet) = (fluxfit(&["identify", LOG, "--unit", "t=s"]), fluxfit(&["-q", "identify", LOG, "--unit", "t=s"]));
    assert_eq!(plain.out, quiet.out);
    assert!(!quiet.err.contains("note:"), "{}", quiet.err);
    let constant = "t,ud,uq,id,iq,speed_rpm\n".to_owned() + &(0..100).map(|k| format!("{k}e-4,-45,80,-2,9,998\n")).collect::<String>();
    let map = ["identify", "-", "--map", "omega=speed_rpm", "--pole-pairs", "4", "--model", "steady"];
    let quiet = fluxfit_with_input(&[&map[..], &["--quiet"]].concat(), constant.as_bytes());
    let plain = fluxfit_with_input(&map, constant.as_bytes());
    assert!(plain.err.contains("note:") && !quiet.err.contains("note:"), "{}\n{}", plain.err, quiet.err);
    let warnings = |text: &str| text.lines().filter(|line| line.starts_with("warning")).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(warnings(&plain.err), warnings(&quiet.err));

    let verbose = fluxfit(&["identify", LOG, "--verbose"]);
    for told in ["9000 rows", "model output error: rows come at 10.0 kHz", "voltages read as", "window 0.25", "dead time: "] {
        assert!(verbose.err.contains(told), "{told} is not in {}", verbose.err);
    }
    let times: Vec<f64> = verbose.err.lines().filter_map(|line| line.trim_start().split_once(" s  ")?.0.parse().ok()).collect();
    assert!(times.len() > 5 && times.is_sorted(), "{}", verbose.err);
    assert_eq!(json(&["identify", LOG, "--verbose"]), json(&["identify", LOG]));
    assert_eq!(fluxfit(&["identify", LOG, "-q", "-v"]).status, 2);
}

/// Of healthy logs and of those that have little to tell; what goes to a pipe is as wide as the narrowest terminal.
#[test]
fn every_line_of_an_answer_fits_80_columns() {
    let zero = "examples/logs/id_zero_two_loads.csv";
    let commands: [&[&str]; 9] = [
        &["identify", LOG],
        &["identify", LOG, "--model", "steady", "--bandwidth", "500Hz", "-v"],
        &["identify", zero, "--model", "steady", "-v"],
        &["identify", zero, "--window", "0.3:0.31", "--motor", "examples/paper_motor.toml"],
        &["identify", LOG, "--prior", "rs=2±1%"],
        &["validate", LOG, "--motor", "examples/paper_motor.toml"],
        &["validate", LOG, "--motor", "examples/paper_motor.toml", "--model", "steady"],
        &["inspect", LOG],
        &["compare", LOG, "--runs", "2", "--iterations", "20"],
    ];
    for command in commands {
        let run = fluxfit(command);
        let wide = run.out.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{command:?}");
        if !command.contains(&"-v") {
            let wide = run.err.lines().filter(|line| line.starts_with("warning")).find(|line| line.chars().count() > 80);
            assert_eq!(wide, None, "{command:?}");
        }
    }
}

#[test]
fn a_code_is_explained_and_a_mistyped_one_is_answered_with_what_is_alike() {
    let run = fluxfit(&["--explain", "no-redundancy"]);
    assert!(run.status == 0 && run.out.starts_with("no-redundancy\n\n") && run.out.contains("What to do:"), "{}", run.out);
    assert!(run.out.lines().all(|line| line.chars().count() <= 80), "{}", run.out);
    let run = fluxfit(&["--explain", "misfits"]);
    assert!(run.status == 2 && run.out.is_empty() && run.err.contains("did you mean misfit?"), "{}", run.err);
    let pages = std::fs::read_to_string(super::root().join("crates/fluxfit-cli/src/explanations/codes.md")).unwrap();
    assert_eq!(std::fs::read_to_string(super::root().join("docs/codes.md")).unwrap(), pages, "docs/codes.md is a copy");
}

#[test]
fn every_shell_gets_completions_of_every_verb() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = fluxfit(&["completions", shell]);
        assert!(run.status == 0 && run.err.is_empty());
        for word in VERBS.into_iter().chain(["--pole-pairs", "--voltage-timing"]) {
            // Fish writes options without their dashes.
            assert!(run.out.contains(word.trim_start_matches('-')), "{shell}: {word}");
        }
    }
}

#[test]
fn every_verb_has_a_page() {
    let directory = tempfile::tempdir().unwrap();
    let run = fluxfit(&["man", directory.path().to_str().unwrap()]);
    assert!(run.status == 0 && run.out.is_empty(), "{}", run.err);
    for verb in VERBS {
        let page = std::fs::read_to_string(directory.path().join(format!("fluxfit-{verb}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS"), "{page}");
    }
    let page = std::fs::read_to_string(directory.path().join("fluxfit.1")).unwrap();
    assert!(page.contains("fluxfit\\-identify(1)"), "{page}");
    assert_eq!(fluxfit(&["man", "no/such/directory"]).status, 2);
}

#[test]
fn a_page_in_place_of_an_answer_is_a_report() {
    let run = fluxfit(&["identify", LOG, "-o", "page.html"]);
    assert_eq!((run.status, run.err.as_str()), (2, "error: -o is no option of this verb; to write a page: --report page.html\n"));
    // Nothing of the kind is said where there is no page.
    assert!(fluxfit(&["identify", LOG, "-o", "page.txt"]).err.starts_with("error: unexpected argument"));
}
