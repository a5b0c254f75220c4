//! Figures as files: for screens and for white paper.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::logs::{Found, TWO, WHOLE, log, origin, report};
use fluxfit::{Log, Request, evidence::Identification, identify};
use fluxfit_report::{FigureFile, Size, figures, html, screen_figures};
use html5ever::{driver::ParseOpts, parse_document, tendril::TendrilSink};
use markup5ever_rcdom::RcDom;
use resvg::tiny_skia::Pixmap;

/// A figure of the page for a wide screen.
pub(crate) fn screen_figure(log: &Log, found: &Identification, name: &str) -> FigureFile {
    let origin = origin();
    screen_figures(&report(log, found, &origin), Size::Wide).into_iter().find(|figure| figure.name == name).unwrap()
}

#[test]
fn screen_figures_are_complete_svg_files() {
    let log = log(&TWO, 0.1);
    let found = identify(&log, &Request::default()).unwrap().identification;
    let Found { log: fast, found: of_fast } = &*WHOLE;
    let origin = origin();
    for size in [Size::Wide, Size::Narrow] {
        let figures = [screen_figures(&report(fast, of_fast, &origin), size), screen_figures(&report(&log, &found, &origin), size)];
        for FigureFile { svg, .. } in figures.into_iter().flatten() {
            assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"));
            assert!(svg.contains("prefers-color-scheme:dark") && svg.contains("role=\"img\" aria-label=\""));
            assert_eq!(svg.matches("://").count(), 1, "the name space alone");
            let document = parse_document(RcDom::default(), ParseOpts::default()).one(format!("<!DOCTYPE html><title>x</title>{svg}"));
            assert!(document.errors.borrow().is_empty(), "{:?}", document.errors);
        }
    }
}

#[test]
fn every_figure_of_the_page_is_a_file_for_white_paper() {
    let Found { log, found } = &*WHOLE;
    let origin = origin();
    let shown = report(log, found, &origin);
    let files = figures(&shown);
    assert_eq!(html(&shown).matches("<figure>").count(), files.len());
    assert_eq!(files.iter().map(|file| file.name).take(4).collect::<Vec<_>>(), ["log", "intervals", "currents", "autocorrelation"]);
    for file in files {
        assert!(file.svg.contains("fill=\"#FFFFFF\"") && file.svg.contains("font-family=\"Inter, sans-serif\""), "{}", file.name);
        assert!(!file.svg.contains("prefers-color-scheme") && !file.svg.contains("font-family=\"sans-serif\""));
        let height: u32 = file.svg.split_once(" height=\"").unwrap().1.split_once('"').unwrap().0.parse().unwrap();
        let picture = Pixmap::decode_png(&file.png()).unwrap();
        assert_eq!((picture.width(), picture.height()), (1440, 2 * height));
        assert!(picture.pixels().iter().all(|pixel| pixel.alpha() == 255));
        // The names of the axes stand in a strip that nothing else reaches into.
        let name = (0..28).flat_map(|y| (0..100).map(move |x| (x, y))).filter(|(x, y)| picture.pixel(*x, *y).unwrap().red() < 100);
        assert!(file.name == "intervals" || name.count() > 20, "{} has no letters", file.name);
    }
}
