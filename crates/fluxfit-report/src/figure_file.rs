//! The figures of a page as files: SVG, and PNG rendered from it with an embedded font.

use crate::{
    drawing::size::Size,
    figure::Figure,
    figures::{of_fleet, of_report, of_validation},
    report::{FleetReport, Report, ValidationReport},
};
use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{Options, Tree, fontdb::Database},
};
use std::sync::Arc;

/// A subset of the font Inter, under the SIL Open Font License (beside it): Latin and Greek letters, digits, signs.
const FONT: &[u8] = include_bytes!("fonts/inter.ttf");

/// Name of the font.
const FAMILY: &str = "Inter";

/// Pixels of the PNG per pixel of the drawing, so that it is sharp on paper and on screens of high resolution.
const SCALE: f32 = 2.0;

/// A figure as a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureFile {
    /// Name of the file without extension; always the same for the same figure.
    pub name: &'static str,
    /// The content of the SVG file.
    pub svg: String,
}

impl FigureFile {
    /// The content of the PNG file, with two pixels per pixel of the SVG.
    pub fn png(&self) -> Vec<u8> {
        // The SVG of a drawing is valid and not empty.
        rendered(&self.svg).unwrap_or_default()
    }
}

fn rendered(svg: &str) -> Option<Vec<u8>> {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let options = Options { fontdb: Arc::new(fonts), font_family: FAMILY.to_owned(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).ok()?;
    let size = tree.size().to_int_size().scale_by(SCALE)?;
    let mut pixels = Pixmap::new(size.width(), size.height())?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().ok()
}

/// The figures of a report, wide and for white paper, in the order of the page.
pub fn figures(report: &Report) -> Vec<FigureFile> {
    on_paper(&of_report(report))
}

/// The figures of a report for a screen: their colours follow the reader's light or dark scheme.
pub fn screen_figures(report: &Report, size: Size) -> Vec<FigureFile> {
    of_report(report).iter().map(|figure| FigureFile { name: figure.name, svg: (figure.draw)(size).standalone() }).collect()
}

/// The figures of a validation, wide and for white paper.
pub fn validation_figures(report: &ValidationReport) -> Vec<FigureFile> {
    on_paper(&of_validation(report))
}

/// The figures of a fleet, wide and for white paper.
pub fn fleet_figures(report: &FleetReport) -> Vec<FigureFile> {
    on_paper(&of_fleet(report))
}

fn on_paper(figures: &[Figure]) -> Vec<FigureFile> {
    figures.iter().map(|figure| FigureFile { name: figure.name, svg: (figure.draw)(Size::Wide).on_paper(FAMILY) }).collect()
}
