//! What README and docs show is what the command prints: each console block is run, and its output begins as shown.

use super::{fluxfit, root};

#[test]
fn console_blocks_are_true() {
    let mut blocks = 0;
    for page in [
        "README.md",
        "docs/log.md",
        "docs/identify.md",
        "docs/validate.md",
        "docs/study.md",
        "docs/drive.md",
        "docs/report.md",
        "docs/track.md",
        "docs/reproduction.md",
    ] {
        let text = std::fs::read_to_string(root().join(page)).unwrap();
        for block in text.split("```console\n$ fluxfit ").skip(1) {
            let (block, _) = block.split_once("```").unwrap();
            let (command, shown) = block.split_once('\n').unwrap();
            let run = fluxfit(&command.split_whitespace().collect::<Vec<_>>());
            assert!(run.out.starts_with(shown), "{page}: fluxfit {command} prints\n{}", run.out);
            blocks += 1;
        }
    }
    assert!(blocks > 0, "no console block found");
}

/// Every command that a page advises is one that the program understands.
#[test]
fn advised_commands_parse() {
    let text = std::fs::read_to_string(root().join("README.md")).unwrap();
    let mut commands = 0;
    for line in text.lines().filter_map(|line| line.strip_prefix("    fluxfit ")) {
        let mut arguments: Vec<&str> = line.split_whitespace().collect();
        arguments.push("--help");
        let run = fluxfit(&arguments);
        assert_eq!(run.status, 0, "fluxfit {line}: {}", run.err);
        commands += 1;
    }
    assert!(commands > 0);
}
