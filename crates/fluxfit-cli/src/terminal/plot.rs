//! Convergence curves in characters: logarithmic cost against iteration, one letter per method, so that they can be told apart
//! without colour.

use anstyle::{AnsiColor, Style};
use fluxfit::{optimizer::Method, study::MethodStudy};
use ratatui_core::{buffer::Buffer, layout::Rect, style::Color, symbols::Marker, widgets::Widget};
use ratatui_widgets::chart::{Axis, Chart, Dataset, GraphType};

/// Size of the plot in characters.
const SIZE: (u16, u16) = (96, 20);

/// Costs below this are drawn at it: rounding, where a logarithm means nothing.
const FLOOR: f64 = 1e-12;

/// A method's letter and colour, in the chart's terms and in the terminal's.
fn pen(study: &MethodStudy) -> (char, Color, AnsiColor) {
    match study.method {
        Method::Tgfpa(_) => ('t', Color::Green, AnsiColor::Green),
        Method::Fpa(_) => ('F', Color::Yellow, AnsiColor::Yellow),
        Method::Lpso(_) => ('L', Color::Blue, AnsiColor::Blue),
        Method::Apso(_) => ('A', Color::Magenta, AnsiColor::Magenta),
    }
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
    format!("{}{}\n", text(&buffer, methods), legend(methods))
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
fn text(buffer: &Buffer, methods: &[(MethodStudy, f64)]) -> String {
    let pens: Vec<_> = methods.iter().map(|(study, _)| pen(study)).collect();
    let mut text = String::new();
    for y in 0..buffer.area.height {
        let mut line = String::new();
        for x in 0..buffer.area.width {
            let Some(cell) = buffer.cell((x, y)) else { continue };
            match pens.iter().find(|(_, color, _)| *color == cell.fg) {
                Some((_, _, color)) => {
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
        let style: Style = color.on_default();
        format!("{style}{letter}{style:#} {}", study.method.label())
    });
    format!("{:>12}{}{:>16}", "", entries.collect::<Vec<_>>().join("   "), "x: iteration")
}
