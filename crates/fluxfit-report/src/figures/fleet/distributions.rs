//! The parameters of a fleet: of few motors each value with its interval, of many a histogram with the typical interval; outliers by name.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line, shade, solid},
        labels::{places, short},
        palette::Ink,
        plot::{Chart, Plot},
        size::Size,
    },
    figure::Figure,
    typography::{self, number, unit},
};
use fluxfit::fleet::{Distribution, FleetOverview, FleetValue, Outlier, Typical};
use fluxfit_units::{Scale, significant};
use maud::html;
use plotters::{
    element::{Circle, PathElement, Rectangle},
    style::text_anchor::{HPos, VPos},
};

/// Of so many motors each has its own line; of more a histogram is read faster.
const LINES: usize = 12;

/// Height of a motor's line, and of a histogram with its axis, pixels.
const LINE: u32 = 18;
const HISTOGRAM: u32 = 150;

/// What the axes of a panel take of its height, pixels.
const AXES: u32 = 76;

/// Bars of a histogram: at most so many in a wide and a narrow figure, and no more than this root of the number of motors asks for.
const BARS: (usize, usize) = (48, 24);
const LEAST_BARS: usize = 8;

/// How far outliers stretch an axis to either side, as a part of the range of the other motors.
const STRETCH: f64 = 0.5;

/// Heights of the outliers within the axis and of the arrows to those beyond, as parts of the panel's.
const CIRCLES: f64 = 0.25;
const ARROWS: f64 = 0.8;

/// Outliers with a name.
const NAMED: usize = 6;

/// The figure; `None` if no motor has a value.
pub(crate) fn figure(fleet: &FleetOverview) -> Option<Figure<'_>> {
    let shown: Vec<(&Distribution, Typical)> =
        fleet.distributions.iter().filter_map(|distribution| Some((distribution, distribution.typical?))).collect();
    let is_many = shown.iter().any(|(distribution, _)| distribution.values.len() > LINES);
    let has_outliers = shown.iter().any(|(distribution, _)| !distribution.outliers.is_empty());
    (!shown.is_empty()).then(|| Figure {
        name: "distributions",
        section: "parameters",
        draw: Box::new(move |size| draw(fleet, &shown, size)),
        data: None,
        caption: html! {
            @if is_many {
                "How many motors have which value. Above: the median with the 95\u{a0}% interval of a typical motor; where it is as wide as the "
                "bars, the motors differ by no more than they are known to."
            } @else {
                "The value of each motor with its 95\u{a0}% interval."
            }
            @if has_outliers { " Motors that stand apart are circles with their intervals; an arrow points to a value beyond the axis." }
        },
    })
}

fn height(distribution: &Distribution) -> u32 {
    let motors = distribution.values.len();
    if motors > LINES { HISTOGRAM } else { AXES + LINE * motors as u32 }
}

fn draw(fleet: &FleetOverview, shown: &[(&Distribution, Typical)], size: Size) -> Drawing {
    let label = shown.iter().map(|(distribution, typical)| {
        let parameter = distribution.parameter;
        let scale = Scale::for_value(parameter, typical.median);
        let error = typical.range[1] - typical.range[0];
        let unit = unit(parameter, &scale);
        format!("{} of {} motors, median {} {unit}", parameter.symbol(), distribution.values.len(), scale.format(typical.median, error))
    });
    let label = format!("Distribution of {}", label.collect::<Vec<_>>().join("; "));
    let heights: Vec<u32> = shown.iter().map(|(distribution, _)| height(distribution)).collect();
    Drawing::new((size.width(), heights.iter().sum()), label, |area| {
        let mut rest = area.clone();
        for ((distribution, typical), height) in shown.iter().zip(heights) {
            let (panel, below) = rest.split_vertically(height * UNITS.unsigned_abs());
            paint(&panel, fleet, distribution, typical, size)?;
            rest = below;
        }
        Ok(())
    })
}

