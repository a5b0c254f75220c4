//! The header of a table of text: where it is, and what separates its names.

use super::{
    beside_settings::{self, Samples},
    levels::{self, Levels},
    record::{self, lines},
    scope::{self, Export},
    tidy::RowStyle,
    unit_names::UNITS,
};
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
    /// Byte between the cells, once the rows are [tidied](RowStyle).
    pub separator: u8,
    /// How the rows are written.
    pub rows: RowStyle,
    /// A row may lack its last cells, where the channels that they are of ended before others.
    pub may_end_early: bool,
    /// Offset of the first byte below.
    pub body: usize,
    /// Line of that byte.
    pub body_line: u64,
}

/// Maximum number of title lines above a header: oscilloscopes write thirty settings.
const TITLES: usize = 40;

/// Maximum length of a unit in a row of units, in characters: that of `electrical rad/s`.
const LONGEST_UNIT: usize = 16;

/// Finds the header, which is the first line that is not blank, a comment or a title, and the row of units below it, if there is one.
/// What had to be inferred is added to `notes`.
///
/// # Errors
/// If there is no header, or it has only one name.
pub fn find(text: &str, notes: &mut Vec<String>) -> Result<Header, FileError> {
    let mut header = match scope::find(text) {
        Some(export) => of_scope(text, export, notes)?,
        None => names(text, notes)?,
    };
    if header.rows == RowStyle::Plain && header.separator != b';' && first_row(text, header.body).is_some_and(|row| row.ends_with(';')) {
        header.rows = RowStyle::Terminated;
        if let Some(last) = header.names.last_mut() {
            last.truncate(last.trim_end_matches(';').trim_end().len());
        }
    }
    if header.units.is_empty()
        && let Some((units, end)) = units(text, &header)
    {
        notes.push(format!("line {} is a row of units", record::line_of(text, header.body)));
        header.units = units;
        header.body = end;
    }
    if header.names.first().is_some_and(|name| name == "Label") && header.units.len() == header.names.len() {
        label(&mut header);
    }
    if let [first, others @ ..] = &mut header.names[..]
        && first.is_empty()
        && others.iter().all(|name| !name.is_empty())
    {
        UNNAMED.clone_into(first);
    }
    header.body_line = input::line_at(text.as_bytes(), header.body);
    Ok(header)
}

/// What pandas calls the index that it wrote without a name, where it reads it back.
pub const UNNAMED: &str = "Unnamed: 0";

/// The header of an export of TwinCAT Scope.
///
/// # Errors
/// If its channels have different sample times and one time for all.
fn of_scope(text: &str, export: Export, notes: &mut Vec<String>) -> Result<Header, FileError> {
    let Export { names, units, start, separator, body, sample_times } = export;
    let line = record::line_of(text, start);
    if !sample_times.is_empty() {
        return Err(FileError::from(Problem::SampleTimes { times: sample_times }).at_line(line));
    }
    notes.push("read as an export of TwinCAT Scope, whose times are milliseconds".to_owned());
    Ok(Header { names, units, line, separator, rows: RowStyle::Plain, may_end_early: true, body, body_line: 0 })
}

/// Tektronix writes the labels of the channels above their names, `TIME,CH1`: what has a label has that name.
fn label(header: &mut Header) {
    let names = std::mem::take(&mut header.units);
    let labels = std::mem::replace(&mut header.names, names);
    for (name, label) in header.names.iter_mut().zip(labels).skip(1).filter(|(_, label)| !label.is_empty()) {
        *name = label;
    }
}

/// The first line below that is not blank, without spaces at its ends.
fn first_row(text: &str, from: usize) -> Option<&str> {
    lines(text.get(from..)?).map(|(_, line)| line.trim()).find(|line| !line.is_empty())
}

