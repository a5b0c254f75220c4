//! A plot: two axes with numbers, names and grid.

use super::{
    axis::Axis,
    canvas::{Area, UNITS, anchored, line, text_style},
    palette::Ink,
};
use plotters::{
    chart::{ChartBuilder, ChartContext},
    coord::types::RangedCoordf64,
    element::PathElement,
    prelude::{Cartesian2d, DrawingAreaErrorKind, SVGBackend},
    style::text_anchor::{HPos, VPos},
};

/// The coordinate system of plotters.
type Series<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A chart, into which series are drawn.
pub(crate) struct Chart<'a> {
    /// Takes elements in coordinates of the axes.
    pub(crate) series: Series<'a>,
    /// Origin of the chart's area in the whole drawing, units.
    origin: (i32, i32),
}

impl Chart<'_> {
    /// Position of a pair of values in the area, units.
    pub(crate) fn place(&self, x: f64, y: f64) -> (i32, i32) {
        let (on_sheet, origin) = (self.series.backend_coord(&(x, y)), self.origin);
        (on_sheet.0 - origin.0, on_sheet.1 - origin.1)
    }
}

/// Axes and their labels.
pub(crate) struct Plot<'a> {
    /// Horizontal axis.
    pub(crate) x: Axis,
    /// Vertical axis.
    pub(crate) y: Axis,
    /// Name of the x axis, below its right end.
    pub(crate) x_name: &'a str,
    /// Name of the y axis, above it.
    pub(crate) y_name: &'a str,
    /// Left margin for the numbers of the y axis, pixels.
    pub(crate) left: i32,
    /// Right margin, pixels.
    pub(crate) right: i32,
    /// Formats a number of the x axis.
    pub(crate) x_label: &'a dyn Fn(f64) -> String,
    /// Formats a number of the y axis.
    pub(crate) y_label: &'a dyn Fn(f64) -> String,
}

/// Top margin for the name of the y axis, pixels.
const TOP: i32 = 26;

/// Bottom margin for the numbers and the name of the x axis, pixels.
const BOTTOM: i32 = 40;

/// Gap between an axis and its numbers, pixels.
const GAP: i32 = 5;

impl Plot<'_> {
    /// Draws axes, grid and labels.
    pub(crate) fn on<'a>(&self, area: &Area<'a>) -> Result<Chart<'a>, DrawingAreaErrorKind<std::io::Error>> {
        let series = ChartBuilder::on(area)
            .margin_top(TOP * UNITS)
            .margin_right(self.right * UNITS)
            .margin_left(self.left * UNITS)
            .margin_bottom(BOTTOM * UNITS)
            .build_cartesian_2d(self.x.low..self.x.high, self.y.low..self.y.high)?;
        let chart = Chart { series, origin: area.get_base_pixel() };
        let (x0, y0) = chart.place(self.x.low, self.y.low);
        let (x1, y1) = chart.place(self.x.high, self.y.high);
        let grid = |from, to| area.draw(&PathElement::new(vec![from, to], line(Ink::Grid, 1.0)));
        for tick in &self.x.ticks {
            let (x, _) = chart.place(*tick, self.y.low);
            grid((x, y0), (x, y1))?;
            area.draw_text(&(self.x_label)(*tick), &anchored(Ink::Axis, HPos::Center, VPos::Top), (x, y0 + GAP * UNITS))?;
        }
        for tick in &self.y.ticks {
            let (_, y) = chart.place(self.x.low, *tick);
            grid((x0, y), (x1, y))?;
            area.draw_text(&(self.y_label)(*tick), &anchored(Ink::Axis, HPos::Right, VPos::Center), (x0 - GAP * UNITS, y))?;
        }
        area.draw(&PathElement::new(vec![(x0, y1), (x0, y0), (x1, y0)], line(Ink::Axis, 1.0)))?;
        area.draw_text(self.y_name, &text_style(Ink::Text), (GAP * UNITS / 2, GAP * UNITS))?;
        area.draw_text(self.x_name, &anchored(Ink::Text, HPos::Right, VPos::Top), (x1, y0 + (GAP + 17) * UNITS))?;
        Ok(chart)
    }
}
