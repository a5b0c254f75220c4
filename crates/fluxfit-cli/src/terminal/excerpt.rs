//! The line of a file that an error is about, below the error's sentence, with the cell in question marked.
//!
//! It is read again from the file, so that no reader has to carry lines about. What is compressed or no text has none.

use fluxfit_files::FileError;
use std::{
    fs::File,
    io::{BufRead, BufReader},
    ops::Range,
    path::Path,
};

/// Columns of the screen that the excerpt may have: those of the narrowest terminal in use.
const WIDTH: usize = 80;

/// Bytes of a line that are looked at; no log's line is longer, and a file without line breaks is not held in memory.
const LONGEST: usize = 1 << 16;

/// What separates cells.
const SEPARATORS: [char; 4] = [',', ';', '\t', '|'];

/// The excerpt, in lines of its own; none, if there is no such line.
pub(super) fn of(error: &FileError) -> Option<String> {
    let (file, number) = (Path::new(error.file()?), error.line()?);
    if !file.is_file() {
        return None;
    }
    let (line, cell) = find(BufReader::new(File::open(file).ok()?), number, error.column())?;
    // A header's cell is never the one in question of a row below; what the sentence quotes is.
    let marked = cell.or_else(|| quoted(&line, &error.to_string())).or_else(|| named(&line, error.column()?));
    Some(draw(number, &line, marked))
}

/// A line, and the place of the column's cell in it: the one below the column's name in the last line above that has it.
fn find(mut file: impl BufRead, number: u64, column: Option<&str>) -> Option<(String, Option<Range<usize>>)> {
    let mut place = None;
    let mut count = 0;
    loop {
        let bytes = next_line(&mut file)?;
        count += 1;
        if count == number {
            let text = String::from_utf8(bytes).ok().filter(|text| !text.contains('\0'))?;
            let cell = place.and_then(|(separator, index)| cells(&text, separator).nth(index));
            return Some((text, cell));
        }
        // The last such line above: a comment may name columns too, a row of numbers does not.
        let text = str::from_utf8(&bytes).ok();
        place = text.zip(column).and_then(|(text, column)| header_place(text, column)).or(place);
    }
}

/// The start of the next line, without its end; none behind the last one. Lines end with `\n`, `\r\n` or `\r`.
fn next_line(file: &mut impl BufRead) -> Option<Vec<u8>> {
    let mut line = Vec::new();
    let mut any = false;
    loop {
        let buffer = file.fill_buf().ok()?;
        if buffer.is_empty() {
            return any.then_some(line);
        }
        any = true;
        let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let part = &buffer[..end.unwrap_or(buffer.len())];
        line.extend_from_slice(&part[..part.len().min(LONGEST - line.len())]);
        let (used, is_return) = (part.len(), end.is_some_and(|end| buffer[end] == b'\r'));
        if end.is_none() {
            file.consume(used);
            continue;
        }
        file.consume(used + 1);
        if is_return && file.fill_buf().ok()?.first() == Some(&b'\n') {
            file.consume(1);
        }
        return Some(line);
    }
}

/// The separator of a line that has the column's name among its cells, and the name's number.
fn header_place(text: &str, column: &str) -> Option<(char, usize)> {
    if !text.contains(column) {
        return None;
    }
    let bare = |cell: Range<usize>| text[cell].trim_matches(|c: char| c.is_whitespace() || matches!(c, '"' | '\'' | '\u{feff}'));
    SEPARATORS.into_iter().find_map(|separator| {
        let index = cells(text, separator).position(|cell| bare(cell) == column)?;
        text.contains(separator).then_some((separator, index))
    })
}

/// Cells of a line, without the blanks around them. Quotation marks around separators are rare enough in logs.
fn cells(text: &str, separator: char) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    text.split(separator).map(move |cell| {
        let first = start + cell.len() - cell.trim_start().len();
        start += cell.len() + separator.len_utf8();
        first..first + cell.trim().len()
    })
}

/// Where the line has what the sentence quotes first, if only once.
fn quoted(line: &str, sentence: &str) -> Option<Range<usize>> {
    let text = sentence.split('"').nth(1)?;
    let text = text.strip_suffix('…').unwrap_or(text);
    let mut places = line.match_indices(text).filter(|_| !text.is_empty());
    match (places.next(), places.next()) {
        (Some((start, _)), None) => Some(start..start + text.len()),
        _ => None,
    }
}

/// Where the line has the column's name, or the last word of a key.
fn named(line: &str, name: &str) -> Option<Range<usize>> {
    let last = name.rsplit('.').next().unwrap_or(name);
    [name, last].into_iter().filter(|name| !name.is_empty()).find_map(|name| line.find(name).map(|start| start..start + name.len()))
}

