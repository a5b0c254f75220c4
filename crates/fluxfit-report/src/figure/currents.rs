//! Measured and predicted currents over time, and what is left between them: two pairs of panels.
//!
//! A column of pixels holds many rows of a log. It is drawn from the least to the largest of them, so that a transient of one row is seen.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line, shade},
    palette::Ink,
    plot::{Chart, Plot},
};
use fluxfit::{frames::Dq, log::Log, validate::Course};
use plotters::{
    element::{PathElement, Rectangle},
    style::{
        Color, ShapeStyle,
        text_anchor::{HPos, VPos},
    },
};

/// Height of a panel of currents, and of residuals, pixels.
const PANELS: [u32; 2] = [230, 150];

/// Room for the numbers of the y axis, and beside the plot, pixels.
const SIDES: (i32, i32) = (52, 12);

/// Widths of the measured and the predicted line, pixels.
const WIDTHS: [f64; 2] = [3.5, 1.2];

/// How much of its ink the measured line has: the predicted one is drawn over it.
const FAINT: f64 = 0.45;

/// The band of noise reaches so many times its root mean square to either side, in a shade of its ink.
const BAND: f64 = 2.0;
const SHADE: f64 = 0.25;

/// One value over time, in the pieces between gaps.
type Pieces = Vec<Vec<(f64, f64)>>;

/// Draws both axes: the currents, A, and below them measured less predicted, on a band of the log's own noise, A rms.
pub(crate) fn draw(log: &Log, courses: &[Course], noise: [f64; 2], size: Size) -> Drawing {
    let label = "Curves over time: i_d and i_q, measured and predicted, and below each what is left between them".to_owned();
    let [tall, low] = PANELS;
    Drawing::new((size.width(), 2 * (tall + low)), label, |area| {
        let unit = UNITS.unsigned_abs();
        let (d, q) = area.split_vertically((tall + low) * unit);
        for (area, axis, name) in [(d, 0, "i_d"), (q, 1, "i_q")] {
            let (above, below) = area.split_vertically(tall * unit);
            paint(&above, &below, log, courses, (axis, name, noise[axis]), size)?;
        }
        Ok(())
    })
}

fn paint(above: &Area, below: &Area, log: &Log, courses: &[Course], (axis, name, noise): (usize, &str, f64), size: Size) -> Drawn {
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
    let left = pieces(&|course, k| of(&course.measured[k]) - of(&course.predicted[k]));

    let ink = [Ink::D, Ink::Q][axis];
    let name_above = format!("{name}, A");
    let mut chart = panel(above, &x, &[&measured, &predicted], &name_above, "")?;
    curve(&mut chart, &measured, faint())?;
    curve(&mut chart, &predicted, line(ink, WIDTHS[1]))?;
    legend(above, ink, size)?;
    let reach = BAND * noise;
    let band = vec![vec![(x.low, -reach), (x.high, reach)]];
    let mut chart = panel(below, &x, &[&left, &band], "measured − predicted, A", "time, s")?;
    chart.series.draw_series([Rectangle::new([(x.low, -reach), (x.high, reach)], shade(Ink::Axis, SHADE))])?;
    curve(&mut chart, &left, line(ink, WIDTHS[1]))?;
    chart.series.draw_series([PathElement::new(vec![(x.low, 0.0), (x.high, 0.0)], line(Ink::Text, 1.0))])?;
    Ok(())
}

/// What is taken from each log's time, s, so that logs of their own clocks follow each other.
fn starts(log: &Log) -> Vec<f64> {
    let logs = log.segments().last().map_or(1, |segment| segment.log + 1);
    let t = &log.columns().t;
    let mut starts = Vec::new();
    let mut end = None;
    for number in 0..logs {
        let rows = || log.segments().iter().filter(|segment| segment.log == number).map(|segment| &segment.rows);
        let (Some(first), Some(last)) = (rows().next(), rows().last()) else {
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
    y_name: &str,
    x_name: &str,
) -> Result<Chart<'a>, plotters::prelude::DrawingAreaErrorKind<std::io::Error>> {
    let values = shown.iter().flat_map(|pieces| pieces.iter().flatten()).map(|point| point.1);
    let y = Axis::around(values, 4);
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

fn faint() -> ShapeStyle {
    ShapeStyle { color: Ink::Axis.color().mix(FAINT), ..line(Ink::Axis, WIDTHS[0]) }
}

fn curve(chart: &mut Chart, pieces: &Pieces, style: ShapeStyle) -> Drawn {
    let paths = pieces.iter().filter(|piece| piece.len() > 1).map(|piece| PathElement::new(piece.clone(), style));
    chart.series.draw_series(paths).map(|_| ())
}

fn legend(area: &Area, ink: Ink, size: Size) -> Drawn {
    let right = size.width() as i32 * UNITS;
    for (style, name, from_right) in [(faint(), "measured", 196), (line(ink, WIDTHS[1]), "predicted", 96)] {
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
    fn nothing_and_one_point_are_kept_as_they_are() {
        assert!(thinned([].into_iter(), 0.0, 1.0).is_empty());
        assert_eq!(thinned([(1.0, 2.0)].into_iter(), 0.0, 0.0), [(1.0, 2.0)]);
        assert!(thinned([(1.0, f64::NAN)].into_iter(), 0.0, 1.0).is_empty());
    }
}
