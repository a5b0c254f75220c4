//! The sheet that figures are drawn on: from lines of the drawing library to SVG that fits a page, a dark screen and a reader who
//! does not see it.
//!
//! plotters places everything at whole units, so a unit is a tenth of a pixel here: curves stay smooth. It writes one style of
//! text and no dashes; subscripts and dashes are put in afterwards.

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

/// Units in a pixel.
pub(super) const UNITS: i32 = 10;

/// Size of letters, pixels.
const LETTERS: f64 = 12.5;

/// plotters takes the height of a line, of which the letters are this part.
const LINE: f64 = 1.24;

/// What is drawn on.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// How drawing ends. A drawing in memory never fails.
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A figure in one size, drawn.
pub(crate) struct Drawing {
    /// Pixels.
    size: (u32, u32),
    /// The figure in words.
    label: String,
    /// Elements of SVG.
    body: String,
}

impl Drawing {
    /// Lets `paint` draw on a sheet of `size` pixels; `label` says in words what is to be seen.
    pub(super) fn new(size: (u32, u32), label: String, paint: impl FnOnce(&Area) -> Drawn) -> Self {
        let mut svg = String::new();
        {
            let units = UNITS.unsigned_abs();
            let root = SVGBackend::with_string(&mut svg, (size.0 * units, size.1 * units)).into_drawing_area();
            // What cannot fail is not reported; if it did, the figure would end early.
            let _ = paint(&root).and_then(|()| root.present());
        }
        // Its own outermost element knows neither label nor pixels.
        let body = svg.split_once('\n').map_or("", |(_, body)| body).trim_end().trim_end_matches("</svg>");
        Self { size, label, body: svg_subscripts(&dashed(body.to_owned())) }
    }

    /// As a file of its own, for light and dark grounds.
    pub(super) fn standalone(&self) -> String {
        let style =
            format!("<style>text{{font-family:system-ui,sans-serif}}\n@media (prefers-color-scheme:dark){{\n{}}}</style>", dark_rules());
        format!("{}{style}\n{}</svg>\n", self.opening(" xmlns=\"http://www.w3.org/2000/svg\""), self.body)
    }

    /// As a file for white paper, its letters of this family where that is there.
    pub(crate) fn on_paper(&self, family: &str) -> String {
        let (width, height) = (self.size.0 * UNITS.unsigned_abs(), self.size.1 * UNITS.unsigned_abs());
        let body = self.body.replace("font-family=\"sans-serif\"", &format!("font-family=\"{family}, sans-serif\""));
        let opening = self.opening(" xmlns=\"http://www.w3.org/2000/svg\"");
        format!("{opening}\n<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>{body}</svg>\n")
    }

    /// As a part of the page, whose style knows the dark ground.
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

/// Letters of this ink.
pub(super) fn letters(ink: Ink) -> TextStyle<'static> {
    ("sans-serif", LETTERS * LINE * f64::from(UNITS)).into_font().color(&ink.color())
}

/// The same, anchored: which point of the text lies at the coordinates given.
pub(super) fn anchored(ink: Ink, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    letters(ink).pos(Pos::new(horizontal, vertical))
}

/// A line this many pixels wide.
pub(super) fn line(ink: Ink, pixels: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().to_rgba(), filled: false, stroke_width: (pixels * f64::from(UNITS)).round() as u32 }
}

/// A light area.
pub(super) fn shade(ink: Ink, opacity: f64) -> ShapeStyle {
    ShapeStyle { color: ink.color().mix(opacity), filled: true, stroke_width: 0 }
}

/// A filled shape.
pub(super) fn solid(ink: Ink) -> ShapeStyle {
    shade(ink, 1.0)
}
