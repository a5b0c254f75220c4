//! Interactive figures: their data in the page, and the script that draws them.
//!
//! A figure is an SVG, and may have [`PlotData`], from which the script draws an interactive plot in its place. Without scripts, and on
//! paper, the SVG is shown. The script is uPlot with the code that calls it: it makes no request, and the page's policy forbids any.

use crate::drawing::palette::Ink;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

/// The plotting library uPlot, MIT. Its first line is a web address; its licence is in the page instead.
const UPLOT: &str = include_str!("uplot.iife.min.js");
const UPLOT_LICENSE: &str = include_str!("uplot.LICENSE");

/// The style sheet of uPlot.
pub(crate) const STYLE: &str = include_str!("uplot.min.css");

/// The code that calls uPlot.
const FIGURES: &str = include_str!("figures.js");

/// The content security policy of the page, which the browser enforces: nothing is loaded.
pub(crate) const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The data of a figure: panels below each other with a common x axis.
#[derive(Debug, Serialize)]
pub(crate) struct PlotData {
    /// The x axis.
    pub(crate) x: XAxis,
    /// The panels, from top to bottom.
    pub(crate) panels: Vec<Panel>,
    /// A description of each point, shown instead of the panels' values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) descriptions: Vec<String>,
    /// Spans of the x axis with a shade of their own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) spans: Vec<Span>,
}

/// A shaded span of the x axis.
#[derive(Debug, Serialize)]
pub(crate) struct Span {
    /// Whether it is a window, or rows that were left out.
    pub(crate) is_window: bool,
    pub(crate) ends: [f64; 2],
    /// What it is; shown for the values within it.
    pub(crate) text: String,
}

/// The x axis of a figure.
#[derive(Debug, Serialize)]
pub(crate) struct XAxis {
    pub(crate) name: &'static str,
    /// Empty if there is none.
    pub(crate) unit: &'static str,
    /// In ascending order.
    pub(crate) values: DeltaColumn,
}

/// The kind of a panel.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PanelKind {
    /// Curves.
    Lines,
    /// Curves on a logarithmic axis; the values are decadic logarithms.
    Decades,
    /// Markers with error bars at whole numbers.
    Bars,
    /// Points in a plane.
    Plane,
}

/// A panel: a y axis with its series.
#[derive(Debug, Serialize)]
pub(crate) struct Panel {
    /// Name and unit of the y axis.
    pub(crate) name: String,
    /// Height, pixels.
    pub(crate) height: i32,
    pub(crate) kind: PanelKind,
    /// Ranges of both axes, if they are not those of the values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ranges: Option<[[f64; 2]; 2]>,
    pub(crate) series: Vec<Series>,
}

/// One series of values over the x axis.
#[derive(Debug, Serialize)]
pub(crate) struct Series {
    name: &'static str,
    /// Colours on white and on dark backgrounds.
    ink: [String; 2],
    /// Dashes and gaps, pixels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    dash: Vec<f64>,
    /// Line width, pixels.
    width: f64,
    opacity: f64,
    values: DeltaColumn,
    /// Lower and upper edge of the band about a curve, or half the length of the error bar of a marker.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    about: Vec<DeltaColumn>,
}

impl Series {
    /// A curve.
    pub(crate) fn new(name: &'static str, ink: Ink, (width, opacity): (f64, f64), values: DeltaColumn) -> Self {
        Self { name, ink: ink.css_colors(), dash: ink.dashes_in_pixels(), width, opacity, values, about: Vec::new() }
    }

    /// The same with a band or an error bar.
    pub(crate) fn with_band(self, about: Vec<DeltaColumn>) -> Self {
        Self { about, ..self }
    }
}

/// A delta-encoded column of numbers: differences of consecutive values as integer multiples of a power of ten, for a small file. A
/// value that is not finite is a gap.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct DeltaColumn {
    /// Exponent of the power of ten.
    exponent: i32,
    steps: Vec<Option<i64>>,
}

/// Digits of the largest number: as many as a screen can show, and some more for zooming.
const DIGITS: i32 = 5;

/// Integers up to here are exact in JavaScript.
const EXACT: f64 = 9e15;

impl DeltaColumn {
    /// Resolves five digits of the largest value.
    pub(crate) fn new(values: &[f64]) -> Self {
        let largest = values.iter().filter(|value| value.is_finite()).fold(0.0_f64, |largest, value| largest.max(value.abs()));
        Self::resolving(values, largest * 10.0_f64.powi(1 - DIGITS))
    }

    /// Resolves the largest power of ten that does not exceed `resolution`.
    pub(crate) fn resolving(values: &[f64], resolution: f64) -> Self {
        // The small addition keeps a power of ten that is too small by rounding.
        let exponent = if resolution.is_normal() { (resolution.log10() + 1e-9).floor() as i32 } else { 0 };
        // Multiplies or divides by a power of ten with a positive exponent, which is exact.
        let whole = |value: f64| if exponent < 0 { value * 10.0_f64.powi(-exponent) } else { value / 10.0_f64.powi(exponent) };
        let mut before = 0;
        let steps = values.iter().map(|value| {
            let value = Some(whole(*value).round()).filter(|value| value.abs() <= EXACT)? as i64;
            Some(value - std::mem::replace(&mut before, value))
        });
        Self { exponent, steps: steps.collect() }
    }
}

impl PlotData {
    /// The data as an element of the page.
    pub(crate) fn element(&self) -> Markup {
        // These types always serialize.
        let text = serde_json::to_string(self).unwrap_or_default();
        html! { script type="application/json" { (PreEscaped(text.replace('<', "\\u003c"))) } }
    }
}

/// The script element at the end of the page.
pub(crate) fn script() -> Markup {
    let (_, uplot) = UPLOT.split_once('\n').unwrap_or(("", UPLOT));
    html! { script { (PreEscaped(format!("/* uPlot 1.6.32\n{UPLOT_LICENSE}*/\n{uplot}\n{FIGURES}"))) } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_delta_encoded() {
        let text = |column: &DeltaColumn| serde_json::to_string(column).unwrap();
        assert_eq!(text(&DeltaColumn::resolving(&[0.0, 0.1, 0.3, f64::NAN, 0.2], 0.1)), r#"{"exponent":-1,"steps":[0,1,2,null,-1]}"#);
        assert_eq!(text(&DeltaColumn::new(&[12.34567, -1.0])), r#"{"exponent":-3,"steps":[12346,-13346]}"#);
        assert_eq!(text(&DeltaColumn::new(&[2e300, 1e300])), r#"{"exponent":296,"steps":[20000,-10000]}"#);
        assert_eq!(text(&DeltaColumn::new(&[0.0, f64::INFINITY])), r#"{"exponent":0,"steps":[0,null]}"#);
        assert_eq!(text(&DeltaColumn::new(&[])), r#"{"exponent":0,"steps":[]}"#);
    }

    #[test]
    fn text_in_the_data_cannot_end_the_script_element() {
        let x = XAxis { name: "x", unit: "", values: DeltaColumn::new(&[1.0]) };
        let data = PlotData { x, panels: Vec::new(), descriptions: vec!["</script><!--<script>".to_owned()], spans: Vec::new() };
        let page = data.element().into_string();
        assert_eq!(page.matches('<').count(), 2, "{page}");
        assert!(page.contains(r"\u003c/script>\u003c!--\u003cscript>"));
    }
}
