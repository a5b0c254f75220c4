//! Currents over time, measured and simulated (or predicted), an axis below the other; below each, what the model misses, on its
//! own scale, with its means over short spans.
//!
//! A column of pixels holds many rows of a log. It is drawn from the least to the largest of them, so that a transient of one row is seen.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line},
    decimation::{decimated, numbered},
    palette::Ink,
    plot::Plot,
};
use crate::{
    interactive::{Along, Column, Kind, Live, Panel, Series},
    measured::{Measured, Row},
};
use fluxfit::frames::Dq;
use maud::{Markup, html};
use plotters::{
    element::PathElement,
    style::{
        Color, ShapeStyle,
        text_anchor::{HPos, VPos},
    },
};
use std::collections::{BTreeMap, BTreeSet};

/// Height of a panel of currents, pixels.
const CURRENTS: i32 = 200;

/// Height of a panel of residuals, pixels.
const RESIDUALS: i32 = 150;

/// The upper panel of a pair has no numbers below it: the lower one is moved up into their room, pixels.
const SHARED: i32 = 34;

/// Room for the numbers of the y axis and beside the plot, pixels.
const SIDES: (i32, i32) = (50, 12);

/// Measured curves stand behind those of the model, and do not shout; residuals behind their means.
const BEHIND: f64 = 0.7;
const FAINT: f64 = 0.5;

/// Spans over which the residuals' means are taken: noise is averaged, and what is left of a transient is not.
const SPANS: usize = 90;

/// Milliamperes, where amperes would be nothing but zeros.
const MILLI: (f64, &str) = (1e3, "mA");

/// Rows up to which a page holds every one of them: so many take 200 kilobytes.
const ROWS: usize = 6_000;

/// Spans of time of a longer log, in each of which the rows are kept that are first, last, least or largest in something.
const KEPT_SPANS: u32 = 600;

/// Steps of time that can be told apart within a sample period.
const WITHIN_PERIOD: f64 = 10.0;

/// A curve, piece by piece: time, s, and value.
type Curve = Vec<Vec<(f64, f64)>>;

/// One axis of the currents.
struct Course<'a> {
    currents: Measured<'a>,
    /// Which: 0 is d.
    axis: usize,
    /// Seconds.
    times: [f64; 2],
}

/// The figure in words.
fn label(currents: &Measured) -> String {
    let squares = |axis: usize| -> f64 {
        currents.pieces().flatten().map(|row| [row.missed.d, row.missed.q][axis].powi(2)).filter(|square| square.is_finite()).sum()
    };
    let rms = [0, 1].map(|axis| (squares(axis) / currents.rows().max(1) as f64).sqrt());
    format!(
        "Curves: i_d and i_q over time, measured and {}, and below each what is left between them, {:.2e} and {:.2e} ampere root mean square",
        currents.word(),
        rms[0],
        rms[1]
    )
}

/// Draws both currents and their residuals.
pub(crate) fn draw(currents: Measured, size: Size) -> Drawing {
    let pair = CURRENTS - SHARED + RESIDUALS;
    Drawing::new((size.width(), 2 * pair.unsigned_abs()), label(&currents), |area| {
        let times = currents.times();
        [0, 1].into_iter().try_for_each(|axis| {
            let course = Course { currents, axis, times };
            let top = axis as i32 * pair;
            course.currents(&panel(area, top, CURRENTS, size), size)?;
            course.residuals(&panel(area, top + CURRENTS - SHARED, RESIDUALS, size), size)
        })
    })
}

/// A strip of the sheet, pixels.
fn panel<'a>(area: &Area<'a>, top: i32, height: i32, size: Size) -> Area<'a> {
    area.clone().shrink((0, top * UNITS), (size.width() as i32 * UNITS, height * UNITS))
}

/// What residuals in ampere are multiplied with, and the unit that this gives.
fn unit_of_missed(largest: f64) -> (f64, &'static str) {
    if largest < 1.0 { MILLI } else { (1.0, "A") }
}

fn is_thinned(currents: &Measured) -> bool {
    currents.rows() > ROWS
}

/// For the caption: what of a long log the page lacks.
pub(crate) fn thinning(currents: &Measured) -> Markup {
    html! {
        @if is_thinned(currents) {
            " Of this long log the page holds, for each " (KEPT_SPANS) "th of its time, the first, last, least and largest rows: zooming shows those. "
            "The means are those of all rows."
        }
    }
}

