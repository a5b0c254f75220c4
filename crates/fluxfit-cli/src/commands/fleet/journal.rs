//! What is finished, beside the results: a line for each motor. Whoever is killed and started again reads it and goes on; a line that was
//! being written is dropped. With the results it is removed.

use super::row::{COLUMNS, Row};
use crate::error::CommandError;
use serde_json::{Value, json};
use std::{
    collections::BTreeMap,
    fs::{File, OpenOptions},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

/// The journal of a run.
#[derive(Default)]
pub(crate) struct Journal {
    /// Its path and file; none of a run whose rows are kept in memory alone.
    file: Option<(PathBuf, File)>,
    /// The rows of each motor; of a motor that is written again, the later ones.
    done: BTreeMap<String, Vec<Row>>,
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
        let mut content = Vec::new();
        file.read_to_end(&mut content)?;
        let whole = content.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let text = String::from_utf8_lossy(&content[..whole]);
        let mut lines = text.lines();
        let head = json!({ "fluxfit fleet": env!("CARGO_PKG_VERSION"), "columns": COLUMNS.len(), "words": words });
        let mut done = BTreeMap::new();
        match lines.next() {
            None => {
                file.set_len(0)?;
                file.rewind()?;
                file.write_all(format!("{head}\n").as_bytes())?;
            }
            Some(first) if serde_json::from_str::<Value>(first).is_ok_and(|first| first == head) => {
                done.extend(lines.filter_map(entry));
                file.set_len(whole as u64)?;
                file.seek(SeekFrom::End(0))?;
            }
            Some(_) => return Err(refuse("it belongs to a run with other arguments or another version; remove it to start anew")),
        }
        Ok(Self { file: Some((path, file)), done })
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
        if let Some((_, file)) = &mut self.file {
            file.write_all(format!("{}\n", json!({ "motor": motor, "rows": rows })).as_bytes())?;
        }
        self.done.insert(motor.to_owned(), rows);
        Ok(())
    }

    /// All rows, by motor and window.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &Row> {
        self.done.values().flatten()
    }

    /// Removes the journal, because the results are written, and gives all rows, by motor and window.
    ///
    /// # Errors
    /// If it cannot be removed.
    pub(crate) fn close(self) -> Result<Vec<Row>, CommandError> {
        if let Some((path, _)) = self.file {
            std::fs::remove_file(path)?;
        }
        Ok(self.done.into_values().flatten().collect())
    }
}

/// The motor and its rows of a line; `None` of a damaged one, whose motor is identified again.
fn entry(line: &str) -> Option<(String, Vec<Row>)> {
    let Value::Object(mut entry) = serde_json::from_str(line).ok()? else { return None };
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
        let journal = Journal::open(&output, &words).unwrap();
        assert_eq!((journal.motors(), journal.finished().collect::<Vec<_>>()), (2, vec!["a", "b"]));
        assert_eq!(journal.rows().cloned().collect::<Vec<_>>(), [row(1.0), row(2.0), row(0.1)]);
        drop(journal);
        assert_eq!(std::fs::read(&path).unwrap(), whole);
        assert!(Journal::open(&output, &["b.csv".to_owned()]).err().unwrap().to_string().contains("other arguments"));
        Journal::open(&output, &words).unwrap().close().unwrap();
        assert!(!path.exists());
    }
}
