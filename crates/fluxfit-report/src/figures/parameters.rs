//! Fig. 5 of the paper: the parameters against iteration, each in its panel, with the true value if it is known.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    report::Report,
    typography::{self, unit},
};
use fluxfit::{
    motor::{Motor, Parameter},
    optimizer::Method,
    study::MethodStudy,
};
use fluxfit_units::Scale;
use maud::html;
use plotters::{
    element::{Circle, PathElement},
    style::text_anchor::{HPos, VPos},
};

/// Height of a panel, pixels.
const PANEL: u32 = 210;

/// The figure, of tGFPA or else of the first method.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (facts, methods) = report.study?;
    let tgfpa = methods.iter().find(|(study, _)| matches!(study.method, Method::Tgfpa(_)));
    let (study, _) = tgfpa.or(methods.first())?;
    let unexcited = facts.problem.unexcited.as_slice();
    let has_curves = !study.convergence.parameters_median.is_empty() && unexcited.len() < Parameter::ALL.len();
    has_curves.then(|| Figure {
        name: "parameters",
        section: "estimates",
        draw: Box::new(move |size| draw(study, facts.truth.as_ref(), unexcited, size)),
        data: None,
        caption: html! {
            "Fig. 5 of the paper: the parameters against iteration with " (study.method.label()) ", medians over the runs."
            @if facts.truth.is_some() { " Dashed: the true value." }
        },
    })
}

/// Draws a panel for each parameter that is excited.
fn draw(study: &MethodStudy, truth: Option<&Motor>, unexcited: &[Parameter], size: Size) -> Drawing {
    let shown: Vec<Parameter> = Parameter::ALL.into_iter().filter(|parameter| !unexcited.contains(parameter)).collect();
    let symbols: Vec<&str> = shown.iter().map(|parameter| parameter.symbol()).collect();
    let label = format!(
        "Curves: medians of {} over the runs of {} against iteration{}",
        symbols.join(", "),
        study.method.label(),
        if truth.is_some() { ", each with its true value" } else { "" }
    );
    let columns = size.pick(2, 1);
    let rows = shown.len().div_ceil(columns).max(1);
    Drawing::new((size.width(), PANEL * rows as u32), label, |area| {
        let panels = area.split_evenly((rows, columns));
        shown.iter().zip(&panels).try_for_each(|(parameter, panel)| paint(panel, study, truth, *parameter))
    })
}

fn paint(area: &Area, study: &MethodStudy, truth: Option<&Motor>, parameter: Parameter) -> Drawn {
    let medians = &study.convergence.parameters_median;
    let curve: Vec<f64> = medians.iter().map(|motor| motor[parameter as usize]).filter(|value| value.is_finite()).collect();
    let truth = truth.map(|truth| truth.get(parameter));
    let end = curve.last().copied().or(truth).unwrap_or(0.0);
    let scale = Scale::for_value(parameter, end);
    let y = Axis::around(curve.iter().copied().chain(truth), 4);
    let step = 10.0 * y.step;
    let y_name = format!("{}, {}", parameter.symbol(), unit(parameter, &scale));
    let last = curve.len().saturating_sub(1).max(1) as f64;
    let plot = Plot {
        x: Axis::between(0.0, last, 3),
        y,
        x_name: "iteration",
        y_name: &y_name,
        left: 50,
        right: 16,
        x_label: &|x| format!("{x:.0}"),
        // Two significant digits of ten steps distinguish neighbouring ticks.
        y_label: &|value| typography::minus(scale.format(value, step)),
    };
    let mut chart = plot.on(area)?;
    if let Some(truth) = truth {
        chart.series.draw_series([PathElement::new(vec![(0.0, truth), (last, truth)], line(Ink::Truth, 1.5))])?;
    }
    let ink = Ink::of_method(&study.method);
    let points: Vec<(f64, f64)> = curve.iter().enumerate().map(|(k, value)| (k as f64, *value)).collect();
    match points.as_slice() {
        [] => {}
        [start] => drop(chart.series.draw_series([Circle::new(*start, 3 * UNITS, line(ink, 2.0).filled())])?),
        _ => drop(chart.series.draw_series([PathElement::new(points, line(ink, 2.0))])?),
    }
    if let Some(truth) = truth {
        // At the right end of the line, on the side opposite to the curve.
        let (x, y) = chart.place(last, truth);
        let from_above = curve.iter().sum::<f64>() >= truth * curve.len() as f64;
        let (vertical, y) = if from_above { (VPos::Bottom, y - 4 * UNITS) } else { (VPos::Top, y + 4 * UNITS) };
        let text = format!("true {}", scale.format(truth, truth.abs() * 1e-3));
        area.draw_text(&text, &anchored(Ink::Truth, HPos::Right, vertical), (x, y))?;
    }
    Ok(())
}