/// A row of short texts without a number above a row with numbers, and the offset of its end.
fn units(text: &str, header: &Header) -> Option<(Vec<String>, usize)> {
    let record = |from: usize| {
        let (start, line) = lines(&text[from..]).find(|(_, line)| !line.trim().is_empty())?;
        Some((cells(line, header.separator, header.rows), from + start + line.len()))
    };
    let (row, end) = record(header.body)?;
    let is_unit = |cell: &String| !is_number(cell) && cell.chars().count() <= LONGEST_UNIT;
    let is_row = row.iter().all(is_unit) && row.iter().filter(|cell| !cell.is_empty()).count() > 1;
    if !is_row || row.len() > header.names.len() {
        return None;
    }
    let (below, _) = record(end)?;
    below.iter().any(|cell| is_number(cell)).then_some((row, end))
}

/// The cells of a line.
fn cells(line: &str, separator: u8, rows: RowStyle) -> Vec<String> {
    match rows {
        RowStyle::Aligned => line.split_whitespace().map(str::to_owned).collect(),
        RowStyle::Terminated => record::first_record(line.trim_end().trim_end_matches(';'), separator).0,
        RowStyle::Plain => record::first_record(line, separator).0,
    }
}

fn names(text: &str, notes: &mut Vec<String>) -> Result<Header, FileError> {
    let of_rows = separator_of_rows(text);
    let mut comments = Vec::new();
    let mut stated_separator = None;
    let mut titles = Vec::new();
    let mut lines = lines(text);
    let (start, first) = loop {
        let (start, line) = lines.next().ok_or(Problem::NoHeader)?;
        let trimmed = line.trim();
        if trimmed.starts_with(['#', '%']) {
            comments.push((start, trimmed));
        } else if let Some(separator) = separator_line(line) {
            stated_separator = Some(separator);
        } else if !trimmed.trim_matches([',', ';', ' ', '\t']).is_empty() {
            if let Some(header) = of_levels(text, start, stated_separator.or(of_rows), notes) {
                return Ok(header);
            }
            if titles.len() < TITLES && is_title(text, start, line, of_rows) {
                titles.push(quote(trimmed));
                continue;
            }
            break (start, line);
        }
    };
    if let Some(Samples { names, units }) = beside_settings::find(text, start) {
        notes.push("the columns are those of the samples beside the settings of an oscilloscope".to_owned());
        return Ok(Header { names, units, body: start, ..at(text, start, b',') });
    }
    if !titles.is_empty() {
        notes.push(format!("read as titles above the header: {}", list(&titles)));
    }
    let header = match stated_separator {
        None if is_aligned(text, start, first) => Header {
            names: cells(first, b'\t', RowStyle::Aligned),
            units: Vec::new(),
            line: record::line_of(text, start),
            separator: b'\t',
            rows: RowStyle::Aligned,
            may_end_early: false,
            body: start + first.len(),
            body_line: 0,
        },
        _ => at(text, start, stated_separator.or(of_rows).unwrap_or_else(|| most_frequent_separator(first))),
    };
    let is_value = |name: &String| is_number(name.trim_end_matches(';'));
    // Settings of an oscilloscope beside its first samples: columns may be called 1 and 2, but not 0.5.
    let fractions = header.names.iter().filter(|name| is_value(name) && name.contains(['.', ','])).count();
    if fractions > 1 && !header.names.iter().all(is_value) {
        return Err(FileError::from(Problem::NumbersForHeader { text: header.names.join(", ") }).at_line(header.line));
    }
    if header.names.len() > 1 && header.names.iter().all(is_value) {
        return from_comments(text, &comments, start, header, notes);
    }
    if header.names.len() < 2 {
        return Err(FileError::from(Problem::OneColumn { text: first.trim().to_owned() }).at_line(header.line));
    }
    Ok(header)
}

/// The header of names with further lines below them.
fn of_levels(text: &str, start: usize, separator: Option<u8>, notes: &mut Vec<String>) -> Option<Header> {
    let separator = separator.unwrap_or_else(|| most_frequent_separator(lines(&text[start..]).next().map_or("", |(_, line)| line)));
    let Levels { names, units, body } = levels::find(text, start, separator)?;
    notes.push("the lines above the rows are read as levels of names, or as what is stated of each".to_owned());
    Some(Header { names, units, body, ..at(text, start, separator) })
}

