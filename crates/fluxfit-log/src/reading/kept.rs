//! The rows that are kept: all of them up to a number; beyond it, the stretches that differ most.
//!
//! Twenty million rows do not tell a motor better than half a million do: what limits the answer then is not noise. But they may
//! hold operating points that the first half million do not. So rows are kept in stretches, and where there are too many, of the
//! two stretches that are most alike, in the means and the spreads of their currents and speed, the later one goes. Nothing that
//! is fitted decides it, so nothing is biased by it.

use crate::block::Block;
use fluxfit_files::FileError;

/// Rows of a stretch: some tenths of a second of a drive, long enough for a steady window.
const STRETCH: usize = 1 << 12;

/// Rows that are kept: with what a fit of them takes, some 220 MB.
pub(super) const MOST_ROWS: usize = 1 << 19;

/// Numbers that tell stretches apart, of a stretch's columns.
pub(super) type Features = Box<dyn Fn(&[Vec<f64>]) -> Vec<f64>>;

/// Rows on their way into a log.
pub(super) struct Kept {
    most: usize,
    telling: Features,
    stretches: Vec<Stretch>,
    columns: usize,
    rows: u64,
}

/// Rows that follow each other.
#[derive(Debug)]
struct Stretch {
    values: Vec<Vec<f64>>,
    lines: Lines,
    /// What tells it from others, once it is full.
    features: Vec<f64>,
}

/// Lines of rows: those that follow each other are one run.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Lines {
    /// The first row of a run, and its line.
    runs: Vec<(usize, u64)>,
    rows: usize,
    /// They are rows of a container, not lines of a text.
    of_container: bool,
}

impl Lines {
    /// Takes lines, which only grow.
    fn push(&mut self, lines: &[u64]) {
        let (Some(first), Some(last)) = (lines.first(), lines.last()) else { return };
        let follows = |lines: &Self, line: u64| lines.runs.last().is_some_and(|(row, first)| first + (lines.rows - row) as u64 == line);
        if last - first == lines.len() as u64 - 1 && follows(self, *first) {
            self.rows += lines.len();
            return;
        }
        for line in lines {
            if !follows(self, *line) {
                self.runs.push((self.rows, *line));
            }
            self.rows += 1;
        }
    }

    fn extend(&mut self, other: &Self) {
        self.runs.extend(other.runs.iter().map(|(row, line)| (row + self.rows, *line)));
        self.rows += other.rows;
    }

    /// The error, at the place of a row.
    pub(super) fn place(&self, error: FileError, row: usize) -> FileError {
        match self.of(row) {
            Some(place) if self.of_container => error.at_row(place),
            Some(place) => error.at_line(place),
            None => error,
        }
    }

    /// The same, of a container or of a text.
    pub(super) fn counting_rows(self, of_container: bool) -> Self {
        Self { of_container, ..self }
    }

    /// The line of a row.
    fn of(&self, row: usize) -> Option<u64> {
        let run = self.runs.partition_point(|(first, _)| *first <= row).checked_sub(1)?;
        let (first, line) = self.runs[run];
        Some(line + (row - first) as u64)
    }
}

impl Kept {
    pub(super) fn new(columns: usize, telling: Features, most: usize) -> Self {
        Self { most, telling, stretches: Vec::new(), columns, rows: 0 }
    }

    /// Takes rows.
    pub(super) fn push(&mut self, block: &Block) {
        let mut from = 0;
        while from < block.lines.len() {
            if self.stretches.last().is_none_or(|stretch| stretch.lines.rows == STRETCH) {
                self.make_room();
                self.stretches.push(Stretch { values: vec![Vec::new(); self.columns], lines: Lines::default(), features: Vec::new() });
            }
            let Some(stretch) = self.stretches.last_mut() else { return };
            let to = block.lines.len().min(from + STRETCH - stretch.lines.rows);
            for (values, more) in stretch.values.iter_mut().zip(&block.values) {
                values.extend_from_slice(&more[from..to]);
            }
            stretch.lines.push(&block.lines[from..to]);
            if stretch.lines.rows == STRETCH {
                stretch.features = (self.telling)(&stretch.values);
            }
            self.rows += (to - from) as u64;
            from = to;
        }
    }

