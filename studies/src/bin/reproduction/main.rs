//! The paper reproduced: every number and figure of `docs/reproduction.md`, made again.
//!
//! `reproduction` simulates the rig, runs the studies and writes the tables into the page, between their marks, and the figures beside it.
//! `reproduction --check` writes nothing and fails where the page says something else.
// What it wrote stands on standard output.
#![allow(clippy::print_stdout)]

mod experiments;
mod page;
mod tables;

use experiments::{Data, Rig, ablation};
use fluxfit::{
    Request,
    optimizer::SearchSettings,
    paper,
    study::comparison::{ComparisonRequest, compare},
};
use fluxfit_report::{Options, Origin, Report, Size, screen_figures};
use page::Page;
use std::{error::Error, ops::ControlFlow, path::Path};

/// Runs of each method where fifty are too few.
const MANY_RUNS: usize = 2000;

fn main() -> Result<(), Box<dyn Error>> {
    let check = std::env::args().any(|argument| argument == "--check");
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");

    let data = Rig::ALL.map(Data::simulate).into_iter().collect::<Result<Vec<_>, _>>()?;
    let studies = data.iter().map(|data| data.study(&paper::METHODS)).collect::<Result<Vec<_>, _>>()?;
    // The paper's rig as the paper has it: switched, without noise.
    let (rig, study) = (&data[Rig::Switched as usize], &studies[Rig::Switched as usize]);

    let mut page = Page::read(&docs.join("reproduction.md"), check)?;
    page.put("table 2", &tables::table_2(study, rig))?;
    page.put("errors", &tables::errors(&data, &studies))?;
    page.put("ranking", &tables::ranking(study.iter().map(|study| (study.method.label().to_owned(), study))))?;
    page.put("many runs", &tables::many_runs(&rig.study_with(&paper::METHODS, MANY_RUNS, SearchSettings::default())?))?;
    page.put("unconverged", &tables::unconverged(rig)?)?;
    let ablated = ablation().into_iter().map(|(name, method)| Ok((name, rig.study(&[method])?.remove(0))));
    let ablated = ablated.collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    page.put("ablation", &tables::ranking(ablated.iter().map(|(name, study)| (name.clone(), study))))?;
    page.finish()?;

    let bounds = paper::SEARCH_BOX.map(|upper| Some((0.0, upper)));
    let asked = ComparisonRequest { request: Request { bounds, ..Request::default() }, truth: Some(paper::MOTOR), ..Default::default() };
    let comparison = compare(&rig.log, &asked, &|_| ControlFlow::Continue(()))?;
    let timed: Vec<_> = comparison.studies.iter().map(|study| (study.clone(), 0.0)).collect();
    let origin =
        Origin { command: "reproduction".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned(), seed: comparison.settings.seed };
    let report = Report {
        title: "reproduction",
        log: &rig.log,
        notes: &[],
        operating_points: &[],
        identification: None,
        held_out: None,
        study: Some((&comparison, &timed)),
        online: None,
        json: None,
        options: Options::default(),
        origin: &origin,
    };
    // The paper has no figure of its log.
    for figure in screen_figures(&report, Size::Wide).into_iter().filter(|figure| figure.name != "log") {
        page::figure(&docs.join(format!("reproduction/{}.svg", figure.name)), &figure.svg, check)?;
    }
    println!("docs/reproduction.md and its figures {}", if check { "are true" } else { "are written" });
    Ok(())
}
