//! Curves in characters: convergence, logarithmic cost against iteration, one letter per method, so that they can be told apart
//! without colour; and the courses of a log's channels.

use anstyle::{Ansi256Color, AnsiColor};
use fluxfit::{
    log::Log,
    study::{MethodStudy, ROUNDING},
};
use fluxfit_units::significant;
use ratatui_core::{buffer::Buffer, layout::Rect, style::Color, symbols::Marker, widgets::Widget};
use ratatui_widgets::chart::{Axis, Chart, Dataset, GraphType};

/// Lines of the plot of convergence.
const LINES: u16 = 20;

/// Most columns of a plot: wider ones show no more.
const WIDEST: u16 = 96;

/// Columns of a plot, as the terminal has them.
fn width() -> u16 {
    u16::try_from(super::width()).unwrap_or(WIDEST).min(WIDEST)
}

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
    let chart = Chart::new(datasets.collect())
        .x_axis(Axis::default().bounds([0.0, iterations]).labels(ticks(0.0, iterations, 3).map(|x| format!("{x:.0}"))))
        .y_axis(Axis::default().bounds([low, high]).labels(ticks(low, high, 4).map(|y| format!("1e{y:+.0}"))));
    let area = Rect::new(0, 0, width(), LINES);
    let mut buffer = Buffer::empty(area);
    chart.render(area, &mut buffer);
    let pens: Vec<_> = methods.iter().map(|(study, _)| pen(study)).map(|(_, color, ansi)| (color, ansi)).collect();
    format!("{}{}\n", text(&buffer, &pens), legend(methods))
}

/// Characters of a method's course, and of its name before it.
const SPARKS: usize = 52;
const NAME: usize = 22;

/// Heights of a character.
const HEIGHTS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The medians of the cost above the minimum of many methods: a line for each, with the scale of all of them.
pub(crate) fn courses_of_methods(methods: &[&(MethodStudy, f64)]) -> String {
    let curves: Vec<Vec<(f64, f64)>> = methods.iter().map(|(study, _)| curve(study)).collect();
    let all = || curves.iter().flatten().map(|(_, y)| *y);
    let (low, high) = (all().fold(f64::INFINITY, f64::min).floor(), all().fold(f64::NEG_INFINITY, f64::max).ceil());
    let last = curves.iter().map(Vec::len).max().unwrap_or(1).max(2) - 1;
    let mut text = String::new();
    for (points, (study, _)) in curves.iter().zip(methods) {
        let (_, _, color) = pen(study);
        let style = color.on_default();
        // A run that stopped early keeps its last value.
        let spark = |k: usize| {
            let (_, y) = points.get(k * last / (SPARKS - 1)).or(points.last()).copied().unwrap_or((0.0, low));
            let height = (y - low) / (high - low).max(1.0) * (HEIGHTS.len() - 1) as f64;
            HEIGHTS[(height.ceil() as usize).min(HEIGHTS.len() - 1)]
        };
        let sparks: String = (0..SPARKS).map(spark).collect();
        text += format!("{:<NAME$}{style}{sparks}{style:#}", study.method.short_label()).trim_end();
        text.push('\n');
    }
    let scale = format!("iteration 0 to {last}; height: from 1e{low:+.0} (empty) to 1e{high:+.0} (full), logarithmic");
    text + &super::wrapped("", &scale)
}

/// Lines of one course, and of the axis below the last one.
const COURSE: (u16, u16) = (4, 2);

/// Points of a course: two, least and largest, for each of the columns of dots that a character has.
const COLUMNS: usize = 140;

/// Voltages, currents and speed of a log over time, one below the other.
pub(crate) fn courses(log: &Log) -> String {
    let columns = log.columns();
    let panels = [
        ("u_d, V", &columns.ud, Color::Cyan),
        ("u_q, V", &columns.uq, Color::Magenta),
        ("i_d, A", &columns.id, Color::Blue),
        ("i_q, A", &columns.iq, Color::Green),
        ("omega_e, rad/s", &columns.omega_e, Color::Yellow),
    ];
    let (Some(start), Some(end)) = (columns.t.first(), columns.t.last()) else { return String::new() };
    let axis = Axis::default().bounds([*start, *end]);
    let last = panels.len() - 1;
    let course = |(place, (name, values, color)): (usize, (&str, &Vec<f64>, Color))| {
        let labels = ticks(*start, *end, 3).map(|t| format!("{} s", significant(t, 4)));
        let (axis, below) = if place == last { (axis.clone().labels(labels), COURSE.1) } else { (axis.clone(), 0) };
        course(name, &extremes(&columns.t, values), color, axis, below)
    };
    panels.into_iter().enumerate().map(course).collect()
}

/// The courses of columns of a file that is no log yet: name, and least and largest number of each of many stretches of rows.
pub(crate) fn courses_of_columns(columns: &[(String, &[[f64; 2]])]) -> String {
    let of_column = |(name, spans): &(String, &[[f64; 2]])| {
        let points: Vec<(f64, f64)> =
            spans.iter().enumerate().flat_map(|(k, [low, high])| [(k as f64, *low), (k as f64 + 0.5, *high)]).collect();
        course(name, &points, Color::Blue, Axis::default().bounds([0.0, spans.len() as f64]), 0)
    };
    columns.iter().filter(|(_, spans)| !spans.is_empty()).map(of_column).collect()
}

/// Numbers with equal steps between them, from end to end.
pub(crate) fn ticks(from: f64, to: f64, steps: usize) -> impl Iterator<Item = f64> {
    (0..=steps).map(move |k| from + (to - from) * k as f64 / steps as f64)
}

/// One course; `below`: lines of the axis below it.
fn course(name: &str, points: &[(f64, f64)], color: Color, x_axis: Axis, below: u16) -> String {
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, y)| (low.min(*y), high.max(*y)));
    let margin = if high > low { 0.05 * (high - low) } else { 0.5 + low.abs() * 0.05 };
    let bounds = [low - margin, high + margin];
    let data = Dataset::default().marker(Marker::Braille).graph_type(GraphType::Line).style(color).data(points);
    let chart = Chart::new(vec![data])
        .x_axis(x_axis)
        .y_axis(Axis::default().bounds(bounds).labels(bounds.map(|y| format!("{:>8}", significant(y, 3)))));
    let area = Rect::new(0, 0, width() - 1, COURSE.0 + below);
    let mut buffer = Buffer::empty(area);
    chart.render(area, &mut buffer);
    let pen = match color {
        Color::Blue => AnsiColor::Blue,
        Color::Cyan => AnsiColor::Cyan,
        Color::Magenta => AnsiColor::Magenta,
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
        .map(|(iteration, [_, median, _])| (iteration as f64, median.max(ROUNDING).log10()))
        .collect()
}

/// The buffer's cells, with their colours.
pub(crate) fn text(buffer: &Buffer, pens: &[(Color, anstyle::Color)]) -> String {
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