fn at(text: &str, start: usize, separator: u8) -> Header {
    let (names, length) = record::first_record(&text[start..], separator);
    let (line, body) = (record::line_of(text, start), start + length);
    Header { names, units: Vec::new(), line, separator, rows: RowStyle::Plain, may_end_early: false, body, body_line: 0 }
}

/// Whether a line and the first row below it, or the line alone if it has numbers only, have as many words and no separator: their cells
/// are separated by spaces.
fn is_aligned(text: &str, start: usize, line: &str) -> bool {
    let bare = |line: &str| !line.trim().contains([',', ';', '\t', '"']);
    let are_numbers = |line: &str| line.split_whitespace().all(is_number);
    let words = line.split_whitespace().count();
    let fits = |row: &str| row.split_whitespace().count() == words && bare(row);
    words > 1
        && bare(line)
        && (are_numbers(line)
            || lines(&text[start + line.len()..])
                .map(|(_, line)| line)
                .filter(|line| !line.trim().is_empty())
                .take(2)
                .take_while(|row| fits(row))
                .any(are_numbers))
}

/// The header in a comment above the rows, where some tools write it: the last one that has as many names as a row has cells. A comment
/// below it with as many cells in brackets has the units.
fn from_comments(text: &str, comments: &[(usize, &str)], body: usize, first: Header, notes: &mut Vec<String>) -> Result<Header, FileError> {
    let cells_of = |comment: &str| {
        let bare = comment.trim_start_matches(['#', '%']);
        if bare.contains([',', ';', '\t']) || first.rows != RowStyle::Aligned {
            let separator = most_frequent_separator(bare);
            let bare = if separator == b';' { bare } else { bare.trim_end_matches(';') };
            return record::first_record(bare, separator).0;
        }
        cells(bare, b'\t', RowStyle::Aligned)
    };
    let mut fitting = comments.iter().rev().map(|(start, comment)| (*start, cells_of(comment))).filter(|(_, cells)| {
        let are_names = !cells.iter().any(|cell| cell.is_empty() || is_number(cell));
        cells.len() == first.names.len() && are_names
    });
    let Some((mut start, mut names)) = fitting.next() else {
        let problem = Problem::NumbersForHeader { text: first.names.join(", ") };
        return Err(FileError::from(problem).at_line(first.line));
    };
    let mut units = Vec::new();
    let is_bracketed = |cell: &String| (cell.starts_with('[') && cell.ends_with(']')) || (cell.starts_with('(') && cell.ends_with(')'));
    if names.iter().all(is_bracketed)
        && let Some((above, of_above)) = fitting.next()
    {
        units = std::mem::replace(&mut names, of_above);
        start = above;
    }
    let line = record::line_of(text, start);
    notes.push(format!("the names of the columns were taken from the comment in line {line}"));
    Ok(Header { names, units, line, body, ..first })
}

