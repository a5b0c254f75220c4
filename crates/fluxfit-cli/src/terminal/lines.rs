//! Lines of words that fit the terminal, wrapped between words; what goes to a pipe or a file is as wide as the narrowest terminal in use.

use std::io::IsTerminal;
use terminal_size::{Height, Width, terminal_size_of};
use unicode_width::UnicodeWidthStr;

/// Columns of the narrowest terminal in use, and of what does not go to a terminal.
const USUAL: usize = 80;

/// Lines of such a terminal.
const USUAL_LINES: u16 = 24;

/// Longer lines of words are hard to read.
const WIDEST: usize = 100;

/// Fewer columns than this would break every line.
const NARROWEST: usize = 40;

/// Columns that an answer may have.
pub(crate) fn width() -> usize {
    of_terminal(terminal_size_of(std::io::stdout())).unwrap_or(USUAL)
}

/// Columns that a line of words on standard error may have; none, where it is not read on a terminal: scripts read lines.
pub(super) fn width_of_messages() -> Option<usize> {
    let stderr = std::io::stderr();
    stderr.is_terminal().then(|| of_terminal(terminal_size_of(stderr)).unwrap_or(USUAL))
}

fn of_terminal(size: Option<(Width, Height)>) -> Option<usize> {
    // A terminal that does not know its width says zero.
    size.map(|(Width(columns), _)| usize::from(columns)).filter(|columns| *columns > 0).map(|columns| columns.clamp(NARROWEST, WIDEST))
}

/// Lines of the terminal on standard output; none, where the answer goes elsewhere.
pub(crate) fn height() -> Option<usize> {
    let stdout = std::io::stdout();
    let of_size = |(_, Height(lines))| Some(lines).filter(|lines| *lines > 0);
    stdout.is_terminal().then(|| usize::from(terminal_size_of(stdout).and_then(of_size).unwrap_or(USUAL_LINES)))
}

/// Columns and lines of the terminal on standard error; those of the narrowest in use, where it does not know them.
pub(crate) fn screen() -> [u16; 2] {
    let size = terminal_size_of(std::io::stderr()).map(|(Width(columns), Height(lines))| [columns, lines]);
    size.filter(|size| !size.contains(&0)).unwrap_or([USUAL as u16, USUAL_LINES])
}

/// Columns that a text takes, without its escape codes.
pub(crate) fn columns(text: &str) -> usize {
    anstream::adapter::strip_str(text).map(UnicodeWidthStr::width).sum()
}

/// Words in lines of the answer. The first line begins with `indent`, the others are two letters further in.
pub(crate) fn wrapped(indent: &str, text: &str) -> String {
    wrapped_to(width(), indent, text)
}

/// Words in lines of so many columns. A word that is longer has a line of its own.
pub(super) fn wrapped_to(width: usize, indent: &str, text: &str) -> String {
    let mut lines = String::new();
    let mut line = indent.to_owned();
    let mut used = columns(indent);
    let mut starts = true;
    for word in unbroken(text) {
        let length = columns(&word);
        if !starts && used + 1 + length > width {
            lines += &format!("{line}\n");
            line = format!("{indent}  {word}");
            used = columns(indent) + 2 + length;
        } else {
            let blank = if starts { "" } else { " " };
            line += &format!("{blank}{word}");
            used += blank.len() + length;
        }
        starts = false;
    }
    format!("{lines}{line}\n")
}

/// Words, where an option and its argument are one, and so are a number and its percent sign.
fn unbroken(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match words.last_mut() {
            Some(last) if word.starts_with('%') || (is_option(last) && !is_option(word)) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Whether a word is an option without its argument.
fn is_option(word: &str) -> bool {
    word.trim_start_matches(['(', '`']).starts_with("--") && !word.contains(' ') && !word.ends_with([',', ';', ':', '.', ')', '`'])
}

/// A count with its noun.
pub(crate) fn count(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::{columns, wrapped_to};

    #[test]
    fn words_are_wrapped_and_none_is_lost() {
        assert_eq!(wrapped_to(80, "  ", "To do: nothing."), "  To do: nothing.\n");
        let text = vec!["letters"; 40].join(" ");
        for width in [40, 80, 100, 140] {
            let lines = wrapped_to(width, "", &text);
            assert!(lines.lines().all(|line| columns(line) <= width), "{lines}");
            assert_eq!(lines.split_whitespace().count(), 40);
            assert!(lines.lines().skip(1).all(|line| line.starts_with("  letters")));
        }
    }

    #[test]
    fn an_option_stays_with_its_argument_and_a_number_with_its_percent_sign() {
        let text = "give it as a prior (--prior rs=VALUE±1%): then ±2.6 %.";
        assert_eq!(wrapped_to(20, "", "a window (--window T0:T1)"), "a window\n  (--window T0:T1)\n");
        for width in 20..60 {
            let lines = wrapped_to(width, "", text);
            assert!(lines.contains("(--prior rs=VALUE±1%):") && lines.contains("±2.6 %."), "{lines}");
        }
    }

    #[test]
    fn letters_count_as_wide_as_they_are_and_colours_not_at_all() {
        assert_eq!([columns("±5 µV"), columns("電圧"), columns("\u{1b}[31mred\u{1b}[0m")], [5, 4, 3]);
        assert_eq!(wrapped_to(9, "", "電圧 電圧"), "電圧 電圧\n");
        assert_eq!(wrapped_to(8, "", "電圧 電圧"), "電圧\n  電圧\n");
    }
}
