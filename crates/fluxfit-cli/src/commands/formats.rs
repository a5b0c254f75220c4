//! `fluxfit formats`: the layouts that are known, each with its columns, and the containers they may come in.

use super::Status;
use crate::{
    error::CommandError,
    terminal::{self, BAD, DIM, HEADING},
};
use fluxfit_log::{CONTAINERS, Container, LAYOUTS};

/// Longest line.
const WIDTH: usize = 96;

const TEXT: &str = "\
Text: comma, semicolon or tab; decimal comma; UTF-8, UTF-16, Windows-1252; gzip; titles, comments and a row of units.
Records: JSON (a record a line, or an array of them), LabVIEW LVM, candump with its database (--dbc FILE.dbc).
";

const OTHERS: &str = "\
The format of a file is recognized from its content, not from its name.
Any other names: --map, or a mapping file, which fluxfit inspect LOG -o MAPPING.toml writes to start from.
";

/// The formats other than text, in one line.
fn containers() -> String {
    let name = |container: &Container| {
        let missing = if container.is_built { "" } else { " (not in this build)" };
        container.names.iter().map(|name| format!("{name}{missing}")).collect::<Vec<_>>()
    };
    format!("Containers: {}.\n", CONTAINERS.iter().flat_map(name).collect::<Vec<_>>().join(", "))
}

/// Runs the verb.
pub(crate) fn run() -> Result<Status, CommandError> {
    let mut text = String::new();
    for layout in LAYOUTS {
        let refused = if layout.is_log() { String::new() } else { format!(" {BAD}refused{BAD:#}") };
        text += &format!("{HEADING}{}{HEADING:#}{refused}  {DIM}{}{DIM:#}\n", layout.name, layout.source);
        for line in wrapped(&layout.headers(), WIDTH - 2).into_iter().chain(wrapped(layout.remark, WIDTH - 2)) {
            text += &format!("  {line}\n");
        }
    }
    terminal::print(&format!("{text}\n{TEXT}{}{OTHERS}", containers()))?;
    Ok(Status::Complete)
}

/// Lines of at most `width` characters, broken at spaces.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= width) {
            Some(line) => *line = format!("{line} {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}
