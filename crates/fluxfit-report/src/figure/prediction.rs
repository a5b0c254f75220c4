//! Measured and predicted currents over time, and what is left between them: two pairs of panels.
//!
//! A column of pixels holds many rows of a log. It is drawn from the least to the largest of them, so that a transient of one row is seen.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line},
    palette::Ink,
    plot::{Chart, Plot},
};
use fluxfit::{frames::Dq, log::Log, validate::Course};
use plotters::{
    element::PathElement,
    style::{
        Color, ShapeStyle,
        text_anchor::{HPos, VPos},
    },
};
use std::collections::BTreeMap;

/// Height of a panel of currents, and of residuals, pixels.
const PANELS: [u32; 2] = [230, 150];

/// Room for the numbers of the y axis, and beside the plot, pixels.
const SIDES: (i32, i32) = (52, 12);

/// Widths of the measured and the predicted line, and of the residuals' means, pixels.
const WIDTHS: [f64; 3] = [3.5, 1.2, 2.0];

/// How much of its ink a line has over which another one is drawn.
const FAINT: f64 = 0.45;

/// Spans over which the residuals' means are taken: noise is averaged, and what is left of a transient is not.
const SPANS: usize = 90;

/// One value over time, in the pieces between gaps.
type Pieces = Vec<Vec<(f64, f64)>>;

/// Draws both axes: the currents, A, and below them measured less predicted, with its means over short spans.
pub(crate) fn draw(log: &Log, courses: &[Course], size: Size) -> Drawing {
    let label = "Curves over time: i_d and i_q, measured and predicted, and below each what is left between them".to_owned();
    let [tall, low] = PANELS;
    Drawing::new((size.width(), 2 * (tall + low)), label, |area| {
        let unit = UNITS.unsigned_abs();
        let (d, q) = area.split_vertically((tall + low) * unit);
        for (area, axis, name) in [(d, 0, "i_d"), (q, 1, "i_q")] {
            let (above, below) = area.split_vertically(tall * unit);
            paint(&above, &below, log, courses, (axis, name), size)?;
        }
        Ok(())
    })
}

fn paint(above: &Area, below: &Area, log: &Log, courses: &[Course], (axis, name): (usize, &str), size: Size) -> Drawn {
    let columns = size.width() as i32 - SIDES.0 - SIDES.1;
    let starts = starts(log);
    let time = |row: usize| log.columns().t[row] - starts[log.segment_of(row).map_or(0, |segment| segment.log)];
    let end = |rows: &std::ops::Range<usize>| time(rows.end.saturating_sub(1));
    let from = courses.iter().map(|course| time(course.rows.start)).fold(f64::INFINITY, f64::min);
    let to = courses.iter().map(|course| end(&course.rows)).fold(f64::NEG_INFINITY, f64::max);
    let x = if from < to { Axis::between(from, to, size.pick(10, 4)) } else { Axis::around([from, to], 4) };
    let of = |value: &Dq| [value.d, value.q][axis];
    let pieces = |value: &dyn Fn(&Course, usize) -> f64| -> Pieces {
        let of_course = |course: &Course| {
            let points = course.rows.clone().enumerate().map(|(k, row)| (time(row), value(course, k)));
            thinned(points, from, (to - from) / f64::from(columns))
        };
        courses.iter().map(of_course).collect()
    };
    let measured = pieces(&|course, k| of(&course.measured[k]));
    let predicted = pieces(&|course, k| of(&course.predicted[k]));
    let difference = |course: &Course, k: usize| of(&course.measured[k]) - of(&course.predicted[k]);
    let left = pieces(&difference);
    let over_spans =
        |course: &Course| means(course.rows.clone().enumerate().map(|(k, row)| (time(row), difference(course, k))), from, to, SPANS);
    let means: Pieces = courses.iter().map(over_spans).collect();

    let ink = [Ink::D, Ink::Q][axis];
    let name_above = format!("{name}, A");
    let mut chart = panel(above, &x, &[&measured, &predicted], 4, &name_above, "")?;
    curve(&mut chart, &measured, faint(Ink::Axis, WIDTHS[0]))?;
    curve(&mut chart, &predicted, line(ink, WIDTHS[1]))?;
    legend(above, ink, size)?;
    let zero = vec![vec![(from, 0.0)]];
    let mut chart = panel(below, &x, &[&left, &zero], 6, "measured − predicted, A", "time, s")?;
    curve(&mut chart, &left, faint(ink, WIDTHS[1]))?;
    chart.series.draw_series([PathElement::new(vec![(x.low, 0.0), (x.high, 0.0)], line(Ink::Text, 1.0))])?;
    curve(&mut chart, &means, line(ink, WIDTHS[2]))
}

/// Means over equal spans from one time to another, s, each at the middle of its points.
fn means(points: impl Iterator<Item = (f64, f64)>, from: f64, to: f64, spans: usize) -> Vec<(f64, f64)> {
    let mut sums: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
    for (t, value) in points.filter(|point| point.1.is_finite()) {
        // The last point belongs to the last span.
        let place = if to > from { ((t - from) / (to - from) * spans as f64) as usize } else { 0 }.min(spans.saturating_sub(1));
        let sum = sums.entry(place).or_default();
        *sum = (sum.0 + t, sum.1 + value, sum.2 + 1.0);
    }
    sums.into_values().map(|(t, value, count)| (t / count, value / count)).filter(|mean| mean.1.is_finite()).collect()
}

