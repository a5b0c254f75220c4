//! The layouts that are known, each with its columns, and the containers they may come in.

use super::{BAD, DIM, HEADING};
use fluxfit_log::LAYOUTS;

/// Longest line.
const WIDTH: usize = 96;

const CONTAINERS: &str = "\
Text: comma, semicolon or tab; decimal comma; UTF-8, UTF-16, Windows-1252; gzip; titles, comments and a row of units.
Parquet, MATLAB (v5 to v7.3), HDF5; MDF 4 where built with it. What a file is is found from its bytes, not from its name.
Any other names: --map, or a mapping file, which fluxfit inspect LOG -o MAPPING.toml writes to start from.
";

/// Shows them.
pub(crate) fn show() -> std::io::Result<()> {
    let mut text = String::new();
    for layout in LAYOUTS {
        let refused = if layout.is_log() { String::new() } else { format!(" {BAD}refused{BAD:#}") };
        text += &format!("{HEADING}{}{HEADING:#}{refused}  {DIM}{}{DIM:#}\n", layout.name, layout.source);
        for line in wrapped(&layout.headers(), WIDTH - 2).into_iter().chain(wrapped(layout.remark, WIDTH - 2)) {
            text += &format!("  {line}\n");
        }
    }
    super::print(&format!("{text}\n{CONTAINERS}"))
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
