//! Figures that answer to the pointer: their numbers in the page, and the one script that draws them.
//!
//! A figure is its SVG; beside it may lie a [`Live`], which the script reads and draws over the SVG's place. Without scripts, and on
//! paper, the SVG stays. The script is uPlot and what calls it: it makes no request, and the page's policy forbids any.

use crate::figure::palette::Ink;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

/// The drawing library, MIT; its first line is an address, and its licence stands in the page instead.
const UPLOT: &str = include_str!("uplot.iife.min.js");
const UPLOT_LICENSE: &str = include_str!("uplot.LICENSE");

/// How its parts lie on each other.
pub(crate) const STYLE: &str = include_str!("uplot.min.css");

/// What calls it.
const FIGURES: &str = include_str!("figures.js");

/// What a page may do, for the browser to enforce: nothing is loaded from anywhere.
pub(crate) const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The numbers of a figure: panels one below the other over the same values along.
#[derive(Debug, Serialize)]
pub(crate) struct Live {
    /// What stands along.
    pub(crate) x: Along,
    /// From above.
    pub(crate) panels: Vec<Panel>,
    /// For each value along, what is told of it instead of the panels' values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) told: Vec<String>,
}

/// The values along.
#[derive(Debug, Serialize)]
pub(crate) struct Along {
    /// Their name, and their unit behind a space.
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    /// Rising.
    pub(crate) values: Column,
}

/// What a panel is.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// Curves.
    Lines,
    /// Curves of decadic logarithms.
    Decades,
    /// Marks with bars at whole numbers.
    Bars,
    /// Points in a plane.
    Plane,
}

/// Axes with what is drawn between them.
#[derive(Debug, Serialize)]
pub(crate) struct Panel {
    /// Name and unit.
    pub(crate) name: String,
    /// Pixels.
    pub(crate) height: i32,
    pub(crate) kind: Kind,
    /// Ends of both axes, where they are not those of the values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) whole: Option<[[f64; 2]; 2]>,
    pub(crate) series: Vec<Series>,
}

/// One value over those along.
#[derive(Debug, Serialize)]
pub(crate) struct Series {
    name: &'static str,
    /// Colours on white and on dark.
    ink: [String; 2],
    /// Dashes and gaps, pixels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    dash: Vec<f64>,
    /// Width of a line, pixels, and how much of its ink it has.
    width: f64,
    opacity: f64,
    values: Column,
    /// From where to where a band about a curve reaches, or half of the bar about a mark.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    about: Vec<Column>,
}

impl Series {
    /// A curve.
    pub(crate) fn new(name: &'static str, ink: Ink, (width, opacity): (f64, f64), values: Column) -> Self {
        Self { name, ink: ink.on_both_grounds(), dash: ink.dashes_in_pixels(), width, opacity, values, about: Vec::new() }
    }

    /// The same with what lies about it.
    pub(crate) fn within(self, about: Vec<Column>) -> Self {
        Self { about, ..self }
    }
}

/// Numbers, as whole multiples of a power of ten, each less the one before: short to write. What is not finite is a gap.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Column {
    /// The power of ten.
    exponent: i32,
    steps: Vec<Option<i64>>,
}

/// Digits of the largest number that can be told apart on a screen, and a few more for zooming.
const DIGITS: i32 = 5;

/// Whole numbers up to here are exact in a script.
const EXACT: f64 = 9e15;

impl Column {
    /// To five digits of the largest.
    pub(crate) fn new(values: &[f64]) -> Self {
        let largest = values.iter().filter(|value| value.is_finite()).fold(0.0_f64, |largest, value| largest.max(value.abs()));
        Self::resolving(values, largest * 10.0_f64.powi(1 - DIGITS))
    }

    /// To the power of ten at or below `resolution`.
    pub(crate) fn resolving(values: &[f64], resolution: f64) -> Self {
        // A power of ten that rounding made a little too small is still that power.
        let exponent = if resolution.is_normal() { (resolution.log10() + 1e-9).floor() as i32 } else { 0 };
        // Of the two powers the one is taken that is exact.
        let whole = |value: f64| if exponent < 0 { value * 10.0_f64.powi(-exponent) } else { value / 10.0_f64.powi(exponent) };
        let mut before = 0;
        let steps = values.iter().map(|value| {
            let value = Some(whole(*value).round()).filter(|value| value.abs() <= EXACT)? as i64;
            Some(value - std::mem::replace(&mut before, value))
        });
        Self { exponent, steps: steps.collect() }
    }
}

impl Live {
    /// The numbers, where the script finds them.
    pub(crate) fn data(&self) -> Markup {
        // Numbers and own words always serialize.
        let text = serde_json::to_string(self).unwrap_or_default();
        html! { script type="application/json" { (PreEscaped(text.replace('<', "\\u003c"))) } }
    }
}

/// The script, for the end of the page.
pub(crate) fn script() -> Markup {
    let (_, uplot) = UPLOT.split_once('\n').unwrap_or(("", UPLOT));
    html! { script { (PreEscaped(format!("/* uPlot 1.6.32\n{UPLOT_LICENSE}*/\n{uplot}\n{FIGURES}"))) } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_short_and_say_the_same() {
        let text = |column: &Column| serde_json::to_string(column).unwrap();
        assert_eq!(text(&Column::resolving(&[0.0, 0.1, 0.3, f64::NAN, 0.2], 0.1)), r#"{"exponent":-1,"steps":[0,1,2,null,-1]}"#);
        assert_eq!(text(&Column::new(&[12.34567, -1.0])), r#"{"exponent":-3,"steps":[12346,-13346]}"#);
        assert_eq!(text(&Column::new(&[2e300, 1e300])), r#"{"exponent":296,"steps":[20000,-10000]}"#);
        assert_eq!(text(&Column::new(&[0.0, f64::INFINITY])), r#"{"exponent":0,"steps":[0,null]}"#);
        assert_eq!(text(&Column::new(&[])), r#"{"exponent":0,"steps":[]}"#);
    }

    #[test]
    fn no_text_of_the_data_ends_its_script() {
        let x = Along { name: "x", unit: "", values: Column::new(&[1.0]) };
        let live = Live { x, panels: Vec::new(), told: vec!["</script><!--<script>".to_owned()] };
        let page = live.data().into_string();
        assert_eq!(page.matches('<').count(), 2, "{page}");
        assert!(page.contains(r"\u003c/script>\u003c!--\u003cscript>"));
    }
}
