//! Currents over time, measured and simulated, an axis below the other; below each, what the simulation misses, on its own scale.

use super::{
    Size,
    axis::Axis,
    canvas::{Area, Drawing, Drawn, UNITS, anchored, line},
    decimation::decimated,
    palette::Ink,
    plot::Plot,
};
use fluxfit::{identify::output_fit::OutputFit, log::Log};
use plotters::{
    element::PathElement,
    style::{
        Color, ShapeStyle,
        text_anchor::{HPos, VPos},
    },
};
use std::ops::Range;

/// Height of a panel of currents, pixels.
const CURRENTS: i32 = 200;

/// Height of a panel of residuals, pixels.
const RESIDUALS: i32 = 140;

/// The upper panel of a pair has no numbers below it: the lower one is moved up into their room, pixels.
const SHARED: i32 = 34;

/// Room for the numbers of the y axis and beside the plot, pixels.
const SIDES: (i32, i32) = (50, 12);

/// Measured curves stand behind simulated ones, and do not shout.
const BEHIND: f64 = 0.7;

/// A curve, piece by piece: time, s, and value.
type Curve = Vec<Vec<(f64, f64)>>;

/// What is drawn of one axis: per stretch of the log its times, and measured and simulated less measured current.
struct Course<'a> {
    log: &'a Log,
    fit: &'a OutputFit,
    /// Which: 0 is d.
    axis: usize,
    /// Seconds.
    times: [f64; 2],
}

/// Draws both currents and their residuals.
pub(crate) fn draw(log: &Log, fit: &OutputFit, size: Size) -> Drawing {
    let rms = fit.residual_rms();
    let label = format!(
        "Curves: i_d and i_q over time, measured and simulated, and their differences, {:.2e} and {:.2e} ampere root mean square",
        rms.d, rms.q
    );
    let pair = CURRENTS - SHARED + RESIDUALS;
    Drawing::new((size.width(), 2 * pair.unsigned_abs()), label, |area| {
        let ends = |end: fn(&Range<usize>) -> usize| fit.stretches.iter().map(move |rows| log.columns().t[end(rows)]);
        let first = ends(|rows| rows.start).fold(f64::INFINITY, f64::min);
        let last = ends(|rows| rows.end - 1).fold(f64::NEG_INFINITY, f64::max);
        [0, 1].into_iter().try_for_each(|axis| {
            let course = Course { log, fit, axis, times: [first, last] };
            let top = axis as i32 * pair;
            course.currents(&panel(area, top, CURRENTS, size), size)?;
            course.residuals(&panel(area, top + CURRENTS - SHARED, RESIDUALS, size), size)
        })
    })
}

/// A strip of the sheet, pixels.
fn panel<'a>(area: &Area<'a>, top: i32, height: i32, size: Size) -> Area<'a> {
    area.clone().shrink((0, top * UNITS), (size.width() as i32 * UNITS, height * UNITS))
}

impl Course<'_> {
    fn measured(&self) -> &[f64] {
        let columns = self.log.columns();
        if self.axis == 0 { &columns.id } else { &columns.iq }
    }

    fn ink(&self) -> Ink {
        if self.axis == 0 { Ink::D } else { Ink::Q }
    }

    /// Per stretch a curve of what `value` makes of a row's measured current and its residual.
    fn curves(&self, value: fn(f64, f64) -> f64, size: Size) -> Curve {
        let (left, right) = SIDES;
        let columns = size.width() - (left + right).unsigned_abs();
        let (t, measured) = (&self.log.columns().t, self.measured());
        let mut before = 0;
        let curves = self.fit.stretches.iter().map(|rows| {
            let residuals = &self.fit.residuals[2 * before..];
            before += rows.len();
            let points = rows.clone().enumerate().map(|(k, row)| (t[row], value(measured[row], residuals[2 * k + self.axis])));
            decimated(points, self.times, columns)
        });
        curves.collect()
    }

    fn currents(&self, area: &Area, size: Size) -> Drawn {
        let measured = self.curves(|measured, _| measured, size);
        let simulated = self.curves(|measured, residual| measured - residual, size);
        let values = measured.iter().chain(&simulated).flatten().map(|(_, i)| *i);
        let name = ["i_d, A", "i_q, A"][self.axis];
        let behind = ShapeStyle { color: Ink::Axis.color().mix(BEHIND), ..line(Ink::Axis, 2.4) };
        let front = line(self.ink(), 1.2);
        self.panel(area, Axis::around(values, 4), ("", name), size, &[(measured, behind), (simulated, front)])?;
        let right = size.width() as i32 * UNITS;
        for (style, text, from_right) in [(behind, "measured", 190), (front, "simulated", 92)] {
            let (x, y) = (right - from_right * UNITS, 13 * UNITS);
            area.draw(&PathElement::new(vec![(x, y), (x + 20 * UNITS, y)], style))?;
            area.draw_text(text, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 25 * UNITS, y))?;
        }
        Ok(())
    }

    fn residuals(&self, area: &Area, size: Size) -> Drawn {
        let residuals = self.curves(|_, residual| residual, size);
        let largest = residuals.iter().flatten().map(|(_, residual)| residual.abs()).fold(0.0, f64::max);
        // Milliamperes where amperes would be nothing but zeros.
        let (factor, name) = if largest < 1.0 { (1e3, "missed, mA") } else { (1.0, "missed, A") };
        let scaled: Curve = residuals.iter().map(|curve| curve.iter().map(|(t, i)| (*t, factor * i)).collect()).collect();
        let zero = vec![self.times.map(|t| (t, 0.0)).to_vec()];
        let y = Axis::around(scaled.iter().flatten().map(|(_, i)| *i).chain([0.0]), 4);
        self.panel(area, y, ("time, s", name), size, &[(scaled, line(self.ink(), 0.8)), (zero, line(Ink::Axis, 1.0))])
    }

    /// Curves over time; without a name of the time its numbers are left out too.
    fn panel(&self, area: &Area, y: Axis, (x_name, y_name): (&str, &str), size: Size, curves: &[(Curve, ShapeStyle)]) -> Drawn {
        let x = Axis::between(self.times[0], self.times[1], size.pick(8, 5));
        let (x_label, y_label) = (x.clone(), y.clone());
        let (left, right) = SIDES;
        let plot = Plot {
            x,
            y,
            x_name,
            y_name,
            left,
            right,
            x_label: &|t| if x_name.is_empty() { String::new() } else { x_label.label(t) },
            y_label: &|i| y_label.label(i),
        };
        let mut chart = plot.on(area)?;
        for (curve, style) in curves {
            chart.series.draw_series(curve.iter().map(|piece| PathElement::new(piece.clone(), *style)))?;
        }
        Ok(())
    }
}
