//! The rows of a table of text: its blocks are read on all cores, each for itself, and joined in order.
//!
//! What is carried from row to row, such as the decimal mark, hardly ever matters to a later block. Where it does, the block is read
//! once more, as a continuation of those before it. So neither the size of the blocks nor the number of threads changes the result.

use super::{
    block_rows::{BlockRows, Carried, Rules},
    blocks::Blocks,
    text::Text,
};
use crate::{
    block::{Block, WantedColumn},
    in_order::in_order,
    problem::Problem,
};
use fluxfit_files::{FileError, csv::header::Header};
use std::cell::RefCell;

/// Reads the wanted columns. Empty cells are missing values, NaN; so are cells of an optional column that are not numbers. Returns
/// what was inferred.
pub(super) fn read(
    header: &Header,
    text: Text,
    wanted: &[WantedColumn],
    size: usize,
    take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>,
) -> Result<Vec<String>, FileError> {
    let rules = Rules::new(header, wanted);
    let mut blocks = Blocks::new(text, header.body, header.body_line, header.separator, size);
    let mut carried = Carried::of(wanted.len());
    let mut notes = Vec::new();
    // Memory of blocks that were taken, for the next ones.
    let spare = RefCell::new(Vec::new());
    in_order(
        || {
            let (bytes, memory) = spare.borrow_mut().pop().unwrap_or_default();
            Ok(blocks.next(bytes)?.map(|text| (text, memory)))
        },
        |(text, memory)| (BlockRows::read(&rules, Carried::of(wanted.len()), &text, memory), text),
        |(mut rows, text)| {
            if carried.changes(&rows, &text) {
                rows = BlockRows::read(&rules, carried.clone(), &text, rows.block);
            }
            carried.join(&rows);
            notes.extend(rows.note);
            take(&mut rows.block)?;
            spare.borrow_mut().push((text.bytes, rows.block));
            rows.end
        },
    )?;
    if !carried.any {
        return Err(FileError::from(Problem::NoRows).at_line(header.line));
    }
    let mut block = Block::of(wanted.len());
    carried.compare_marks(wanted, &mut block);
    // Spreadsheets quote numbers with thousands separators where commas separate.
    if let Some(line) = carried.marks.unclear_comma().filter(|_| header.separator == b',') {
        return Err(FileError::from(Problem::UnclearComma).at_line(line));
    }
    if carried.marks.comma.is_some() {
        notes.push("decimal commas were read as decimal points".to_owned());
    }
    take(&mut block)?;
    Ok(notes)
}
