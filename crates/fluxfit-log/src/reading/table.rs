//! A table, whatever it came in: named columns, and their values in blocks of rows.

use crate::block::{Block, Head, Wanted};
use crate::{
    container::{self, Binary, Source},
    csv::TextTable,
};
use bytes::Bytes;
use fluxfit_files::{
    FileError,
    input::{Raw, Watched, io_problem},
};
use std::io::{Cursor, Read, Seek};

/// What a table came in.
pub(crate) enum Table {
    Text(TextTable),
    Binary(Binary),
}

/// Bytes that tell a container.
const START: u64 = 1024;

impl Table {
    /// Reads as far as the names of the columns.
    ///
    /// # Errors
    /// If it cannot be read, or has none.
    pub(crate) fn open(raw: Raw) -> Result<Self, FileError> {
        let failed = |error: std::io::Error| FileError::from(io_problem("reading", &error));
        match raw {
            Raw::File(mut file, watch) => match Binary::open(Source::file(file.try_clone().map_err(failed)?)?)? {
                Some(binary) => Ok(Self::Binary(binary)),
                None => {
                    file.rewind().map_err(failed)?;
                    TextTable::open(Box::new(Watched { file, watch })).map(Self::Text)
                }
            },
            Raw::Stream(mut stream) => {
                let mut start = Vec::new();
                (&mut stream).take(START).read_to_end(&mut start).map_err(failed)?;
                if !container::is_told_by(&start) {
                    return TextTable::open(Box::new(Cursor::new(start).chain(stream))).map(Self::Text);
                }
                stream.read_to_end(&mut start).map_err(failed)?;
                let bytes = Bytes::from(start);
                match Binary::open(Source::memory(bytes.clone()))? {
                    Some(binary) => Ok(Self::Binary(binary)),
                    None => TextTable::open(Box::new(Cursor::new(bytes))).map(Self::Text),
                }
            }
        }
    }

    pub(crate) fn heads(&self) -> &[Head] {
        match self {
            Self::Text(table) => &table.heads,
            Self::Binary(table) => table.heads(),
        }
    }

    /// Columns that hold no numbers, where the container says so.
    pub(crate) fn unreadable(&self) -> &[String] {
        match self {
            Self::Text(_) => &[],
            Self::Binary(table) => table.unreadable(),
        }
    }

    /// What had to be inferred so far.
    pub(crate) fn notes(&self) -> &[String] {
        match self {
            Self::Text(table) => &table.notes,
            Self::Binary(_) => &[],
        }
    }

    /// The line with the names, in a file of text.
    pub(crate) fn line(&self) -> Option<u64> {
        match self {
            Self::Text(table) => Some(table.line()),
            Self::Binary(_) => None,
        }
    }

    /// What it is, in a few words.
    pub(crate) fn kind(&self) -> String {
        match self {
            Self::Text(table) => format!("text, separated by {}", table.separator()),
            Self::Binary(table) => table.kind().to_owned(),
        }
    }

    /// Values of columns of one group; what had to be inferred.
    ///
    /// # Errors
    /// Those of reading, and of `take`.
    pub(crate) fn read(
        &mut self,
        wanted: &[Wanted],
        take: &mut dyn FnMut(Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        match self {
            Self::Text(table) => table.read(wanted, take),
            Self::Binary(table) => {
                let columns: Vec<usize> = wanted.iter().map(|column| column.index).collect();
                let mut row = 0;
                table.read(&columns, &mut |values| {
                    let rows = values.first().map_or(0, |column| column.len() as u64);
                    let lines = (row + 1..=row + rows).collect();
                    row += rows;
                    take(Block { values, lines, refused: vec![None; columns.len()] })
                })?;
                Ok(Vec::new())
            }
        }
    }
}
