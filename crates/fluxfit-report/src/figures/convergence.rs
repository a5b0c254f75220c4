//! Convergence (Fig. 4 of the paper, on a logarithmic scale): cost above the minimum against iteration. Each method has its colour, its
//! dashes, and its name at the end of its curve.

use crate::{
    drawing::{
        axis::{Axis, power_of_ten},
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line, shade},
        labels::{NAMES_APART, spread},
        palette::Ink,
        plot::{Chart, Plot},
        size::Size,
    },
    figure::Figure,
    interactive::{DeltaColumn, Panel, PanelKind, PlotData, Series, XAxis},
    report::Report,
};
use fluxfit::study::{MethodStudy, ROUNDING, comparison::Comparison, fitness::Fitness};
use maud::html;
use plotters::{
    element::{Circle, PathElement, Polygon},
    style::text_anchor::{HPos, VPos},
};

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (facts, methods) = report.study?;
    let fitness = &facts.problem.fitness;
    let has_curves = methods.iter().any(|(study, _)| !study.convergence.quartiles.is_empty());
    has_curves.then(|| Figure {
        name: "convergence",
        section: "study",
        draw: Box::new(move |size| draw(facts, methods, size)),
        // An interactive plot of all curves would be as full as one drawing of them.
        data: if facts.is_crowded() { None } else { Some(Box::new(move || data(fitness, methods))) },
        caption: html! {
            "Convergence (Fig. 4 of the paper, here on a logarithmic scale): F\u{a0}−\u{a0}F" sub { (fitness.minimum_subscript()) } " against "
            "iteration. Lines are medians over the runs, bands reach from the lower to the upper quartile."
            @if facts.is_crowded() { " Each panel has one method, with those of the others in grey; the best stands first." }
            @if has_values_below_floor(methods) {
                " Values below 10" sup { "\u{2212}12" } " " (fitness.unit()) ", including zero, are rounding errors and drawn at that value."
            }
        },
    })
}

/// Draws the curves of all methods.
fn draw(facts: &Comparison, methods: &[(MethodStudy, f64)], size: Size) -> Drawing {
    let fitness = &facts.problem.fitness;
    let names: Vec<&str> = methods.iter().map(|(study, _)| study.method.label()).collect();
    let label = format!(
        "Curves: cost above the {} against iteration, logarithmic, median and quartiles over the runs, for {}",
        fitness.minimum_label(),
        names.join(", ")
    );
    if facts.is_crowded() {
        let ranked: Vec<&MethodStudy> = facts.ranking().into_iter().filter_map(|place| Some(&methods.get(place)?.0)).collect();
        let columns = size.pick(4, 2);
        let rows = ranked.len().div_ceil(columns).max(1);
        return Drawing::new((size.width(), PANEL * rows as u32), label, |area| {
            let panels = area.split_evenly((rows, columns));
            ranked.iter().zip(&panels).try_for_each(|(study, panel)| paint_one(panel, study, &ranked))
        });
    }
    Drawing::new((size.width(), size.pick(HEIGHTS.0, HEIGHTS.1).unsigned_abs()), label, |area| paint(area, fitness, methods, size))
}

/// Height of the panel of one of many methods, pixels.
const PANEL: u32 = 150;

/// Points of a grey curve, some three pixels apart: all points of all curves in all panels would be megabytes.
const GREY_POINTS: usize = 60;

/// One of many methods, before the others' medians.
fn paint_one(area: &Area, study: &MethodStudy, all: &[&MethodStudy]) -> Drawn {
    let costs = all.iter().flat_map(|study| study.convergence.quartiles.iter().flatten());
    let last = all.iter().map(|study| study.convergence.quartiles.len().saturating_sub(1)).max().unwrap_or(0).max(1) as f64;
    let name = study.method.short_label();
    let plot = Plot {
        x: Axis::between(0.0, last, 2),
        y: Axis::decades(costs.map(|cost| height(*cost)), 4),
        x_name: "",
        y_name: &name,
        left: 36,
        right: 10,
        x_label: &|x| format!("{x:.0}"),
        y_label: &power_of_ten,
    };
    let mut chart = plot.on(area)?;
    for other in all.iter().filter(|other| other.method != study.method) {
        // Down to the axis, and not along it.
        let points = medians(other).into_iter().step_by(last as usize / GREY_POINTS + 1);
        let above: Vec<(f64, f64)> = points.take_while(|(_, y)| *y > ROUNDING.log10()).collect();
        chart.series.draw_series([PathElement::new(above, line(Ink::Grid, 1.0))])?;
    }
    band(&mut chart, study)?;
    median(&mut chart, study)
}

/// Height of the figure, pixels: wide and narrow.
const HEIGHTS: (i32, i32) = (400, 340);

/// Largest number of iterations in the data of a page; of more iterations every second, third, … is kept.
const ITERATIONS: usize = 1_000;

/// Opacity of a band.
const BAND: f64 = 0.16;

/// Resolution of the decadic logarithms in the data: a hundredth of a decade is two percent.
const RESOLUTION: f64 = 1e-2;

