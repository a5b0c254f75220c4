//! What a person sees. Answers on standard output, everything else on standard error; colour only where it is wanted (a terminal,
//! and no `NO_COLOR`).

pub(crate) mod identification;
mod plot;
pub(crate) mod simulation;
pub(crate) mod study;
pub(crate) mod validation;

use anstyle::{AnsiColor, Style};
use comfy_table::{Cell, CellAlignment, Table, presets};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    io::{BufWriter, Write},
    path::Path,
    time::Duration,
};

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const GOOD: Style = AnsiColor::Green.on_default();
const BAD: Style = AnsiColor::Red.on_default();
const DIM: Style = Style::new().dimmed();
const HEADING: Style = Style::new().bold();

/// Prints an answer.
pub(crate) fn print(text: &str) -> std::io::Result<()> {
    let mut out = anstream::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Prints an answer as it is made, through a buffer.
pub(crate) fn stream(write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> std::io::Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    write(&mut out)?;
    out.flush()
}

/// Says why a command stopped.
pub(crate) fn complain(error: &dyn std::error::Error) {
    say(&format!("{ERROR}error:{ERROR:#} {error}"));
}

/// Says what the reader should know.
pub(crate) fn warn(code: &str, message: &str) {
    say(&format!("{WARNING}warning{WARNING:#} [{code}]: {message}"));
}

/// Says what was inferred.
pub(crate) fn note(message: &str) {
    say(&format!("{DIM}note:{DIM:#} {message}"));
}

/// Says that something was written.
pub(crate) fn wrote(what: &str, path: &Path) {
    say(&format!("{DIM}{what}:{DIM:#} {}", path.display()));
}

fn say(line: &str) {
    // Nobody listening on standard error is no reason to stop.
    let _ = writeln!(anstream::stderr().lock(), "{line}");
}

/// A progress bar on standard error, where that is a terminal.
pub(crate) fn progress(length: usize, what: &str, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}, {eta} left").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(length as u64), target).with_style(style).with_message(what.to_owned())
}

/// Between two turns of a sign of life: fast enough to be seen moving.
const TICK: Duration = Duration::from_millis(100);

/// A sign of life on standard error, where that is a terminal, for work of unknown length; it goes when that is done.
pub(crate) fn working<T>(what: String, work: impl FnOnce() -> T) -> T {
    let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed}").unwrap_or_else(|_| ProgressStyle::default_spinner());
    let spinner = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()).with_style(style).with_message(what);
    spinner.enable_steady_tick(TICK);
    let done = work();
    spinner.finish_and_clear();
    done
}

/// A table without frame: a heading, and rows whose columns after the first `left` are aligned to the right.
fn table(heading: &[&str], left: usize, rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(heading.iter().map(Cell::new));
    rows.into_iter().for_each(|row| {
        table.add_row(row);
    });
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((2, 0));
        if index >= left {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}
