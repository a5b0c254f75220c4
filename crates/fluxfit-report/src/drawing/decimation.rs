//! Decimation of a curve to the resolution of a drawing: of all points in a pixel column the first, smallest, largest and last (M4).
//!
//! The line through them covers the same pixels as the line through all points, so that no transient is lost. U. Jugel and others,
//! "M4: a visualization-oriented time series data aggregation", Proc. VLDB Endow. 7 (2014) 797, doi:10.14778/2732951.2732953.

/// The index of a point, and the point.
pub(crate) type Indexed = (usize, (f64, f64));

/// The points that are kept of a pixel column.
struct PixelColumn {
    place: f64,
    first: Indexed,
    least: Indexed,
    largest: Indexed,
    last: Indexed,
}

impl PixelColumn {
    fn of(place: f64, point: Indexed) -> Self {
        Self { place, first: point, least: point, largest: point, last: point }
    }

    fn add(&mut self, point: Indexed) {
        let (_, (_, y)) = point;
        if y < self.least.1.1 {
            self.least = point;
        }
        if y > self.largest.1.1 {
            self.largest = point;
        }
        self.last = point;
    }

    fn points(&self) -> impl Iterator<Item = Indexed> + use<> {
        let mut kept = [self.first, self.least, self.largest, self.last];
        kept.sort_by_key(|(index, _)| *index);
        kept.into_iter().enumerate().filter(move |(k, (index, _))| *k == 0 || kept[k - 1].0 != *index).map(|(_, point)| point)
    }
}

/// At most four points for each of `columns` pixel columns over the range, from points in order of `x`. Points that are not finite are
/// left out.
pub(crate) fn decimated(points: impl Iterator<Item = (f64, f64)>, range: [f64; 2], columns: u32) -> Vec<(f64, f64)> {
    decimated_with_index(points, range, columns).into_iter().map(|(_, point)| point).collect()
}

/// The same, each point with its index among all points.
pub(crate) fn decimated_with_index(points: impl Iterator<Item = (f64, f64)>, [low, high]: [f64; 2], columns: u32) -> Vec<Indexed> {
    let mut kept = Vec::new();
    let mut column: Option<PixelColumn> = None;
    for (index, (x, y)) in points.enumerate().filter(|(_, (x, y))| x.is_finite() && y.is_finite()) {
        let place = ((x - low) / (high - low) * f64::from(columns)).floor();
        match &mut column {
            Some(column) if column.place == place => column.add((index, (x, y))),
            _ => {
                let full = column.replace(PixelColumn::of(place, (index, (x, y))));
                kept.extend(full.iter().flat_map(PixelColumn::points));
            }
        }
    }
    kept.extend(column.iter().flat_map(PixelColumn::points));
    kept
}

#[cfg(test)]
mod tests {
    use super::decimated;

    #[test]
    fn few_points_are_not_decimated() {
        let points = [(0.0, 1.0), (0.5, f64::NAN), (1.0, -1.0), (2.0, 3.0)];
        assert_eq!(decimated(points.into_iter(), [0.0, 2.0], 100), [points[0], points[2], points[3]]);
        assert!(decimated([].into_iter(), [0.0, 1.0], 10).is_empty());
    }

    #[test]
    fn a_single_peak_among_a_million_rows_is_kept_in_order() {
        let n = 1_000_000;
        let value = |k: usize| if k == 123_456 { 9.0 } else { (k % 7) as f64 * 0.1 };
        let kept = decimated((0..n).map(|k| (k as f64, value(k))), [0.0, n as f64], 500);
        assert!(kept.len() <= 4 * 500, "{}", kept.len());
        assert!(kept.contains(&(123_456.0, 9.0)) && kept.first() == Some(&(0.0, 0.0)) && kept.last().unwrap().0 == (n - 1) as f64);
        assert!(kept.is_sorted_by(|one, other| one.0 < other.0));
    }
}
