//! The operating points in the plane of i_d and i_q.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, solid},
    palette::Ink,
    plot::Plot,
};
use fluxfit::steady::OperatingPoint;
use plotters::{
    element::Circle,
    style::text_anchor::{HPos, VPos},
};

/// Markers nearer than this, pixels, share one label.
const NEAR: i32 = 14;

/// Numbers in one label; more are cut short.
const NUMBERS: usize = 3;

/// Least length of an axis as a fraction of the other's: noise of one current must not look like a spread.
const LEAST_LENGTH: f64 = 0.25;

/// Draws the points with their numbers.
pub(super) fn draw(points: &[OperatingPoint], size: Size) -> Drawing {
    let label = format!("{} operating points in the plane of i_d and i_q, in ampere", points.len());
    Drawing::new((size.width(), 300), label, |area| paint(area, points, size))
}

fn paint(area: &Area, points: &[OperatingPoint], size: Size) -> Drawn {
    let currents = || points.iter().map(OperatingPoint::current).filter(|i| i.d.is_finite() && i.q.is_finite());
    // No current belongs to the picture: how far i_d is from zero is what tells L_d.
    let (d, q) = (extent(currents().map(|i| i.d)), extent(currents().map(|i| i.q)));
    let x = Axis::around(widened(d, q), size.pick(6, 4));
    let y = Axis::around(widened(q, d), 5);
    let (x_label, y_label) = (x.clone(), y.clone());
    let plot = Plot {
        x,
        y,
        x_name: "i_d, A",
        y_name: "i_q, A",
        left: 50,
        right: 24,
        x_label: &|x| x_label.label(x),
        y_label: &|y| y_label.label(y),
    };
    let chart = plot.on(area)?;
    // Each label: where it stands and whom it names.
    let mut labels: Vec<((i32, i32), Vec<usize>)> = Vec::new();
    for (number, i) in (1..).zip(currents()) {
        let at = chart.place(i.d, i.q);
        area.draw(&Circle::new(at, 4 * UNITS, solid(Ink::D)))?;
        let near = |(x, y): (i32, i32)| (x - at.0).abs().max((y - at.1).abs()) < NEAR * UNITS;
        match labels.iter_mut().find(|(place, _)| near(*place)) {
            Some((_, numbers)) => numbers.push(number),
            None => labels.push((at, vec![number])),
        }
    }
    for ((x, y), numbers) in labels {
        let named: Vec<String> = numbers.iter().take(NUMBERS).map(ToString::to_string).collect();
        let text = format!("{}{}", named.join(", "), if numbers.len() > NUMBERS { " …" } else { "" });
        area.draw_text(&text, &anchored(Ink::Text, HPos::Center, VPos::Bottom), (x, y - 6 * UNITS))?;
    }
    Ok(())
}

/// Least and largest value; zero is always between.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([0.0, 0.0], |[low, high], value| [low.min(value), high.max(value)])
}

/// A range, on both sides as much longer as it needs to stand beside the other one.
fn widened([low, high]: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let missing = (LEAST_LENGTH * (other[1] - other[0]) - (high - low)).max(0.0);
    [low - 0.5 * missing, high + 0.5 * missing]
}
