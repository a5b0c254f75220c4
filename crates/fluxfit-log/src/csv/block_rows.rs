//! The rows of one block of text: the wanted cells as numbers, and the line of each row.

use super::{blocks::TextBlock, marks::Marks};
use crate::{
    block::{Block, WantedColumn},
    problem::Problem,
};
use ::csv::ByteRecord;
use fluxfit_files::{
    FileError, Problem as FileProblem,
    csv::{
        header::Header,
        record::{begin, in_memory, next, number, offset, reader, text_of, trimmed},
    },
    input::line_at,
};
use std::ops::Range;

/// How the rows of a table are read.
pub(super) struct Rules<'a> {
    pub(super) separator: u8,
    /// Number of cells of a row.
    pub(super) expected: usize,
    /// A row may have fewer.
    may_end_early: bool,
    pub(super) wanted: &'a [WantedColumn],
    /// The wanted columns in the order of the file: the index of each, and its place among the wanted ones. None if two are the same
    /// column.
    pub(super) order: Option<Vec<(usize, usize)>>,
}

/// What rows before a block mean to its own.
#[derive(Clone)]
pub(super) struct Carried {
    /// Whether any row was read.
    pub(super) any: bool,
    /// Of the columns that are needed.
    pub(super) marks: Marks,
    /// Of each wanted column that is optional.
    optional: Vec<Marks>,
    /// Optional columns that were refused.
    refused: Vec<bool>,
}

/// The rows of a block.
pub(super) struct BlockRows<'a> {
    pub(super) rules: &'a Rules<'a>,
    /// The rows up to the first error.
    pub(super) block: Block,
    pub(super) note: Option<String>,
    pub(super) end: Result<(), FileError>,
    carried: Carried,
    /// The decimal point of every wanted column was seen.
    pub(super) has_all_points: bool,
    pub(super) scratch: String,
}

/// A row with its place.
pub(super) struct Row<'a> {
    pub(super) text: &'a [u8],
    /// Its cells in the text.
    pub(super) cells: &'a [Range<usize>],
    pub(super) line: u64,
    /// The file ends within this row.
    pub(super) is_cut_off: bool,
}

/// How a row was read.
enum Reading {
    Taken,
    /// Or a comment.
    Blank,
    /// The last row, whose end is missing.
    CutOff,
}

impl<'a> Rules<'a> {
    pub(super) fn new(header: &Header, wanted: &'a [WantedColumn]) -> Self {
        let (separator, expected, may_end_early) = (header.separator, header.names.len(), header.may_end_early);
        let mut order: Vec<(usize, usize)> = wanted.iter().enumerate().map(|(place, column)| (column.index, place)).collect();
        order.sort_unstable();
        // Cells that are no numbers are not those of a usual row.
        let is_distinct = order.windows(2).all(|pair| pair[0].0 != pair[1].0) && wanted.iter().all(|column| column.instants.is_none());
        Self { separator, expected, may_end_early, wanted, order: is_distinct.then_some(order) }
    }
}

impl Carried {
    /// Before the first row.
    pub(super) fn of(columns: usize) -> Self {
        Self { any: false, marks: Marks::default(), optional: vec![Marks::default(); columns], refused: vec![false; columns] }
    }

    /// Whether rows that were read as the first ones of a table might be read otherwise after these.
    pub(super) fn changes(&self, rows: &BlockRows, text: &TextBlock) -> bool {
        let later = &rows.carried;
        let optional = || self.optional.iter().zip(&later.optional);
        // The last row may be cut off only if it is not the first.
        self.any && text.is_last
            || self.marks.and_later(&later.marks).is_mixed()
            || optional().any(|(own, later)| !own.is_mixed() && own.and_later(later).is_mixed())
    }

    /// Continues with what the rows of a block mean to later ones.
    pub(super) fn join(&mut self, rows: &BlockRows) {
        let later = &rows.carried;
        self.any |= later.any;
        self.marks = self.marks.and_later(&later.marks);
        for (own, later) in self.optional.iter_mut().zip(&later.optional) {
            *own = own.and_later(later);
        }
        for (own, later) in self.refused.iter_mut().zip(&rows.block.refused) {
            *own |= later.is_some();
        }
    }

