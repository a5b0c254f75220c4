//! The operating points in the plane of i_d and i_q.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, solid},
        labels,
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    interactive::{DeltaColumn, Panel, PanelKind, PlotData, Series, XAxis},
    operating_point_uncertainty::{residual_uncertainties, residual_unit},
    report::Report,
    typography::{decimals, decimals_of_span, number, prose},
};
use fluxfit::{evidence::SteadyFit, frames::Dq, steady::OperatingPoint};
use maud::html;
use plotters::{
    element::Circle,
    style::text_anchor::{HPos, VPos},
};

/// Residuals in standard uncertainties up to which a point agrees with the fit, and above which it contradicts it.
const AGREES: f64 = 2.0;
const CONTRADICTS: f64 = 4.0;

/// The kinds of points by their residual, with their colours.
const KINDS: [(&str, Ink); 3] = [("agrees", Ink::Identified), ("in doubt", Ink::Weak), ("contradicts", Ink::NotIdentifiable)];

/// Left and right margin of the plot, pixels.
const MARGINS: (i32, i32) = (60, 24);

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
        draw: Box::new(move |size| draw(fit, size)),
        data: Some(Box::new(move || data(fit))),
        caption: html! {
            "The operating points in the plane of the currents, numbered as in the table. "
            @if fit.estimate.redundancy > 0 {
                "Green: both residuals are within two standard uncertainties"
                @if fit.misfit.is_some() { " (widened, because the points contradict each other)" }
                "; amber: within four; red: one is larger. "
            }
            (prose(
                "The farther apart they are, the better the parameters can be distinguished; L_d needs operating points with different i_d."
            ))
        },
    })
}

/// Draws the points with their numbers.
fn draw(found: &SteadyFit, size: Size) -> Drawing {
    let points = &found.operating_points;
    let label = format!("{} operating points in the plane of i_d and i_q, in ampere", points.len());
    Drawing::new((size.width(), HEIGHT), label, |area| paint(area, found, size))
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

/// The kind of each point by the larger of its residuals in standard uncertainties.
fn kinds(found: &SteadyFit) -> Vec<usize> {
    let uncertainties = residual_uncertainties(found);
    let both = found.estimate.residuals.iter().zip(uncertainties);
    both.map(|(residual, uncertainty)| {
        let largest = [0, 1].map(|axis| if uncertainty[axis] > 0.0 { (residual[axis] / uncertainty[axis]).abs() } else { 0.0 });
        match largest[0].max(largest[1]) {
            ratio if ratio <= AGREES => 0,
            ratio if ratio <= CONTRADICTS => 1,
            _ => 2,
        }
    })
    .collect()
}

/// The data of the interactive plot, with a description of each point.
fn data(found: &SteadyFit) -> PlotData {
    let all = found.operating_points.iter().zip(&found.estimate.residuals).zip(residual_uncertainties(found));
    let unit = residual_unit(found);
    let mut points: Vec<(&OperatingPoint, String, usize)> = (1..)
        .zip(all)
        .zip(kinds(found))
        .map(|((number, ((point, residual), uncertainty)), kind)| (point, description(number, point, (*residual, uncertainty), unit), kind))
        .filter(|(point, ..)| point.current().d.is_finite() && point.current().q.is_finite())
        .collect();
    points.sort_by(|(one, ..), (other, ..)| one.current().d.total_cmp(&other.current().d));
    let column =
        |value: &dyn Fn(&OperatingPoint) -> f64| DeltaColumn::new(&points.iter().map(|(point, ..)| value(point)).collect::<Vec<_>>());
    // The first series holds all points, for the pointer; those of the kinds are drawn over it.
    let of_kind = |(k, (name, ink)): (usize, (&'static str, Ink))| {
        let values = points.iter().map(|(point, _, kind)| if *kind == k { point.current().q } else { f64::NAN }).collect::<Vec<_>>();
        Series::new(name, ink, (1.0, 1.0), DeltaColumn::new(&values))
    };
    let all = Series::new("point", Ink::Axis, (1.0, 0.0), column(&|point| point.current().q));
    let series = [all].into_iter().chain(KINDS.into_iter().enumerate().map(of_kind)).collect();
    PlotData {
        x: XAxis { name: "i_d", unit: "A", values: column(&|point| point.current().d) },
        panels: vec![Panel {
            name: "i_q, A".to_owned(),
            height: HEIGHT as i32,
            kind: PanelKind::Plane,
            ranges: Some(axes(&found.operating_points, 6).map(|axis| [axis.low, axis.high])),
            series,
        }],
        descriptions: points.iter().map(|(_, description, _)| description.clone()).collect(),
        spans: Vec::new(),
    }
}

/// Time, currents, speed and residuals of a point, the latter with two standard uncertainties (95 %).
fn description(
    number_of_point: usize,
    point: &OperatingPoint,
    (residual, uncertainty): ([f64; 2], [f64; 2]),
    (unit, per_volt): (&str, f64),
) -> String {
    let (start, end) = point.time;
    let of_time = decimals_of_span(end - start);
    let fixed = |value: f64, decimals: usize| number(value, |value| format!("{value:.decimals$}"));
    let [d, q] = [0, 1].map(|axis| {
        let tenths = decimals(per_volt * uncertainty[axis], 1);
        format!("{} ± {} {unit}", fixed(per_volt * residual[axis], tenths), fixed(per_volt * AGREES * uncertainty[axis], tenths))
    });
    let (current, omega_e) = (point.current(), fixed(point.omega_e(), 1));
    format!(
        "Point {number_of_point}: {} to {} s; i_d {} A, i_q {} A, omega_e {omega_e} rad/s; residual of u_d {d}, of u_q {q} (95 %)",
        fixed(start, of_time),
        fixed(end, of_time),
        fixed(current.d, 3),
        fixed(current.q, 3),
    )
}

fn paint(area: &Area, found: &SteadyFit, size: Size) -> Drawn {
    let points = &found.operating_points;
    let [x, y] = axes(points, size.pick(6, 4));
    let (x_label, y_label) = (x.clone(), y.clone());
    let plot = Plot {
        x,
        y,
        x_name: "i_d, A",
        y_name: "i_q, A",
        left: MARGINS.0,
        right: MARGINS.1,
        x_label: &|x| x_label.label(x),
        y_label: &|y| y_label.label(y),
    };
    let chart = plot.on(area)?;
    let (mut places, mut names) = (Vec::new(), Vec::new());
    for ((number, point), kind) in (1..).zip(points).zip(kinds(found)) {
        let i = point.current();
        if i.d.is_finite() && i.q.is_finite() {
            let at = chart.place(i.d, i.q);
            area.draw(&Circle::new(at, 4 * UNITS, solid(KINDS[kind].1)))?;
            places.push((at.0 / UNITS, at.1 / UNITS));
            names.push(number.to_string());
        }
    }
    let labelled = labels::places(&places, &names, (size.width() as i32, HEIGHT as i32)).into_iter().zip(names);
    for ((x, y), name) in labelled.filter_map(|(place, name)| Some((place?, name))) {
        area.draw_text(&name, &anchored(Ink::Text, HPos::Center, VPos::Center), (x * UNITS, y * UNITS))?;
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
