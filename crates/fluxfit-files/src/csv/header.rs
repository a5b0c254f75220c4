//! The header of a table of text: where it is, and what separates its names.

use super::record;
use crate::{error::FileError, input, problem::Problem};
use fluxfit_units::wording::{list, quote};

/// The names of the columns, and where the rows begin.
pub struct Header {
    /// The names, without spaces and quotes, and without the empty names after trailing separators.
    pub names: Vec<String>,
    /// The units from a row below the names; empty without such a row.
    pub units: Vec<String>,
    /// Line of the header, from 1.
    pub line: u64,
    /// Byte between the cells.
    pub separator: u8,
    /// Offset of the first byte below.
    pub body: usize,
    /// Line of that byte.
    pub body_line: u64,
}

/// Maximum number of title lines above a header.
const TITLES: usize = 20;

/// Maximum length of a unit in a row of units, in characters: that of `electrical rad/s`.
const LONGEST_UNIT: usize = 16;

/// Finds the header, which is the first line that is not blank, a comment or a title, and the row of units below it, if there is one.
/// What had to be inferred is added to `notes`.
///
/// # Errors
/// If there is no header, or it has only one name.
pub fn find(text: &str, notes: &mut Vec<String>) -> Result<Header, FileError> {
    let mut header = names(text, notes)?;
    if let Some((units, end)) = units(text, &header) {
        notes.push(format!("line {} is a row of units", record::line_of(text, header.body)));
        header.units = units;
        header.body = end;
    }
    header.body_line = input::line_at(text.as_bytes(), header.body);
    Ok(header)
}

/// A row of short texts without a number above a row with numbers, and the offset of its end.
fn units(text: &str, header: &Header) -> Option<(Vec<String>, usize)> {
    let record = |from: usize| {
        let (start, line) = lines(&text[from..]).find(|(_, line)| !line.trim().is_empty())?;
        Some((record::first_record(line, header.separator).0, from + start + line.len()))
    };
    let (cells, end) = record(header.body)?;
    let (below, _) = record(end)?;
    let is_unit = |cell: &String| !is_number(cell, header.separator) && cell.chars().count() <= LONGEST_UNIT;
    let is_row = cells.iter().all(is_unit) && cells.iter().filter(|cell| !cell.is_empty()).count() > 1;
    (is_row && cells.len() <= header.names.len() && below.iter().any(|cell| is_number(cell, header.separator))).then_some((cells, end))
}

fn names(text: &str, notes: &mut Vec<String>) -> Result<Header, FileError> {
    let mut comment = None;
    let mut stated_separator = None;
    let mut titles = Vec::new();
    let mut lines = lines(text);
    let (start, first) = loop {
        let (start, line) = lines.next().ok_or(Problem::NoHeader)?;
        let trimmed = line.trim();
        if trimmed.starts_with(['#', '%']) {
            comment = Some((start, trimmed));
        } else if let Some(separator) = separator_line(line) {
            stated_separator = Some(separator);
        } else if !trimmed.trim_matches([',', ';', ' ', '\t']).is_empty() {
            if titles.len() < TITLES && is_title(text, start, line) {
                titles.push(quote(trimmed));
                continue;
            }
            break (start, line);
        }
    };
    if !titles.is_empty() {
        notes.push(format!("read as titles above the header: {}", list(&titles)));
    }
    let separator = stated_separator.unwrap_or_else(|| most_frequent_separator(first));
    let header = at(text, start, separator);
    if header.names.len() > 1 && header.names.iter().all(|name| is_number(name, separator)) {
        return from_comment(text, comment, start, &header, notes);
    }
    if header.names.len() < 2 {
        return Err(FileError::from(Problem::OneColumn { text: first.trim().to_owned() }).at_line(header.line));
    }
    Ok(header)
}

fn at(text: &str, start: usize, separator: u8) -> Header {
    let (names, length) = record::first_record(&text[start..], separator);
    Header { names, units: Vec::new(), line: record::line_of(text, start), separator, body: start + length, body_line: 0 }
}

/// The header in the last comment above the rows, where some tools write it.
fn from_comment(
    text: &str,
    comment: Option<(usize, &str)>,
    body: usize,
    first: &Header,
    notes: &mut Vec<String>,
) -> Result<Header, FileError> {
    if let Some((start, comment)) = comment {
        let bare = comment.trim_start_matches(['#', '%']);
        let separator = most_frequent_separator(bare);
        let (names, _) = record::first_record(bare, separator);
        if names.len() == first.names.len() && names.iter().all(|name| !is_number(name, separator)) {
            let line = record::line_of(text, start);
            notes.push(format!("the names of the columns were taken from the comment in line {line}"));
            return Ok(Header { names, units: Vec::new(), line, separator: first.separator, body, body_line: 0 });
        }
    }
    let problem = Problem::NumbersForHeader { text: first.names.join(", ") };
    Err(FileError::from(problem).at_line(first.line))
}

