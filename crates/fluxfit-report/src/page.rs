//! The HTML document: head, heading, sections with their figures.

use crate::{
    drawing::palette,
    figure::Figure,
    figures, headline, interactive,
    report::{FleetReport, Origin, Report, ValidationReport},
    section::Section,
    sections,
    typography::{breakable, prose},
};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The style sheet of the page.
const STYLE: &str = include_str!("style.css");

/// The report as an HTML document.
pub fn html(report: &Report) -> String {
    document(
        report.title,
        &headline::headline(report),
        &sections::of_report(report),
        &figures::of_report(report),
        (report.json, report.origin),
    )
}

/// A validation as an HTML document.
pub fn validation_html(report: &ValidationReport) -> String {
    let title = format!("{} on {}", report.motor, report.title);
    let summary = html! { (sections::badge(report.found.outcome)) " " (prose(&report.found.verdict())) };
    document(&title, &summary, &sections::of_validation(report), &figures::of_validation(report), (report.json, report.origin))
}

/// The results of a fleet as an HTML document.
pub fn fleet_html(report: &FleetReport) -> String {
    let summary = html! { strong { (prose(&report.fleet.to_string())) } };
    document(report.title, &summary, &sections::of_fleet(report), &figures::of_fleet(report), (None, report.origin))
}

fn document(title: &str, summary: &Markup, sections: &[Section], figures: &[Figure], (json, origin): (Option<&str>, &Origin)) -> String {
    let document = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(interactive::POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content={ "fluxfit " (origin.version) };
                title { (title) " – fluxfit" }
                style { (PreEscaped(interactive::STYLE)) (PreEscaped(STYLE)) "@media screen and (prefers-color-scheme:dark){" (PreEscaped(palette::dark_rules())) "}" }
            }
            body {
                header {
                    p.program { "fluxfit " (origin.version) " · motor parameters from a drive log" }
                    h1 { (breakable(title)) }
                    p.found { (summary) }
                    nav aria-label="Sections" {
                        ul { @for section in sections { li { a href={ "#" (section.anchor) } { (section.heading) } } } }
                    }
                }
                main {
                    @for section in sections {
                        section id=(section.anchor) aria-labelledby={ (section.anchor) "-heading" } {
                            h2 id={ (section.anchor) "-heading" } { (section.heading) }
                            (section.content)
                            @for figure in figures.iter().filter(|figure| figure.section == section.anchor) { (figure.element()) }
                        }
                    }
                }
                @if let Some(json) = json { div id="document" hidden { script type="application/json" { (PreEscaped(json.replace('<', "\\u003c"))) } } }
                (interactive::script())
            }
        }
    };
    document.into_string()
}
