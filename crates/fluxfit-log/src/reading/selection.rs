//! Selection of the rows of a long log: all of them up to a limit; beyond it, the stretches that differ most.
//!
//! Beyond half a million rows voltage accuracy dominates, not noise, so more rows do not improve the parameters. But later rows may
//! contain operating points that the first ones do not. So rows are collected in stretches. Where there are too many, the two most
//! similar stretches are found, by the means and standard deviations of their currents and speed, and the later one is dropped. No
//! fitted quantity decides this, so it biases nothing.

use super::lines::Lines;
use crate::block::Block;

/// Rows of a stretch: some tenths of a second at the rate of a drive, long enough for a steady window.
const STRETCH: usize = 1 << 12;

/// Maximum number of rows that are selected: with the memory for their fit, some 220 MB.
pub(super) const MOST_ROWS: usize = 1 << 19;

/// Computes the features of a stretch from its columns: the numbers by which stretches are compared.
pub(super) type Features = Box<dyn Fn(&[Vec<f64>]) -> Vec<f64>>;

/// Collects rows, up to a limit.
pub(super) struct Selection {
    most: usize,
    features: Features,
    stretches: Vec<Stretch>,
    /// The scales of the features with which the stretches were compared.
    scales: Vec<f64>,
    columns: usize,
    rows: u64,
}

/// The rows that were selected.
pub(super) struct Selected {
    /// Their columns.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) lines: Lines,
    /// Those before which others were dropped.
    pub(super) dropped_before: Vec<usize>,
    /// On what was dropped.
    pub(super) note: Option<String>,
}

/// Consecutive rows.
#[derive(Debug)]
struct Stretch {
    /// Rows before it, dropped ones too.
    first: u64,
    values: Vec<Vec<f64>>,
    lines: Lines,
    /// Its features, once it is full.
    features: Vec<f64>,
    /// The most similar earlier stretch: the distance from it, and its place. None if they have to be compared.
    most_similar: Option<(f64, usize)>,
}

impl Stretch {
    fn new(columns: usize, first: u64) -> Self {
        Self { first, values: vec![Vec::new(); columns], lines: Lines::default(), features: Vec::new(), most_similar: None }
    }
}

impl Selection {
    pub(super) fn new(columns: usize, features: Features, most: usize) -> Self {
        Self { most, features, stretches: Vec::new(), scales: Vec::new(), columns, rows: 0 }
    }

    /// Adds rows.
    pub(super) fn push(&mut self, block: &Block) {
        let mut from = 0;
        while from < block.lines.len() {
            if self.stretches.last().is_none_or(|stretch| stretch.lines.rows() == STRETCH) {
                self.make_room();
                self.stretches.push(Stretch::new(self.columns, self.rows));
            }
            let Some(stretch) = self.stretches.last_mut() else { return };
            let to = block.lines.len().min(from + STRETCH - stretch.lines.rows());
            for (values, more) in stretch.values.iter_mut().zip(&block.values) {
                values.extend_from_slice(&more[from..to]);
            }
            stretch.lines.push(&block.lines[from..to]);
            if stretch.lines.rows() == STRETCH {
                stretch.features = (self.features)(&stretch.values);
            }
            self.rows += (to - from) as u64;
            from = to;
        }
    }

    /// Drops the stretch that adds least if there is no room for another one.
    fn make_room(&mut self) {
        if self.stretches.len() < self.most.div_ceil(STRETCH) {
            return;
        }
        let scales = self.scales();
        if scales != self.scales {
            self.stretches.iter_mut().for_each(|stretch| stretch.most_similar = None);
            self.scales = scales;
        }
        let mut least = (f64::INFINITY, self.stretches.len() - 1);
        for later in 0..self.stretches.len() {
            let (distance, earlier) = self.stretches[later].most_similar.unwrap_or_else(|| self.most_similar(later));
            self.stretches[later].most_similar = Some((distance, earlier));
            if distance < least.0 {
                least = (distance, later);
            }
        }
        let dropped = least.1;
        self.stretches.remove(dropped);
        for stretch in &mut self.stretches {
            stretch.most_similar = stretch.most_similar.filter(|(_, earlier)| *earlier != dropped);
            if let Some((_, earlier)) = &mut stretch.most_similar {
                *earlier -= usize::from(*earlier > dropped);
            }
        }
    }

    /// The most similar of the stretches before one: the distance from it, and its place.
    fn most_similar(&self, later: usize) -> (f64, usize) {
        let of_later = &self.stretches[later].features;
        let mut least = (f64::INFINITY, later);
        for (earlier, stretch) in self.stretches[..later].iter().enumerate() {
            let pairs = stretch.features.iter().zip(of_later).zip(&self.scales);
            let distance = pairs.map(|((a, b), scale)| (a / scale - b / scale) * (a / scale - b / scale)).sum::<f64>();
            if distance < least.0 {
                least = (distance, earlier);
            }
        }
        least
    }

    /// The scale of each feature: its range over the stretches; 1 where it does not vary.
    fn scales(&self) -> Vec<f64> {
        let features = self.stretches.first().map_or(0, |stretch| stretch.features.len());
        let range = |k: usize| {
            let of = || self.stretches.iter().map(|stretch| stretch.features[k]);
            of().fold(f64::NEG_INFINITY, f64::max) - of().fold(f64::INFINITY, f64::min)
        };
        (0..features).map(range).map(|range| if range > 0.0 { range } else { 1.0 }).collect()
    }