/// The range of the values that do not stand apart, widened for those that do.
fn axis(distribution: &Distribution, typical: &Typical, count: usize) -> Axis {
    let is_apart = |motor: usize| distribution.outliers.iter().any(|outlier| outlier.motor == motor);
    let is_many = distribution.values.len() > LINES;
    let ends = |value: &FleetValue| {
        let half = if is_many { 0.0 } else { value.half_width };
        [value.value - half, value.value + half]
    };
    let near = distribution.values.iter().filter(|(motor, _)| !is_apart(*motor)).flat_map(|(_, value)| ends(value));
    let typical = [typical.median - typical.half_width, typical.median + typical.half_width];
    let near: Vec<f64> = near.chain(typical).collect();
    let (low, high) = near.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let reach = STRETCH * (high - low);
    let far = distribution.outliers.iter().map(|outlier| outlier.value.value.clamp(low - reach, high + reach));
    Axis::around(near.into_iter().chain(far), count)
}

fn paint(area: &Area, fleet: &FleetOverview, distribution: &Distribution, typical: &Typical, size: Size) -> Drawn {
    let parameter = distribution.parameter;
    let scale = Scale::for_value(parameter, typical.median);
    let x = axis(distribution, typical, size.pick(8, 4));
    let step = 10.0 * x.step;
    let motors = distribution.values.len();
    let name = format!("{}, {}", parameter.symbol(), unit(parameter, &scale));
    let bars = (motors > LINES).then(|| counted(distribution, &x, size));
    // A fifth more than the highest bar, for the typical interval.
    let most = bars.as_ref().map_or(motors, |bars| bars.iter().copied().max().unwrap_or(1)) as f64;
    let y = match &bars {
        Some(_) => {
            let axis = Axis::between(0.0, 1.3 * most, 3);
            let ticks = axis.ticks.iter().copied().filter(|tick| tick.fract() == 0.0 && *tick <= most).collect();
            Axis { ticks, ..axis }
        }
        None => Axis { low: 0.0, high: most, ticks: Vec::new(), step: 1.0 },
    };
    let plot = Plot {
        x,
        y,
        x_name: "",
        y_name: &name,
        left: if bars.is_some() { 46 } else { size.pick(130, 96) },
        right: 24,
        // Two significant digits of ten steps distinguish neighbouring ticks.
        x_label: &|value| typography::minus(scale.format(value, step)),
        y_label: &|count| format!("{count:.0}"),
    };
    let mut chart = plot.on(area)?;
    match bars {
        Some(bars) => {
            histogram(&mut chart, &plot, &bars)?;
            typical_interval(area, &mut chart, typical, 1.15 * most)?;
            outliers(area, &mut chart, &plot, fleet, distribution, size)
        }
        None => lines(area, &mut chart, fleet, distribution),
    }
}

/// How many motors lie in each bar; those beyond the axis in none.
fn counted(distribution: &Distribution, x: &Axis, size: Size) -> Vec<usize> {
    let most = size.pick(BARS.0, BARS.1);
    let bars = (2.0 * (distribution.values.len() as f64).sqrt()).round().clamp(LEAST_BARS as f64, most as f64) as usize;
    let mut counts = vec![0; bars];
    for (_, value) in &distribution.values {
        let place = (value.value - x.low) / (x.high - x.low) * bars as f64;
        if let Some(count) = (place >= 0.0).then(|| counts.get_mut(place as usize)).flatten() {
            *count += 1;
        }
    }
    counts
}

fn histogram(chart: &mut Chart, plot: &Plot, bars: &[usize]) -> Drawn {
    let width = (plot.x.high - plot.x.low) / bars.len() as f64;
    let bar = |(k, count): (usize, &usize)| {
        let left = plot.x.low + width * k as f64;
        Rectangle::new([(left, 0.0), (left + width, *count as f64)], shade(Ink::D, 0.55))
    };
    chart.series.draw_series(bars.iter().enumerate().filter(|(_, count)| **count > 0).map(bar))?;
    Ok(())
}

/// The median with the interval of a typical motor, and how wide it is.
fn typical_interval(area: &Area, chart: &mut Chart, typical: &Typical, y: f64) -> Drawn {
    interval(area, chart, FleetValue { value: typical.median, half_width: typical.half_width }, y, Ink::Text)?;
    let (x, y) = chart.place(typical.median + typical.half_width, y);
    let width = number(100.0 * typical.half_width / typical.median.abs(), |percent| significant(percent, 2));
    area.draw_text(&format!("±{width} %"), &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 8 * UNITS, y))
}

