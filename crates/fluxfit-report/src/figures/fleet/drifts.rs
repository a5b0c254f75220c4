//! Parameters that drift: the largest movements of each parameter from window to window.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line, solid},
        labels::{NAMES_APART, short, spread},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    typography::minus,
};
use fluxfit::{
    fleet::{Drift, FleetOverview},
    motor::Parameter,
    paper,
};
use maud::html;
use plotters::{
    element::{Circle, PathElement},
    style::text_anchor::{HPos, VPos},
};

/// Height of a panel, pixels.
const PANEL: u32 = 190;

/// Room for names at the right, pixels: wide and narrow.
const NAMES: (i32, i32) = (140, 104);

/// Windows of a curve that are drawn: of more, every second, third, … one.
const POINTS: usize = 300;

/// Windows up to which each is a point with its interval.
const FEW: usize = 40;

/// The figure; `None` if nothing drifts.
pub(crate) fn figure(fleet: &FleetOverview) -> Option<Figure<'_>> {
    (!fleet.drifts.is_empty()).then(|| Figure {
        name: "drift",
        section: "drift",
        draw: Box::new(move |size| draw(fleet, size)),
        data: None,
        caption: html! {
            "The largest movements of each parameter, in percent of the motor's first window, over the time since then. Bars: 95\u{a0}% intervals."
        },
    })
}

/// The panels: each parameter that drifts, with as many motors as there are colours that all eyes tell apart.
fn panels(fleet: &FleetOverview) -> Vec<(Parameter, Vec<&Drift>)> {
    let of = |parameter: Parameter| fleet.drifts.iter().filter(move |drift| drift.parameter == parameter).take(paper::METHODS.len());
    let panels = Parameter::ALL.into_iter().map(|parameter| (parameter, of(parameter).collect::<Vec<_>>()));
    panels.filter(|(_, drifts)| !drifts.is_empty()).collect()
}

fn draw(fleet: &FleetOverview, size: Size) -> Drawing {
    let panels = panels(fleet);
    let said = panels.iter().map(|(parameter, drifts)| {
        let names: Vec<&str> = drifts.iter().filter_map(|drift| Some(&*fleet.motors.get(drift.motor)?.best.motor)).collect();
        format!("{} of {}", parameter.symbol(), names.join(", "))
    });
    let label = format!("Curves over time: {}", said.collect::<Vec<_>>().join("; "));
    Drawing::new((size.width(), PANEL * panels.len() as u32), label, |area| {
        let areas = area.split_evenly((panels.len(), 1));
        panels.iter().zip(&areas).try_for_each(|((parameter, drifts), area)| paint(area, fleet, *parameter, drifts, size))
    })
}

/// A point of a curve: time since the first window, s; value and half-width, % of the first value.
type Point = (f64, f64, f64);

fn curve(drift: &Drift) -> Vec<Point> {
    let Some(first) = drift.points.first() else { return Vec::new() };
    let percent = |value: f64| 100.0 * value / first.value.value.abs();
    let every = drift.points.len().div_ceil(POINTS).max(1);
    let point = |point: &fluxfit::fleet::DriftPoint| {
        (point.start - first.start, percent(point.value.value - first.value.value), percent(point.value.half_width))
    };
    drift.points.iter().step_by(every).map(point).collect()
}

/// A unit of time that suits a span, s: its length and name.
fn unit_of_time(span: f64) -> (f64, &'static str) {
    const UNITS_OF_TIME: [(f64, &str); 3] = [(86_400.0, "days"), (3600.0, "h"), (60.0, "min")];
    UNITS_OF_TIME.into_iter().find(|(length, _)| span >= 2.0 * length).unwrap_or((1.0, "s"))
}

fn paint(area: &Area, fleet: &FleetOverview, parameter: Parameter, drifts: &[&Drift], size: Size) -> Drawn {
    let curves: Vec<Vec<Point>> = drifts.iter().map(|drift| curve(drift)).collect();
    let points = || curves.iter().flatten();
    let (length, unit) = unit_of_time(points().map(|(t, ..)| *t).fold(0.0, f64::max));
    let end = points().map(|(t, ..)| t / length).fold(0.0, f64::max);
    let has_bars = |curve: &[Point]| curve.len() <= FEW;
    let ends = curves.iter().flat_map(|curve| {
        let bars = if has_bars(curve) { 1.0 } else { 0.0 };
        curve.iter().flat_map(move |(_, value, half)| [value - bars * half, value + bars * half])
    });
    let (x_name, y_name) = (format!("time since the first window, {unit}"), format!("{}, change in %", parameter.symbol()));
    let y = Axis::around(ends.chain([0.0]), 6);
    let tick = |axis: &Axis, value: f64| axis.label(value);
    let x = Axis::between(0.0, end.max(f64::MIN_POSITIVE), size.pick(6, 3));
    let (of_x, of_y) = (x.clone(), y.clone());
    let plot = Plot {
        x,
        y,
        x_name: &x_name,
        y_name: &y_name,
        left: 50,
        right: size.pick(NAMES.0, NAMES.1),
        x_label: &|value| tick(&of_x, value),
        y_label: &|value| minus(tick(&of_y, value)),
    };
    let mut chart = plot.on(area)?;
    let mut names = Vec::new();
    for ((curve, drift), method) in curves.iter().zip(drifts).zip(&paper::METHODS) {
        let ink = Ink::of_method(method);
        let at = |(t, value, _): &Point| (t / length, *value);
        chart.series.draw_series([PathElement::new(curve.iter().map(at).collect::<Vec<_>>(), line(ink, 2.0))])?;
        for (t, value, half) in curve.iter().filter(|_| has_bars(curve)) {
            let bar = vec![chart.place(t / length, value - half), chart.place(t / length, value + half)];
            area.draw(&PathElement::new(bar, line(ink, 1.0)))?;
            area.draw(&Circle::new(chart.place(t / length, *value), 3 * UNITS, solid(ink)))?;
        }
        if let (Some((t, value, _)), Some(member)) = (curve.last(), fleet.motors.get(drift.motor)) {
            names.push((chart.place(t / length, *value), ink, short(&member.best.motor)));
        }
    }
    // Names stand at the right edge, in the order of the curves' ends.
    names.sort_by_key(|((_, y), ..)| *y);
    let heights = spread(&names.iter().map(|((_, y), ..)| *y).collect::<Vec<_>>(), NAMES_APART * UNITS);
    let (right, _) = chart.place(plot.x.high, plot.y.low);
    for ((_, ink, name), y) in names.into_iter().zip(heights) {
        area.draw(&PathElement::new(vec![(right + 5 * UNITS, y), (right + 20 * UNITS, y)], line(ink, 2.0)))?;
        area.draw_text(&name, &anchored(Ink::Text, HPos::Left, VPos::Center), (right + 24 * UNITS, y))?;
    }
    Ok(())
}
