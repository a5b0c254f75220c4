//! The rows: the wanted cells of each as numbers, and the line that it stands in.

use super::text::Text;
use crate::{
    block::{Block, Wanted},
    problem::Problem,
};
use ::csv::ByteRecord;
use fluxfit_files::{
    FileError, Problem as FileProblem,
    csv::{
        header::Header,
        record::{begin, lossy, next, number, offset, place, reader, trimmed},
    },
    input::line_at,
};

/// Rows of a block that is handed on.
const BLOCK_ROWS: usize = 1 << 13;

/// The rows on their way: what is carried from one to the next.
struct Rows<'a> {
    header: &'a Header,
    wanted: &'a [Wanted],
    block: Block,
    any: bool,
    marks: Marks,
    optional: Vec<Marks>,
    scratch: String,
}

/// A row on its way from cells to numbers.
struct Row<'a> {
    record: &'a ByteRecord,
    line: u64,
    separator: u8,
    /// The file ends within it.
    cut: bool,
}

/// Lines of rows with a decimal point and with a decimal comma.
#[derive(Default, Clone)]
struct Marks {
    point: Option<u64>,
    comma: Option<u64>,
}

/// What becomes of a row.
enum Outcome {
    Taken,
    Blank,
    /// The last one, whose end is missing.
    CutOff,
}

/// Reads the wanted columns. Missing values, which are empty cells, are NaN; of a dispensable column, so is what is no number.
/// Returns what had to be inferred.
pub(super) fn read(
    header: &Header,
    text: Text,
    wanted: &[Wanted],
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
    /// The rows of a block of text.
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
            let end = place(reader.position().byte());
            let cut = is_last && end >= bytes.len() && !bytes.ends_with(b"\n") && !bytes.ends_with(b"\r");
            let row = Row { record: &record, line, separator: self.header.separator, cut };
            match self.take(&row).map_err(|error| error.at_line(line))? {
                Outcome::Taken => {
                    self.any = true;
                    self.block.lines.push(line);
                }
                Outcome::Blank => {}
                Outcome::CutOff => notes.push(format!("line {line}, the last one, is cut off and left out")),
            }
            if self.block.lines.len() == BLOCK_ROWS {
                take(std::mem::replace(&mut self.block, Block::of(self.wanted.len())))?;
            }
        }
        Ok(())
    }

    /// The row's numbers, appended to the block.
    fn take(&mut self, row: &Row) -> Result<Outcome, FileError> {
        let expected = self.header.names.len();
        let found = row.record.len();
        // More cells than names are trailing separators, as long as they are empty.
        if found < expected || row.record.iter().skip(expected).any(|cell| !trimmed(cell).is_empty()) {
            if row.is_blank() {
                return Ok(Outcome::Blank);
            }
            if row.cut && found < expected && self.any {
                return Ok(Outcome::CutOff);
            }
            let multiline = row.record.as_slice().contains(&b'\n');
            return Err(FileProblem::RowLength { found, expected, multiline }.into());
        }
        let mut missing = 0;
        for (place, column) in self.wanted.iter().enumerate() {
            let cell = row.cell(column.index);
            let value = match number(cell, row.separator, &mut self.scratch) {
                Some(value) => {
                    self.agree(place, cell, row)?;
                    value
                }
                None if cell.is_empty() => {
                    missing += 1;
                    f64::NAN
                }
                None => {
                    let refused = refusal(cell, column.is_time).in_column(&column.header);
                    if row.cut && self.any {
                        self.undo(place);
                        return Ok(Outcome::CutOff);
                    }
                    if !column.dispensable {
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
            return Ok(Outcome::Blank);
        }
        Ok(Outcome::Taken)
    }

    /// Refuses dispensable columns whose decimal mark is not that of the others; takes over the mark of the rest.
    fn compare_marks(&mut self) {
        for (place, column) in self.wanted.iter().enumerate().filter(|(_, column)| column.dispensable) {
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

    /// Takes back the values of a row that does not count, in the first `columns`.
    fn undo(&mut self, columns: usize) {
        self.block.values[..columns].iter_mut().for_each(|values| {
            values.pop();
        });
    }

    /// Takes note of the cell's decimal mark. One mark throughout: else the 1,234 of a file with decimal points would be 1.234. A
    /// column that may be left out answers for itself.
    fn agree(&mut self, place: usize, cell: &[u8], row: &Row) -> Result<(), FileError> {
        if row.separator == b',' {
            return Ok(());
        }
        let column = &self.wanted[place];
        let own = if column.dispensable { &mut self.optional[place] } else { &mut self.marks };
        let Some(other) = own.disagree(cell, row.line) else { return Ok(()) };
        let refused = FileError::from(Problem::DecimalMarks { text: lossy(cell), other }).in_column(&column.header);
        if column.dispensable {
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

fn refusal(cell: &[u8], is_time: bool) -> FileError {
    let text = lossy(cell);
    let is_grouped = text.contains(',') && text.contains('.') && text.bytes().all(|byte| byte.is_ascii_digit() || b",.+-".contains(&byte));
    match is_time && text.contains(':') {
        true => Problem::ClockTime { text }.into(),
        false if is_grouped => Problem::Thousands { text }.into(),
        false => FileProblem::NotANumber { text }.into(),
    }
}

impl Marks {
    /// Takes note of the cell's decimal mark; the line of a row with the other mark, if there is one.
    #[inline]
    fn disagree(&mut self, cell: &[u8], line: u64) -> Option<u64> {
        // Once points are the rule only a comma matters, and the other way around.
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