/// Whether a line is a title, a timestamp or a line of information above the header: it has one cell, and some line below has more; or it
/// begins with a digit, and the next line has more cells; or it has at most half as many cells as the first row of numbers below; or it has
/// empty cells, and a line below has fewer and is no row of numbers either; or it is a remark above each name; or it belongs to a preamble.
fn is_title(text: &str, start: usize, line: &str, of_rows: Option<u8>) -> bool {
    let separator = |line: &str| of_rows.unwrap_or_else(|| most_frequent_separator(line));
    let header = at(text, start, separator(line));
    let cells = header.names.len();
    let dated = header.names.first().is_some_and(|name| name.starts_with(|c: char| c.is_ascii_digit()) && !is_number(name));
    let below = || lines(&text[header.body..]).filter(|(_, line)| !line.trim().is_empty());
    let cells_of = |line: &str| record::first_record(line, separator(line)).0;
    let is_above_names = || header.names.iter().any(String::is_empty) && is_above_names(&header, text);
    if cells > 1 && is_above_names() {
        return true;
    }
    if cells > 1 && !dated {
        let is_row = |cells: &Vec<String>| cells.len() > 1 && cells.iter().filter(|cell| is_number(cell)).count() * 2 > cells.len();
        let row = below().take(TITLES).map(|(_, line)| cells_of(line)).find(is_row);
        return row.is_some_and(|row| 2 * cells <= row.len()) || are_remarks(&header, text) || is_preamble(&header, text, separator);
    }
    let mut below = below().map(|(_, line)| cells_of(line));
    let Some(next) = below.next() else { return false };
    if next.len() > cells || cells > 1 {
        return next.len() > cells;
    }
    // Above others of one cell, too, if there is a table below.
    let mut below = below.take(TITLES).skip_while(|line| line.len() <= cells).skip(1);
    below.by_ref().take(NAMES_AND_UNITS).any(|line| line.len() > 1 && line.iter().filter(|cell| is_number(cell)).count() * 2 > line.len())
}

/// Whether a line has a remark above each name: the next one has as many texts, and stands above numbers. Of the two the names are shorter.
/// Short texts below names are their units.
fn are_remarks(line: &Header, text: &str) -> bool {
    let mut below = lines(&text[line.body..]).map(|(_, below)| below.trim()).filter(|below| !below.is_empty());
    let mut next =
        || below.next().map(|below| record::first_record(below, line.separator).0).filter(|cells| cells.len() == line.names.len());
    let (Some(names), Some(row)) = (next(), next()) else { return false };
    let are_texts = |cells: &[String]| cells.iter().all(|cell| !cell.is_empty() && !is_number(cell));
    let longest = |cells: &[String]| cells.iter().map(|cell| cell.chars().count()).max().unwrap_or_default();
    let are_units = longest(&names) <= LONGEST_UNIT;
    // Names with their units, `Strom [A]`, are no units of what stands above.
    let states_unit = |cell: &String| cell.ends_with([']', ')']) && !cell.starts_with(['[', '(']);
    let are_named = names.iter().all(states_unit) && !line.names.iter().any(states_unit);
    are_texts(&line.names)
        && are_texts(&names)
        && (are_named || !are_units && longest(&line.names) > longest(&names))
        && row.iter().all(|cell| is_number(cell))
}

/// Whether a line belongs to a preamble: above the rows of numbers another line has as many names as these have cells, and this one has
/// not, or it has only their units.
fn is_preamble(line: &Header, text: &str, separator: impl Fn(&str) -> u8) -> bool {
    let cells: Vec<Vec<String>> = lines(&text[line.body..])
        .map(|(_, below)| below.trim())
        .filter(|below| !below.is_empty() && !below.starts_with(['#', '%']))
        .take(TITLES)
        .map(|below| record::first_record(below, separator(below)).0)
        .collect();
    let numbers = |cells: &[String]| cells.iter().filter(|cell| is_number(cell)).count();
    let filled = |cells: &[String]| cells.iter().filter(|cell| !cell.is_empty()).count();
    let is_row = |cells: &[String]| numbers(cells) > 1 && numbers(cells) == filled(cells);
    let body = cells.windows(2).position(|pair| is_row(&pair[0]) && is_row(&pair[1]) && pair[0].len() == pair[1].len());
    let Some((above, width)) = body.map(|at| (&cells[..at], cells[at].len())) else { return false };
    let has_names = above.iter().any(|cells| cells.len() == width && filled(cells) == width && numbers(cells) == 0);
    let are_units = |names: &[String]| names.iter().filter(|name| UNITS.contains(&name.to_lowercase().as_str())).count() * 2 > names.len();
    // Of an oscilloscope: settings, some of which happen to have the width of the rows. The names are in the last two lines.
    let settings = above.iter().filter(|cells| cells.len() != width).count();
    let is_setting = above.len() >= NAMES_AND_UNITS && (settings >= SETTINGS || numbers(&line.names) > 0);
    // As wide as the rows, where one channel is stored: more lines than names have below them.
    let are_many = above.len() > NAMES_AND_UNITS || above.len() == NAMES_AND_UNITS && above.last().is_some_and(|last| are_units(last));
    has_names && (line.names.len() != width || are_units(&line.names) || is_setting || are_many)
}

