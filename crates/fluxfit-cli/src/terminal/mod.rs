//! What a person sees. Answers on standard output, everything else on standard error; colour only where it is wanted (a terminal,
//! and no `NO_COLOR`).

pub(crate) mod advice;
mod excerpt;
mod given;
mod lines;
pub(crate) mod mending;
pub(crate) mod options;
pub(crate) mod plot;
mod progress;
pub(crate) mod told;

use crate::error::CommandError;
use anstyle::{AnsiColor, Style};
use comfy_table::{Cell, CellAlignment, Table, presets};
use fluxfit::Warning;
use fluxfit_units::{significant, wording::one_line};
pub(crate) use lines::{columns, count, height, screen, width, wrapped};
pub(crate) use progress::{Progress, counting, reading, unknown, working};
use std::{
    io::{BufWriter, IsTerminal, Write},
    path::Path,
    sync::{
        LazyLock, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU8, AtomicUsize, Ordering},
    },
    time::Instant,
};
use told::Told;

pub(crate) const ERROR: Style = AnsiColor::Red.on_default().bold();
pub(crate) const WARNING: Style = AnsiColor::Yellow.on_default().bold();
pub(crate) const GOOD: Style = AnsiColor::Green.on_default();
pub(crate) const BAD: Style = AnsiColor::Red.on_default();
pub(crate) const DIM: Style = Style::new().dimmed();
pub(crate) const HEADING: Style = Style::new().bold();

/// Whether nobody reads the answer any more.
static IS_UNREAD: AtomicBool = AtomicBool::new(false);

/// Why an answer could not be written, where that is not because nobody reads it: a full disk.
static UNWRITTEN: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Prints an answer. Whoever closes the pipe early, as `head` does, still gets the report and the other files, and so does whoever sends
/// the answer to a full disk: the error is told at the end.
pub(crate) fn print(text: &str) -> std::io::Result<()> {
    LIVE.store(0, Ordering::Relaxed);
    let mut out = anstream::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => {
            IS_UNREAD.store(true, Ordering::Relaxed);
            Ok(())
        }
        Err(error) => {
            IS_UNREAD.store(true, Ordering::Relaxed);
            UNWRITTEN.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            Ok(())
        }
        Ok(()) => Ok(()),
    }
}

/// Why an answer could not be written, once.
pub(crate) fn unwritten() -> Option<std::io::Error> {
    UNWRITTEN.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// Whether an answer was not read to its end.
pub(crate) fn is_unread() -> bool {
    IS_UNREAD.load(Ordering::Relaxed)
}

/// Prints an answer as it is made, through a buffer.
pub(crate) fn stream(write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> std::io::Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    write(&mut out)?;
    out.flush()
}

/// How much is told on standard error, beside warnings and errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(crate) enum Detail {
    /// Nothing.
    Quiet,
    /// What was inferred and what was written, and how far the work is.
    Notes,
    /// What was decided on the way, and when.
    Everything,
}

static DETAIL: AtomicU8 = AtomicU8::new(Detail::Notes as u8);
/// Whether progress may be shown, where there is a terminal.
static HAS_PROGRESS: AtomicBool = AtomicBool::new(true);
static START: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Settles how much is told, and starts the clock.
pub(crate) fn tell(detail: Detail, has_progress: bool) {
    DETAIL.store(detail as u8, Ordering::Relaxed);
    HAS_PROGRESS.store(has_progress && detail > Detail::Quiet, Ordering::Relaxed);
    LazyLock::force(&START);
}

fn detail_level() -> Detail {
    match DETAIL.load(Ordering::Relaxed) {
        0 => Detail::Quiet,
        1 => Detail::Notes,
        _ => Detail::Everything,
    }
}

/// Prints why a command stopped: a sentence, and below it the line of the file that it is about.
pub(crate) fn print_error(error: &CommandError) {
    release_notes();
    say(&format!("{ERROR}error:{ERROR:#} {}", options::with_option(&error.to_string(), error.option())));
    say_lines(error.lines());
    if let Some(excerpt) = error.in_file().and_then(excerpt::of) {
        let _ = write!(anstream::stderr().lock(), "{DIM}{excerpt}{DIM:#}");
    }
}

/// Prints lines to be copied on standard error, as they are.
fn say_lines(lines: &str) {
    // Nobody listening on standard error is no reason to stop.
    let _ = write!(anstream::stderr().lock(), "{lines}");
}

/// Says what a signal does, from the first column on, whatever progress has left there.
pub(crate) fn interrupted(what: &str) {
    let clear = if std::io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
    say(&format!("{clear}{WARNING}interrupted:{WARNING:#} {what}"));
}

/// Says what was decided, and how long after the start, if everything is to be told.
pub(crate) fn detail(message: impl FnOnce() -> String) {
    if detail_level() == Detail::Everything {
        say(&format!("{DIM}{:8.3} s  {}{DIM:#}", START.elapsed().as_secs_f64(), message()));
    }
}

/// Whether everything is to be told.
pub(crate) fn is_verbose() -> bool {
    detail_level() == Detail::Everything
}

