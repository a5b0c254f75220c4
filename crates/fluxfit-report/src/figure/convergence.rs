//! Fig. 4 of the paper, as it can be read on a logarithmic scale: cost above the minimum against iteration. Each method has
//! its colour, its dashes and its name at the end of its curve.

use super::{
    Size,
    axis::{Axis, power_of_ten},
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line, shade},
    palette::Ink,
    plot::{Chart, Plot},
};
use crate::interactive::{Along, Column, Kind, Live, Panel, Series};
use fluxfit::study::{MethodStudy, fitness::Fitness};
use plotters::{
    element::{Circle, PathElement, Polygon},
    style::text_anchor::{HPos, VPos},
};

/// Costs below this are drawn at it: rounding, where a logarithm means nothing.
pub(crate) const FLOOR: f64 = 1e-12;

/// Least distance of two names, pixels.
const NAMES_APART: i32 = 16;

/// Draws the curves of all methods.
pub(crate) fn draw(fitness: &Fitness, methods: &[(MethodStudy, f64)], size: Size) -> Drawing {
    let names: Vec<&str> = methods.iter().map(|(study, _)| study.method.label()).collect();
    let label = format!(
        "Curves: cost above the {} against iteration, logarithmic, median and quartiles over the runs, for {}",
        fitness.minimum_label(),
        names.join(", ")
    );
    Drawing::new((size.width(), size.pick(HEIGHTS.0, HEIGHTS.1).unsigned_abs()), label, |area| paint(area, fitness, methods, size))
}

/// Height of the figure, pixels: wide and narrow.
const HEIGHTS: (i32, i32) = (400, 340);

/// Iterations that the page holds at most; of more, every second, third … one.
const ITERATIONS: usize = 1_000;

/// How much of its ink a band has.
const BAND: f64 = 0.16;

/// A logarithm that is told apart from the next one: a hundredth of a decade is two percent.
const LOGARITHM: f64 = 1e-2;

/// The same for the pointer.
pub(crate) fn live(fitness: &Fitness, methods: &[(MethodStudy, f64)]) -> Live {
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len()).max().unwrap_or(0).saturating_sub(1);
    let every = last / ITERATIONS + 1;
    // The last one is always there.
    let shown: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
    let series = methods.iter().map(|(study, _)| {
        let column = |which: usize| {
            let of_iteration = |k: &usize| study.convergence.quartiles.get(*k).map_or(f64::NAN, |quartiles| height(quartiles[which]));
            Column::resolving(&shown.iter().map(of_iteration).collect::<Vec<_>>(), LOGARITHM)
        };
        Series::new(study.method.label(), Ink::of_method(&study.method), (2.0, 1.0), column(1)).within(vec![column(0), column(2)])
    });
    let panel = Panel { name: cost(fitness), height: HEIGHTS.0, kind: Kind::Decades, whole: None, series: series.collect() };
    let numbers: Vec<f64> = shown.iter().map(|k| *k as f64).collect();
    Live { x: Along { name: "iteration", unit: "", values: Column::resolving(&numbers, 1.0) }, panels: vec![panel], told: Vec::new() }
}

/// Name of the axis of costs.
fn cost(fitness: &Fitness) -> String {
    format!("F − F_{}, {}", fitness.minimum_subscript(), fitness.unit())
}

/// Whether some value lies below the floor of the drawing.
pub(crate) fn has_values_below_floor(methods: &[(MethodStudy, f64)]) -> bool {
    methods.iter().flat_map(|(study, _)| &study.convergence.quartiles).flatten().any(|cost| *cost < FLOOR)
}

fn height(cost: f64) -> f64 {
    // What is not a number is far away.
    if cost.is_finite() { cost.max(FLOOR).log10() } else { f64::MAX.log10() }
}

fn paint(area: &Area, fitness: &Fitness, methods: &[(MethodStudy, f64)], size: Size) -> Drawn {
    let all = methods.iter().flat_map(|(study, _)| study.convergence.quartiles.iter().flatten());
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len().saturating_sub(1)).max().unwrap_or(0).max(1) as f64;
    let cost = cost(fitness);
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

/// From the lower quartile to the upper one.
fn band(chart: &mut Chart, study: &MethodStudy) -> Drawn {
    let course =
        |which: usize| study.convergence.quartiles.iter().enumerate().map(move |(k, quartiles)| (k as f64, height(quartiles[which])));
    let outline: Vec<(f64, f64)> = course(0).chain(course(2).collect::<Vec<_>>().into_iter().rev()).collect();
    chart.series.draw_series([Polygon::new(outline, shade(Ink::of_method(&study.method), BAND))])?;
    Ok(())
}

fn median(chart: &mut Chart, study: &MethodStudy) -> Drawn {
    let ink = Ink::of_method(&study.method);
    let points: Vec<(f64, f64)> =
        study.convergence.quartiles.iter().enumerate().map(|(k, [_, median, _])| (k as f64, height(*median))).collect();
    match points.as_slice() {
        [] => {}
        [start] => drop(chart.series.draw_series([Circle::new(*start, 3 * UNITS, shade(ink, 1.0))])?),
        _ => drop(chart.series.draw_series([PathElement::new(points, line(ink, 2.0))])?),
    }
    Ok(())
}

/// A piece of the curve and the name, beside each end; apart from each other where ends are close.
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

/// Rising positions as near to the wanted ones as a least distance allows: groups that are too close share their mean.
fn spread(wanted: &[i32], apart: i32) -> Vec<i32> {
    // Each group: its first and its number of members, and the sum of what its members want of the first.
    let mut groups: Vec<(i32, i32)> = Vec::new();
    let first = |(count, sum): (i32, i32)| sum / count;
    for y in wanted {
        groups.push((1, *y));
        while let [.., (count, sum), (next_count, next_sum)] = groups[..]
            && first((next_count, next_sum)) < first((count, sum)) + count * apart
        {
            groups.truncate(groups.len() - 2);
            groups.push((count + next_count, sum + next_sum - next_count * count * apart));
        }
    }
    groups.into_iter().flat_map(|group| (0..group.0).map(move |k| first(group) + k * apart)).collect()
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn names_stand_apart_and_stay_near() {
        assert_eq!(spread(&[10, 100, 200], 16), [10, 100, 200]);
        assert_eq!(spread(&[100, 100], 16), [92, 108]);
        assert_eq!(spread(&[100, 100, 100, 300], 16), [84, 100, 116, 300]);
        // The second pair runs into the first.
        assert_eq!(spread(&[100, 104, 110], 16), [88, 104, 120]);
        assert!(spread(&[], 16).is_empty());
    }
}
