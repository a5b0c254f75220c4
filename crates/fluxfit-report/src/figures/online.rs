//! The courses of the estimators of a stream: a row of panels for each estimator, a column for each parameter.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, line, shade, text_style},
        palette::Ink,
        plot::{Chart, Plot},
        size::Size,
    },
    figure::Figure,
    report::Report,
    row_times::offsets,
    typography::{self, unit},
};
use fluxfit::{
    log::Log,
    motor::{PARAMETERS, Parameter},
};
use fluxfit_track::{
    Tracked, Verdict,
    comparison::{Course, OnlineComparison},
};
use fluxfit_units::Scale;
use maud::html;
use plotters::element::{PathElement, Polygon};

/// Heights of a panel, of what two panels below each other have in common, and of the line above with the estimator's name, pixels.
const PANEL: i32 = 132;
const OVERLAP: i32 = 30;
const NAME: i32 = 20;

/// Opacity of an interval.
const BAND: f64 = 0.2;

/// Least distance of the ends of an axis from the reference, as a part of it: an error that matters to nobody does not fill the panel.
const CLOSE: f64 = 0.05;

/// What is drawn.
struct Courses<'a> {
    of: &'a OnlineComparison,
    /// Times of the rows that were kept, s.
    times: Vec<f64>,
}

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let of = report.online?;
    let courses = Courses { of, times: times(report.log, &of.rows) };
    Some(Figure {
        name: "estimators",
        section: "online",
        draw: Box::new(move |size| courses.draw(size)),
        data: None,
        caption: html! {
            "What each estimator tells in the course of the log, row by row. Green: identified (half of the 95\u{a0}% interval, shaded, is at most 5 % "
            "of the value); amber: weak; grey: held while nothing excites the parameters; black: an estimator without an error covariance, "
            "which cannot tell how wrong it is. No line: no value is told. "
            @if of.document.truth.is_some() { "Dashed: the true value. " }
            "Thin line across the panel: the batch answer, from all rows. The axes of a column are the same; a line along the edge is beyond it."
        },
    })
}

/// Times of rows, s; those of joined logs are consecutive.
fn times(log: &Log, rows: &[usize]) -> Vec<f64> {
    let offsets = offsets(log);
    let offset = |row: usize| log.segment_of(row).and_then(|segment| offsets.get(segment.log)).copied().unwrap_or(0.0);
    rows.iter().map(|row| log.columns().t[*row] - offset(*row)).collect()
}

