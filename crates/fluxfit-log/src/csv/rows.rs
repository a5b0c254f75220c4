//! The rows of a table of text: the wanted cells as numbers, and the line of each row.

use super::text::Text;
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

/// Rows of a block.
const BLOCK_ROWS: usize = 1 << 13;

/// The state of reading: what is carried from row to row.
struct Rows<'a> {
    header: &'a Header,
    wanted: &'a [WantedColumn],
    block: Block,
    /// Whether any row was read.
    any: bool,
    marks: Marks,
    optional: Vec<Marks>,
    scratch: String,
}

/// A record with its place.
struct Row<'a> {
    record: &'a ByteRecord,
    line: u64,
    separator: u8,
    /// The file ends within this row.
    is_cut_off: bool,
}

/// The first lines with a decimal point and with a decimal comma.
#[derive(Default, Clone)]
struct Marks {
    point: Option<u64>,
    comma: Option<u64>,
}

/// How a record was read.
enum Reading {
    Taken,
    Blank,
    /// The last row, whose end is missing.
    CutOff,
}

/// Reads the wanted columns. Empty cells are missing values, NaN; so are cells of an optional column that are not numbers. Returns
/// what was inferred.
pub(super) fn read(
    header: &Header,
    text: Text,
    wanted: &[WantedColumn],
    take: &mut dyn FnMut(Block) -> Result<(), FileError>,
) -> Result<Vec<String>, FileError> {
    let mut rows = Rows {
        header,
        wanted,
        block: Block::of(wanted.len()),
        any: false,
        marks: Marks::default(),
        optional: vec![Marks::default(); wanted.len()],
        scratch: String::new(),
    };
    let mut notes = Vec::new();
    text.blocks(header.body, header.body_line, |bytes, line, is_last| rows.read(bytes, line, is_last, &mut notes, take))?;
    if !rows.any {
        return Err(FileError::from(Problem::NoRows).at_line(header.line));
    }
    rows.compare_marks();
    if rows.marks.comma.is_some() {
        notes.push("decimal commas were read as decimal points".to_owned());
    }
    take(std::mem::take(&mut rows.block))?;
    Ok(notes)
}

