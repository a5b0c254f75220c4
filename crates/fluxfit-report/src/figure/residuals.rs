//! Residuals: what the fitted motor leaves of the measured voltages at each operating point.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line, solid},
    palette::Ink,
    plot::Plot,
};
use crate::interactive::{Along, Column, Kind, Live, Panel, Series};
use fluxfit::evidence::SteadyFit;
use plotters::{
    element::{Circle, PathElement, Polygon},
    style::text_anchor::{HPos, VPos},
};

/// Standard uncertainties that a bar reaches to either side.
const BAR: f64 = 2.0;

/// Distance of the two equations' markers from the middle of their operating point, which is one wide.
const ASIDE: f64 = 0.15;

/// Part of a bar that is told apart.
const OF_BAR: f64 = 0.01;

/// Radius of a marker, pixels.
const MARKER: i32 = 4;

/// Standard uncertainty, V, of both residuals of each operating point: noise of the means, and accuracy of the voltages.
pub(crate) fn uncertainties(found: &SteadyFit) -> Vec<[f64; 2]> {
    let points = found.operating_points.iter().zip(&found.estimate.accuracy);
    let both = points.map(|(point, accuracy)| {
        let noise = point.residual_covariance(&found.estimate.motor);
        [0, 1].map(|axis| (noise[axis][axis].max(0.0) + accuracy.powi(2)).sqrt())
    });
    both.collect()
}

/// Height of the figure, pixels, and the name of its y axis.
const HEIGHT: u32 = 290;
const NAME: &str = "measured − fitted, mV";

/// Draws both residuals of each operating point, mV.
pub(crate) fn draw(found: &SteadyFit, size: Size) -> Drawing {
    let label = format!("Residuals of u_d and u_q in millivolts at {} operating points, with bars", found.operating_points.len());
    Drawing::new((size.width(), HEIGHT), label, |area| paint(area, found, size))
}

/// The marks of one axis: where each stands, the residual and its bar, mV.
fn marks(found: &SteadyFit, axis: usize) -> impl Iterator<Item = (f64, f64, f64)> {
    let of_points = found.estimate.residuals.iter().zip(uncertainties(found)).enumerate();
    let aside = if axis == 0 { -ASIDE } else { ASIDE };
    of_points
        .map(move |(w, (residual, uncertainty))| ((w + 1) as f64 + aside, 1e3 * residual[axis], 1e3 * BAR * uncertainty[axis]))
        .filter(|(_, residual, bar)| residual.is_finite() && bar.is_finite())
}

/// The y axis: from the lowest end of a bar to the highest one.
fn heights(found: &SteadyFit) -> Axis {
    let ends = [0, 1].into_iter().flat_map(|axis| marks(found, axis)).flat_map(|(_, residual, bar)| [residual - bar, residual + bar]);
    Axis::around(ends.chain([0.0]), 5)
}

/// Right end of the x axis.
fn end(found: &SteadyFit) -> f64 {
    found.operating_points.len().max(1) as f64 + 0.5
}

/// The same for the pointer.
pub(crate) fn live(found: &SteadyFit) -> Live {
    let (uncertainties, y) = (uncertainties(found), heights(found));
    let numbers: Vec<f64> = (1..=found.operating_points.len()).map(|number| number as f64).collect();
    let series = [(0, "u_d", Ink::D), (1, "u_q", Ink::Q)].map(|(axis, name, ink)| {
        let residuals: Vec<f64> = found.estimate.residuals.iter().map(|residual| 1e3 * residual[axis]).collect();
        let bars: Vec<f64> = uncertainties.iter().map(|both| 1e3 * BAR * both[axis]).collect();
        // The same digits for both: those that the shortest bar is worth.
        let shortest = bars.iter().copied().filter(|bar| *bar > 0.0).fold(f64::INFINITY, f64::min);
        let column = |values: &[f64]| Column::resolving(values, shortest * OF_BAR);
        Series::new(name, ink, (1.5, 1.0), column(&residuals)).within(vec![column(&bars)])
    });
    Live {
        x: Along { name: "operating point", unit: "", values: Column::resolving(&numbers, 1.0) },
        panels: vec![Panel {
            name: NAME.to_owned(),
            height: HEIGHT as i32,
            kind: Kind::Bars,
            whole: Some([[0.5, end(found)], [y.low, y.high]]),
            series: series.into(),
        }],
        told: Vec::new(),
    }
}

fn paint(area: &Area, found: &SteadyFit, size: Size) -> Drawn {
    let marks = |axis: usize| marks(found, axis);
    let y = heights(found);
    let mut x = Axis::between(0.5, end(found), size.pick(12, 6));
    // Between two numbers there is no operating point.
    x.ticks.retain(|tick| tick.fract() == 0.0);
    let y_label = y.clone();
    let plot = Plot {
        x,
        y,
        x_name: "operating point",
        y_name: NAME,
        left: 50,
        right: 12,
        x_label: &|x| format!("{x:.0}"),
        y_label: &|value| y_label.label(value),
    };
    let mut chart = plot.on(area)?;
    chart.series.draw_series([PathElement::new(vec![(0.5, 0.0), (end(found), 0.0)], line(Ink::Axis, 1.0))])?;
    for (axis, ink) in [(0, Ink::D), (1, Ink::Q)] {
        for (x, residual, bar) in marks(axis) {
            chart.series.draw_series([PathElement::new(vec![(x, residual - bar), (x, residual + bar)], line(ink, 1.5))])?;
            let at = chart.place(x, residual);
            marker(area, axis, at, ink)?;
        }
    }
    legend(area, size)
}

/// A disc for d, a square for q: told apart without colour.
fn marker(area: &Area, axis: usize, (x, y): (i32, i32), ink: Ink) -> Drawn {
    let r = MARKER * UNITS;
    if axis == 0 {
        return area.draw(&Circle::new((x, y), r, solid(ink)));
    }
    area.draw(&Polygon::new(vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)], solid(ink)))
}

fn legend(area: &Area, size: Size) -> Drawn {
    let right = size.width() as i32 * UNITS;
    for (axis, ink, name, from_right) in [(0, Ink::D, "u_d", 88), (1, Ink::Q, "u_q", 42)] {
        let (x, y) = (right - from_right * UNITS, 13 * UNITS);
        marker(area, axis, (x, y), ink)?;
        area.draw_text(name, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 9 * UNITS, y))?;
    }
    Ok(())
}
