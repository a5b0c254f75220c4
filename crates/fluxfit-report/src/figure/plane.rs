//! The operating points in the plane of i_d and i_q.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, solid},
    palette::Ink,
    plot::Plot,
    residuals::uncertainties,
};
use crate::{
    interactive::{Along, Column, Kind, Live, Panel, Series},
    typography::{decimals, number},
};
use fluxfit::{evidence::SteadyFit, frames::Dq, steady::OperatingPoint};
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

/// Height of the figure, pixels.
const HEIGHT: u32 = 300;

/// Draws the points with their numbers.
pub(crate) fn draw(points: &[OperatingPoint], size: Size) -> Drawing {
    let label = format!("{} operating points in the plane of i_d and i_q, in ampere", points.len());
    Drawing::new((size.width(), HEIGHT), label, |area| paint(area, points, size))
}

fn currents(points: &[OperatingPoint]) -> impl Iterator<Item = Dq> {
    points.iter().map(OperatingPoint::current).filter(|i| i.d.is_finite() && i.q.is_finite())
}

/// Both axes, of which the x axis has about so many numbers.
fn axes(points: &[OperatingPoint], count: usize) -> [Axis; 2] {
    // No current belongs to the picture: how far i_d is from zero is what tells L_d.
    let (d, q) = (extent(currents(points).map(|i| i.d)), extent(currents(points).map(|i| i.q)));
    [Axis::around(widened(d, q), count), Axis::around(widened(q, d), 5)]
}

/// The same for the pointer, which is told when the point was, where it lies and what is left of its voltages.
pub(crate) fn live(found: &SteadyFit) -> Live {
    let all = found.operating_points.iter().zip(&found.estimate.residuals).zip(uncertainties(found));
    let mut points: Vec<(&OperatingPoint, String)> = (1..)
        .zip(all)
        .map(|(number, ((point, residual), uncertainty))| (point, told(number, point, *residual, uncertainty)))
        .filter(|(point, _)| point.current().d.is_finite() && point.current().q.is_finite())
        .collect();
    points.sort_by(|(one, _), (other, _)| one.current().d.total_cmp(&other.current().d));
    let column = |value: &dyn Fn(&OperatingPoint) -> f64| Column::new(&points.iter().map(|(point, _)| value(point)).collect::<Vec<_>>());
    Live {
        x: Along { name: "i_d", unit: "A", values: column(&|point| point.current().d) },
        panels: vec![Panel {
            name: "i_q, A".to_owned(),
            height: HEIGHT as i32,
            kind: Kind::Plane,
            whole: Some(axes(&found.operating_points, 6).map(|axis| [axis.low, axis.high])),
            series: vec![Series::new("point", Ink::D, (1.0, 1.0), column(&|point| point.current().q))],
        }],
        told: points.iter().map(|(_, told)| told.clone()).collect(),
    }
}

/// A point in words; its residuals, V, with their standard uncertainties.
fn told(of: usize, point: &OperatingPoint, residual: [f64; 2], uncertainty: [f64; 2]) -> String {
    let (start, end) = point.time;
    // Digits that tell the length to a hundredth of it.
    let of_time = (2.0 - (end - start).log10().floor()).clamp(0.0, 9.0) as usize;
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    let [d, q] = [0, 1].map(|axis| {
        let tenths = decimals(1e3 * uncertainty[axis], 1);
        format!("{} ± {} mV", fixed(1e3 * residual[axis], tenths), fixed(1e3 * uncertainty[axis], tenths))
    });
    let (current, omega_e) = (point.current(), fixed(point.omega_e(), 1));
    format!(
        "Point {of}: {} to {} s; i_d {} A, i_q {} A, omega_e {omega_e} rad/s; residual of u_d {d}, of u_q {q}",
        fixed(start, of_time),
        fixed(end, of_time),
        fixed(current.d, 3),
        fixed(current.q, 3),
    )
}

fn paint(area: &Area, points: &[OperatingPoint], size: Size) -> Drawn {
    let [x, y] = axes(points, size.pick(6, 4));
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
    for (number, i) in (1..).zip(currents(points)) {
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