/// The data of the interactive plot.
fn data(fitness: &Fitness, methods: &[(MethodStudy, f64)]) -> PlotData {
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len()).max().unwrap_or(0).saturating_sub(1);
    let every = last / ITERATIONS + 1;
    // The last iteration is always kept.
    let shown: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
    let series = methods.iter().map(|(study, _)| {
        let column = |which: usize| {
            let of_iteration = |k: &usize| study.convergence.quartiles.get(*k).map_or(f64::NAN, |quartiles| height(quartiles[which]));
            DeltaColumn::resolving(&shown.iter().map(of_iteration).collect::<Vec<_>>(), RESOLUTION)
        };
        Series::new(study.method.label(), Ink::of_method(&study.method), (2.0, 1.0), column(1)).with_band(vec![column(0), column(2)])
    });
    let panel = Panel { name: cost_name(fitness), height: HEIGHTS.0, kind: PanelKind::Decades, ranges: None, series: series.collect() };
    let numbers: Vec<f64> = shown.iter().map(|k| *k as f64).collect();
    let x = XAxis { name: "iteration", unit: "", values: DeltaColumn::resolving(&numbers, 1.0) };
    PlotData { x, panels: vec![panel], descriptions: Vec::new(), spans: Vec::new() }
}

/// Name of the y axis.
fn cost_name(fitness: &Fitness) -> String {
    format!("F − F_{}, {}", fitness.minimum_subscript(), fitness.unit())
}

/// Whether some cost is drawn at [`ROUNDING`].
fn has_values_below_floor(methods: &[(MethodStudy, f64)]) -> bool {
    methods.iter().flat_map(|(study, _)| &study.convergence.quartiles).flatten().any(|cost| *cost < ROUNDING)
}

/// Decadic logarithm of a cost.
fn height(cost: f64) -> f64 {
    // A cost that is not finite is drawn at the upper end.
    if cost.is_finite() { cost.max(ROUNDING).log10() } else { f64::MAX.log10() }
}

fn paint(area: &Area, fitness: &Fitness, methods: &[(MethodStudy, f64)], size: Size) -> Drawn {
    let all = methods.iter().flat_map(|(study, _)| study.convergence.quartiles.iter().flatten());
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len().saturating_sub(1)).max().unwrap_or(0).max(1) as f64;
    let cost = cost_name(fitness);
    let plot = Plot {
        x: Axis::between(0.0, last, size.pick(6, 3)),
        y: Axis::decades(all.map(|cost| height(*cost)), size.pick(9, 8)),
        x_name: "iteration",
        y_name: &cost,
        left: 42,
        right: 76,
        x_label: &|x| format!("{x:.0}"),
        y_label: &power_of_ten,
    };
    let mut chart = plot.on(area)?;
    for (study, _) in methods {
        band(&mut chart, study)?;
    }
    for (study, _) in methods {
        median(&mut chart, study)?;
    }
    let ends = methods.iter().filter_map(|(study, _)| {
        let end = height(study.convergence.quartiles.last()?[1]);
        Some((study, chart.place(last, end)))
    });
    names(area, ends.collect())
}

/// The band from the lower to the upper quartile.
fn band(chart: &mut Chart, study: &MethodStudy) -> Drawn {
    let curve =
        |which: usize| study.convergence.quartiles.iter().enumerate().map(move |(k, quartiles)| (k as f64, height(quartiles[which])));
    let outline: Vec<(f64, f64)> = curve(0).chain(curve(2).collect::<Vec<_>>().into_iter().rev()).collect();
    chart.series.draw_series([Polygon::new(outline, shade(Ink::of_method(&study.method), BAND))])?;
    Ok(())
}

/// Iterations and heights of the median.
fn medians(study: &MethodStudy) -> Vec<(f64, f64)> {
    study.convergence.quartiles.iter().enumerate().map(|(k, [_, median, _])| (k as f64, height(*median))).collect()
}

fn median(chart: &mut Chart, study: &MethodStudy) -> Drawn {
    let ink = Ink::of_method(&study.method);
    let points = medians(study);
    match points.as_slice() {
        [] => {}
        [start] => drop(chart.series.draw_series([Circle::new(*start, 3 * UNITS, shade(ink, 1.0))])?),
        _ => drop(chart.series.draw_series([PathElement::new(points, line(ink, 2.0))])?),
    }
    Ok(())
}

/// A sample of the line and the name of each method beside the end of its curve, moved apart where ends are close.
fn names(area: &Area, mut ends: Vec<(&MethodStudy, (i32, i32))>) -> Drawn {
    ends.sort_by_key(|(_, (_, y))| *y);
    let heights = spread(&ends.iter().map(|(_, (_, y))| *y).collect::<Vec<_>>(), NAMES_APART * UNITS);
    for ((study, (x, _)), y) in ends.into_iter().zip(heights) {
        let ink = Ink::of_method(&study.method);
        area.draw(&PathElement::new(vec![(x + 6 * UNITS, y), (x + 30 * UNITS, y)], line(ink, 2.0)))?;
        area.draw_text(study.method.label(), &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 34 * UNITS, y))?;
    }
    Ok(())
}