/// What is taken from each log's time, s, so that logs of their own clocks follow each other.
fn starts(log: &Log) -> Vec<f64> {
    let logs = log.segments().last().map_or(1, |segment| segment.log + 1);
    let t = &log.columns().t;
    let mut starts = Vec::new();
    let mut end = None;
    for number in 0..logs {
        let rows = || log.segments().iter().filter(|segment| segment.log == number).map(|segment| &segment.rows);
        let (Some(first), Some(last)) = (rows().next(), rows().next_back()) else {
            starts.push(0.0);
            continue;
        };
        // The first keeps its time.
        let start = end.map_or(0.0, |end| t[first.start] - end);
        starts.push(start);
        end = Some(t[last.end - 1] - start);
    }
    starts
}

/// At most four points a column: first, least, largest and last, in their order.
fn thinned(points: impl Iterator<Item = (f64, f64)>, from: f64, width: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let mut column: Vec<(f64, f64)> = Vec::new();
    let place = |t: f64| if width > 0.0 { ((t - from) / width).floor() as i64 } else { 0 };
    for point in points.filter(|point| point.1.is_finite()) {
        if column.first().is_some_and(|first| place(first.0) != place(point.0)) {
            kept.extend(extremes(&column));
            column.clear();
        }
        column.push(point);
    }
    kept.extend(extremes(&column));
    kept
}

fn extremes(column: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let places = 0..column.len();
    let by_value = |one: &usize, other: &usize| column[*one].1.total_cmp(&column[*other].1);
    let (least, largest) = (places.clone().min_by(by_value), places.clone().max_by(by_value));
    let mut kept: Vec<usize> =
        [Some(0), least, largest, column.len().checked_sub(1)].into_iter().flatten().filter(|k| places.contains(k)).collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|k| column[k]).collect()
}

fn panel<'a>(
    area: &Area<'a>,
    x: &Axis,
    shown: &[&Pieces],
    ticks: usize,
    y_name: &str,
    x_name: &str,
) -> Result<Chart<'a>, plotters::prelude::DrawingAreaErrorKind<std::io::Error>> {
    let values = shown.iter().flat_map(|pieces| pieces.iter().flatten()).map(|point| point.1);
    let y = Axis::around(values, ticks);
    let (x_label, y_label) = (x.clone(), y.clone());
    let plot = Plot {
        x: x.clone(),
        y,
        x_name,
        y_name,
        left: SIDES.0,
        right: SIDES.1,
        x_label: &|value| x_label.label(value),
        y_label: &|value| y_label.label(value),
    };
    plot.on(area)
}

fn faint(ink: Ink, width: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().mix(FAINT), ..line(ink, width) }
}

fn curve(chart: &mut Chart, pieces: &Pieces, style: ShapeStyle) -> Drawn {
    let paths = pieces.iter().filter(|piece| piece.len() > 1).map(|piece| PathElement::new(piece.clone(), style));
    chart.series.draw_series(paths).map(|_| ())
}

fn legend(area: &Area, ink: Ink, size: Size) -> Drawn {
    let right = size.width() as i32 * UNITS;
    for (style, name, from_right) in [(faint(Ink::Axis, WIDTHS[0]), "measured", 196), (line(ink, WIDTHS[1]), "predicted", 96)] {
        let (x, y) = (right - from_right * UNITS, 13 * UNITS);
        area.draw(&PathElement::new(vec![(x, y), (x + 18 * UNITS, y)], style))?;
        area.draw_text(name, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 23 * UNITS, y))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transient_of_one_row_stays() {
        let points = (0..10_000).map(|k| (f64::from(k), if k == 4321 { 7.0 } else { (f64::from(k) * 0.7).sin() }));
        let kept = thinned(points, 0.0, 100.0);
        assert!(kept.len() <= 400 && kept.contains(&(4321.0, 7.0)), "{}", kept.len());
        assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn means_of_each_span() {
        let points = [(0.0, 1.0), (0.5, 3.0), (1.0, 5.0), (1.2, f64::NAN), (2.0, 9.0)];
        assert_eq!(means(points.into_iter(), 0.0, 2.0, 2), [(0.25, 2.0), (1.5, 7.0)]);
        assert_eq!(means(points.into_iter(), 0.0, 0.0, 2), [(0.875, 4.5)]);
    }

    #[test]
    fn nothing_and_one_point_are_kept_as_they_are() {
        assert!(thinned([].into_iter(), 0.0, 1.0).is_empty());
        assert_eq!(thinned([(1.0, 2.0)].into_iter(), 0.0, 0.0), [(1.0, 2.0)]);
        assert!(thinned([(1.0, f64::NAN)].into_iter(), 0.0, 1.0).is_empty());
    }
}
