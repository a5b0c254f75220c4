//! A curve brought down to what a drawing can show: of all points in a column of pixels the first, the least, the largest and the last.
//!
//! The line through them covers the pixels that the line through all points covers, so that no transient is lost. U. Jugel and others,
//! "M4: a visualization-oriented time series data aggregation", Proc. VLDB Endow. 7 (2014) 797, doi:10.14778/2732951.2732953.

/// A point, and which of the curve it is.
pub(super) type Numbered = (usize, (f64, f64));

/// What is kept of a column.
struct Column {
    place: f64,
    first: Numbered,
    least: Numbered,
    largest: Numbered,
    last: Numbered,
}

impl Column {
    fn of(place: f64, point: Numbered) -> Self {
        Self { place, first: point, least: point, largest: point, last: point }
    }

    fn add(&mut self, point: Numbered) {
        let (_, (_, y)) = point;
        if y < self.least.1.1 {
            self.least = point;
        }
        if y > self.largest.1.1 {
            self.largest = point;
        }
        self.last = point;
    }

    fn points(&self) -> impl Iterator<Item = Numbered> + use<> {
        let mut kept = [self.first, self.least, self.largest, self.last];
        kept.sort_by_key(|(number, _)| *number);
        kept.into_iter().enumerate().filter(move |(k, (number, _))| *k == 0 || kept[k - 1].0 != *number).map(|(_, point)| point)
    }
}

/// At most four points per column of those in order of `x`, with `columns` columns from `low` to `high`. What is not finite is left out.
pub(super) fn decimated(points: impl Iterator<Item = (f64, f64)>, range: [f64; 2], columns: u32) -> Vec<(f64, f64)> {
    numbered(points, range, columns).into_iter().map(|(_, point)| point).collect()
}

/// The same, each with its number among all points.
pub(super) fn numbered(points: impl Iterator<Item = (f64, f64)>, [low, high]: [f64; 2], columns: u32) -> Vec<Numbered> {
    let mut kept = Vec::new();
    let mut column: Option<Column> = None;
    for (number, (x, y)) in points.enumerate().filter(|(_, (x, y))| x.is_finite() && y.is_finite()) {
        let place = ((x - low) / (high - low) * f64::from(columns)).floor();
        match &mut column {
            Some(column) if column.place == place => column.add((number, (x, y))),
            _ => {
                let full = column.replace(Column::of(place, (number, (x, y))));
                kept.extend(full.iter().flat_map(Column::points));
            }
        }
    }
    kept.extend(column.iter().flat_map(Column::points));
    kept
}

#[cfg(test)]
mod tests {
    use super::decimated;

    #[test]
    fn few_points_stay_as_they_are() {
        let points = [(0.0, 1.0), (0.5, f64::NAN), (1.0, -1.0), (2.0, 3.0)];
        assert_eq!(decimated(points.into_iter(), [0.0, 2.0], 100), [points[0], points[2], points[3]]);
        assert!(decimated([].into_iter(), [0.0, 1.0], 10).is_empty());
    }

    #[test]
    fn a_single_peak_among_a_million_rows_survives_in_order() {
        let n = 1_000_000;
        let value = |k: usize| if k == 123_456 { 9.0 } else { (k % 7) as f64 * 0.1 };
        let kept = decimated((0..n).map(|k| (k as f64, value(k))), [0.0, n as f64], 500);
        assert!(kept.len() <= 4 * 500, "{}", kept.len());
        assert!(kept.contains(&(123_456.0, 9.0)) && kept.first() == Some(&(0.0, 0.0)) && kept.last().unwrap().0 == (n - 1) as f64);
        assert!(kept.is_sorted_by(|one, other| one.0 < other.0));
    }
}
