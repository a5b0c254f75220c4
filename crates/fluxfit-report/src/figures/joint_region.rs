//! The joint confidence region of the two parameters whose errors are correlated most: an ellipse about the estimate, in percent of it,
//! and a box from the two intervals.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, line, shade, solid},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    judgement::{correlation, most_correlated},
    report::Report,
    typography::{list, minus, prose, symbol},
};
use fluxfit::{Judgement, evidence::Identification, motor::Parameter};
use maud::html;
use plotters::element::{Circle, PathElement, Polygon};
use std::f64::consts::TAU;

/// Half-axis of the joint 95 % region of two independent normal errors, in standard errors: the square root of 5.991, the 95 % quantile
/// of chi-squared with two degrees of freedom.
const JOINT: f64 = 2.447_746_83;

/// Number of corners of the polygon that is drawn as the ellipse.
const CORNERS: usize = 144;

/// Two judgements and the correlation of their errors.
#[derive(Clone, Copy)]
struct ParameterPair<'a> {
    /// On the horizontal axis.
    x: &'a Judgement,
    /// On the vertical axis.
    y: &'a Judgement,
    /// From -1 to 1.
    correlation: f64,
}

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    let pair = pair(found)?;
    Some(Figure {
        name: "joint-region",
        section: "correlation",
        draw: Box::new(move |size| draw(&pair, size)),
        data: None,
        caption: html! {
            "The joint 95\u{a0}% confidence region of " (list(&[symbol(pair.x.parameter), symbol(pair.y.parameter)])) ", whose errors are correlated "
            "most, about the estimate (dot), in percent of it, from the standard errors and their correlation, "
            (minus(format!("{:.2}", pair.correlation))) " (that of noise, accuracy and priors). The box is made of the two 95\u{a0}% intervals. Where "
            "the ellipse is narrow and slanted, values in a corner of the box are not plausible together, although each of them is plausible "
            "alone."
            @if let Some(remedy) = separated_by(&pair) { " " (prose(remedy)) }
        },
    })
}

/// The pair, if two parameters have an error.
fn pair(found: &Identification) -> Option<ParameterPair<'_>> {
    let [x, y] = most_correlated(found)?;
    Some(ParameterPair { x, y, correlation: correlation(found, x, y) })
}

/// What tells the two apart, where one equation has both in it.
fn separated_by(pair: &ParameterPair) -> Option<&'static str> {
    match (pair.x.parameter, pair.y.parameter) {
        (Parameter::Rs, Parameter::PsiF) => {
            Some("Both parameters enter the voltage of the q axis; operating points at different speeds separate them.")
        }
        (Parameter::Rs, Parameter::Lq) => {
            Some("Both parameters enter the voltage of the d axis; operating points at different speeds separate them.")
        }
        (Parameter::Ld, Parameter::PsiF) => {
            Some("Both parameters enter the voltage of the q axis; operating points with different i_d separate them.")
        }
        _ => None,
    }
}

/// An error of a parameter in percent of its value.
fn percent(judgement: &Judgement, error: f64) -> f64 {
    100.0 * error / judgement.raw.abs()
}

/// Outline of the region, percent of the values.
fn outline(pair: &ParameterPair) -> Vec<(f64, f64)> {
    let [x, y] = [pair.x, pair.y].map(|judgement| JOINT * percent(judgement, judgement.uncertainty.standard_error()));
    let rho = pair.correlation.clamp(-1.0, 1.0);
    let point = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / CORNERS as f64).sin_cos();
        (x * cos, y * (rho * cos + (1.0 - rho * rho).sqrt() * sin))
    };
    (0..=CORNERS).map(point).collect()
}

/// Draws the region.
fn draw(pair: &ParameterPair, size: Size) -> Drawing {
    let label = format!(
        "Ellipse: joint 95 % region of {} and {}, whose errors have the correlation {:.2}",
        pair.x.parameter.symbol(),
        pair.y.parameter.symbol(),
        pair.correlation
    );
    Drawing::new((size.width(), size.pick(320, 290)), label, |area| paint(area, pair, size))
}

fn paint(area: &Area, pair: &ParameterPair, size: Size) -> Drawn {
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
    use fluxfit::{Columns, Log, Request, evidence::ParameterUncertainty, frames::Dq, identify, paper};

    /// That of any log, with this value and standard error.
    fn judgement(parameter: Parameter, raw: f64, statistical: f64) -> Judgement {
        let mut columns = Columns::default();
        for row in 0..200 {
            let i = if row < 100 { Dq { d: 0.0, q: 9.0 } } else { Dq { d: -2.0, q: 8.5 } };
            let u = paper::MOTOR.steady_voltage(i, 400.0);
            let Columns { t, ud, uq, id, iq, omega_e, .. } = &mut columns;
            for (column, value) in [(t, f64::from(row) * 1e-3), (ud, u.d), (uq, u.q), (id, i.d), (iq, i.q), (omega_e, 400.0)] {
                column.push(value);
            }
        }
        let mut judgement = identify(&Log::new(columns).unwrap(), &Request::default()).unwrap().parameter(parameter).clone();
        judgement.raw = raw;
        judgement.uncertainty = ParameterUncertainty::default();
        judgement.uncertainty.statistical = statistical;
        judgement
    }

    /// Every point of the outline has the same Mahalanobis distance: its square is 2 ln 20, beyond which 5 % of the probability lie.
    #[test]
    fn the_outline_contains_95_percent() {
        let (rs, psi_f) = (judgement(Parameter::Rs, 2.0, 0.02), judgement(Parameter::PsiF, 0.1, 2e-4));
        let correlation = -0.8;
        for (x, y) in outline(&ParameterPair { x: &rs, y: &psi_f, correlation }) {
            // In standard errors: 1 % and 0.2 % of the values.
            let (x, y) = (x / 1.0, y / 0.2);
            let distance = (x * x - 2.0 * correlation * x * y + y * y) / (1.0 - correlation * correlation);
            assert!((distance - 2.0 * 20.0_f64.ln()).abs() < 1e-6, "{distance}");
        }
    }
}