impl Courses<'_> {
    fn draw(&self, size: Size) -> Drawing {
        let columns = size.pick(PARAMETERS as i32, 2);
        let lines = PARAMETERS as i32 / columns;
        let (width, height) = (size.width() as i32 / columns, NAME + lines * (PANEL - OVERLAP));
        let names: Vec<&str> = self.of.courses.iter().map(|course| course.method.label()).collect();
        let label = format!("Curves over time: R_s, L_d, L_q and psi_f as told by {}", names.join("; "));
        let whole = (height * self.of.courses.len() as i32 + OVERLAP).unsigned_abs();
        Drawing::new((size.width(), whole), label, |area| {
            (0..).zip(&self.of.courses).try_for_each(|(row, course)| {
                let top = row * height;
                let (key, label) = (course.method.key(), course.method.label());
                let name = size.pick(format!("{key}: {label}"), key.to_owned());
                area.draw_text(&name, &text_style(Ink::Text), (2 * UNITS, (top + 4) * UNITS))?;
                let is_last = row as usize + 1 == self.of.courses.len();
                (0..).zip(Parameter::ALL).try_for_each(|(place, parameter)| {
                    let corner = (place % columns * width * UNITS, (top + NAME + place / columns * (PANEL - OVERLAP)) * UNITS);
                    let panel = area.clone().shrink(corner, (width * UNITS, PANEL * UNITS));
                    self.paint(&panel, course, parameter, is_last && place / columns + 1 == lines)
                })
            })
        })
    }

    /// True value and batch value.
    fn references(&self, parameter: Parameter) -> [Option<f64>; 2] {
        let document = &self.of.document;
        let j = parameter as usize;
        let truth = document.truth.as_ref().map(|truth| [truth.rs, truth.ld, truth.lq, truth.psi_f][j]);
        let batch = &document.batch;
        [truth, [batch.rs, batch.ld, batch.lq, batch.psi_f][j].value]
    }

    /// The axis of a parameter: around the references, and as far as the recommended estimator goes when it has identified it.
    fn axis(&self, parameter: Parameter) -> Axis {
        let j = parameter as usize;
        let is_known = |tracked: &Tracked| matches!(tracked.verdict, Verdict::Identified | Verdict::Holding { .. });
        let of_best = self.of.courses.first().into_iter().flat_map(|course| &course.told).map(|told| told[j]);
        let known = of_best.filter(is_known).filter_map(|tracked| tracked.value);
        let wanted: Vec<f64> = self.references(parameter).into_iter().flatten().chain(known).collect();
        let around = wanted.iter().flat_map(|value| [value * (1.0 - CLOSE), value * (1.0 + CLOSE)]);
        if wanted.is_empty() {
            let all = self.of.courses.iter().flat_map(|course| &course.told).filter_map(|told| told[j].value);
            Axis::robust(all, 3)
        } else {
            Axis::around(around, 3)
        }
    }

    fn paint(&self, area: &Area, course: &Course, parameter: Parameter, is_last: bool) -> Drawn {
        let (start, end) = (self.times.first().copied().unwrap_or(0.0), self.times.last().copied().unwrap_or(1.0));
        let x = if start < end { Axis::between(start, end, 5) } else { Axis::around([start, end], 2) };
        let y = self.axis(parameter);
        let (x_label, [low, high], step) = (x.clone(), [y.low, y.high], y.step);
        let scale = Scale::for_value(parameter, 0.5 * (low + high));
        let y_name = format!("{}, {}", parameter.symbol(), unit(parameter, &scale));
        let plot = Plot {
            x,
            y,
            x_name: if is_last { "time, s" } else { "" },
            y_name: &y_name,
            left: 44,
            right: 8,
            x_label: &|t| if is_last { x_label.label(t) } else { String::new() },
            // Two significant digits of ten steps distinguish neighbouring ticks.
            y_label: &|value| typography::minus(scale.format(value, 10.0 * step)),
        };
        let mut chart = plot.on(area)?;
        let [truth, batch] = self.references(parameter);
        for (value, ink, pixels) in [(batch, Ink::Axis, 0.8), (truth, Ink::Truth, 1.5)] {
            if let Some(value) = value.filter(|value| (low..=high).contains(value)) {
                chart.series.draw_series([PathElement::new(vec![(start, value), (end, value)], line(ink, pixels))])?;
            }
        }
        self.curve(&mut chart, course, parameter, [low, high])
    }

    /// Interval and value, a piece for each verdict.
    fn curve(&self, chart: &mut Chart, course: &Course, parameter: Parameter, [low, high]: [f64; 2]) -> Drawn {
        let told: Vec<(f64, Tracked)> = self.times.iter().copied().zip(course.told.iter().map(|told| told[parameter as usize])).collect();
        let mut begin = 0;
        while begin < told.len() {
            let ink = ink(told[begin].1.verdict);
            let length = told[begin..].iter().take_while(|(_, tracked)| self::ink(tracked.verdict) == ink).count();
            // To the first point of the next piece: no gap where only the verdict changes.
            let piece = &told[begin..told.len().min(begin + length + 1)];
            begin += length;
            let Some(ink) = ink else { continue };
            let inside = |y: f64| y.clamp(low, high);
            let points: Vec<(f64, f64)> = piece.iter().filter_map(|(t, tracked)| Some((*t, inside(tracked.value?)))).collect();
            let end = |side: usize| piece.iter().filter_map(move |(t, tracked)| Some((*t, inside(tracked.interval()?[side]))));
            let outline: Vec<(f64, f64)> = end(0).chain(end(1).collect::<Vec<_>>().into_iter().rev()).collect();
            if outline.len() > 2 {
                chart.series.draw_series([Polygon::new(outline, shade(ink, BAND))])?;
            }
            if points.len() > 1 {
                chart.series.draw_series([PathElement::new(points, line(ink, 1.6))])?;
            }
        }
        Ok(())
    }
}

/// The ink of a verdict; none where no value is told.
fn ink(verdict: Verdict) -> Option<Ink> {
    match verdict {
        Verdict::Identified => Some(Ink::Identified),
        Verdict::Weak => Some(Ink::Weak),
        Verdict::Holding { .. } => Some(Ink::Axis),
        Verdict::Unknown => Some(Ink::Text),
        Verdict::NotIdentifiable => None,
    }
}
