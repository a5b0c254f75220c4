//! The line of the file, or the row of a container, that each row of a log comes from: for error messages.

use fluxfit_files::FileError;

/// Line numbers of rows, stored as runs of consecutive lines.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Lines {
    /// The first row of each run, and its line.
    runs: Vec<(usize, u64)>,
    rows: usize,
    /// The numbers are rows of a container, not lines of a text.
    of_container: bool,
}

impl Lines {
    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Appends lines, which increase.
    pub(super) fn push(&mut self, lines: &[u64]) {
        let (Some(first), Some(last)) = (lines.first(), lines.last()) else { return };
        let continues = |lines: &Self, line: u64| lines.runs.last().is_some_and(|(row, first)| first + (lines.rows - row) as u64 == line);
        if last - first == lines.len() as u64 - 1 && continues(self, *first) {
            self.rows += lines.len();
            return;
        }
        for line in lines {
            if !continues(self, *line) {
                self.runs.push((self.rows, *line));
            }
            self.rows += 1;
        }
    }

    /// Appends the lines of other rows.
    pub(super) fn extend(&mut self, other: &Self) {
        self.runs.extend(other.runs.iter().map(|(row, line)| (row + self.rows, *line)));
        self.rows += other.rows;
    }

    /// The same numbers, as rows of a container or as lines of a text.
    pub(super) fn of_container(self, of_container: bool) -> Self {
        Self { of_container, ..self }
    }

    /// The error, at the line of a row.
    pub(super) fn locate(&self, error: FileError, row: usize) -> FileError {
        match self.line(row) {
            Some(number) if self.of_container => error.at_row(number),
            Some(number) => error.at_line(number),
            None => error,
        }
    }

    /// The line of a row.
    fn line(&self, row: usize) -> Option<u64> {
        let run = self.runs.partition_point(|(first, _)| *first <= row).checked_sub(1)?;
        let (first, line) = self.runs[run];
        Some(line + (row - first) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_its_line() {
        let mut lines = Lines::default();
        lines.push(&[2, 3, 4]);
        lines.push(&[5, 6]);
        lines.push(&[8, 9, 20]);
        let mut more = Lines::default();
        more.push(&[30, 31]);
        lines.extend(&more);
        assert_eq!((0..11).map(|row| lines.line(row)).collect::<Vec<_>>()[..10], [2, 3, 4, 5, 6, 8, 9, 20, 30, 31].map(Some));
        assert_eq!((lines.rows(), lines.runs.len()), (10, 4));
    }
}