/// Whether a line is a title, a timestamp or a line of information above the header: it has one cell or begins with a digit, and the
/// next line has more cells; or it has at most half as many cells as the first row of numbers below.
fn is_title(text: &str, start: usize, line: &str) -> bool {
    let header = at(text, start, most_frequent_separator(line));
    let cells = header.names.len();
    let dated =
        header.names.first().is_some_and(|name| name.starts_with(|c: char| c.is_ascii_digit()) && !is_number(name, header.separator));
    let below = || lines(&text[header.body..]).filter(|(_, line)| !line.trim().is_empty());
    let cells_of = |line: &str| record::first_record(line, most_frequent_separator(line)).0;
    if cells > 1 && !dated {
        let is_row = |cells: &Vec<String>| cells.len() > 1 && cells.iter().filter(|cell| is_number(cell, b';')).count() * 2 > cells.len();
        let row = below().take(TITLES).map(|(_, line)| cells_of(line)).find(is_row);
        return row.is_some_and(|row| 2 * cells <= row.len());
    }
    below().next().is_some_and(|(_, line)| cells_of(line).len() > cells)
}

/// The separator from a line `sep=;`, as spreadsheets write it.
fn separator_line(line: &str) -> Option<u8> {
    let line = line.trim_end_matches(['\r', '\n']);
    let mark = line.get(..4)?.eq_ignore_ascii_case("sep=").then(|| &line[4..])?;
    match mark {
        "," | ";" | "\t" => mark.bytes().next(),
        _ => None,
    }
}

/// The most frequent separator outside of quotes. On a tie the semicolon, which is rare in other roles, then the comma: tabs may only
/// align the text.
fn most_frequent_separator(line: &str) -> u8 {
    let count = |separator: u8| {
        let mut quoted = false;
        let outside = |byte: &u8| {
            quoted ^= *byte == b'"';
            !quoted && *byte == separator
        };
        line.as_bytes().iter().copied().filter(outside).count()
    };
    // The last of equal maxima wins.
    [b'\t', b',', b';'].into_iter().max_by_key(|separator| count(*separator)).unwrap_or(b',')
}

/// Whether a cell holds a number.
pub fn is_number(cell: &str, separator: u8) -> bool {
    record::number(cell.as_bytes(), separator, &mut String::new()).is_some()
}

/// Lines with their offsets; they end with `\n`, `\r\n` or `\r`.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut offset = 0;
    std::iter::from_fn(move || {
        let rest = text.get(offset..).filter(|rest| !rest.is_empty())?;
        let length = rest.find(['\n', '\r']).map_or(rest.len(), |at| if rest[at..].starts_with("\r\n") { at + 2 } else { at + 1 });
        let line = (offset, &rest[..length]);
        offset += length;
        Some(line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> (Vec<String>, u64, u8, &str) {
        let header = find(text, &mut Vec::new()).unwrap_or_else(|error| panic!("{text:?}: {error}"));
        (header.names, header.line, header.separator, text[header.body..].trim_start())
    }

    #[test]
    fn the_header_is_found_below_comments_blank_lines_and_titles() {
        let names = || vec!["a b".to_owned(), "c".to_owned()];
        assert_eq!(found("a b,c\n1,2"), (names(), 1, b',', "1,2"));
        assert_eq!(found("# x\r\n\r\n% y\r\n \"a b\" ; c;;\r\n1;2"), (names(), 4, b';', "1;2"));
        assert_eq!(found("sep=\t\na b\tc\n"), (names(), 2, b'\t', ""));
        assert_eq!(found(";;\na b,\tc\n"), (names(), 2, b',', ""));
        assert_eq!(found("\"a b\",\"c\"\r1,2"), (names(), 1, b',', "1,2"));
    }

    #[test]
    fn names_in_a_comment_are_taken_if_their_number_fits() {
        let mut notes = Vec::new();
        let header = find("# made by hand\n# a,b,c\n1;2,5;3\n", &mut notes).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((header.names, header.separator, header.body), (vec!["a".into(), "b".into(), "c".into()], b';', 23));
        assert_eq!(notes, ["the names of the columns were taken from the comment in line 2"]);
        assert!(find("# a,b\n1,2,3\n", &mut notes).is_err());
    }

    #[test]
    fn separators_inside_of_quotes_do_not_count() {
        assert_eq!(most_frequent_separator("\"a,b,c\";d"), b';');
        assert_eq!(most_frequent_separator("a,\tb,\tc"), b',');
        assert_eq!(most_frequent_separator("a, x;b"), b';');
        assert_eq!(most_frequent_separator("a"), b';');
    }
}
