//! Two axes with their numbers, names and grid: what most figures have in common.

use super::{
    axis::Axis,
    canvas::{Area, UNITS, anchored, letters, line},
    palette::Ink,
};
use plotters::{
    chart::{ChartBuilder, ChartContext},
    coord::types::RangedCoordf64,
    element::PathElement,
    prelude::{Cartesian2d, DrawingAreaErrorKind, SVGBackend},
    style::text_anchor::{HPos, VPos},
};

/// What plotters draws series into.
type Series<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A chart to draw series into.
pub(super) struct Chart<'a> {
    /// Takes elements at values of the axes.
    pub(super) series: Series<'a>,
    /// Where the area of the chart lies on the sheet, units.
    origin: (i32, i32),
}

impl Chart<'_> {
    /// Where in the area a pair of values lies, units.
    pub(super) fn place(&self, x: f64, y: f64) -> (i32, i32) {
        let (on_sheet, origin) = (self.series.backend_coord(&(x, y)), self.origin);
        (on_sheet.0 - origin.0, on_sheet.1 - origin.1)
    }
}

/// Axes and the words at them.
pub(super) struct Plot<'a> {
    /// Along the sheet.
    pub(super) x: Axis,
    /// Up the sheet.
    pub(super) y: Axis,
    /// Stands below the right end of the x axis.
    pub(super) x_name: &'a str,
    /// Stands above the y axis.
    pub(super) y_name: &'a str,
    /// Room for the numbers of the y axis, pixels.
    pub(super) left: i32,
    /// Room beside the plot, pixels.
    pub(super) right: i32,
    /// How a number of the x axis is written.
    pub(super) x_label: &'a dyn Fn(f64) -> String,
    /// How a number of the y axis is written.
    pub(super) y_label: &'a dyn Fn(f64) -> String,
}

/// Room above the plot for the name of the y axis, pixels.
const TOP: i32 = 26;

/// Room below it for the numbers and the name of the x axis, pixels.
const BOTTOM: i32 = 40;

/// Between an axis and its numbers, pixels.
const GAP: i32 = 5;

impl Plot<'_> {
    /// Draws axes, grid and words.
    pub(super) fn on<'a>(&self, area: &Area<'a>) -> Result<Chart<'a>, DrawingAreaErrorKind<std::io::Error>> {
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
        area.draw_text(self.y_name, &letters(Ink::Text), (GAP * UNITS / 2, GAP * UNITS))?;
        area.draw_text(self.x_name, &anchored(Ink::Text, HPos::Right, VPos::Top), (x1, y0 + (GAP + 17) * UNITS))?;
        Ok(chart)
    }
}