/// The rows that a page holds, and one without values in each gap; beside each the means of what is missed.
fn held(currents: &Measured) -> Vec<(Row, Dq)> {
    let nothing = Dq { d: f64::NAN, q: f64::NAN };
    let mut held: Vec<(Row, Dq)> = Vec::new();
    let times = currents.times();
    let values: [fn(&Row) -> f64; 4] = [|row| row.measured.d, |row| row.measured.q, |row| row.missed.d, |row| row.missed.q];
    // The rows of a piece can be gone through again and again, but not be held all at once.
    for rows in currents.pieces() {
        let rows = || rows.clone();
        let kept: Option<BTreeSet<usize>> = is_thinned(currents).then(|| {
            let of_value = |value: &fn(&Row) -> f64| numbered(rows().map(|row| (row.t, value(&row))), times, KEPT_SPANS);
            values.iter().flat_map(of_value).map(|(number, _)| number).collect()
        });
        let [d, q] = [values[2], values[3]].map(|value| means(rows().map(|row| (row.t, value(&row))), times, SPANS));
        let mut rows = rows().enumerate().filter(|(number, _)| kept.as_ref().is_none_or(|kept| kept.contains(number))).peekable();
        if let (Some((before, _)), Some((_, first))) = (held.last(), rows.peek()) {
            held.push((Row { t: 0.5 * (before.t + first.t), measured: nothing, missed: nothing }, nothing));
        }
        held.extend(rows.map(|(_, row)| (row, Dq { d: between(&d, row.t), q: between(&q, row.t) })));
    }
    held
}

/// The value of a curve at a time, s; beyond its ends, theirs.
fn between(curve: &[(f64, f64)], t: f64) -> f64 {
    let next = curve.partition_point(|point| point.0 <= t);
    match (curve.get(next.wrapping_sub(1)), curve.get(next)) {
        (Some((t0, y0)), Some((t1, y1))) => y0 + (y1 - y0) * (t - t0) / (t1 - t0),
        (Some((_, y)), None) | (None, Some((_, y))) => *y,
        (None, None) => f64::NAN,
    }
}

/// The same for the pointer.
pub(crate) fn live(currents: Measured) -> Live {
    let held = held(&currents);
    let column = |value: &dyn Fn(&(Row, Dq)) -> f64| -> Vec<f64> { held.iter().map(value).collect() };
    let t = column(&|(row, _)| row.t);
    let period = t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let panels = [(0, "i_d, A", Ink::D), (1, "i_q, A", Ink::Q)].into_iter().flat_map(|(axis, name, ink)| {
        let of = |value: Dq| [value.d, value.q][axis];
        let measured = column(&|(row, _)| of(row.measured));
        let simulated = column(&|(row, _)| of(row.measured) - of(row.missed));
        let missed = column(&|(row, _)| of(row.missed));
        let largest = missed.iter().filter(|missed| missed.is_finite()).fold(0.0, |largest: f64, missed| largest.max(missed.abs()));
        let (factor, unit) = unit_of_missed(largest);
        let scaled = |values: &[f64]| Column::new(&values.iter().map(|value| factor * value).collect::<Vec<_>>());
        let currents_of = Panel {
            name: name.to_owned(),
            height: CURRENTS,
            kind: Kind::Lines,
            whole: None,
            series: vec![
                Series::new("measured", Ink::Axis, (2.4, BEHIND), Column::new(&measured)),
                Series::new(currents.word(), ink, (1.2, 1.0), Column::new(&simulated)),
            ],
        };
        let residuals = Panel {
            name: format!("measured − {}, {unit}", currents.word()),
            height: RESIDUALS,
            kind: Kind::Lines,
            whole: None,
            series: vec![
                Series::new("row", ink, (0.8, FAINT), scaled(&missed)),
                Series::new("mean", ink, (2.0, 1.0), scaled(&column(&|(_, mean)| of(*mean)))),
            ],
        };
        [currents_of, residuals]
    });
    let panels = panels.collect();
    Live { x: Along { name: "time", unit: "s", values: Column::resolving(&t, period / WITHIN_PERIOD) }, panels, told: Vec::new() }
}

