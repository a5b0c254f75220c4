//! The joint confidence region of R_s and psi_f: an ellipse about the value, in percent of it, and the two single intervals as a box.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, line, shade, solid},
    palette::Ink,
    plot::Plot,
};
use fluxfit::Judgement;
use plotters::element::{Circle, PathElement, Polygon};
use std::f64::consts::TAU;

/// Standard errors that the joint 95 % region of two normal errors reaches: chi-squared with two degrees of freedom is 5.991 there.
pub(crate) const JOINT: f64 = 2.447_746_83;

/// Corners that look like a curve.
const CORNERS: usize = 144;

/// Two judgements and the correlation of their errors.
#[derive(Clone, Copy)]
pub(crate) struct Pair<'a> {
    /// Along the sheet.
    pub(crate) x: &'a Judgement,
    /// Up the sheet.
    pub(crate) y: &'a Judgement,
    /// From -1 to 1.
    pub(crate) correlation: f64,
}

/// Percent of its value that a parameter's error is.
fn percent(judgement: &Judgement, error: f64) -> f64 {
    100.0 * error / judgement.raw.abs()
}

/// Outline of the region, percent of the values.
fn outline(pair: &Pair) -> Vec<(f64, f64)> {
    let [x, y] = [pair.x, pair.y].map(|judgement| JOINT * percent(judgement, judgement.uncertainty.standard_error()));
    let rho = pair.correlation.clamp(-1.0, 1.0);
    let point = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / CORNERS as f64).sin_cos();
        (x * cos, y * (rho * cos + (1.0 - rho * rho).sqrt() * sin))
    };
    (0..=CORNERS).map(point).collect()
}

/// Draws the region.
pub(crate) fn draw(pair: &Pair, size: Size) -> Drawing {
    let label = format!(
        "Ellipse: joint 95 % region of {} and {}, whose errors have the correlation {:.2}",
        pair.x.parameter.symbol(),
        pair.y.parameter.symbol(),
        pair.correlation
    );
    Drawing::new((size.width(), size.pick(320, 290)), label, |area| paint(area, pair, size))
}

fn paint(area: &Area, pair: &Pair, size: Size) -> Drawn {
    let outline = outline(pair);
    let [x, y] = [pair.x, pair.y].map(|judgement| percent(judgement, judgement.uncertainty.half_width));
    let x_axis = Axis::around(outline.iter().map(|(x, _)| *x).chain([-x, x]), size.pick(7, 4));
    let y_axis = Axis::around(outline.iter().map(|(_, y)| *y).chain([-y, y]), 6);
    let (x_label, y_label) = (x_axis.clone(), y_axis.clone());
    let [x_name, y_name] = [pair.x, pair.y].map(|judgement| format!("{}, % from the value", judgement.parameter.symbol()));
    let plot = Plot {
        x: x_axis,
        y: y_axis,
        x_name: &x_name,
        y_name: &y_name,
        left: 62,
        right: 16,
        x_label: &|x| x_label.label(x),
        y_label: &|y| y_label.label(y),
    };
    let mut chart = plot.on(area)?;
    let corners = vec![(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)];
    chart.series.draw_series([PathElement::new(corners, line(Ink::Axis, 1.0))])?;
    chart.series.draw_series([Polygon::new(outline.clone(), shade(Ink::D, 0.14))])?;
    chart.series.draw_series([PathElement::new(outline, line(Ink::D, 2.0))])?;
    area.draw(&Circle::new(chart.place(0.0, 0.0), 4 * UNITS, solid(Ink::Text)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit::{Verdict, evidence::ParameterUncertainty, motor::Parameter};

    fn judgement(parameter: Parameter, raw: f64, statistical: f64) -> Judgement {
        let uncertainty = ParameterUncertainty { statistical, ..ParameterUncertainty::default() };
        Judgement { parameter, raw, uncertainty, verdict: Verdict::Identified, reason: None, remedy: None }
    }

    /// Every point of the outline has the same distance, by the covariance of the two errors: 2 ln 20, at which 5 % are left.
    #[test]
    fn the_outline_is_where_five_percent_are_left() {
        let (rs, psi_f) = (judgement(Parameter::Rs, 2.0, 0.02), judgement(Parameter::PsiF, 0.1, 2e-4));
        let correlation = -0.8;
        for (x, y) in outline(&Pair { x: &rs, y: &psi_f, correlation }) {
            // In standard errors: 1 % and 0.2 % of the values.
            let (x, y) = (x / 1.0, y / 0.2);
            let distance = (x * x - 2.0 * correlation * x * y + y * y) / (1.0 - correlation * correlation);
            assert!((distance - 2.0 * 20.0_f64.ln()).abs() < 1e-6, "{distance}");
        }
    }
}
