//! Curves in characters: convergence, logarithmic cost against iteration, one letter per method, so that they can be told apart
//! without colour; and the courses of a log's currents and speed.

use anstyle::{Ansi256Color, AnsiColor};
use fluxfit::{log::Log, study::MethodStudy};
use fluxfit_units::significant;
use ratatui_core::{buffer::Buffer, layout::Rect, style::Color, symbols::Marker, widgets::Widget};
use ratatui_widgets::chart::{Axis, Chart, Dataset, GraphType};

/// Size of the plot in characters.
const SIZE: (u16, u16) = (96, 20);

/// Costs below this are drawn at it: rounding, where a logarithm means nothing.
const FLOOR: f64 = 1e-12;

/// A method's letter and colour, in the chart's terms and in the terminal's.
fn pen(study: &MethodStudy) -> (char, Color, anstyle::Color) {
    let look = study.method.facts().look;
    let ansi = Ansi256Color(look.terminal);
    // The first sixteen have names, which every terminal knows.
    (look.letter, Color::Indexed(look.terminal), ansi.into_ansi().map_or(ansi.into(), Into::into))
}

/// The medians of the cost above the minimum, drawn.
pub(crate) fn convergence(methods: &[(MethodStudy, f64)]) -> String {
    let curves: Vec<Vec<(f64, f64)>> = methods.iter().map(|(study, _)| curve(study)).collect();
    let all = || curves.iter().flatten();
    let iterations = all().map(|(x, _)| *x).fold(1.0, f64::max);
    let low = all().map(|(_, y)| *y).fold(f64::INFINITY, f64::min).floor();
    let high = all().map(|(_, y)| *y).fold(f64::NEG_INFINITY, f64::max).ceil().max(low + 1.0);

    let datasets = curves.iter().zip(methods).map(|(points, (study, _))| {
        let (letter, color, _) = pen(study);
        Dataset::default().marker(Marker::Custom(letter)).graph_type(GraphType::Line).style(color).data(points)
    });
    let labels = |from: f64, to: f64, steps: usize| (0..=steps).map(move |k| from + (to - from) * k as f64 / steps as f64);
    let chart = Chart::new(datasets.collect())
        .x_axis(Axis::default().bounds([0.0, iterations]).labels(labels(0.0, iterations, 3).map(|x| format!("{x:.0}"))))
        .y_axis(Axis::default().bounds([low, high]).labels(labels(low, high, 4).map(|y| format!("1e{y:+.0}"))));
    let area = Rect::new(0, 0, SIZE.0, SIZE.1);
    let mut buffer = Buffer::empty(area);
    chart.render(area, &mut buffer);
    let pens: Vec<_> = methods.iter().map(|(study, _)| pen(study)).map(|(_, color, ansi)| (color, ansi)).collect();
    format!("{}{}\n", text(&buffer, &pens), legend(methods))
}

/// Size of one course in characters.
const COURSE: (u16, u16) = (79, 7);

/// Points of a course: two, least and largest, for each of the columns of dots that a character has.
const COLUMNS: usize = 140;

/// i_d, i_q and the speed of a log over time, one below the other.
pub(crate) fn courses(log: &Log) -> String {
    let columns = log.columns();
    let panels =
        [("i_d, A", &columns.id, Color::Blue), ("i_q, A", &columns.iq, Color::Green), ("omega_e, rad/s", &columns.omega_e, Color::Yellow)];
    panels.into_iter().map(|(name, values, color)| course(name, &columns.t, values, color)).collect()
}

fn course(name: &str, t: &[f64], values: &[f64], color: Color) -> String {
    let (Some(start), Some(end)) = (t.first(), t.last()) else { return String::new() };
    let points = extremes(t, values);
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, y)| (low.min(*y), high.max(*y)));
    let margin = if high > low { 0.05 * (high - low) } else { 0.5 + low.abs() * 0.05 };
    let bounds = [low - margin, high + margin];
    let labels = |from: f64, to: f64, steps: usize| (0..=steps).map(move |k| from + (to - from) * k as f64 / steps as f64);
    let data = Dataset::default().marker(Marker::Braille).graph_type(GraphType::Line).style(color).data(&points);
    let chart = Chart::new(vec![data])
        .x_axis(Axis::default().bounds([*start, *end]).labels(labels(*start, *end, 3).map(|t| format!("{} s", significant(t, 4)))))
        .y_axis(Axis::default().bounds(bounds).labels(labels(bounds[0], bounds[1], 1).map(|y| format!("{:>8}", significant(y, 3)))));
    let area = Rect::new(0, 0, COURSE.0, COURSE.1);
    let mut buffer = Buffer::empty(area);
    chart.render(area, &mut buffer);
    let pen = match color {
        Color::Blue => AnsiColor::Blue,
        Color::Green => AnsiColor::Green,
        _ => AnsiColor::Yellow,
    };
    format!("{name}\n{}", text(&buffer, &[(color, pen.into())]))
}

/// Least and largest value of each of [`COLUMNS`] spans of time.
fn extremes(t: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    let span = t.len().div_ceil(COLUMNS).max(1);
    let of_span = |(t, values): (&[f64], &[f64])| {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let points: Vec<(f64, f64)> = t.iter().copied().zip(values.iter().copied()).collect();
        let mut ends: Vec<(f64, f64)> = points.iter().min_by(by).into_iter().chain(points.iter().max_by(by)).copied().collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        ends
    };
    t.chunks(span).zip(values.chunks(span)).flat_map(of_span).collect()
}

/// Iteration and the logarithm of the median cost.
fn curve(study: &MethodStudy) -> Vec<(f64, f64)> {
    study
        .convergence
        .quartiles
        .iter()
        .enumerate()
        .map(|(iteration, [_, median, _])| (iteration as f64, median.max(FLOOR).log10()))
        .collect()
}

/// The buffer's cells, with their colours.
fn text(buffer: &Buffer, pens: &[(Color, anstyle::Color)]) -> String {
    let mut text = String::new();
    for y in 0..buffer.area.height {
        let mut line = String::new();
        for x in 0..buffer.area.width {
            let Some(cell) = buffer.cell((x, y)) else { continue };
            match pens.iter().find(|(color, _)| *color == cell.fg) {
                Some((_, color)) => {
                    let style = color.on_default();
                    line += &format!("{style}{}{style:#}", cell.symbol());
                }
                None => line += cell.symbol(),
            }
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

fn legend(methods: &[(MethodStudy, f64)]) -> String {
    let entries = methods.iter().map(|(study, _)| {
        let (letter, _, color) = pen(study);
        let style = color.on_default();
        format!("{style}{letter}{style:#} {}", study.method.label())
    });
    format!("{:>12}{}{:>16}", "", entries.collect::<Vec<_>>().join("   "), "x: iteration")
}
