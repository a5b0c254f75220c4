//! How wide the intervals are: the half-width of each parameter's 95 % interval as a fraction of its value, on a logarithmic scale
//! with the limits of the verdicts.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, letters, line, shade, solid},
    palette::Ink,
    plot::Plot,
};
use fluxfit::identify::{
    Identification,
    verdict::{IDENTIFIED, Judgement, Verdict, WEAK},
};
use fluxfit_files::number::significant;
use plotters::{
    element::{Circle, PathElement, Rectangle},
    style::text_anchor::{HPos, VPos},
};

/// Left end of the scale, a power of ten of percent: no drive's voltages allow less.
const NARROWEST: f64 = -3.0;

/// Right end.
const WIDEST: f64 = 2.0;

/// Half of the interval as a fraction of the value, where there is a value and a width.
pub(crate) fn relative_half_width(judgement: &Judgement) -> Option<f64> {
    let width = judgement.uncertainty.half_width / judgement.value()?.abs();
    (width > 0.0 && width.is_finite()).then_some(width)
}

/// Draws a row for each parameter.
pub(crate) fn draw(found: &Identification, size: Size) -> Drawing {
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
        x_name: "half of the interval, % of the value",
        y_name: "",
        left: 42,
        right: 24,
        x_label: &percent,
        y_label: &percent,
    };
    let mut chart = plot.on(area)?;
    let limits = [NARROWEST, (100.0 * IDENTIFIED).log10(), (100.0 * WEAK).log10(), WIDEST];
    for (verdict, ends) in [Verdict::Identified, Verdict::Weak, Verdict::NotIdentifiable].into_iter().zip(limits.windows(2)) {
        chart.draw_series([Rectangle::new([(ends[0], 0.0), (ends[1], rows)], shade(Ink::of_verdict(verdict), 0.12))])?;
    }
    for (name, ends, place) in [("identified", [limits[0], limits[1]], 0.5), ("weak", [limits[1], limits[2]], 0.5)] {
        let (x, y) = chart.backend_coord(&(ends[0] + place * (ends[1] - ends[0]), rows));
        area.draw_text(name, &anchored(Ink::Axis, HPos::Center, VPos::Bottom), (x, y - 4 * UNITS))?;
    }
    for (k, judgement) in found.parameters.iter().enumerate() {
        let y = rows - k as f64 - 0.5;
        let (x0, middle) = chart.backend_coord(&(NARROWEST, y));
        area.draw_text(judgement.parameter.symbol(), &letters(Ink::Text).pos(right_center()), (x0 - 8 * UNITS, middle))?;
        let Some(width) = relative_half_width(judgement) else {
            let why = if judgement.value().is_some() { "given" } else { "not identifiable: no value" };
            area.draw_text(why, &anchored(Ink::Axis, HPos::Left, VPos::Center), (x0 + 8 * UNITS, middle))?;
            continue;
        };
        let ink = Ink::of_verdict(judgement.verdict);
        let x = (100.0 * width).log10().clamp(NARROWEST, WIDEST);
        chart.draw_series([PathElement::new(vec![(NARROWEST, y), (x, y)], line(ink, 2.0))])?;
        let (x, y) = chart.backend_coord(&(x, y));
        area.draw(&Circle::new((x, y), 5 * UNITS, solid(ink)))?;
        let text = format!("±{} %", significant(100.0 * width, 2));
        // Beside the marker, where the sheet has room.
        let room = (size.width() as i32 * UNITS) - x > 110 * UNITS;
        let (side, x) = if room { (HPos::Left, x + 9 * UNITS) } else { (HPos::Right, x - 9 * UNITS) };
        area.draw_text(
            &text,
            &anchored(Ink::Text, side, if room { VPos::Center } else { VPos::Bottom }),
            (x, if room { y } else { y - 4 * UNITS }),
        )?;
    }
    Ok(())
}

fn right_center() -> plotters::style::text_anchor::Pos {
    plotters::style::text_anchor::Pos::new(HPos::Right, VPos::Center)
}