/// Prints a warning in a line of its own; the whole sentence, and the option that answers it, where everything is to be told.
pub(crate) fn warn(warning: &Warning) {
    if is_verbose() {
        warn_at_length(warning);
    } else {
        warn_of(warning.code(), &warning.in_short());
    }
}

/// Says where more is said of warnings.
pub(crate) fn point_to_explanations(warnings: &[Warning]) {
    if let Some(first) = warnings.first().filter(|_| detail_level() == Detail::Notes) {
        let what = if warnings.len() > 1 { "a warning" } else { "it" };
        say(&format!("{DIM}more on {what}: fluxfit --explain {}{DIM:#}", first.code()));
    }
}

/// Prints the whole sentence of a warning, and the option that answers it.
pub(crate) fn warn_at_length(warning: &Warning) {
    warn_of(warning.code(), &options::with_option(&warning.to_string(), options::of_warning(warning)));
}

/// Prints a finding of the columns as a warning, with the lines that mend it.
pub(crate) fn warn_of_columns(finding: &Told) {
    warn_of(finding.code, &finding.sentence);
    say_lines(&finding.lines);
}

/// Prints a warning that is not one of the library's.
pub(crate) fn warn_of(code: &str, message: &str) {
    say(&format!("{WARNING}warning{WARNING:#} [{code}]: {message}"));
}

/// Says what was inferred; while notes are [held](hold_notes), later.
pub(crate) fn note(message: &str) {
    if detail_level() > Detail::Quiet {
        match held_notes().as_mut() {
            Some(held) => held.push(message.to_owned()),
            None => say_note(message),
        }
    }
}

fn say_note(message: &str) {
    say(&format!("{DIM}note:{DIM:#} {message}"));
}

/// Notes that wait for the answer, where it comes first.
static HELD_NOTES: Mutex<Option<Vec<String>>> = Mutex::new(None);

fn held_notes() -> MutexGuard<'static, Option<Vec<String>>> {
    // Each change leaves it whole.
    HELD_NOTES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps notes until [`release_notes`]: the answer stands above them.
pub(crate) fn hold_notes() {
    held_notes().get_or_insert_default();
}

/// Says the notes that were kept.
pub(crate) fn release_notes() {
    let held = held_notes().take();
    held.into_iter().flatten().for_each(|message| say_note(&message));
}

/// How many lines above the cursor are redrawn in place.
static LIVE: AtomicUsize = AtomicUsize::new(0);

/// Whether lines may be redrawn in place on standard error.
pub(crate) fn can_redraw() -> bool {
    let moves_its_cursor = std::env::var_os("TERM").is_none_or(|terminal| terminal != "dumb");
    HAS_PROGRESS.load(Ordering::Relaxed) && std::io::stderr().is_terminal() && moves_its_cursor
}

/// Draws lines in place of those that were drawn last. What is said meanwhile stands above them; an answer leaves them where they are.
pub(crate) fn live(lines: &str) {
    let _whole = std::io::stderr().lock();
    let drawn = LIVE.swap(lines.lines().count(), Ordering::Relaxed);
    if drawn > 0 {
        move_cursor(&format!("\x1b[{drawn}A"));
    }
    for line in lines.lines() {
        // Nobody listening on standard error is no reason to stop.
        let _ = write!(anstream::stderr(), "{line}");
        // The rest of the old line goes; the whole at once would flicker.
        move_cursor("\x1b[K\n");
    }
    move_cursor("\x1b[J");
}

fn take_live_away() {
    let drawn = LIVE.swap(0, Ordering::Relaxed);
    if drawn > 0 {
        move_cursor(&format!("\x1b[{drawn}A\x1b[J"));
    }
}

/// Not through anstream: the cursor moves without colours too.
fn move_cursor(codes: &str) {
    let _ = write!(std::io::stderr(), "{codes}");
}

/// Says that a file was written, and what it is.
pub(crate) fn wrote(what: &str, file: &Path) {
    if detail_level() > Detail::Quiet && file.as_os_str() != "-" {
        say(&format!("{DIM}{what}:{DIM:#} {}", one_line(&file.display().to_string())));
    }
}

/// Says why one was not.
pub(crate) fn refuse_export(file: &Path, why: &str) {
    say(&format!("{ERROR}error:{ERROR:#} {} is not written: {why}", one_line(&file.display().to_string())));
}

/// Prints a line on standard error; on a terminal in as many lines as it takes.
fn say(line: &str) {
    let lines = lines::width_of_messages().map_or_else(|| format!("{line}\n"), |width| lines::wrapped_to(width, "", line));
    let _whole = std::io::stderr().lock();
    take_live_away();
    // Nobody listening on standard error is no reason to stop.
    let _ = write!(anstream::stderr(), "{lines}");
}

/// A table without frame: a heading, and rows whose columns after the first `left` are aligned to the right.
pub(crate) fn table(heading: &[&str], left: usize, rows: impl IntoIterator<Item = Vec<String>>) -> String {
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

/// A frequency with its unit.
pub(crate) fn frequency(hertz: f64) -> String {
    if hertz >= 1000.0 { format!("{} kHz", significant(hertz / 1000.0, 3)) } else { format!("{} Hz", significant(hertz, 3)) }
}