    /// Lets the stretch go that adds least, where another one would be too many.
    fn make_room(&mut self) {
        if self.stretches.len() < self.most.div_ceil(STRETCH) {
            return;
        }
        let scales = self.scales();
        let scaled = |stretch: &Stretch| stretch.features.iter().zip(&scales).map(|(feature, scale)| feature / scale).collect::<Vec<_>>();
        let features: Vec<Vec<f64>> = self.stretches.iter().map(scaled).collect();
        let mut nearest = (f64::INFINITY, self.stretches.len() - 1);
        for (later, of_later) in features.iter().enumerate() {
            for of_earlier in &features[..later] {
                let apart = of_earlier.iter().zip(of_later).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
                if apart < nearest.0 {
                    nearest = (apart, later);
                }
            }
        }
        self.stretches.remove(nearest.1);
    }

    /// What makes features comparable: their range; 1 for those that do not vary.
    fn scales(&self) -> Vec<f64> {
        let features = self.stretches.first().map_or(0, |stretch| stretch.features.len());
        let range = |k: usize| {
            let of = || self.stretches.iter().map(|stretch| stretch.features[k]);
            of().fold(f64::NEG_INFINITY, f64::max) - of().fold(f64::INFINITY, f64::min)
        };
        (0..features).map(range).map(|range| if range > 0.0 { range } else { 1.0 }).collect()
    }

    /// The columns, the lines of their rows, and what had to be left out.
    pub(super) fn finish(mut self) -> (Vec<Vec<f64>>, Lines, Option<String>) {
        let (mut values, mut lines) = (vec![Vec::new(); self.columns], Lines::default());
        let stretches = self.stretches.len();
        // Column by column, so that no value is held twice for long.
        for stretch in &self.stretches {
            lines.extend(&stretch.lines);
        }
        for (place, column) in values.iter_mut().enumerate() {
            column.reserve_exact(lines.rows);
            for stretch in &mut self.stretches {
                column.append(&mut stretch.values[place]);
                stretch.values[place] = Vec::new();
            }
        }
        let note = (lines.rows as u64) < self.rows;
        let note = note.then(|| {
            format!(
                "of {} rows, {} in the {stretches} stretches that differ most in current and speed were kept: more would not make the answer better known",
                self.rows, lines.rows
            )
        });
        (values, lines, note)
    }
}

/// Of the numbers among the values.
pub(super) fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    // Around some value of the column, so that squares do not cancel.
    let around = values.iter().copied().find(|value| value.is_finite()).unwrap_or(0.0);
    let (mut rows, mut sum, mut squares) = (0.0_f64, 0.0, 0.0);
    for value in values.iter().map(|value| value - around).filter(|value| value.is_finite()) {
        rows += 1.0;
        sum += value;
        squares += value * value;
    }
    let mean = sum / rows.max(1.0);
    [around + mean, (squares / rows.max(1.0) - mean * mean).max(0.0).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows `from..to`, whose one column is the place of their stretch, modulo `period`.
    fn block(from: usize, to: usize, period: usize) -> Block {
        Block {
            values: vec![(from..to).map(|row| ((row / STRETCH) % period) as f64).collect()],
            lines: (from..to).map(|row| row as u64 + 2).collect(),
            refused: Vec::new(),
        }
    }

    #[test]
    fn everything_is_kept_where_there_is_room() {
        let mut kept = Kept::new(1, Box::new(|values| mean_and_deviation(&values[0]).to_vec()), 4 * STRETCH);
        (0..10).for_each(|k| kept.push(&block(1000 * k, 1000 * (k + 1), 3)));
        let (values, lines, note) = kept.finish();
        assert_eq!((values, note), (block(0, 10_000, 3).values, None));
        assert_eq!((lines.of(0), lines.of(9_999), lines.runs.len()), (Some(2), Some(10_001), 3));
    }

    #[test]
    fn stretches_that_differ_stay() {
        // Three kinds of stretches among twenty, room for four.
        let mut kept = Kept::new(1, Box::new(|values| mean_and_deviation(&values[0]).to_vec()), 4 * STRETCH);
        kept.push(&block(0, 20 * STRETCH, 3));
        let (values, lines, note) = kept.finish();
        let kinds = |kind: f64| values[0].iter().filter(|value| **value == kind).count() / STRETCH;
        assert_eq!(values[0].len(), 4 * STRETCH);
        assert!(kinds(0.0) > 0 && kinds(1.0) > 0 && kinds(2.0) > 0);
        // The last stretch is always there, with its own lines.
        assert_eq!(lines.of(4 * STRETCH - 1), Some(20 * STRETCH as u64 + 1));
        assert!(note.unwrap().starts_with("of 81920 rows, 16384 in the 4 stretches"));
    }
}
