//! Currents over time, measured and simulated (or predicted), for both axes; below each, the residual on its own scale, with its means
//! over short spans.
//!
//! A pixel column contains many rows of a log. It is drawn from the smallest to the largest of them, so that a transient of a single row
//! is visible.

use crate::{
    current_comparison::{CurrentComparison, CurrentSample},
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line},
        decimation::{decimated, decimated_with_index},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    interactive::{DeltaColumn, Panel, PanelKind, PlotData, Series, XAxis},
    report::Report,
};
use fluxfit::{evidence::OutputFit, faults::Fault, frames::Dq};
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
const CURRENT_HEIGHT: i32 = 200;

/// Height of a panel of residuals, pixels.
const RESIDUAL_HEIGHT: i32 = 150;

/// Overlap of a panel of currents and its panel of residuals, pixels: the upper one has no numbers at its x axis.
const OVERLAP: i32 = 34;

/// Left and right margin of a panel, pixels.
const MARGINS: (i32, i32) = (60, 12);

/// Opacity of measured curves, behind those of the model.
const MEASURED_OPACITY: f64 = 0.7;

/// Opacity of residuals, behind their means.
const RESIDUAL_OPACITY: f64 = 0.5;

/// Number of spans over which the residuals are averaged: enough rows each to average noise, short enough to show transients.
const MEAN_SPANS: usize = 90;

/// Milliampere, the unit of residuals below an ampere.
const MILLIAMPERE: (f64, &str) = (1e3, "mA");

/// Largest number of rows that are all in the data of a page; a row takes about 30 bytes.
const MAX_ROWS: usize = 100_000;

/// Number of time spans of a longer log; of each the first, last, smallest and largest rows of every curve are in the data.
const KEPT_SPANS: u32 = 600;

/// Resolution of time in the data, as a fraction of the sample period.
const TIME_RESOLUTION: f64 = 0.1;

/// A curve in pieces between gaps: time, s, and value.
type Curve = Vec<Vec<(f64, f64)>>;

/// The currents of one axis.
struct AxisCurrents<'a> {
    comparison: CurrentComparison<'a>,
    /// 0 for d, 1 for q.
    axis: usize,
    /// First and last time, s.
    times: [f64; 2],
}

/// The figure of an identification from simulated currents.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    let fit = found.output.as_ref()?;
    let comparison = CurrentComparison::with_simulated(report.log, fit);
    Some(of("currents", "currents", comparison, &sensor_faults(fit)))
}

/// The figure of a comparison of currents; `note` is the end of its caption.
pub(crate) fn of<'a>(name: &'static str, section: &'static str, comparison: CurrentComparison<'a>, note: &Markup) -> Figure<'a> {
    Figure {
        name,
        section,
        draw: Box::new(move |size| draw(comparison, size)),
        data: Some(Box::new(move || data(comparison))),
        caption: caption(comparison, note),
    }
}

fn caption(comparison: CurrentComparison, note: &Markup) -> Markup {
    html! {
        "Measured currents (wide, grey) and " (comparison.name()) " ones (thin, coloured); below each, measured less " (comparison.name())
        " on its own scale. Each pixel column is drawn from the smallest to the largest of its rows, so that no transient is lost. The bold "
        "line is the mean over short spans, which shows errors smaller than the noise."
        (note)
        @if is_thinned(&comparison) {
            " Of this long log, the page contains only the first, last, smallest and largest rows of each of " (KEPT_SPANS)
            " equal time spans. The means are those of all rows."
        }
        @if comparison.pieces().count() > 1 { " Gaps in the log are not bridged." }
    }
}

/// A note on the faults of the current sensors that were identified.
fn sensor_faults(fit: &OutputFit) -> Markup {
    html! {
        @if Fault::ALL.into_iter().any(|fault| fault.alters_measured_current() && fit.has(fault)) {
            " The measured current is the logged one; the simulated current includes the identified faults of the sensors."
        }
    }
}

/// The text alternative.
fn label(currents: &CurrentComparison) -> String {
    let squares = |axis: usize| -> f64 {
        currents.pieces().flatten().map(|row| [row.residual.d, row.residual.q][axis].powi(2)).filter(|square| square.is_finite()).sum()
    };
    let rms = [0, 1].map(|axis| (squares(axis) / currents.rows().max(1) as f64).sqrt());
    format!(
        "Curves: i_d and i_q over time, measured and {}, and below each their difference, {:.2e} and {:.2e} ampere root mean square",
        currents.name(),
        rms[0],
        rms[1]
    )
}

/// Draws both currents and their residuals.
fn draw(comparison: CurrentComparison, size: Size) -> Drawing {
    let pair = CURRENT_HEIGHT - OVERLAP + RESIDUAL_HEIGHT;
    Drawing::new((size.width(), 2 * pair.unsigned_abs()), label(&comparison), |area| {
        let times = comparison.times();
        [0, 1].into_iter().try_for_each(|axis| {
            let of_axis = AxisCurrents { comparison, axis, times };
            let top = axis as i32 * pair;
            of_axis.draw_currents(&panel(area, top, CURRENT_HEIGHT, size), size)?;
            of_axis.draw_residuals(&panel(area, top + CURRENT_HEIGHT - OVERLAP, RESIDUAL_HEIGHT, size), size)
        })
    })
}

