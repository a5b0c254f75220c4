//! A table of many motors, cut where the value of a column changes: each motor's rows are passed on as soon as they are read, so that the
//! memory is that of one motor. Of a motor with many rows it is passed on where they are in the file, so that the memory does not grow with
//! them. The rows of a motor must stand together.

use crate::{
    container::{Binary, RandomAccess},
    file_part::{FilePart, PartRows},
    memory_table::{MemoryColumn, MemoryTable},
    problem::Problem,
};
use fluxfit_files::{
    FileError, FileErrorKind,
    input::{io_problem, name},
};
use std::{
    fs::File,
    io::{BufRead, BufReader, Read, Seek},
    ops::ControlFlow,
    path::Path,
};

/// Most rows of a motor that are passed on in memory: with ten columns they take 42 MB. Of more the reader selects rows, for which it needs
/// to see each of them once.
const MOST_HELD: u64 = 1 << 19;

/// Separators of the columns of a text.
const SEPARATORS: [char; 4] = [',', ';', '\t', '|'];

/// Consecutive rows of one motor.
#[derive(Debug)]
pub struct Group {
    /// The value of the column; `None` of rows that have none.
    pub key: Option<String>,
    /// The rows.
    pub rows: GroupRows,
}

/// The rows of a motor.
#[derive(Debug)]
pub enum GroupRows {
    /// A table of text, with the header of the whole.
    Text(Vec<u8>),
    /// Columns of numbers.
    Numbers(Vec<GroupColumn>),
    /// Many rows, which are still in the file.
    Part(FilePart),
}

/// A column of the rows of a motor.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupColumn {
    /// Its name in the file.
    pub name: String,
    /// The numbers are seconds since the first row of the file.
    pub is_instant: bool,
    /// One for each row; NaN where the file has none.
    pub values: Vec<f64>,
}

impl GroupRows {
    /// Numbers as a table.
    pub fn table(columns: &[GroupColumn]) -> MemoryTable<'_> {
        let columns = columns.iter().map(|GroupColumn { name, is_instant, values }| MemoryColumn {
            name: name.clone(),
            unit: is_instant.then_some("s"),
            rows: values.len(),
            read: Box::new(move |rows, into| into.extend_from_slice(&values[rows])),
        });
        MemoryTable { columns: columns.collect(), unreadable: Vec::new() }
    }
}

/// Reads a table of text or Parquet and passes the rows of each motor to `take`, in the order of the file, until it breaks off. `by` is the
/// name of the column that names the motors.
///
/// # Errors
/// If the file cannot be read, or has no such column. The motors before the place of an error are passed on.
pub fn read_groups(path: &Path, by: &str, take: &mut dyn FnMut(Group) -> ControlFlow<()>) -> Result<(), FileError> {
    let failed = |error: std::io::Error| FileError::from(io_problem("reading", &error));
    let mut read = || {
        let mut file = File::open(path).map_err(failed)?;
        let mut start = [0; 4];
        let count = file.read(&mut start).map_err(failed)?;
        file.rewind().map_err(failed)?;
        if &start[..count] == b"PAR1" { of_parquet(file, by, take) } else { of_text(file, by, take) }
    };
    read().map_err(|error: FileError| error.in_file(&name(path)))
}

/// The refusal of a table without a column `by` that names the motors.
pub fn no_motors_column(by: &str, names: Vec<String>) -> FileError {
    Problem::NoMotors { by: by.to_owned(), names }.into()
}

/// The refusal of a column `by` that names no motors.
pub fn no_motor_names(by: &str) -> FileError {
    FileError::from(Problem::MotorNames).in_column(by)
}

fn of_parquet(file: File, by: &str, take: &mut dyn FnMut(Group) -> ControlFlow<()>) -> Result<(), FileError> {
    let file = RandomAccess::file(file)?;
    let Some(binary @ Binary::Parquet(_)) = Binary::open(file.clone())? else { return Err(no_motors_column(by, Vec::new())) };
    let Binary::Parquet(parquet) = &binary else { return Err(no_motors_column(by, Vec::new())) };
    let Some(runs) = parquet.runs(by)? else { return Err(no_motors_column(by, parquet.names())) };
    let wanted: Vec<usize> = (0..binary.heads().len()).filter(|&index| binary.heads()[index].name != by).collect();
    let empty = || -> Vec<GroupColumn> {
        let heads = wanted.iter().map(|&index| &binary.heads()[index]);
        heads.map(|head| GroupColumn { name: head.name.clone(), is_instant: head.unit.is_some(), values: Vec::new() }).collect()
    };
    let mut runs = runs.into_iter();
    let mut open = runs.next();
    let (mut columns, mut held, mut row) = (empty(), 0, 0);
    let mut is_over = false;
    let broken = || FileError::new(FileErrorKind::Data, "broken off");
    let outcome = binary.read(&wanted, &mut |block| {
        let rows = block.first().map_or(0, Vec::len);
        let mut from = 0;
        while from < rows {
            let Some((_, whole)) = &open else { return Ok(()) };
            let is_kept = *whole <= MOST_HELD;
            let to = rows.min(from + usize::try_from(whole - held).unwrap_or(usize::MAX));
            if is_kept {
                columns.iter_mut().zip(&block).for_each(|(column, block)| column.values.extend_from_slice(&block[from..to]));
            }
            held += (to - from) as u64;
            row += (to - from) as u64;
            from = to;
            if held == *whole {
                let part = || FilePart { file: file.clone(), rows: PartRows::Parquet { rows: row - held..row, without: by.to_owned() } };
                let rows = if is_kept { GroupRows::Numbers(std::mem::replace(&mut columns, empty())) } else { GroupRows::Part(part()) };
                let key = open.take().and_then(|(key, _)| key);
                (open, held) = (runs.next(), 0);
                if take(Group { key, rows }).is_break() {
                    is_over = true;
                    return Err(broken());
                }
            }
        }
        Ok(())
    });
    if is_over { Ok(()) } else { outcome }
}