    /// Refuses optional columns with another decimal mark than the needed ones, and adopts the mark of the others.
    pub(super) fn compare_marks(&mut self, wanted: &[WantedColumn], block: &mut Block) {
        for (place, column) in wanted.iter().enumerate().filter(|(_, column)| column.is_optional) {
            let own = &self.optional[place];
            let against = own.point.zip(self.marks.comma).or(own.comma.zip(self.marks.point));
            if let Some((line, other)) = against {
                let problem = Problem::OtherMark { other };
                block.refuse(place, FileError::from(problem).in_column(&column.header).at_line(line));
            } else if !self.refused[place] {
                self.marks = self.marks.and_later(own);
            }
        }
    }
}

impl<'a> BlockRows<'a> {
    /// Reads the rows of a block, up to the first error, into `memory`.
    pub(super) fn read(rules: &'a Rules, carried: Carried, text: &TextBlock, memory: Block) -> Self {
        let mut block = memory.emptied(rules.wanted.len());
        // A row has at least as many bytes as cells.
        let most = in_memory(text.lines + 1).min(text.bytes.len() / rules.expected.max(1) + 1);
        block.lines.reserve(most);
        block.values.iter_mut().for_each(|values| values.reserve(most));
        let mut rows = Self { rules, block, note: None, end: Ok(()), carried, has_all_points: false, scratch: String::new() };
        rows.end = if is_plain(&text.bytes) { rows.plain(text) } else { rows.records(text) };
        // Without the values of a refused row.
        let count = rows.block.lines.len();
        rows.block.values.iter_mut().for_each(|values| values.truncate(count));
        rows
    }

    /// Reads rows of any kind.
    fn records(&mut self, text: &TextBlock) -> Result<(), FileError> {
        let bytes = &text.bytes;
        let mut reader = reader(bytes, self.rules.separator);
        let mut record = ByteRecord::new();
        let mut cells = Vec::new();
        let (mut line, mut counted) = (text.line, 0);
        while next(&mut reader, &mut record)? {
            let start = begin(bytes, offset(&record));
            line += line_at(&bytes[counted..start], start - counted) - 1;
            counted = start;
            let end = in_memory(reader.position().byte());
            let is_cut_off = text.is_last && end >= bytes.len() && !bytes.ends_with(b"\n") && !bytes.ends_with(b"\r");
            cells.clear();
            cells.extend((0..record.len()).filter_map(|cell| record.range(cell)));
            self.row(&Row { text: record.as_slice(), cells: &cells, line, is_cut_off })?;
        }
        Ok(())
    }

    /// Appends a row of any kind.
    pub(super) fn row(&mut self, row: &Row) -> Result<(), FileError> {
        let line = row.line;
        match self.take(row).map_err(|error| error.at_line(line))? {
            Reading::Taken => self.taken(line),
            Reading::Blank => {}
            Reading::CutOff => self.note = Some(format!("the last line, {line}, is cut off and left out")),
        }
        Ok(())
    }

    /// Counts a row whose values were appended.
    #[inline]
    pub(super) fn taken(&mut self, line: u64) {
        self.carried.any = true;
        self.block.lines.push(line);
    }

