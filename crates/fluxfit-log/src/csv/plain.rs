//! Rows of plain text, the usual ones: each line is a row, and the wanted cells are numbers or empty. Any other row is left to the way in
//! which rows of any kind are read, which also states what is wrong with it. Both give the same.

use super::{
    block_rows::{BlockRows, Row},
    blocks::TextBlock,
};
use fluxfit_files::{
    FileError,
    csv::record::{leading_number, number, trimmed},
};
use std::ops::Range;

/// What is needed for each row, kept to avoid allocations.
struct Line<'a> {
    text: &'a [u8],
    number: u64,
    /// The wanted cells that were read, by their place.
    cells: &'a mut [Range<usize>],
}

impl BlockRows<'_> {
    /// Reads the rows of a plain text.
    pub(super) fn plain(&mut self, text: &TextBlock) -> Result<(), FileError> {
        let bytes = text.bytes.as_slice();
        let mut wanted = vec![0..0; self.rules.wanted.len()];
        let mut all = Vec::new();
        let (mut start, mut line) = (0, text.line);
        while start < bytes.len() {
            let newline = memchr::memchr(b'\n', &bytes[start..]).map(|at| start + at);
            let end = newline.unwrap_or(bytes.len());
            let row = &bytes[start..end];
            let row = if newline.is_some() { row.strip_suffix(b"\r").unwrap_or(row) } else { row };
            if !row.is_empty() && !self.usual(&mut Line { text: row, number: line, cells: &mut wanted })? {
                all.clear();
                split(row, self.rules.separator, &mut all);
                self.row(&Row { text: row, cells: &all, line, is_cut_off: text.is_last && newline.is_none() })?;
            }
            start = end + 1;
            line += 1;
        }
        Ok(())
    }

    /// Appends a usual row; false if it is none.
    #[inline]
    fn usual(&mut self, line: &mut Line) -> Result<bool, FileError> {
        let rules = self.rules;
        let Some(order) = &rules.order else { return Ok(false) };
        let (text, separator) = (line.text, rules.separator);
        let (mut start, mut index, mut missing) = (0, 0, 0);
        for (done, &(wanted, place)) in order.iter().enumerate() {
            // To the beginning of the wanted cell.
            while index < wanted {
                let Some(at) = memchr::memchr(separator, &text[start..]) else { return self.leave(done) };
                start += at + 1;
                index += 1;
            }
            let (value, end) = match leading_number(&text[start..]) {
                Some((value, length)) if text.get(start + length).is_none_or(|byte| *byte == separator) => (value, start + length),
                _ => {
                    let end = memchr::memchr(separator, &text[start..]).map_or(text.len(), |at| start + at);
                    let cell = trimmed(&text[start..end]);
                    missing += usize::from(cell.is_empty());
                    let value = if cell.is_empty() { Some(f64::NAN) } else { number(cell, separator, &mut self.scratch) };
                    let Some(value) = value else { return self.leave(done) };
                    (value, end)
                }
            };
            self.block.values[place].push(value);
            line.cells[place] = start..end;
            // The next cell begins after the separator; there is none at the end of the row.
            if end == text.len() {
                let is_whole = done + 1 == order.len() && wanted + 1 == rules.expected;
                return if is_whole && missing < order.len() { self.accept(line) } else { self.leave(done + 1) };
            }
            start = end + 1;
            index = wanted + 1;
        }
        // The cells that are not wanted, and empty ones beyond the names.
        let found = index + 1 + memchr::memchr_iter(separator, &text[start..]).count();
        let extra = found.saturating_sub(rules.expected);
        let is_whole = found >= rules.expected && text.iter().rev().take(extra).all(|byte| *byte == separator);
        if is_whole && missing < order.len() { self.accept(line) } else { self.leave(order.len()) }
    }

    /// Takes the row whose values were appended.
    #[inline]
    fn accept(&mut self, line: &Line) -> Result<bool, FileError> {
        // No comma is left between commas: there only the first point of each column is of interest.
        let may_have_comma = self.rules.separator != b',';
        if may_have_comma || !self.has_all_points {
            for (place, cell) in line.cells.iter().enumerate() {
                let cell = trimmed(&line.text[cell.clone()]);
                if !cell.is_empty() && (!self.has_point(place) || cell.contains(&b',')) {
                    self.check_mark(place, cell, line.number).map_err(|error| error.at_line(line.number))?;
                }
            }
            self.has_all_points = !may_have_comma && (0..line.cells.len()).all(|place| self.has_point(place));
        }
        self.taken(line.number);
        Ok(true)
    }

    /// Removes the values of the first `done` columns of the current row, which is not a usual one.
    #[cold]
    fn leave(&mut self, done: usize) -> Result<bool, FileError> {
        for (_, place) in self.rules.order.iter().flatten().take(done) {
            self.block.values[*place].pop();
        }
        Ok(false)
    }
}

/// The cells of a row.
fn split(row: &[u8], separator: u8, cells: &mut Vec<Range<usize>>) {
    let mut start = 0;
    for end in memchr::memchr_iter(separator, row).chain([row.len()]) {
        cells.push(start..end);
        start = end + 1;
    }
}
