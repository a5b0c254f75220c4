//! What is finished, beside the results: a line for each motor. Whoever is killed and started again reads it and goes on; a line that was
//! being written is dropped. With the results it is removed. Rows are read again from their lines, so that the memory does not grow with
//! them.

use super::row::{COLUMNS, Row};
use crate::error::CommandError;
use serde_json::{Value, json};
use std::{
    collections::BTreeMap,
    fs::{File, OpenOptions},
    io::{BufRead, BufReader, Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

/// The journal of a run.
#[derive(Default)]
pub(crate) struct Journal {
    /// None of a run whose rows are kept in memory alone.
    lines: Option<Lines>,
    /// The rows of each motor; of a motor that is written again, the later ones.
    done: BTreeMap<String, Place>,
}

/// The file, and its length in bytes.
struct Lines {
    path: PathBuf,
    file: File,
    length: u64,
}

/// Where the rows of a motor are.
enum Place {
    Memory(Vec<Row>),
    /// Where a line of the file begins, and how long it is.
    Line(u64, usize),
}

impl Journal {
    /// Opens the journal of these results; `words` say what the run does.
    ///
    /// # Errors
    /// If it cannot be written, belongs to another run, or to one that still goes on.
    pub(crate) fn open(output: &Path, words: &[String]) -> Result<Self, CommandError> {
        let mut name = output.as_os_str().to_owned();
        name.push(".journal");
        let path = PathBuf::from(name);
        let refuse = |why: &str| CommandError::Usage(format!("{}: {why}", path.display()));
        let opened = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path);
        let mut file = opened.map_err(|error| refuse(&format!("{error}; name results that can be written")))?;
        // Where a file system has no locks, nothing tells of the other run.
        if let Err(std::fs::TryLockError::WouldBlock) = file.try_lock() {
            return Err(refuse("another run writes these results; wait for it, or name others"));
        }
        let head = json!({ "fluxfit fleet": env!("CARGO_PKG_VERSION"), "columns": COLUMNS.len(), "words": words });
        let (mut length, mut done) = (0, BTreeMap::new());
        let (mut reader, mut line) = (BufReader::new(&file), Vec::new());
        while reader.read_until(b'\n', &mut line)? > 0 && line.ends_with(b"\n") {
            if length == 0 && !serde_json::from_slice::<Value>(&line).is_ok_and(|first| first == head) {
                return Err(refuse("it belongs to a run with other arguments or another version; remove it to start anew"));
            }
            if let Some((motor, _)) = entry(&line) {
                done.insert(motor, Place::Line(length, line.len()));
            }
            length += line.len() as u64;
            line.clear();
        }
        file.set_len(length)?;
        if length == 0 {
            file.rewind()?;
            let head = format!("{head}\n");
            file.write_all(head.as_bytes())?;
            length = head.len() as u64;
        }
        Ok(Self { lines: Some(Lines { path, file, length }), done })
    }

    /// The motors that are finished.
    pub(crate) fn finished(&self) -> impl Iterator<Item = &str> {
        self.done.keys().map(String::as_str)
    }

    /// How many motors are finished.
    pub(crate) fn motors(&self) -> usize {
        self.done.len()
    }

    /// Takes the rows of a motor.
    ///
    /// # Errors
    /// If they cannot be written.
    pub(crate) fn add(&mut self, motor: &str, rows: Vec<Row>) -> Result<(), CommandError> {
        let place = match &mut self.lines {
            None => Place::Memory(rows),
            Some(lines) => {
                let line = format!("{}\n", json!({ "motor": motor, "rows": rows }));
                lines.file.seek(SeekFrom::Start(lines.length))?;
                lines.file.write_all(line.as_bytes())?;
                let start = lines.length;
                lines.length += line.len() as u64;
                Place::Line(start, line.len())
            }
        };
        self.done.insert(motor.to_owned(), place);
        Ok(())
    }

    /// Passes on all rows, by motor and window.
    ///
    /// # Errors
    /// If a line cannot be read again, and those of `take`.
    pub(crate) fn rows(&mut self, take: &mut dyn FnMut(&Row) -> Result<(), CommandError>) -> Result<(), CommandError> {
        for place in self.done.values() {
            match (place, &mut self.lines) {
                (Place::Memory(rows), _) => rows.iter().try_for_each(&mut *take)?,
                (Place::Line(start, length), Some(lines)) => lines.read(*start, *length)?.iter().try_for_each(&mut *take)?,
                (Place::Line(..), None) => (),
            }
        }
        Ok(())
    }

    /// Removes the journal, because the results are written.
    ///
    /// # Errors
    /// If it cannot be removed.
    pub(crate) fn close(self) -> Result<(), CommandError> {
        Ok(self.lines.map_or(Ok(()), |lines| std::fs::remove_file(lines.path))?)
    }
}

impl Lines {
    /// The rows of a line.
    fn read(&mut self, start: u64, length: usize) -> Result<Vec<Row>, CommandError> {
        let mut line = vec![0; length];
        self.file.seek(SeekFrom::Start(start))?;
        self.file.read_exact(&mut line)?;
        let changed = || CommandError::Usage(format!("{}: another program changed it; remove it to start anew", self.path.display()));
        entry(&line).map(|(_, rows)| rows).ok_or_else(changed)
    }
}

/// The motor and its rows of a line; `None` of a damaged one, whose motor is identified again.
fn entry(line: &[u8]) -> Option<(String, Vec<Row>)> {
    let Value::Object(mut entry) = serde_json::from_slice(line).ok()? else { return None };
    let rows = match entry.remove("rows")? {
        Value::Array(rows) => rows,
        _ => return None,
    };
    let rows = rows.into_iter().map(|row| if let Value::Object(row) = row { Some(row) } else { None });
    Some((entry.remove("motor")?.as_str()?.to_owned(), rows.collect::<Option<_>>()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(journal: &mut Journal) -> Vec<Row> {
        let mut rows = Vec::new();
        let mut take = |row: &Row| {
            rows.push(row.clone());
            Ok(())
        };
        journal.rows(&mut take).unwrap();
        rows
    }

    #[test]
    fn a_torn_line_is_dropped_and_the_rest_is_kept() {
        let directory = tempfile::tempdir().unwrap();
        let output = directory.path().join("results.csv");
        let words = ["a.csv".to_owned()];
        let row = |value: f64| json!({ "rs": value }).as_object().unwrap().clone();
        let mut journal = Journal::open(&output, &words).unwrap();
        journal.add("b", vec![row(0.1)]).unwrap();
        journal.add("a", vec![row(1.0), row(2.0)]).unwrap();
        assert!(Journal::open(&output, &words).is_err(), "another run");
        drop(journal);
        let path = directory.path().join("results.csv.journal");
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, [&whole[..], b"{\"motor\": \"c\", \"ro"].concat()).unwrap();
        let mut journal = Journal::open(&output, &words).unwrap();
        assert_eq!((journal.motors(), journal.finished().collect::<Vec<_>>()), (2, vec!["a", "b"]));
        assert_eq!(rows(&mut journal), [row(1.0), row(2.0), row(0.1)]);
        assert_eq!(std::fs::read(&path).unwrap(), whole);
        // What is added after rows were read again stands behind them, and takes the place of what the motor had.
        journal.add("c", vec![row(3.0)]).unwrap();
        journal.add("b", vec![row(4.0)]).unwrap();
        let expected = [row(1.0), row(2.0), row(4.0), row(3.0)];
        assert_eq!(rows(&mut journal), expected);
        drop(journal);
        assert!(std::fs::read(&path).unwrap().starts_with(&whole));
        assert_eq!(rows(&mut Journal::open(&output, &words).unwrap()), expected);
        assert!(Journal::open(&output, &["b.csv".to_owned()]).err().unwrap().to_string().contains("other arguments"));
        Journal::open(&output, &words).unwrap().close().unwrap();
        assert!(!path.exists());
    }
}
