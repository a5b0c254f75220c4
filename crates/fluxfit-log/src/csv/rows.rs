//! The rows of a table of text: its blocks are read on all cores, each for itself, and joined in order.
//!
//! What is carried from row to row, such as the decimal mark, hardly ever matters to a later block. Where it does, the block is read
//! once more, as a continuation of those before it. So neither the size of the blocks nor the number of threads changes the result.

use super::{
    blocks::{Blocks, TextBlock},
    block_rows::{BlockRows, Carried, Rules},
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
    take: &mut dyn FnMut(Block) -> Result<(), FileError>,
) -> Result<Vec<String>, FileError> {
    let rules = Rules::new(header.separator, header.names.len(), wanted);
    let mut blocks = Blocks::new(text, header.body, header.body_line, header.separator, size);
    let mut carried = Carried::of(wanted.len());
    let mut notes = Vec::new();
    // Memory of blocks that were read.
    let spare = RefCell::new(Vec::new());
    in_order(
        || blocks.next(spare.borrow_mut().pop().unwrap_or_default()),
        |text| (BlockRows::read(&rules, Carried::of(wanted.len()), &text), text),
        |(rows, text): (BlockRows, TextBlock)| {
            let rows = if carried.changes(&rows, &text) { BlockRows::read(&rules, carried.clone(), &text) } else { rows };
            carried.join(&rows);
            notes.extend(rows.note);
            spare.borrow_mut().push(text.bytes);
            take(rows.block)?;
            rows.end
        },
    )?;
    if !carried.any {
        return Err(FileError::from(Problem::NoRows).at_line(header.line));
    }
    let mut block = Block::of(wanted.len());
    carried.compare_marks(wanted, &mut block);
    if carried.marks.comma.is_some() {
        notes.push("decimal commas were read as decimal points".to_owned());
    }
    take(block)?;
    Ok(notes)
}