/// Lines at the end of a preamble that may be names, and labels above or units below them.
const NAMES_AND_UNITS: usize = 2;

/// Lines of settings that make a preamble.
const SETTINGS: usize = 3;

/// Whether a line below a line with empty cells, and above the first row of numbers, has more names in it.
fn is_above_names(line: &Header, text: &str) -> bool {
    let filled = |cells: &[String]| cells.iter().filter(|cell| !cell.is_empty()).count();
    let numbers = |cells: &[String]| cells.iter().filter(|cell| is_number(cell)).count();
    lines(&text[line.body..])
        .filter(|(_, line)| !line.trim().is_empty())
        .take(TITLES)
        .map(|(_, below)| record::first_record(below, line.separator).0)
        .take_while(|below| 2 * numbers(below) <= filled(below))
        .any(|below| filled(&below) > filled(&line.names) && numbers(&below) == 0)
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

/// Lines that are looked at for the separator, and the part of them at the end that tells it: above are titles and names.
const LINES: usize = 80;
const LAST: usize = 4;

/// The separator that the rows of numbers show, if it is none that a number has: where decimal commas are in every cell, commas are more
/// frequent, and names have them, too.
fn separator_of_rows(text: &str) -> Option<u8> {
    let lines: Vec<&str> = lines(text)
        .map(|(_, line)| line.trim_end_matches(['\r', '\n']))
        .filter(|line| !line.trim().is_empty() && !line.starts_with(['#', '%']))
        .take(LINES)
        .collect();
    // The last one may be cut.
    let end = lines.len() - usize::from(lines.len() > 2);
    let rows = &lines[end - end.div_ceil(LAST)..end];
    let is_row = |line: &str, separator: u8| {
        let (cells, _) = record::first_record(line, separator);
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
        filled > 1 && 2 * cells.iter().filter(|cell| is_number(cell)).count() > filled
    };
    let shows = |separator: &u8| !rows.is_empty() && rows.iter().all(|line| is_row(line, *separator));
    [b'\t', b';'].into_iter().find(shows)
}

/// The most frequent separator outside of quotes. On a tie the semicolon, which is rare in other roles, then the comma: tabs may only
/// align the text.
fn most_frequent_separator(line: &str) -> u8 {
    let bytes = line.as_bytes();
    let outside = |separator: u8, is_of_name: &dyn Fn(usize) -> bool| {
        let mut quoted = false;
        let is = |(place, byte): &(usize, &u8)| {
            quoted ^= **byte == b'"';
            !quoted && **byte == separator && !is_of_name(*place)
        };
        bytes.iter().enumerate().filter(is).count()
    };
    // Beside several semicolons a comma before a space belongs to a name: `Strom, Istwert [A]`.
    let has_names = outside(b';', &|_| false) > 1;
    let count = |separator: u8| outside(separator, &|place| separator == b',' && has_names && bytes.get(place + 1) == Some(&b' '));
    // A semicolon at the end alone separates nothing.
    let ends = line.trim_end().ends_with(';') && count(b';') == 1 && count(b',') + count(b'\t') > 0;
    if ends {
        return if count(b',') >= count(b'\t') { b',' } else { b'\t' };
    }
    // The last of equal maxima wins.
    [b'\t', b',', b';'].into_iter().max_by_key(|separator| count(*separator)).unwrap_or(b',')
}

/// Whether a cell holds a number. A comma in it is a decimal comma: where commas separate, it was quoted.
pub fn is_number(cell: &str) -> bool {
    record::number(cell.as_bytes(), b';', &mut String::new()).is_some()
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
        // With the units in a comment below, and rows that end with a semicolon.
        let header = find("% drive 3\r\n\r\n%a,b\r\n%[s],[V]\r\n1,2;\r\n3,4;\r\n", &mut notes).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((header.names, header.units), (vec!["a".to_owned(), "b".to_owned()], vec!["[s]".to_owned(), "[V]".to_owned()]));
        assert_eq!((header.line, header.separator, header.rows), (3, b',', RowStyle::Terminated));
        let header = find("# a b c\n1.0 2.0 3.0\n", &mut notes).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((header.names.concat(), header.rows, header.body), ("abc".to_owned(), RowStyle::Aligned, 8));
    }

    #[test]
    fn titles_with_empty_cells_are_above_the_names() {
        let names = || vec!["t".to_owned(), "ud".to_owned(), "uq".to_owned()];
        assert_eq!(found("Bench 3;;2016\n;Drive;\nt;ud;uq\n1;2;3"), (names(), 3, b';', "1;2;3"));
        assert_eq!(found("t;ud;uq;\n1;2;3"), (names(), 1, b';', "1;2;3"));
        assert_eq!(found("Bench 3\nDrive A: 8 kHz\nt;ud;uq\n1;2;3"), (names(), 3, b';', "1;2;3"));
        assert_eq!(found("Bench 3;;\n29.11.2026;;\n;;\nt;ud;uq\n1;2;3"), (names(), 4, b';', "1;2;3"));
        // A column without a name, as pandas writes its index.
        assert_eq!(found(",ud,uq\n0,1,2\n").0, [UNNAMED, "ud", "uq"]);
    }

    #[test]
    fn preambles_of_instruments_are_titles() {
        let names = || vec!["Time".to_owned(), "Ampl".to_owned()];
        let lecroy =
            "LECROY,12345,Waveform\nSegments,1,SegmentSize,9000\nSegment,TrigTime,Since\n#1,14-Aug-2012,0\nTime,Ampl\n0.1,1\n0.2,2\n";
        assert_eq!(found(lecroy), (names(), 5, b',', "0.1,1\n0.2,2\n"));
        let siglent = "Record Length,Analog:9000\nVertical Units,CH1:V\nHorizontal Units,S\nSource,CH1\nSecond,Volt\n0.1,1\n0.2,2\n";
        assert_eq!(found(siglent), (vec!["Source".into(), "CH1".into()], 4, b',', "0.1,1\n0.2,2\n"));
        let dspace = "unit,s,V\n\npath,,Root/a\n\nnames,Time,Ampl\n,0.1,1\n,0.2,2\n";
        assert_eq!(found(dspace), (vec!["names".into(), "Time".into(), "Ampl".into()], 5, b',', ",0.1,1\n,0.2,2\n"));
        // Settings beside the samples, and no names at all.
        let beside = "Points,2500,,0.0,1.2\nSample Interval,4e-6,,0.1,1.3\n";
        assert!(find(beside, &mut Vec::new()).is_err_and(|error| error.to_string().contains("in place of a header")));
        // A wider row of data has no other line of names above it.
        assert_eq!(found("a,b\n1,2,3\n1,2,3\n").1, 1);
    }

    #[test]
    fn remarks_as_wide_as_the_table_are_titles() {
        let names = ["rpm", "brake (V)", "T measured (Nm)", "phase-phase voltage (V) rms"].map(str::to_owned).to_vec();
        let header = "rpm,brake (V),T measured (Nm),phase-phase voltage (V) rms";
        let rows = "100,0,0.07,0.33\n200,0,0.1,0.7\n";
        for above in [
            "2/12/2016,,run ~/projects/speed_test/ramp_test,\n,,layout: ~/projects/motor_tests.sml,\n,,meter,\"be sure, in DC\"\n",
            "read from the drive's display,set by hand at the supply,\"of the torque meter, zeroed before\",77 IV multimeter\n",
        ] {
            let text = format!("{above}{header}\n{rows}");
            let found = found(&text);
            assert_eq!((found.0, found.3), (names.clone(), rows), "{above}");
        }
        // Units, or what a column is, stand below its name.
        let units = find(&format!("{header}\nr/min,V,Nm,V\n{rows}"), &mut Vec::new()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((&units.names, units.units.concat().as_str()), (&names, "r/minVNmV"));
        let described = "speed of the shaft in r/min,voltage of the brake,torque of the sensor,voltage between two terminals of the motor";
        assert_eq!(found(&format!("{header}\n{described}\n{rows}")).1, 1);
    }

    /// As a TDS 2012 writes it.
    #[test]
    fn samples_beside_settings_are_columns() {
        let text = "Record Length,2.5e+03,,  -0.0500,   0.01,\nSample Interval,4e-05,,  -0.0499,   0.02,\nSource,CH1,,-00.0498,  0.03,\nVertical Units,V,,-00.0497,  0.04,\nHorizontal Units,s,,-00.0496,  0.05,\n,,,-00.0495,  0.06,\n";
        let header = find(text, &mut Vec::new()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            (header.names, header.units),
            (["", "", "", "TIME", "CH1"].map(str::to_owned).to_vec(), ["", "", "", "s", "V"].map(str::to_owned).to_vec())
        );
        assert_eq!((header.body, header.body_line), (0, 1));
    }

    #[test]
    fn names_and_numbers_may_be_aligned_with_spaces() {
        let header = find("  t    ud   uq\n 0.0  1.0 -2.0\n", &mut Vec::new()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((header.names.join(","), header.rows, header.body), ("t,ud,uq".to_owned(), RowStyle::Aligned, 15));
        assert!(find("one title of words\n", &mut Vec::new()).is_err());
    }

    /// As German spreadsheets and drives write tables: every cell has a comma, and so may the names.
    #[test]
    fn rows_tell_the_separator() {
        let names = || vec!["Zeit [s]".to_owned(), "P-44, Strom, Ist".to_owned(), "n".to_owned()];
        let rows = "0,00;1,25;2,50\n0,01;1,26;-2,51\n0,02;1,27;2,52\n";
        for above in [
            "",
            "Titel;x\n",
            "Titel\nDatum 12.1.\n",
            "Oszilloskop;Lenze\nRate [us];100\nTrigger;0\n\n",
            "\"Trace\";\"S120\"\n\"Datum\";\"14.07.2023\"\n",
        ] {
            for separator in [';', '\t'] {
                let text = format!("{above}Zeit [s];P-44, Strom, Ist;n\n{rows}").replace(';', &separator.to_string());
                let found = found(&text);
                assert_eq!((found.0, char::from(found.2)), (names(), separator), "{text}");
            }
        }
        // A title of as many cells as the table.
        assert_eq!(found("Motor;A 12\nStrom [A];Drehmoment [Nm]\n1,00;155,0\n2,00;310,1\n").1, 2);
        assert_eq!(found("Strom;Drehmoment\n[A];[Nm]\n1,00;155,0\n2,00;310,1\n").1, 1);
        // A mark at the end of a row separates nothing.
        assert_eq!(found("a,b\n1,2;\n3,4;\n5,6;\n").2, b',');
    }

    #[test]
    fn separators_inside_of_quotes_do_not_count() {
        assert_eq!(most_frequent_separator("\"a,b,c\";d"), b';');
        assert_eq!(most_frequent_separator("a,\tb,\tc"), b',');
        assert_eq!(most_frequent_separator("a, x;b"), b';');
        assert_eq!(most_frequent_separator("t;S-0-0040, n, ist;P-0-0043, i, ist"), b';');
        assert_eq!(most_frequent_separator("a"), b';');
    }
}