/// A horizontal strip of the drawing; `top` and `height` in pixels.
fn panel<'a>(area: &Area<'a>, top: i32, height: i32, size: Size) -> Area<'a> {
    area.clone().shrink((0, top * UNITS), (size.width() as i32 * UNITS, height * UNITS))
}

/// The factor from ampere to the unit of the residuals, and the unit.
fn residual_unit(largest: f64) -> (f64, &'static str) {
    if largest < 1.0 { MILLIAMPERE } else { (1.0, "A") }
}

/// Whether the data of the page contains only a part of the rows.
fn is_thinned(comparison: &CurrentComparison) -> bool {
    comparison.rows() > MAX_ROWS
}

/// The rows in the data of a page, with one row without values in each gap; each with the mean of the residuals at its time.
fn kept_rows(comparison: &CurrentComparison) -> Vec<(CurrentSample, Dq)> {
    let nothing = Dq { d: f64::NAN, q: f64::NAN };
    let mut kept_rows: Vec<(CurrentSample, Dq)> = Vec::new();
    let times = comparison.times();
    let values: [fn(&CurrentSample) -> f64; 4] = [|row| row.measured.d, |row| row.measured.q, |row| row.residual.d, |row| row.residual.q];
    // The rows of a piece are iterated several times instead of being collected.
    for rows in comparison.pieces() {
        let rows = || rows.clone();
        let kept: Option<BTreeSet<usize>> = is_thinned(comparison).then(|| {
            let of_value =
                |value: &fn(&CurrentSample) -> f64| decimated_with_index(rows().map(|row| (row.t, value(&row))), times, KEPT_SPANS);
            values.iter().flat_map(of_value).map(|(index, _)| index).collect()
        });
        let [d, q] = [values[2], values[3]].map(|value| means(rows().map(|row| (row.t, value(&row))), times, MEAN_SPANS));
        let mut rows = rows().enumerate().filter(|(index, _)| kept.as_ref().is_none_or(|kept| kept.contains(index))).peekable();
        if let (Some((before, _)), Some((_, first))) = (kept_rows.last(), rows.peek()) {
            let gap = CurrentSample { t: 0.5 * (before.t + first.t), measured: nothing, residual: nothing };
            kept_rows.push((gap, nothing));
        }
        kept_rows.extend(rows.map(|(_, row)| (row, Dq { d: interpolated(&d, row.t), q: interpolated(&q, row.t) })));
    }
    kept_rows
}

/// Linear interpolation of a curve at a time, s; beyond its ends their values.
fn interpolated(curve: &[(f64, f64)], t: f64) -> f64 {
    let next = curve.partition_point(|point| point.0 <= t);
    match (curve.get(next.wrapping_sub(1)), curve.get(next)) {
        (Some((t0, y0)), Some((t1, y1))) => y0 + (y1 - y0) * (t - t0) / (t1 - t0),
        (Some((_, y)), None) | (None, Some((_, y))) => *y,
        (None, None) => f64::NAN,
    }
}

/// The data of the interactive plot.
fn data(comparison: CurrentComparison) -> PlotData {
    let rows = kept_rows(&comparison);
    let column = |value: &dyn Fn(&(CurrentSample, Dq)) -> f64| -> Vec<f64> { rows.iter().map(value).collect() };
    let t = column(&|(row, _)| row.t);
    let period = t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let panels = [(0, "i_d, A", Ink::D), (1, "i_q, A", Ink::Q)].into_iter().flat_map(|(axis, name, ink)| {
        let of = |value: Dq| [value.d, value.q][axis];
        let measured = column(&|(row, _)| of(row.measured));
        let modelled = column(&|(row, _)| of(row.measured) - of(row.residual));
        let residual = column(&|(row, _)| of(row.residual));
        let largest =
            residual.iter().filter(|residual| residual.is_finite()).fold(0.0, |largest: f64, residual| largest.max(residual.abs()));
        let (factor, unit) = residual_unit(largest);
        let scaled = |values: &[f64]| DeltaColumn::new(&values.iter().map(|value| factor * value).collect::<Vec<_>>());
        let currents = Panel {
            name: name.to_owned(),
            height: CURRENT_HEIGHT,
            kind: PanelKind::Lines,
            ranges: None,
            series: vec![
                Series::new("measured", Ink::Axis, (2.4, MEASURED_OPACITY), DeltaColumn::new(&measured)),
                Series::new(comparison.name(), ink, (1.2, 1.0), DeltaColumn::new(&modelled)),
            ],
        };
        let residuals = Panel {
            name: format!("measured − {}, {unit}", comparison.name()),
            height: RESIDUAL_HEIGHT,
            kind: PanelKind::Lines,
            ranges: None,
            series: vec![
                Series::new("row", ink, (0.8, RESIDUAL_OPACITY), scaled(&residual)),
                Series::new("mean", ink, (2.0, 1.0), scaled(&column(&|(_, mean)| of(*mean)))),
            ],
        };
        [currents, residuals]
    });
    let x = XAxis { name: "time", unit: "s", values: DeltaColumn::resolving(&t, period * TIME_RESOLUTION) };
    PlotData { x, panels: panels.collect(), descriptions: Vec::new(), spans: Vec::new() }
}

