//! Residuals: what the fitted motor leaves of the measured voltages at each operating point.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line, solid},
    palette::Ink,
    plot::Plot,
};
use fluxfit::identify::steady_fit::SteadyFit;
use plotters::{
    element::{Circle, PathElement, Polygon},
    style::text_anchor::{HPos, VPos},
};

/// Standard uncertainties that a bar reaches to either side.
const BAR: f64 = 2.0;

/// Distance of the two equations' markers from the middle of their operating point, which is one wide.
const ASIDE: f64 = 0.15;

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

/// Draws both residuals of each operating point, mV.
pub(crate) fn draw(found: &SteadyFit, size: Size) -> Drawing {
    let label = format!("Residuals of u_d and u_q in millivolts at {} operating points, with bars", found.operating_points.len());
    Drawing::new((size.width(), 290), label, |area| paint(area, found, size))
}

fn paint(area: &Area, found: &SteadyFit, size: Size) -> Drawn {
    // The marks of one axis: where it stands, the residual and its bar, mV.
    let marks = |axis: usize| {
        let of_points = found.estimate.residuals.iter().zip(uncertainties(found)).enumerate();
        let aside = if axis == 0 { -ASIDE } else { ASIDE };
        of_points
            .map(move |(w, (residual, uncertainty))| ((w + 1) as f64 + aside, 1e3 * residual[axis], 1e3 * BAR * uncertainty[axis]))
            .filter(|(_, residual, bar)| residual.is_finite() && bar.is_finite())
    };
    let points = found.operating_points.len();
    let ends = [0, 1].into_iter().flat_map(marks).flat_map(|(_, residual, bar)| [residual - bar, residual + bar]);
    let y = Axis::around(ends.chain([0.0]), 5);
    let mut x = Axis::between(0.5, points.max(1) as f64 + 0.5, size.pick(12, 6));
    // Between two numbers there is no operating point.
    x.ticks.retain(|tick| tick.fract() == 0.0);
    let y_label = y.clone();
    let plot = Plot {
        x,
        y,
        x_name: "operating point",
        y_name: "measured − fitted, mV",
        left: 50,
        right: 12,
        x_label: &|x| format!("{x:.0}"),
        y_label: &|value| y_label.label(value),
    };
    let mut chart = plot.on(area)?;
    chart.series.draw_series([PathElement::new(vec![(0.5, 0.0), (points.max(1) as f64 + 0.5, 0.0)], line(Ink::Axis, 1.0))])?;
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