    /// Appends the numbers of a row to the block.
    fn take(&mut self, row: &Row) -> Result<Reading, FileError> {
        let Rules { expected, may_end_early, wanted, .. } = *self.rules;
        let found = row.cells.len();
        // TwinCAT Scope writes it as the last line if it is asked to.
        if may_end_early && found == 1 && row.cell(0) == b"EOF" {
            return Ok(Reading::Blank);
        }
        // Empty cells beyond the names are trailing separators.
        if found < expected && (!may_end_early || row.is_cut_off) || (expected..found).any(|index| !row.cell(index).is_empty()) {
            if row.is_blank() || row.is_comment() {
                return Ok(Reading::Blank);
            }
            if row.is_cut_off && found < expected && self.carried.any {
                return Ok(Reading::CutOff);
            }
            let multiline = row.text.contains(&b'\n');
            return Err(FileProblem::RowLength { found, expected, multiline }.into());
        }
        let mut missing = 0;
        for (place, column) in wanted.iter().enumerate() {
            let cell = row.cell(column.index);
            let value = match &column.instants {
                Some(instants) => instants.seconds(cell),
                // A comma in a cell that commas separate was quoted: it is a decimal comma.
                None => number(cell, b';', &mut self.scratch),
            };
            let value = match value {
                Some(value) => {
                    if column.instants.is_none() {
                        self.check_mark(place, cell, row.line)?;
                    }
                    value
                }
                None if cell.is_empty() => {
                    missing += 1;
                    f64::NAN
                }
                None => {
                    let refused = not_a_number(cell, column).in_column(&column.header);
                    if row.is_cut_off && self.carried.any {
                        self.undo(place);
                        return Ok(Reading::CutOff);
                    }
                    if !column.is_optional {
                        return Err(refused);
                    }
                    self.block.refuse(place, refused.at_line(row.line));
                    f64::NAN
                }
            };
            self.block.values[place].push(value);
        }
        if missing == wanted.len() || missing > 0 && row.is_blank() {
            self.undo(wanted.len());
            return Ok(Reading::Blank);
        }
        Ok(Reading::Taken)
    }

    /// Removes the values of the current row from the first `columns`.
    fn undo(&mut self, columns: usize) {
        self.block.values[..columns].iter_mut().for_each(|values| {
            values.pop();
        });
    }

    /// Whether the decimal point of a column was seen, after which only commas matter.
    #[inline]
    pub(super) fn has_point(&self, place: usize) -> bool {
        let is_optional = self.rules.wanted[place].is_optional;
        if is_optional { self.carried.optional[place].point.is_some() } else { self.carried.marks.point.is_some() }
    }

    /// Checks that the decimal mark of a cell is that of the others. An optional column is compared with itself only, and refused alone.
    pub(super) fn check_mark(&mut self, place: usize, cell: &[u8], line: u64) -> Result<(), FileError> {
        let column = &self.rules.wanted[place];
        let own = if column.is_optional { &mut self.carried.optional[place] } else { &mut self.carried.marks };
        let Some(other) = own.conflicting(cell, line) else { return Ok(()) };
        let refused = FileError::from(Problem::DecimalMarks { text: text_of(cell), other }).in_column(&column.header);
        if column.is_optional {
            self.block.refuse(place, refused.at_line(line));
            return Ok(());
        }
        Err(refused)
    }
}

impl Row<'_> {
    fn cell(&self, index: usize) -> &[u8] {
        trimmed(self.cells.get(index).and_then(|range| self.text.get(range.clone())).unwrap_or_default())
    }

    /// Tools write them between the rows and below the last one, too.
    fn is_comment(&self) -> bool {
        trimmed(self.text).starts_with(b"#") || trimmed(self.text).starts_with(b"%")
    }

    fn is_blank(&self) -> bool {
        (0..self.cells.len()).all(|index| self.cell(index).is_empty())
    }
}

/// Whether every line of a text is a row, and its cells are what is between the separators: it has no quotation marks, and its lines
/// end with `\n` or `\r\n`.
fn is_plain(bytes: &[u8]) -> bool {
    let is_whole = |at: usize| bytes.get(at + 1) == Some(&b'\n');
    memchr::memchr(b'"', bytes).is_none() && memchr::memchr_iter(b'\r', bytes).all(is_whole)
}

/// The error for a cell that is not a number.
fn not_a_number(cell: &[u8], column: &WantedColumn) -> FileError {
    let text = text_of(cell);
    if column.instants.is_some() {
        return Problem::Instant { text }.into();
    }
    let is_grouped = text.contains(',') && text.contains('.') && text.bytes().all(|byte| byte.is_ascii_digit() || b",.+-".contains(&byte));
    match column.is_time && text.contains(':') {
        true => Problem::ClockTime { text }.into(),
        false if is_grouped => Problem::Thousands { text }.into(),
        false => FileProblem::NotANumber { text }.into(),
    }
}
