//! A table, whatever its format: named columns, and their values in blocks of rows.

use crate::{
    block::{Block, ColumnHead, WantedColumn},
    container::{self, Binary, RandomAccess},
    csv::{FirstCells, Text, TextTable},
    file_part::{FilePart, PartRows},
    memory_table::Held,
    problem::Problem,
    records::Records,
};
use fluxfit_files::{
    FileError,
    input::{Bytes, Reporting, io_problem},
};
use std::io::{Cursor, Read, Seek};

/// A table of text or of another format.
pub(super) enum Table<'a> {
    Text(TextTable),
    Records(Records),
    Binary(Binary),
    Held(Held<'a>),
}

/// Bytes at the beginning of a file by which its format is recognized.
const START: u64 = 1024;

impl Table<'_> {
    /// Reads up to the names of the columns.
    ///
    /// # Errors
    /// If the bytes cannot be read, or have no names of columns.
    pub(super) fn open(bytes: Bytes, dbc: Option<&str>) -> Result<Table<'static>, FileError> {
        let failed = |error: std::io::Error| FileError::from(io_problem("reading", &error));
        match bytes {
            Bytes::File(mut file, progress) => match Binary::open(RandomAccess::file(file.try_clone().map_err(failed)?)?)? {
                Some(binary) => Ok(Table::Binary(binary)),
                None => {
                    file.rewind().map_err(failed)?;
                    Self::of_text(Box::new(Reporting { file, progress }), dbc)
                }
            },
            Bytes::Stream(mut stream) => {
                let mut start = Vec::new();
                (&mut stream).take(START).read_to_end(&mut start).map_err(failed)?;
                if !container::is_container(&start) {
                    return Self::of_text(Box::new(Cursor::new(start).chain(stream)), dbc);
                }
                stream.read_to_end(&mut start).map_err(failed)?;
                let content = bytes::Bytes::from(start);
                match Binary::open(RandomAccess::memory(content.clone()))? {
                    Some(binary) => Ok(Table::Binary(binary)),
                    None => Self::of_text(Box::new(Cursor::new(content)), dbc),
                }
            }
        }
    }

    /// Some rows of a file.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub(super) fn of_part(part: &FilePart, dbc: Option<&str>) -> Result<Table<'static>, FileError> {
        match &part.rows {
            PartRows::Parquet { rows, without } => Binary::part_of_parquet(part.file.clone(), rows.clone(), without).map(Table::Binary),
            PartRows::Text { header, bytes } => {
                let lines = part.file.range(bytes.start, bytes.end);
                Self::open(Bytes::Stream(Box::new(Cursor::new(header.clone()).chain(lines))), dbc)
            }
        }
    }

    /// A table of text, of which the beginning is known.
    pub(super) fn beginning(text: Text) -> Result<Table<'static>, FileError> {
        TextTable::of(text).map(Table::Text)
    }

    fn of_text(bytes: Box<dyn Read>, dbc: Option<&str>) -> Result<Table<'static>, FileError> {
        let text = Text::open(bytes)?;
        if Records::has(&text)? { Records::open(text, dbc).map(Table::Records) } else { TextTable::of(text).map(Table::Text) }
    }

    /// The columns.
    pub(super) fn heads(&self) -> &[ColumnHead] {
        match self {
            Self::Text(table) => &table.heads,
            Self::Records(records) => records.heads(),
            Self::Binary(table) => table.heads(),
            Self::Held(held) => &held.heads,
        }
    }

    /// Names of columns that hold no numbers, where the format states it.
    pub(super) fn unreadable(&self) -> &[String] {
        match self {
            Self::Text(_) => &[],
            Self::Records(records) => records.unreadable(),
            Self::Binary(table) => table.unreadable(),
            Self::Held(held) => &held.table.unreadable,
        }
    }

    /// Names of columns that hold a list in each row, where the format states it.
    pub(super) fn lists(&self) -> &[String] {
        match self {
            Self::Binary(table) => table.lists(),
            _ => &[],
        }
    }

    /// What the first rows of a text tell of each column; nothing of another format. They are looked at only when this is asked for.
    pub(super) fn first_cells(&self) -> Vec<FirstCells> {
        match self {
            Self::Text(table) => table.first_cells(),
            _ => Vec::new(),
        }
    }

    /// Why the log itself cannot be read, if it seems to be in a part of the file that cannot.
    pub(super) fn passed_over(&self) -> Option<&Problem> {
        match self {
            Self::Binary(table) => table.passed_over(),
            _ => None,
        }
    }

    /// What was inferred so far.
    pub(super) fn notes(&self) -> &[String] {
        match self {
            Self::Text(table) => &table.notes,
            Self::Records(records) => records.notes(),
            Self::Binary(_) | Self::Held(_) => &[],
        }
    }

    /// The line of the header, in a file of text.
    pub(super) fn line(&self) -> Option<u64> {
        match self {
            Self::Text(table) => Some(table.line()),
            Self::Records(_) | Self::Binary(_) | Self::Held(_) => None,
        }
    }

    /// The format, in a few words.
    pub(super) fn kind(&self) -> String {
        match self {
            Self::Records(records) => records.kind().to_owned(),
            Self::Text(table) => format!("text, separated by {}", table.separator()),
            Self::Binary(table) => table.kind().to_owned(),
            Self::Held(_) => "a table in memory".to_owned(),
        }
    }

    /// Reads columns of one group and passes blocks of their values to `take`. Returns what was inferred.
    ///
    /// # Errors
    /// If reading or `take` fails.
    pub(super) fn read(
        &mut self,
        wanted: &[WantedColumn],
        take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        match self {
            Self::Text(table) => table.read(wanted, take),
            Self::Records(records) => records.read(wanted, take),
            Self::Held(held) => held.read(wanted, take).map(|()| Vec::new()),
            Self::Binary(table) => {
                let columns: Vec<usize> = wanted.iter().map(|column| column.index).collect();
                let mut row = 0;
                table.read(&columns, &mut |values| {
                    let rows = values.first().map_or(0, |column| column.len() as u64);
                    let lines = (row + 1..=row + rows).collect();
                    row += rows;
                    take(&mut Block { values, lines, refused: vec![None; columns.len()] })
                })?;
                Ok(Vec::new())
            }
        }
    }
}