    /// The rows that were kept, and a note if others were dropped.
    pub(super) fn finish(mut self) -> Selected {
        let (mut values, mut lines) = (vec![Vec::new(); self.columns], Lines::default());
        let stretches = self.stretches.len();
        let (mut dropped_before, mut next) = (Vec::new(), 0);
        // Column by column, so that little is in memory twice.
        for stretch in &self.stretches {
            if stretch.first != next {
                dropped_before.push(lines.rows());
            }
            next = stretch.first + stretch.lines.rows() as u64;
            lines.extend(&stretch.lines);
        }
        for (place, column) in values.iter_mut().enumerate() {
            column.reserve_exact(lines.rows());
            for stretch in &mut self.stretches {
                column.append(&mut stretch.values[place]);
                stretch.values[place] = Vec::new();
            }
        }
        let note = (lines.rows() as u64) < self.rows;
        let note = note.then(|| {
            format!(
                "of {} rows, {} are kept, in the {stretches} stretches that differ most in current and speed: more rows would not improve the accuracy",
                self.rows,
                lines.rows()
            )
        });
        Selected { values, lines, dropped_before, note }
    }
}

/// Mean and standard deviation of the finite values.
pub(super) fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    // Relative to some value of the column, so that the difference of squares does not cancel.
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
    use fluxfit_files::{FileError, FileErrorKind};

    /// Rows `from..to`, whose one column is the number of their stretch, modulo `period`.
    fn block(from: usize, to: usize, period: usize) -> Block {
        Block {
            values: vec![(from..to).map(|row| ((row / STRETCH) % period) as f64).collect()],
            lines: (from..to).map(|row| row as u64 + 2).collect(),
            refused: Vec::new(),
        }
    }

    #[test]
    fn all_rows_are_selected_up_to_the_limit() {
        let mut selection = Selection::new(1, Box::new(|values| mean_and_deviation(&values[0]).to_vec()), 4 * STRETCH);
        (0..10).for_each(|k| selection.push(&block(1000 * k, 1000 * (k + 1), 3)));
        let Selected { values, lines, dropped_before, note } = selection.finish();
        assert_eq!((values, dropped_before, note), (block(0, 10_000, 3).values, vec![], None));
        let numbered = |row| lines.locate(FileError::new(FileErrorKind::Value, ""), row).line();
        assert_eq!((numbered(0), numbered(9_999)), (Some(2), Some(10_001)));
    }

    /// The pair of most similar stretches, compared anew each time.
    fn dropped_of(features: &[[f64; 2]]) -> usize {
        let range = |k: usize| {
            let of = || features.iter().map(|feature| feature[k]);
            of().fold(f64::MIN, f64::max) - of().fold(f64::MAX, f64::min)
        };
        let scales = [range(0), range(1)].map(|range| if range > 0.0 { range } else { 1.0 });
        let distance = |a: usize, b: usize| (0..2).map(|k| ((features[a][k] - features[b][k]) / scales[k]).powi(2)).sum::<f64>();
        let pairs = (0..features.len()).flat_map(|later| (0..later).map(move |earlier| (earlier, later)));
        pairs.min_by(|a, b| distance(a.0, a.1).total_cmp(&distance(b.0, b.1))).unwrap().1
    }

    #[test]
    fn the_later_one_of_the_most_similar_pair_is_dropped_each_time() {
        let value = |stretch: u32| f64::from((stretch * stretch * 37 + stretch * 11) % 101);
        let mut selection = Selection::new(1, Box::new(|values| vec![values[0][0], values[0][0].sin()]), 6 * STRETCH);
        let mut expected: Vec<u32> = Vec::new();
        for stretch in 0..60 {
            if expected.len() == 6 {
                let features: Vec<[f64; 2]> = expected.iter().map(|stretch| [value(*stretch), value(*stretch).sin()]).collect();
                expected.remove(dropped_of(&features));
            }
            expected.push(stretch);
            selection.push(&Block { values: vec![vec![value(stretch); STRETCH]], lines: vec![1; STRETCH], refused: Vec::new() });
            let held: Vec<f64> = selection.stretches.iter().map(|stretch| stretch.values[0][0]).collect();
            assert_eq!(held, expected.iter().map(|stretch| value(*stretch)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn stretches_that_differ_are_selected() {
        // Three kinds of stretches among twenty, room for four.
        let mut selection = Selection::new(1, Box::new(|values| mean_and_deviation(&values[0]).to_vec()), 4 * STRETCH);
        selection.push(&block(0, 20 * STRETCH, 3));
        let Selected { values, lines, dropped_before, note } = selection.finish();
        assert!(
            !dropped_before.is_empty() && dropped_before.iter().all(|row| row % STRETCH == 0 && *row < 4 * STRETCH),
            "{dropped_before:?}"
        );
        let kinds = |kind: f64| values[0].iter().filter(|value| **value == kind).count() / STRETCH;
        assert_eq!(values[0].len(), 4 * STRETCH);
        assert!(kinds(0.0) > 0 && kinds(1.0) > 0 && kinds(2.0) > 0);
        // The last stretch is always selected, with its own lines.
        let last = lines.locate(FileError::new(FileErrorKind::Value, ""), 4 * STRETCH - 1).line();
        assert_eq!(last, Some(20 * STRETCH as u64 + 1));
        assert!(note.unwrap().starts_with("of 81920 rows, 16384 are kept, in the 4 stretches"));
    }
}
