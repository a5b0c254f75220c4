//! A table of text.
//!
//! ```text
//! bytes -> unpacked, decoded text -> header -> cells -> numbers
//! ```
//!
//! Read without being told: comma, semicolon or tab, also at the end of a line; quotes and spaces around names and values; gzip;
//! UTF-8, UTF-16 and Windows-1252; titles above the header and `#` and `%` comments; a row of units below it; blank lines; a decimal
//! comma, unless the comma separates. Of a log of millions of rows only the wanted cells become numbers, a block at a time.

mod rows;
mod text;

use crate::block::{Block, Head, Wanted};
use fluxfit_files::{
    FileError,
    csv::header::{self, Header},
};
use std::io::Read;
use text::Text;

/// A table whose header is read and whose rows are not.
pub(crate) struct TextTable {
    header: Header,
    text: Option<Text>,
    /// Its columns.
    pub(crate) heads: Vec<Head>,
    /// What had to be inferred.
    pub(crate) notes: Vec<String>,
}

impl TextTable {
    /// Reads as far as the header.
    ///
    /// # Errors
    /// If it cannot be read, is no text, or has no header.
    pub(crate) fn open(raw: Box<dyn Read>) -> Result<Self, FileError> {
        let mut text = Text::open(raw)?;
        let mut notes = std::mem::take(&mut text.notes);
        let header = header::find(&text.head, &mut notes)?;
        let unit = |place: usize| header.units.get(place).filter(|unit| !unit.is_empty()).cloned();
        let heads = header.names.iter().enumerate().map(|(place, name)| Head {
            name: name.clone(),
            unit: unit(place),
            rows: 0,
            group: 0,
            is_time: false,
        });
        Ok(Self { heads: heads.collect(), header, text: Some(text), notes })
    }

    /// The line of the header.
    pub(crate) fn line(&self) -> u64 {
        self.header.line
    }

    /// What separates the cells, in words.
    pub(crate) fn separator(&self) -> &'static str {
        match self.header.separator {
            b';' => "semicolons",
            b'\t' => "tabs",
            _ => "commas",
        }
    }

    /// The rows, in blocks, once; what had to be inferred.
    ///
    /// # Errors
    /// If a row is of another length, or a wanted cell is no number; those of `take`.
    pub(crate) fn read(
        &mut self,
        wanted: &[Wanted],
        take: &mut dyn FnMut(Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        self.text.take().map_or(Ok(Vec::new()), |text| rows::read(&self.header, text, wanted, take))
    }
}