/// A point with its interval.
fn interval(area: &Area, chart: &mut Chart, value: FleetValue, y: f64, ink: Ink) -> Drawn {
    let ends = [value.value - value.half_width, value.value + value.half_width];
    let range = chart.series.x_range();
    let ends = ends.map(|end| end.clamp(range.start, range.end));
    chart.series.draw_series([PathElement::new(ends.map(|x| (x, y)).to_vec(), line(ink, 2.0))])?;
    area.draw(&Circle::new(chart.place(value.value, y), 4 * UNITS, solid(ink)))
}

/// The motors that stand apart, in the lower third of the panel; the farthest of them have names.
fn outliers(area: &Area, chart: &mut Chart, plot: &Plot, fleet: &FleetOverview, distribution: &Distribution, size: Size) -> Drawn {
    let (x, y) = (&plot.x, CIRCLES * plot.y.high);
    let name = |outlier: &Outlier| fleet.motors.get(outlier.motor).map(|member| short(&member.best.motor)).unwrap_or_default();
    let (below, others): (Vec<&Outlier>, Vec<&Outlier>) = distribution.outliers.iter().partition(|outlier| outlier.value.value < x.low);
    let (above, within): (Vec<&Outlier>, Vec<&Outlier>) = others.into_iter().partition(|outlier| outlier.value.value > x.high);
    for outlier in &within {
        interval(area, chart, outlier.value, y, Ink::Q)?;
    }
    let place = |outlier: &&&Outlier| {
        let (x, y) = chart.place(outlier.value.value, y);
        (x / UNITS, y / UNITS)
    };
    let named: Vec<&&Outlier> = within.iter().take(NAMED).collect();
    let points: Vec<(i32, i32)> = named.iter().map(place).collect();
    let names: Vec<String> = named.iter().map(|outlier| name(outlier)).collect();
    let (width, height) = area.dim_in_pixel();
    let room = (width as i32 / UNITS, height as i32 / UNITS);
    for (place, name) in places(&points, &names, room).into_iter().zip(&names) {
        if let Some((x, y)) = place {
            area.draw_text(name, &anchored(Ink::Q, HPos::Center, VPos::Center), (x * UNITS, y * UNITS))?;
        }
    }
    for (beyond, edge, towards, anchor) in [(below, x.low, 1, HPos::Left), (above, x.high, -1, HPos::Right)] {
        if beyond.is_empty() {
            continue;
        }
        // An arrow to the edge, and the names inside.
        let (tip, y) = chart.place(edge, ARROWS * plot.y.high);
        let (tip, back) = (tip + 3 * towards * UNITS, tip + 10 * towards * UNITS);
        area.draw(&PathElement::new(vec![(back, y - 5 * UNITS), (tip, y), (back, y + 5 * UNITS)], line(Ink::Q, 2.0)))?;
        let mut names: Vec<String> = beyond.iter().take(size.pick(3, 1)).map(|outlier| name(outlier)).collect();
        let more = beyond.len() - names.len();
        names.extend((more > 0).then(|| format!("{more} more")));
        area.draw_text(&names.join(", "), &anchored(Ink::Q, anchor, VPos::Center), (back + 6 * towards * UNITS, y))?;
    }
    Ok(())
}

/// Each motor's value with its interval, in order of the motors' names.
fn lines(area: &Area, chart: &mut Chart, fleet: &FleetOverview, distribution: &Distribution) -> Drawn {
    let named = distribution.values.iter().filter_map(|(motor, value)| Some((&*fleet.motors.get(*motor)?.best.motor, *motor, *value)));
    let mut named: Vec<(&str, usize, FleetValue)> = named.collect();
    named.sort_by(|one, other| one.0.cmp(other.0));
    let motors = named.len() as f64;
    for (k, (name, motor, value)) in named.into_iter().enumerate() {
        let y = motors - k as f64 - 0.5;
        let is_apart = distribution.outliers.iter().any(|outlier| outlier.motor == motor);
        let ink = if is_apart { Ink::Q } else { Ink::D };
        interval(area, chart, value, y, ink)?;
        let (x, y) = chart.place(chart.series.x_range().start, y);
        area.draw_text(&short(name), &anchored(Ink::Text, HPos::Right, VPos::Center), (x - 6 * UNITS, y))?;
    }
    Ok(())
}