impl Rows<'_> {
    /// Reads the rows of a block of text.
    fn read(
        &mut self,
        bytes: &[u8],
        first_line: u64,
        is_last: bool,
        notes: &mut Vec<String>,
        take: &mut dyn FnMut(Block) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let mut reader = reader(bytes, self.header.separator);
        let mut record = ByteRecord::new();
        let (mut line, mut counted) = (first_line, 0);
        while next(&mut reader, &mut record)? {
            let start = begin(bytes, offset(&record));
            line += line_at(&bytes[counted..start], start - counted) - 1;
            counted = start;
            let end = in_memory(reader.position().byte());
            let is_cut_off = is_last && end >= bytes.len() && !bytes.ends_with(b"\n") && !bytes.ends_with(b"\r");
            let row = Row { record: &record, line, separator: self.header.separator, is_cut_off };
            match self.take(&row).map_err(|error| error.at_line(line))? {
                Reading::Taken => {
                    self.any = true;
                    self.block.lines.push(line);
                }
                Reading::Blank => {}
                Reading::CutOff => notes.push(format!("the last line, {line}, is cut off and left out")),
            }
            if self.block.lines.len() == BLOCK_ROWS {
                take(std::mem::replace(&mut self.block, Block::of(self.wanted.len())))?;
            }
        }
        Ok(())
    }

    /// Appends the numbers of a row to the block.
    fn take(&mut self, row: &Row) -> Result<Reading, FileError> {
        let expected = self.header.names.len();
        let found = row.record.len();
        // Empty cells beyond the names are trailing separators.
        if found < expected || row.record.iter().skip(expected).any(|cell| !trimmed(cell).is_empty()) {
            if row.is_blank() {
                return Ok(Reading::Blank);
            }
            if row.is_cut_off && found < expected && self.any {
                return Ok(Reading::CutOff);
            }
            let multiline = row.record.as_slice().contains(&b'\n');
            return Err(FileProblem::RowLength { found, expected, multiline }.into());
        }
        let mut missing = 0;
        for (place, column) in self.wanted.iter().enumerate() {
            let cell = row.cell(column.index);
            let value = match number(cell, row.separator, &mut self.scratch) {
                Some(value) => {
                    self.check_mark(place, cell, row)?;
                    value
                }
                None if cell.is_empty() => {
                    missing += 1;
                    f64::NAN
                }
                None => {
                    let refused = not_a_number(cell, column.is_time).in_column(&column.header);
                    if row.is_cut_off && self.any {
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
        if missing == self.wanted.len() || missing > 0 && row.is_blank() {
            self.undo(self.wanted.len());
            return Ok(Reading::Blank);
        }
        Ok(Reading::Taken)
    }

    /// Refuses optional columns with another decimal mark than the needed ones, and adopts the mark of the others.
    fn compare_marks(&mut self) {
        for (place, column) in self.wanted.iter().enumerate().filter(|(_, column)| column.is_optional) {
            let own = &self.optional[place];
            let against = own.point.zip(self.marks.comma).or(own.comma.zip(self.marks.point));
            if let Some((line, other)) = against {
                let problem = Problem::OtherMark { other };
                self.block.refuse(place, FileError::from(problem).in_column(&column.header).at_line(line));
            } else if self.block.refused[place].is_none() {
                self.marks.comma = self.marks.comma.or(own.comma);
                self.marks.point = self.marks.point.or(own.point);
            }
        }
    }

    /// Removes the values of the current row from the first `columns`.
    fn undo(&mut self, columns: usize) {
        self.block.values[..columns].iter_mut().for_each(|values| {
            values.pop();
        });
    }

    /// Checks that the decimal mark of a cell is that of the others: otherwise the 1,234 of a file with decimal points would be read as
    /// 1.234. An optional column is compared with itself only, and refused alone.
    fn check_mark(&mut self, place: usize, cell: &[u8], row: &Row) -> Result<(), FileError> {
        if row.separator == b',' {
            return Ok(());
        }
        let column = &self.wanted[place];
        let own = if column.is_optional { &mut self.optional[place] } else { &mut self.marks };
        let Some(other) = own.conflicting(cell, row.line) else { return Ok(()) };
        let refused = FileError::from(Problem::DecimalMarks { text: text_of(cell), other }).in_column(&column.header);
        if column.is_optional {
            self.block.refuse(place, refused.at_line(row.line));
            return Ok(());
        }
        Err(refused)
    }
}

impl Row<'_> {
    fn cell(&self, index: usize) -> &[u8] {
        trimmed(self.record.get(index).unwrap_or_default())
    }

    fn is_blank(&self) -> bool {
        self.record.iter().all(|cell| trimmed(cell).is_empty())
    }
}

/// The error for a cell that is not a number.
fn not_a_number(cell: &[u8], is_time: bool) -> FileError {
    let text = text_of(cell);
    let is_grouped = text.contains(',') && text.contains('.') && text.bytes().all(|byte| byte.is_ascii_digit() || b",.+-".contains(&byte));
    match is_time && text.contains(':') {
        true => Problem::ClockTime { text }.into(),
        false if is_grouped => Problem::Thousands { text }.into(),
        false => FileProblem::NotANumber { text }.into(),
    }
}

impl Marks {
    /// Records the decimal mark of a cell, and returns the line of a row with the other mark, if there is one.
    #[inline]
    fn conflicting(&mut self, cell: &[u8], line: u64) -> Option<u64> {
        // After the first point only commas matter, and vice versa.
        let has_comma = cell.contains(&b',');
        if has_comma {
            self.comma.get_or_insert(line);
        } else if self.point.is_none() && cell.contains(&b'.') {
            self.point = Some(line);
        }
        let (point, comma) = (self.point?, self.comma?);
        Some(if has_comma { point } else { comma })
    }
}