impl AxisCurrents<'_> {
    fn ink(&self) -> Ink {
        [Ink::D, Ink::Q][self.axis]
    }

    /// The decimated curve of a function of each row's measured current and residual.
    fn curve(&self, value: fn(f64, f64) -> f64, size: Size) -> Curve {
        let (left, right) = MARGINS;
        let columns = size.width() - (left + right).unsigned_abs();
        self.comparison.pieces().map(|rows| decimated(self.points(rows, value), self.times, columns)).collect()
    }

    fn points(&self, rows: impl Iterator<Item = CurrentSample>, value: fn(f64, f64) -> f64) -> impl Iterator<Item = (f64, f64)> {
        rows.map(move |row| (row.t, value([row.measured.d, row.measured.q][self.axis], [row.residual.d, row.residual.q][self.axis])))
    }

    fn draw_currents(&self, area: &Area, size: Size) -> Drawn {
        let measured = self.curve(|measured, _| measured, size);
        let modelled = self.curve(|measured, residual| measured - residual, size);
        let values = measured.iter().chain(&modelled).flatten().map(|(_, i)| *i);
        let name = ["i_d, A", "i_q, A"][self.axis];
        let behind = translucent(Ink::Axis, 2.4, MEASURED_OPACITY);
        let front = line(self.ink(), 1.2);
        self.panel(area, Axis::around(values, 4), ("", name), size, &[(measured, behind), (modelled, front)])?;
        legend(area, size, &[(behind, "measured", 190), (front, self.comparison.name(), 92)])
    }

    fn draw_residuals(&self, area: &Area, size: Size) -> Drawn {
        let residuals = self.curve(|_, residual| residual, size);
        let largest = residuals.iter().flatten().map(|(_, residual)| residual.abs()).fold(0.0, f64::max);
        let (factor, unit) = residual_unit(largest);
        let scaled =
            |curve: Curve| -> Curve { curve.into_iter().map(|piece| piece.into_iter().map(|(t, i)| (t, factor * i)).collect()).collect() };
        let means = self.comparison.pieces().map(|rows| means(self.points(rows, |_, residual| residual), self.times, MEAN_SPANS));
        let (means, residuals) = (scaled(means.collect()), scaled(residuals));
        let zero = vec![self.times.map(|t| (t, 0.0)).to_vec()];
        let y = Axis::robust(residuals.iter().flatten().map(|(_, i)| *i).chain([0.0]), 4);
        let within = |curve: Curve| -> Curve {
            curve.into_iter().map(|piece| piece.into_iter().map(|(t, i)| (t, i.clamp(y.low, y.high))).collect()).collect()
        };
        let (means, residuals) = (within(means), within(residuals));
        let name = format!("measured − {}, {unit}", self.comparison.name());
        let (behind, front) = (translucent(self.ink(), 0.8, RESIDUAL_OPACITY), line(self.ink(), 2.0));
        self.panel(area, y.clone(), ("time, s", &name), size, &[(residuals, behind), (zero, line(Ink::Text, 1.0)), (means, front)])?;
        legend(area, size, &[(behind, "rows", 134), (front, "mean", 67)])
    }

    /// Draws curves over time; the x axis has numbers only if it has a name.
    fn panel(&self, area: &Area, y: Axis, (x_name, y_name): (&str, &str), size: Size, curves: &[(Curve, ShapeStyle)]) -> Drawn {
        let [from, to] = self.times;
        let x = if from < to { Axis::between(from, to, size.pick(8, 5)) } else { Axis::around(self.times, 4) };
        let (x_label, y_label) = (x.clone(), y.clone());
        let (left, right) = MARGINS;
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

fn translucent(ink: Ink, width: f64, opacity: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().mix(opacity), ..line(ink, width) }
}

/// A sample of each line with its name, at a distance from the right, pixels.
fn legend(area: &Area, size: Size, lines: &[(ShapeStyle, &str, i32)]) -> Drawn {
    let right = size.width() as i32 * UNITS;
    for (style, text, from_right) in lines {
        let (x, y) = (right - from_right * UNITS, 13 * UNITS);
        area.draw(&PathElement::new(vec![(x, y), (x + 20 * UNITS, y)], *style))?;
        area.draw_text(text, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 25 * UNITS, y))?;
    }
    Ok(())
}

/// Means over equal time spans, each at the mean time of its points, s.
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
