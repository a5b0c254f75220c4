//! Tables of text: CSV in its dialects.
//!
//! ```text
//! bytes -> decompressed, decoded text -> header -> cells -> numbers
//! ```
//!
//! Recognized without options: comma, semicolon, tab or aligning spaces; a separator or a semicolon at the end of a line; quotes and
//! spaces around names and values; gzip; UTF-8, UTF-16 and Windows-1252; titles above the header, `#` and `%` comments, and a header in
//! them; a row of units below it; blank lines; a decimal comma, in quotes where the comma separates; dates and times, those of a serial
//! monitor, too. Only the wanted cells are converted to numbers, in blocks of rows on all cores.

mod block_rows;
mod blocks;
mod first_rows;
mod marks;
mod padding;
mod plain;
mod rows;
mod serial_monitor;
#[cfg(test)]
mod tests;
mod text;
mod unit_cells;
mod vesc_express;

use crate::{
    block::{Block, ColumnHead, WantedColumn},
    container::MOST_COLUMNS,
    problem::Problem,
};
pub(crate) use first_rows::{FirstCells, counts};
use fluxfit_files::{
    FileError,
    csv::{
        header::{self, Header},
        tidy::RowStyle,
    },
};
#[cfg(test)]
use std::io::Read;
pub(crate) use text::Text;

/// A table whose header is read, and whose rows are not yet.
pub(crate) struct TextTable {
    header: Header,
    text: Option<Text>,
    /// Bytes of the blocks that are read at a time.
    block_size: usize,
    /// The columns.
    pub(crate) heads: Vec<ColumnHead>,
    /// What was inferred.
    pub(crate) notes: Vec<String>,
}

impl TextTable {
    /// Reads up to the header.
    ///
    /// # Errors
    /// If the bytes cannot be read, are not text, or have no header.
    #[cfg(test)]
    pub(crate) fn open(bytes: Box<dyn Read>) -> Result<Self, FileError> {
        Self::of(Text::open(bytes)?)
    }

    /// Reads up to the header of a text.
    ///
    /// # Errors
    /// If it has no header.
    pub(crate) fn of(mut text: Text) -> Result<Self, FileError> {
        text = serial_monitor::with_times_as_cells(text);
        let mut notes = std::mem::take(&mut text.notes);
        let mut header = header::find(&text.head, &mut notes)?;
        let is_cut = text.has_rest() && header.body >= text.head.len();
        if is_cut || header.names.len() > MOST_COLUMNS {
            return Err(FileError::from(Problem::ManyColumns { most: MOST_COLUMNS }).at_line(header.line));
        }
        if header.rows != RowStyle::Plain {
            text = text.with_rows(header.rows, header.body);
        }
        text = unit_cells::without_units(text, &mut header);
        notes.append(&mut text.notes);
        if let Some(fields) = vesc_express::fields(&header.names) {
            (header.names, header.units) = fields.into_iter().map(|(name, unit)| (name, unit.unwrap_or_default())).unzip();
        }
        let mut instants = first_rows::instants(&text.head, &header);
        let unit = |place: usize| header.units.get(place).filter(|unit| !unit.is_empty()).cloned();
        let heads = header.names.iter().enumerate().map(|(place, name)| ColumnHead {
            name: name.clone(),
            unit: unit(place),
            instants: instants.get_mut(place).and_then(Option::take),
            ..ColumnHead::default()
        });
        Ok(Self { heads: heads.collect(), header, text: Some(text), block_size: blocks::BLOCK, notes })
    }

    /// What the first rows tell of each column; nothing once the rows are read.
    pub(crate) fn first_cells(&self) -> Vec<FirstCells> {
        let is_instant = |place: usize| self.heads.get(place).is_some_and(|head| head.instants.is_some());
        self.text.as_ref().map_or(Vec::new(), |text| first_rows::cells(&text.head, &self.header, is_instant))
    }

    /// The line of the header.
    pub(crate) fn line(&self) -> u64 {
        self.header.line
    }

    /// The separator of the cells, in words.
    pub(crate) fn separator(&self) -> &'static str {
        match self.header.separator {
            b';' => "semicolons",
            _ if self.header.rows == RowStyle::Aligned => "spaces",
            b'\t' => "tabs",
            _ => "commas",
        }
    }

    /// Passes the rows to `take` in blocks; can be called once. Returns what was inferred.
    ///
    /// # Errors
    /// If a row has another length, a wanted cell is not a number, or `take` fails.
    pub(crate) fn read(
        &mut self,
        wanted: &[WantedColumn],
        take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        self.text.take().map_or(Ok(Vec::new()), |text| rows::read(&self.header, text, wanted, self.block_size, take))
    }
}
