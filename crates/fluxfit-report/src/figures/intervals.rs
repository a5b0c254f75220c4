//! The half-width of each parameter's 95 % interval relative to its value, on a logarithmic scale with the limits of the verdicts.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line, shade, solid},
        palette::Ink,
        plot::{Chart, Plot},
        size::Size,
    },
    figure::Figure,
    judgement::{is_weak_though_narrow, relative_half_width},
    report::Report,
};
use fluxfit::{Judgement, Verdict, evidence::IDENTIFIED, evidence::Identification, evidence::WEAK};
use fluxfit_units::significant;
use maud::html;
use plotters::{
    element::{Circle, PathElement, Rectangle},
    style::text_anchor::{HPos, VPos},
};

/// Left end of the scale, decadic logarithm of percent: the accuracy of drives' voltages does not allow less.
const NARROWEST: f64 = -3.0;

/// Right end of the scale, with space for parameters without a value.
const WIDEST: f64 = 2.7;

/// Width of a character of a number, pixels.
const CHARACTER: i32 = 8;

/// Distance of a number from the middle of its marker, pixels.
const ASIDE: i32 = 9;

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    Some(Figure {
        name: "intervals",
        section: "uncertainty",
        draw: Box::new(move |size| draw(found, size)),
        data: None,
        caption: html! {
            "Half-width of each 95\u{a0}% interval relative to the value, on a logarithmic scale; smaller (farther left) is better. The background "
            "shows the verdict that a width alone would have"
            @if found.parameters.iter().any(is_weak_though_narrow) { "; “weak” beside a number: for another reason than its width" }
            "."
        },
    })
}

/// Draws a row for each parameter.
fn draw(found: &Identification, size: Size) -> Drawing {
    let rows = found.parameters.iter().map(|judgement| {
        let width = relative_half_width(judgement).map_or_else(|| "none".to_owned(), |w| format!("{} %", significant(100.0 * w, 2)));
        format!("{} {width}", judgement.parameter.symbol())
    });
    let label = format!("Half-width of the 95 % interval relative to the value: {}", rows.collect::<Vec<_>>().join(", "));
    Drawing::new((size.width(), 210), label, |area| paint(area, found, size))
}

fn paint(area: &Area, found: &Identification, size: Size) -> Drawn {
    let rows = found.parameters.len() as f64;
    let percent = |power: f64| significant(10.0_f64.powf(power), 1);
    let plot = Plot {
        x: Axis { low: NARROWEST, high: WIDEST, ticks: vec![-3.0, -2.0, -1.0, 0.0, 1.0, 2.0], step: 1.0 },
        y: Axis { low: 0.0, high: rows, ticks: Vec::new(), step: 1.0 },
        x_name: "half-width of the interval, % of the value",
        y_name: "",
        left: 42,
        right: 24,
        x_label: &percent,
        y_label: &percent,
    };
    let mut chart = plot.on(area)?;
    let limits = [NARROWEST, (100.0 * IDENTIFIED).log10(), (100.0 * WEAK).log10(), WIDEST];
    for (verdict, ends) in [Verdict::Identified, Verdict::Weak, Verdict::NotIdentifiable].into_iter().zip(limits.windows(2)) {
        chart.series.draw_series([Rectangle::new([(ends[0], 0.0), (ends[1], rows)], shade(Ink::of_verdict(verdict), 0.12))])?;
    }
    for (name, ends) in ["identified", "weak", size.pick("no value", "none")].into_iter().zip(limits.windows(2)) {
        let (x, y) = chart.place(0.5 * (ends[0] + ends[1]), rows);
        area.draw_text(name, &anchored(Ink::Axis, HPos::Center, VPos::Bottom), (x, y - 4 * UNITS))?;
    }
    for (k, judgement) in found.parameters.iter().enumerate() {
        row(area, &mut chart, judgement, rows - k as f64 - 0.5, size)?;
    }
    Ok(())
}

/// One parameter at height `y`: a line up to its half-width with the number, or the reason why there is none.
fn row(area: &Area, chart: &mut Chart, judgement: &Judgement, y: f64, size: Size) -> Drawn {
    let ink = Ink::of_verdict(judgement.verdict);
    let (start, middle) = chart.place(NARROWEST, y);
    area.draw_text(judgement.parameter.symbol(), &anchored(Ink::Text, HPos::Right, VPos::Center), (start - 8 * UNITS, middle))?;
    let Some(width) = relative_half_width(judgement) else {
        if judgement.value().is_some() {
            return area.draw_text("given", &anchored(Ink::Axis, HPos::Left, VPos::Center), (start + 8 * UNITS, middle));
        }
        let (x, y) = chart.place(0.5 * ((100.0 * WEAK).log10() + WIDEST), y);
        let (r, stroke) = (4 * UNITS, line(ink, 2.0));
        area.draw(&PathElement::new(vec![(x - r, y - r), (x + r, y + r)], stroke))?;
        area.draw(&PathElement::new(vec![(x - r, y + r), (x + r, y - r)], stroke))?;
        return area.draw_text("not identifiable", &anchored(Ink::Text, HPos::Right, VPos::Center), (x - 10 * UNITS, y));
    };
    let x = (100.0 * width).log10().clamp(NARROWEST, WIDEST);
    chart.series.draw_series([PathElement::new(vec![(NARROWEST, y), (x, y)], line(ink, 2.0))])?;
    let (x, y) = chart.place(x, y);
    area.draw(&Circle::new((x, y), 5 * UNITS, solid(ink)))?;
    let weak = if is_weak_though_narrow(judgement) { ", weak" } else { "" };
    let text = format!("±{} %{weak}", significant(100.0 * width, 2));
    // To the right of the marker, or above its line if there is no space.
    let needed = ASIDE + CHARACTER * text.chars().count() as i32;
    if size.width() as i32 * UNITS - x > needed * UNITS {
        area.draw_text(&text, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + ASIDE * UNITS, y))
    } else {
        area.draw_text(&text, &anchored(Ink::Text, HPos::Right, VPos::Bottom), (x - ASIDE * UNITS, y - 3 * UNITS))
    }
}
