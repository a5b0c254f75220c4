//! The operating points in the plane of i_d and i_q.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, solid},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    interactive::{DeltaColumn, Panel, PanelKind, PlotData, Series, XAxis},
    operating_point_uncertainty::residual_uncertainties,
    report::Report,
    typography::{decimals, decimals_of_span, number, prose},
};
use fluxfit::{evidence::SteadyFit, frames::Dq, steady::OperatingPoint};
use plotters::{
    element::Circle,
    style::text_anchor::{HPos, VPos},
};

/// Markers closer than this, pixels, share one label.
const NEAR: i32 = 14;

/// Largest number of points in one label; further ones are abbreviated.
const NUMBERS: usize = 3;

/// Smallest length of an axis relative to the other: noise of one current must not look like different operating points.
const MIN_LENGTH: f64 = 0.25;

/// Height of the figure, pixels.
const HEIGHT: u32 = 300;

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    let fit = found.steady.as_ref()?;
    Some(Figure {
        name: "operating-points",
        section: "operating-points",
        draw: Box::new(move |size| draw(&fit.operating_points, size)),
        data: Some(Box::new(move || data(fit))),
        caption: prose(
            "The operating points in the plane of the currents, numbered as in the table. The farther apart they are, the better the parameters \
             can be distinguished; L_d needs operating points with different i_d.",
        ),
    })
}

/// Draws the points with their numbers.
fn draw(points: &[OperatingPoint], size: Size) -> Drawing {
    let label = format!("{} operating points in the plane of i_d and i_q, in ampere", points.len());
    Drawing::new((size.width(), HEIGHT), label, |area| paint(area, points, size))
}

fn currents(points: &[OperatingPoint]) -> impl Iterator<Item = Dq> {
    points.iter().map(OperatingPoint::current).filter(|i| i.d.is_finite() && i.q.is_finite())
}

/// Both axes; the x axis has about `count` ticks.
fn axes(points: &[OperatingPoint], count: usize) -> [Axis; 2] {
    // The axes include zero: the distance of i_d from zero determines how well L_d is identified.
    let (d, q) = (extent(currents(points).map(|i| i.d)), extent(currents(points).map(|i| i.q)));
    [Axis::around(widened(d, q), count), Axis::around(widened(q, d), 5)]
}

/// The data of the interactive plot, with a description of each point.
fn data(found: &SteadyFit) -> PlotData {
    let all = found.operating_points.iter().zip(&found.estimate.residuals).zip(residual_uncertainties(found));
    let mut points: Vec<(&OperatingPoint, String)> = (1..)
        .zip(all)
        .map(|(number, ((point, residual), uncertainty))| (point, description(number, point, *residual, uncertainty)))
        .filter(|(point, _)| point.current().d.is_finite() && point.current().q.is_finite())
        .collect();
    points.sort_by(|(one, _), (other, _)| one.current().d.total_cmp(&other.current().d));
    let column =
        |value: &dyn Fn(&OperatingPoint) -> f64| DeltaColumn::new(&points.iter().map(|(point, _)| value(point)).collect::<Vec<_>>());
    PlotData {
        x: XAxis { name: "i_d", unit: "A", values: column(&|point| point.current().d) },
        panels: vec![Panel {
            name: "i_q, A".to_owned(),
            height: HEIGHT as i32,
            kind: PanelKind::Plane,
            ranges: Some(axes(&found.operating_points, 6).map(|axis| [axis.low, axis.high])),
            series: vec![Series::new("point", Ink::D, (1.0, 1.0), column(&|point| point.current().q))],
        }],
        descriptions: points.iter().map(|(_, description)| description.clone()).collect(),
    }
}

/// Time, currents, speed and residuals of a point, the latter with their standard uncertainties.
fn description(number_of_point: usize, point: &OperatingPoint, residual: [f64; 2], uncertainty: [f64; 2]) -> String {
    let (start, end) = point.time;
    let of_time = decimals_of_span(end - start);
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    let [d, q] = [0, 1].map(|axis| {
        let tenths = decimals(1e3 * uncertainty[axis], 1);
        format!("{} ± {} mV", fixed(1e3 * residual[axis], tenths), fixed(1e3 * uncertainty[axis], tenths))
    });
    let (current, omega_e) = (point.current(), fixed(point.omega_e(), 1));
    format!(
        "Point {number_of_point}: {} to {} s; i_d {} A, i_q {} A, omega_e {omega_e} rad/s; residual of u_d {d}, of u_q {q}",
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
    // Each label: its position, and the numbers of its points.
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

/// Smallest and largest value, and zero.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([0.0, 0.0], |[low, high], value| [low.min(value), high.max(value)])
}

/// A range, extended on both sides to the smallest length relative to the other axis.
fn widened([low, high]: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let missing = (MIN_LENGTH * (other[1] - other[0]) - (high - low)).max(0.0);
    [low - 0.5 * missing, high + 0.5 * missing]
}