fn of_text(mut file: File, by: &str, take: &mut dyn FnMut(Group) -> ControlFlow<()>) -> Result<(), FileError> {
    let failed = |error: std::io::Error| FileError::from(io_problem("reading", &error));
    let source = RandomAccess::file(file.try_clone().map_err(failed)?)?;
    file.rewind().map_err(failed)?;
    let mut lines = BufReader::with_capacity(1 << 18, file);
    let mut header = Vec::new();
    // Where the line ends that was read last.
    let mut at = lines.read_until(b'\n', &mut header).map_err(failed)? as u64;
    let text = String::from_utf8_lossy(&header);
    let text = text.trim_start_matches('\u{feff}').trim_end();
    if text.is_empty() {
        return Err(fluxfit_files::Problem::Empty.into());
    }
    let found = SEPARATORS.iter().find_map(|separator| {
        let names: Vec<String> = cells(text, *separator).collect();
        names.iter().position(|name| name == by).map(|place| (*separator, place))
    });
    let Some((separator, place)) = found else {
        let separator = SEPARATORS.into_iter().max_by_key(|separator| text.matches(*separator).count()).unwrap_or(',');
        return Err(no_motors_column(by, cells(text, separator).collect()));
    };
    if !header.ends_with(b"\n") {
        header.push(b'\n');
    }
    let (mut key, mut content, mut rows): (Option<Vec<u8>>, Vec<u8>, u64) = (None, header.clone(), 0);
    // Where the first line of the motor begins.
    let mut start = at;
    let mut line = Vec::new();
    loop {
        line.clear();
        let length = lines.read_until(b'\n', &mut line).map_err(failed)? as u64;
        let (is_end, above) = (length == 0, at);
        at += length;
        if !is_end && line.trim_ascii().is_empty() {
            continue;
        }
        let cell = cell(&line, separator, place);
        if rows > 0 && (is_end || key.as_deref() != Some(cell.as_ref())) {
            let rows = if rows > MOST_HELD {
                GroupRows::Part(FilePart { file: source.clone(), rows: PartRows::Text { header: header.clone(), bytes: start..above } })
            } else {
                GroupRows::Text(std::mem::replace(&mut content, header.clone()))
            };
            let key = key.as_deref().map(|key| String::from_utf8_lossy(key).trim().to_owned()).filter(|key| !key.is_empty());
            if take(Group { key, rows }).is_break() {
                return Ok(());
            }
        }
        if is_end {
            return Ok(());
        }
        if key.as_deref() != Some(cell.as_ref()) {
            (key, rows, start) = (Some(cell.into_owned()), 0, above);
        }
        rows += 1;
        if rows <= MOST_HELD {
            content.extend_from_slice(&line);
        } else if content.len() > header.len() {
            content = header.clone();
        }
    }
}

/// The cells of a line, without their quotes.
fn cells(line: &str, separator: char) -> impl Iterator<Item = String> {
    let mut is_quoted = false;
    let parts = line.split(move |c: char| {
        is_quoted ^= c == '"';
        c == separator && !is_quoted
    });
    parts.map(|cell| cell.trim().trim_matches('"').to_owned())
}

/// One cell of a line.
fn cell(line: &[u8], separator: char, place: usize) -> std::borrow::Cow<'_, [u8]> {
    let line = line.trim_ascii_end();
    if line.contains(&b'"') {
        let text = String::from_utf8_lossy(line);
        return cells(&text, separator).nth(place).unwrap_or_default().into_bytes().into();
    }
    line.split(|byte| char::from(*byte) == separator).nth(place).unwrap_or_default().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(text: &str, by: &str) -> Result<Vec<(Option<String>, String)>, String> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("fleet.csv");
        std::fs::write(&path, text).unwrap();
        let mut found = Vec::new();
        let read = read_groups(&path, by, &mut |group| {
            let GroupRows::Text(text) = group.rows else { panic!("no text") };
            found.push((group.key, String::from_utf8(text).unwrap()));
            ControlFlow::Continue(())
        });
        read.map(|()| found).map_err(|error| error.to_string().replace(&path.display().to_string(), "fleet.csv"))
    }

    #[test]
    fn a_text_is_cut_where_the_motor_changes() {
        let group = |key: &str, text: &str| (Some(key.to_owned()).filter(|key| !key.is_empty()), text.to_owned());
        let found = groups("m,t\na,1\na,2\n\n\"b,c\",3\n,4\na,5", "m").unwrap();
        let expected = [("a", "m,t\na,1\na,2\n"), ("b,c", "m,t\n\"b,c\",3\n"), ("", "m,t\n,4\n"), ("a", "m,t\na,5")];
        assert_eq!(found, expected.map(|(key, text)| group(key, text)));
        assert_eq!(groups("\u{feff}t;m\n1;x\n", "m").unwrap(), [group("x", "\u{feff}t;m\n1;x\n")]);
        let refusal = "fleet.csv: there is no column 'motor' that names the motors; the columns are m and t";
        assert_eq!(groups("m,t\n", "motor").unwrap_err(), refusal);
        assert_eq!(groups("m,t\n", "m").unwrap(), []);
    }
}
