//! Voltage residuals: measured less fitted voltages of each operating point.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line, solid},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    interactive::{DeltaColumn, Panel, PanelKind, PlotData, Series, XAxis},
    operating_point_uncertainty::residual_uncertainties,
    report::Report,
    typography::percent,
};
use fluxfit::evidence::SteadyFit;
use maud::{Markup, html};
use plotters::{
    element::{Circle, PathElement, Polygon},
    style::text_anchor::{HPos, VPos},
};

/// Half the length of an error bar, in standard uncertainties.
const BAR: f64 = 2.0;

/// Horizontal distance of the two equations' markers from their operating point; operating points are one apart.
const ASIDE: f64 = 0.15;

/// Resolution of the data as a fraction of the shortest error bar.
const RESOLUTION: f64 = 0.01;

/// Radius of a marker, pixels.
const MARKER: i32 = 4;

/// Height of the figure, pixels.
const HEIGHT: u32 = 290;

/// The axis reaches this many times as far as half of the error bars do: a single point far away must not flatten all others.
const REACH: f64 = 6.0;

/// Units of the y axis: factor from volt and name; millivolt up to a volt.
const UNITS_OF_VOLTAGE: [(f64, &str); 2] = [(1e3, "mV"), (1.0, "V")];

/// The figure; `None` with as many equations as unknowns, where all residuals are zero whatever the log.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    let fit = found.steady.as_ref().filter(|fit| fit.estimate.redundancy > 0)?;
    Some(Figure {
        name: "residuals",
        section: "operating-points",
        draw: Box::new(move |size| draw(fit, size)),
        data: Some(Box::new(move || data(fit))),
        caption: caption(fit),
    })
}

fn caption(fit: &SteadyFit) -> Markup {
    html! {
        "Residuals of both voltage equations with error bars of two standard uncertainties (95\u{a0}%), from the noise of the means and "
        @if let Some(misfit) = fit.misfit {
            "the accuracy with which the operating points are consistent, " (percent(misfit.voltage_accuracy)) " % of the voltage. A pattern, such "
            "as a dependence on the current, shows what the model lacks."
        } @else {
            "the accuracy of the voltages. If an error bar does not include zero, that operating point contradicts the others."
        }
        @match beyond(fit) {
            0 => {}
            1 => { " One residual lies beyond the axis." }
            count => { " " (count) " residuals lie beyond the axis." }
        }
    }
}

/// Draws both residuals of each operating point, mV.
pub(crate) fn draw(found: &SteadyFit, size: Size) -> Drawing {
    let label = format!("Residuals of u_d and u_q at {} operating points, with bars", found.operating_points.len());
    Drawing::new((size.width(), HEIGHT), label, |area| paint(area, found, size))
}

/// The markers of one axis: horizontal position, residual and half of its error bar, V.
fn marks(found: &SteadyFit, axis: usize) -> impl Iterator<Item = (f64, f64, f64)> {
    let of_points = found.estimate.residuals.iter().zip(residual_uncertainties(found)).enumerate();
    let aside = if axis == 0 { -ASIDE } else { ASIDE };
    of_points
        .map(move |(w, (residual, uncertainty))| ((w + 1) as f64 + aside, residual[axis], BAR * uncertainty[axis]))
        .filter(|(_, residual, bar)| residual.is_finite() && bar.is_finite())
}

/// How far the axis reaches from zero at most, V.
fn reach(found: &SteadyFit) -> f64 {
    let mut reaches: Vec<f64> =
        [0, 1].into_iter().flat_map(|axis| marks(found, axis)).map(|(_, residual, bar)| residual.abs() + bar).collect();
    reaches.sort_by(f64::total_cmp);
    reaches.get(reaches.len() / 2).map_or(f64::INFINITY, |middle| REACH * middle)
}

/// Number of residuals beyond the axis.
fn beyond(found: &SteadyFit) -> usize {
    let reach = reach(found);
    [0, 1].into_iter().flat_map(|axis| marks(found, axis)).filter(|(_, residual, _)| residual.abs() > reach).count()
}