impl Course<'_> {
    fn ink(&self) -> Ink {
        [Ink::D, Ink::Q][self.axis]
    }

    /// A curve of what `value` makes of a row's measured current and its residual along this axis.
    fn curve(&self, value: fn(f64, f64) -> f64, size: Size) -> Curve {
        let (left, right) = SIDES;
        let columns = size.width() - (left + right).unsigned_abs();
        self.currents.pieces().map(|rows| decimated(self.points(rows, value), self.times, columns)).collect()
    }

    fn points(&self, rows: impl Iterator<Item = Row>, value: fn(f64, f64) -> f64) -> impl Iterator<Item = (f64, f64)> {
        rows.map(move |row| (row.t, value([row.measured.d, row.measured.q][self.axis], [row.missed.d, row.missed.q][self.axis])))
    }

    fn currents(&self, area: &Area, size: Size) -> Drawn {
        let measured = self.curve(|measured, _| measured, size);
        let simulated = self.curve(|measured, missed| measured - missed, size);
        let values = measured.iter().chain(&simulated).flatten().map(|(_, i)| *i);
        let name = ["i_d, A", "i_q, A"][self.axis];
        let behind = faint(Ink::Axis, 2.4, BEHIND);
        let front = line(self.ink(), 1.2);
        self.panel(area, Axis::around(values, 4), ("", name), size, &[(measured, behind), (simulated, front)])?;
        legend(area, size, &[(behind, "measured", 190), (front, self.currents.word(), 92)])
    }

    fn residuals(&self, area: &Area, size: Size) -> Drawn {
        let missed = self.curve(|_, missed| missed, size);
        let largest = missed.iter().flatten().map(|(_, missed)| missed.abs()).fold(0.0, f64::max);
        let (factor, unit) = unit_of_missed(largest);
        let scaled =
            |curve: Curve| -> Curve { curve.into_iter().map(|piece| piece.into_iter().map(|(t, i)| (t, factor * i)).collect()).collect() };
        let means = self.currents.pieces().map(|rows| means(self.points(rows, |_, missed| missed), self.times, SPANS));
        let (means, missed) = (scaled(means.collect()), scaled(missed));
        let zero = vec![self.times.map(|t| (t, 0.0)).to_vec()];
        let y = Axis::around(missed.iter().flatten().map(|(_, i)| *i).chain([0.0]), 4);
        let name = format!("measured − {}, {unit}", self.currents.word());
        let (behind, front) = (faint(self.ink(), 0.8, FAINT), line(self.ink(), 2.0));
        self.panel(area, y, ("time, s", &name), size, &[(missed, behind), (zero, line(Ink::Text, 1.0)), (means, front)])?;
        legend(area, size, &[(front, "mean", 67)])
    }

    /// Curves over time; without a name of the time its numbers are left out too.
    fn panel(&self, area: &Area, y: Axis, (x_name, y_name): (&str, &str), size: Size, curves: &[(Curve, ShapeStyle)]) -> Drawn {
        let [from, to] = self.times;
        let x = if from < to { Axis::between(from, to, size.pick(8, 5)) } else { Axis::around(self.times, 4) };
        let (x_label, y_label) = (x.clone(), y.clone());
        let (left, right) = SIDES;
        let plot = Plot {
            x,
            y,
            x_name,
            y_name,
            left,
            right,
            x_label: &|t| if x_name.is_empty() { String::new() } else { x_label.label(t) },
            y_label: &|i| y_label.label(i),
        };
        let mut chart = plot.on(area)?;
        for (curve, style) in curves {
            let long = curve.iter().filter(|piece| piece.len() > 1);
            chart.series.draw_series(long.map(|piece| PathElement::new(piece.clone(), *style)))?;
        }
        Ok(())
    }
}

fn faint(ink: Ink, width: f64, opacity: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().mix(opacity), ..line(ink, width) }
}

/// A piece of each line and its name, so many pixels from the right.
fn legend(area: &Area, size: Size, lines: &[(ShapeStyle, &str, i32)]) -> Drawn {
    let right = size.width() as i32 * UNITS;
    for (style, text, from_right) in lines {
        let (x, y) = (right - from_right * UNITS, 13 * UNITS);
        area.draw(&PathElement::new(vec![(x, y), (x + 20 * UNITS, y)], *style))?;
        area.draw_text(text, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 25 * UNITS, y))?;
    }
    Ok(())
}

/// Means over equal spans from one time to another, s, each at the middle of its points.
fn means(points: impl Iterator<Item = (f64, f64)>, [from, to]: [f64; 2], spans: usize) -> Vec<(f64, f64)> {
    let mut sums: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
    for (t, value) in points.filter(|point| point.1.is_finite()) {
        // The last point belongs to the last span.
        let place = if to > from { ((t - from) / (to - from) * spans as f64) as usize } else { 0 }.min(spans.saturating_sub(1));
        let sum = sums.entry(place).or_default();
        *sum = (sum.0 + t, sum.1 + value, sum.2 + 1.0);
    }
    sums.into_values().map(|(t, value, count)| (t / count, value / count)).filter(|mean| mean.1.is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::means;

    #[test]
    fn means_of_each_span() {
        let points = [(0.0, 1.0), (0.5, 3.0), (1.0, 5.0), (1.2, f64::NAN), (2.0, 9.0)];
        assert_eq!(means(points.into_iter(), [0.0, 2.0], 2), [(0.25, 2.0), (1.5, 7.0)]);
        assert_eq!(means(points.into_iter(), [0.0, 0.0], 2), [(0.875, 4.5)]);
    }
}
