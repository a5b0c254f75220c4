//! Every figure of a page as files of its own: SVG, and PNG drawn from it with a font that comes along.
//!
//! A file is for white paper: it carries its colours, its ground and the name of its font, and follows no dark screen.

use crate::{
    Report, ValidationReport, correlation,
    currents::correlations,
    figure::{Size, autocorrelation, canvas::Drawing, convergence, courses, currents, ellipse, intervals, plane, residuals},
    measured::Measured,
    study, validation,
};
use fluxfit::{Validation, log::Log, validation::prediction::Prediction};
use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{Options, Tree, fontdb::Database},
};
use std::sync::Arc;

/// A part of Inter, under the SIL Open Font License (beside it): Latin and Greek letters, digits, signs.
const FONT: &[u8] = include_bytes!("inter.ttf");

/// Its name.
const FAMILY: &str = "Inter";

/// Pixels of a picture for each of the drawing's, so that it is sharp on paper and on today's screens.
const SCALE: f32 = 2.0;

/// A figure, to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureFile {
    /// Name of the file without its ending; always the same for the same figure.
    pub name: &'static str,
    /// The drawing, as an SVG file.
    pub svg: String,
}

impl FigureFile {
    fn new(name: &'static str, drawing: &Drawing) -> Self {
        Self { name, svg: drawing.on_paper(FAMILY) }
    }

    /// The same as a PNG file, two of its pixels for each of the drawing's.
    pub fn png(&self) -> Vec<u8> {
        // Our own drawings can be read, and are not empty.
        drawn(&self.svg).unwrap_or_default()
    }
}

fn drawn(svg: &str) -> Option<Vec<u8>> {
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

/// The figures of a report, in its order.
pub fn figures(report: &Report) -> Vec<FigureFile> {
    let mut files = Vec::new();
    let mut add = |name, drawing: Drawing| files.push(FigureFile::new(name, &drawing));
    if let Some((found, _)) = report.identification {
        add("intervals", intervals::draw(found, Size::Wide));
        if let Some(fit) = &found.output {
            add("currents", currents::draw(Measured::and_simulated(report.log, fit), Size::Wide));
            let (correlations, band) = correlations(fit);
            add("autocorrelation", autocorrelation::draw(&correlations, band, Size::Wide));
        }
        if let Some((log, Some(validation))) = report.held_out {
            prediction(log, validation).into_iter().for_each(|drawing| add("held-out", drawing));
        }
        if let Some(pair) = correlation::pair(found) {
            add("joint-region", ellipse::draw(&pair, Size::Wide));
        }
        if let Some(fit) = &found.steady {
            add("residuals", residuals::draw(fit, Size::Wide));
            add("operating-points", plane::draw(&fit.operating_points, Size::Wide));
        }
    }
    if let Some((facts, methods)) = report.study {
        if study::has_courses(methods) {
            add("convergence", convergence::draw(&facts.problem.fitness, methods, Size::Wide));
        }
        if let Some(shown) = study::shown(methods, &facts.problem.unexcited) {
            add("parameters", courses::draw(shown, facts.truth.as_ref(), &facts.problem.unexcited, Size::Wide));
        }
    }
    files
}

/// The figure of a validation.
pub fn validation_figures(report: &ValidationReport) -> Vec<FigureFile> {
    prediction(report.log, report.found).iter().map(|drawing| FigureFile::new("prediction", drawing)).collect()
}

fn prediction(log: &Log, found: &Validation) -> Option<Drawing> {
    match &found.prediction {
        Prediction::Currents(courses) => Some(currents::draw(Measured::and_predicted(log, courses), Size::Wide)),
        Prediction::Voltages(left) => {
            found.own.steady.as_ref().map(|fit| residuals::draw(&validation::with_residuals(fit, left), Size::Wide))
        }
    }
}