/// Factor from volt to the unit of the axis, and its name.
fn unit(found: &SteadyFit) -> (f64, &'static str) {
    let largest = [0, 1].into_iter().flat_map(|axis| marks(found, axis)).map(|(_, residual, bar)| residual.abs() + bar).fold(0.0, f64::max);
    UNITS_OF_VOLTAGE[usize::from(largest.min(reach(found)) >= 1.0)]
}

fn name(found: &SteadyFit) -> String {
    format!("measured − fitted, {}", unit(found).1)
}

/// The y axis, in its unit, with all error bars within its reach.
fn y_axis(found: &SteadyFit) -> Axis {
    let (factor, reach) = (unit(found).0, reach(found));
    let ends = [0, 1].into_iter().flat_map(|axis| marks(found, axis)).flat_map(|(_, residual, bar)| [residual - bar, residual + bar]);
    Axis::around(ends.map(|end| factor * end.clamp(-reach, reach)).chain([0.0]), 5)
}

/// Right end of the x axis.
fn end(found: &SteadyFit) -> f64 {
    found.operating_points.len().max(1) as f64 + 0.5
}

/// The data of the interactive plot.
pub(crate) fn data(found: &SteadyFit) -> PlotData {
    let (uncertainties, y, (factor, _)) = (residual_uncertainties(found), y_axis(found), unit(found));
    let numbers: Vec<f64> = (1..=found.operating_points.len()).map(|number| number as f64).collect();
    let series = [(0, "u_d", Ink::D), (1, "u_q", Ink::Q)].map(|(axis, name, ink)| {
        let residuals: Vec<f64> = found.estimate.residuals.iter().map(|residual| factor * residual[axis]).collect();
        let bars: Vec<f64> = uncertainties.iter().map(|both| factor * BAR * both[axis]).collect();
        // The resolution of both is a fraction of the shortest error bar.
        let shortest = bars.iter().copied().filter(|bar| *bar > 0.0).fold(f64::INFINITY, f64::min);
        let column = |values: &[f64]| DeltaColumn::resolving(values, shortest * RESOLUTION);
        Series::new(name, ink, (1.5, 1.0), column(&residuals)).with_band(vec![column(&bars)])
    });
    PlotData {
        x: XAxis { name: "operating point", unit: "", values: DeltaColumn::resolving(&numbers, 1.0) },
        panels: vec![Panel {
            name: name(found),
            height: HEIGHT as i32,
            kind: PanelKind::Bars,
            ranges: Some([[0.5, end(found)], [y.low, y.high]]),
            series: series.into(),
        }],
        descriptions: Vec::new(),
        spans: Vec::new(),
    }
}

fn paint(area: &Area, found: &SteadyFit, size: Size) -> Drawn {
    let marks = |axis: usize| marks(found, axis);
    let (y, name, factor) = (y_axis(found), name(found), unit(found).0);
    let (low, high) = (y.low, y.high);
    let mut x = Axis::between(0.5, end(found), size.pick(12, 6));
    // Ticks only at operating points.
    x.ticks.retain(|tick| tick.fract() == 0.0);
    let y_label = y.clone();
    let plot = Plot {
        x,
        y,
        x_name: "operating point",
        y_name: &name,
        left: 60,
        right: 12,
        x_label: &|x| format!("{x:.0}"),
        y_label: &|value| y_label.label(value),
    };
    let mut chart = plot.on(area)?;
    chart.series.draw_series([PathElement::new(vec![(0.5, 0.0), (end(found), 0.0)], line(Ink::Axis, 1.0))])?;
    for (axis, ink) in [(0, Ink::D), (1, Ink::Q)] {
        for (x, residual, bar) in marks(axis) {
            // What lies beyond the axis is drawn at its end.
            let [below, middle, above] = [residual - bar, residual, residual + bar].map(|value| (factor * value).clamp(low, high));
            chart.series.draw_series([PathElement::new(vec![(x, below), (x, above)], line(ink, 1.5))])?;
            let at = chart.place(x, middle);
            marker(area, axis, at, ink)?;
        }
    }
    legend(area, size)
}

/// A disc for d, a square for q, so that they can be distinguished without colour.
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
