//! The canvas of a figure: converts the drawing library's output to SVG with a text alternative, for a page, a dark screen or paper.
//!
//! plotters rounds coordinates to whole units, so a unit is a tenth of a pixel here to keep curves smooth. It supports neither
//! subscripts nor dashes, which are added to its SVG afterwards.

use super::palette::{Ink, dark_rules, dashed};
use crate::typography::svg_subscripts;
use maud::{Escaper, Markup, PreEscaped};
use plotters::{
    coord::Shift,
    prelude::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, SVGBackend},
    style::{
        Color, IntoFont, ShapeStyle, TextStyle,
        text_anchor::{HPos, Pos, VPos},
    },
};
use std::fmt::Write;

/// Units per pixel.
pub(crate) const UNITS: i32 = 10;

/// Font size, pixels.
const FONT_SIZE: f64 = 12.5;

/// Ratio of the line height, which plotters takes, to the font size.
const LINE_HEIGHT: f64 = 1.24;

/// A drawing area.
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Result of drawing. Drawing in memory never fails.
pub(crate) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A figure drawn in one size.
pub(crate) struct Drawing {
    /// Width and height, pixels.
    size: (u32, u32),
    /// Text alternative.
    label: String,
    /// SVG elements.
    body: String,
}

impl Drawing {
    /// Lets `paint` draw on an area of `size` pixels; `label` is the text alternative.
    pub(crate) fn new(size: (u32, u32), label: String, paint: impl FnOnce(&Area) -> Drawn) -> Self {
        let mut svg = String::new();
        {
            let units = UNITS.unsigned_abs();
            let root = SVGBackend::with_string(&mut svg, (size.0 * units, size.1 * units)).into_drawing_area();
            // Drawing in memory does not fail; if it did, the figure would be incomplete.
            let _ = paint(&root).and_then(|()| root.present());
        }
        // The outermost element of plotters has neither label nor pixels and is replaced.
        let body = svg.split_once('\n').map_or("", |(_, body)| body).trim_end().trim_end_matches("</svg>");
        Self { size, label, body: svg_subscripts(&dashed(body.to_owned())) }
    }

    /// A complete SVG file for light and dark backgrounds.
    pub(crate) fn standalone(&self) -> String {
        let style =
            format!("<style>text{{font-family:system-ui,sans-serif}}\n@media (prefers-color-scheme:dark){{\n{}}}</style>", dark_rules());
        format!("{}{style}\n{}</svg>\n", self.opening(" xmlns=\"http://www.w3.org/2000/svg\""), self.body)
    }

    /// A complete SVG file for white paper, with this font family where it is installed.
    pub(crate) fn on_paper(&self, family: &str) -> String {
        let (width, height) = (self.size.0 * UNITS.unsigned_abs(), self.size.1 * UNITS.unsigned_abs());
        let body = self.body.replace("font-family=\"sans-serif\"", &format!("font-family=\"{family}, sans-serif\""));
        let opening = self.opening(" xmlns=\"http://www.w3.org/2000/svg\"");
        format!("{opening}\n<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>{body}</svg>\n")
    }

    /// An SVG element of the page, whose style sheet has the colours for dark backgrounds.
    pub(crate) fn inline(&self, class: &str) -> Markup {
        PreEscaped(format!("{}\n{}</svg>", self.opening(&format!(" class=\"{class}\"")), self.body))
    }

    fn opening(&self, attributes: &str) -> String {
        let (width, height) = self.size;
        let mut label = String::new();
        // Writing to a string does not fail.
        let _ = Escaper::new(&mut label).write_str(&self.label);
        format!(
            "<svg{attributes} width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{label}\">",
            width * UNITS.unsigned_abs(),
            height * UNITS.unsigned_abs(),
        )
    }
}

/// Text style.
pub(crate) fn text_style(ink: Ink) -> TextStyle<'static> {
    ("sans-serif", FONT_SIZE * LINE_HEIGHT * f64::from(UNITS)).into_font().color(&ink.color())
}

/// Text style with an anchor: the point of the text that lies at the given coordinates.
pub(crate) fn anchored(ink: Ink, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    text_style(ink).pos(Pos::new(horizontal, vertical))
}

/// A line with a width in pixels.
pub(crate) fn line(ink: Ink, pixels: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().to_rgba(), filled: false, stroke_width: (pixels * f64::from(UNITS)).round() as u32 }
}

/// A translucent area.
pub(crate) fn shade(ink: Ink, opacity: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().mix(opacity), filled: true, stroke_width: 0 }
}

/// A filled shape.
pub(crate) fn solid(ink: Ink) -> ShapeStyle {
    shade(ink, 1.0)
}