/// Line number, line and marks. Of a line that is too long, what is around the marks.
fn draw(number: u64, line: &str, marked: Option<Range<usize>>) -> String {
    let margin = number.to_string().len();
    let room = WIDTH - margin - " | ".len();
    let letters: Vec<char> = line.trim_start_matches('\u{feff}').trim_end().chars().map(visible).collect();
    let offset = line.chars().take_while(|c| *c == '\u{feff}').count();
    // Letters, not bytes; an empty cell is marked where it should be.
    let marks = marked.map(|marked| {
        let start = line[..marked.start].chars().count() - offset.min(line[..marked.start].chars().count());
        start..start + line[marked].chars().count().max(1)
    });
    let centre = marks.as_ref().map_or(0, |marks| marks.start + marks.len().min(room) / 2);
    let first = centre.saturating_sub(room / 2).min(letters.len().saturating_sub(room));
    let last = (first + room).min(letters.len());
    let mut shown = letters[first..last].to_vec();
    if first > 0 {
        shown[0] = '…';
    }
    if let Some(end) = shown.last_mut().filter(|_| last < letters.len()) {
        *end = '…';
    }
    let shown: String = shown.into_iter().collect();
    let mut text = format!("{:margin$} |\n{number} | {shown}\n", "");
    if let Some(marks) = marks {
        let (from, to) = (marks.start.max(first) - first, marks.end.min(first + room) - first);
        text += &format!("{:margin$} | {:from$}{}\n", "", "", "^".repeat(to.saturating_sub(from).max(1)));
    }
    text
}

/// A letter as it may be shown: nothing that moves the cursor or turns the writing around.
fn visible(letter: char) -> char {
    match letter {
        '\t' => ' ',
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}' => '\u{fffd}',
        letter if letter.is_control() => '\u{fffd}',
        letter => letter,
    }
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, draw, find, next_line, quoted};

    const LOG: &[u8] = b"# t, uq\r\nt ; ud;\"uq\" \r0;1;2\n0.1;;8O\n";

    #[test]
    fn the_cell_below_the_columns_name_is_found_whatever_ends_the_lines() {
        for (line, column, cell) in [(3, "uq", "2"), (4, "uq", "8O"), (4, "ud", ""), (4, "t", "0.1")] {
            let (text, place) = find(LOG, line, Some(column)).unwrap();
            assert_eq!(&text[place.unwrap()], cell, "line {line}, column {column}");
        }
        assert_eq!(find(LOG, 4, Some("iq")), Some(("0.1;;8O".to_owned(), None)));
        assert_eq!(find(LOG, 5, None), None);
    }

    #[test]
    fn marks_stand_below_the_letters_and_long_lines_are_cut_around_them() {
        assert_eq!(draw(12, "rs = \"0.9 Om\"", Some(6..12)), "   |\n12 | rs = \"0.9 Om\"\n   |       ^^^^^^\n");
        assert_eq!(draw(5, "1,,2", Some(2..2)), "  |\n5 | 1,,2\n  |   ^\n");
        assert_eq!(draw(5, "µ,x", Some(3..4)), "  |\n5 | µ,x\n  |   ^\n");
        let long = format!("{}abc{}", "1,".repeat(5000), ",1".repeat(5000));
        let drawn = draw(7, &long, Some(10_000..10_003));
        let lines: Vec<&str> = drawn.lines().collect();
        assert!(lines.iter().all(|line| line.chars().count() <= 80), "{drawn}");
        let start = lines[2].chars().position(|c| c == '^').unwrap();
        assert_eq!(lines[1].chars().skip(start).take(3).collect::<String>(), "abc");
        assert_eq!(lines[2].matches('^').count(), 3);
        // Marks that are themselves longer than the line may be.
        assert!(draw(7, &"x".repeat(500), Some(0..500)).lines().all(|line| line.chars().count() <= 80));
    }

    #[test]
    fn nothing_that_moves_the_cursor_is_shown() {
        let drawn = draw(1, "a\u{1b}[2Jb\tc\u{202e}d\u{7}", None);
        assert_eq!(drawn, "  |\n1 | a\u{fffd}[2Jb c\u{fffd}d\u{fffd}\n");
    }

    #[test]
    fn a_line_without_end_is_not_held_in_memory() {
        let bytes = vec![b'x'; 3 * LONGEST];
        let mut file = &bytes[..];
        assert_eq!(next_line(&mut file).unwrap().len(), LONGEST);
        assert_eq!(next_line(&mut file), None);
        assert_eq!(find(&b"a\0b"[..], 1, None), None);
        assert_eq!(find(&b"\x1f\x8b\x08"[..], 1, None), None);
    }

    #[test]
    fn what_the_sentence_quotes_is_marked_only_where_it_is_sure() {
        assert_eq!(quoted("a, 8O, b", "x, line 3: \"8O\" is not a number"), Some(3..5));
        assert_eq!(quoted("8O, 8O", "\"8O\" is not a number"), None);
        assert_eq!(quoted("8O", "the cell is empty"), None);
    }
}
