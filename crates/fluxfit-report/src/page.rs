//! The document: its head, its heading, its sections in order.

use crate::{
    Origin, Report, answer, correlation, currents,
    figure::palette,
    fit, interactive, origin, search, study, tried,
    typography::{capitalized, count, grouped, in_words, list, symbol},
    validation,
};
use fluxfit::{Judgement, Verdict, evidence::Identification};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// How everything looks; nothing else is loaded.
const STYLE: &str = include_str!("style.css");

/// A section: its anchor, its heading, what it holds.
pub(crate) struct Section {
    pub(crate) anchor: &'static str,
    pub(crate) heading: &'static str,
    pub(crate) content: Markup,
}

/// The whole page.
pub(crate) fn document(report: &Report) -> Markup {
    sheet(report.title, &found(report), &sections(report), report.origin)
}

/// A page: its heading, what was found in a line, its sections.
pub(crate) fn sheet(title: &str, found: &Markup, sections: &[Section], origin: &Origin) -> Markup {
    html! {
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
                    h1 { (title) }
                    p.found { (found) }
                    nav aria-label="Sections" {
                        ul { @for section in sections { li { a href={ "#" (section.anchor) } { (section.heading) } } } }
                    }
                }
                main {
                    @for section in sections {
                        section id=(section.anchor) aria-labelledby={ (section.anchor) "-heading" } {
                            h2 id={ (section.anchor) "-heading" } { (section.heading) }
                            (section.content)
                        }
                    }
                }
                (interactive::script())
            }
        }
    }
}

fn sections(report: &Report) -> Vec<Section> {
    let mut sections = Vec::new();
    if let Some((found, method)) = report.identification {
        sections.push(Section { anchor: "answer", heading: "The answer", content: answer::section(found) });
        if let Some(fit) = &found.output {
            let content = currents::section(report.log, fit);
            sections.push(Section { anchor: "currents", heading: "Measured against simulated", content });
        }
        if let Some(held_out) = report.held_out {
            let content = validation::held_out(held_out);
            sections.push(Section { anchor: "held-out", heading: "What was held out", content });
        }
        if let Some(content) = correlation::section(found) {
            sections.push(Section { anchor: "correlation", heading: "How the errors hang together", content });
        }
        if let Some(fit) = &found.output {
            sections.push(Section { anchor: "tried", heading: "What was tried", content: tried::section(fit) });
        }
        if let Some(fit) = &found.steady {
            let answered = found.output.is_none();
            let heading = if answered { "Operating points, measured against fitted" } else { "Operating points, as a check" };
            sections.push(Section { anchor: "fit", heading, content: fit::section(fit, found.saturation.as_ref(), answered) });
        }
        if let Some(content) = search::section(found, method.as_ref()) {
            sections.push(Section { anchor: "search", heading: "The swarm’s answer", content });
        }
    }
    if let Some((facts, methods)) = report.study {
        let content = study::section(facts, methods);
        sections.push(Section { anchor: "study", heading: "Methods compared", content });
    }
    sections.push(Section { anchor: "read", heading: "What was read", content: origin::read(report) });
    sections.push(Section { anchor: "reproduce", heading: "How to reproduce", content: origin::reproduce(report.origin) });
    sections
}

/// What was found, in a line.
fn found(report: &Report) -> Markup {
    html! {
        @if let Some((found, _)) = report.identification { (identified(found)) }
        @if let Some((facts, methods)) = report.study {
            @if report.identification.is_some() { " " }
            (study::in_a_line(facts, methods))
        }
    }
}

fn identified(found: &Identification) -> Markup {
    let with = |is: &dyn Fn(&Judgement) -> bool| -> Vec<Markup> {
        found.parameters.iter().filter(|judgement| is(judgement)).map(|judgement| symbol(judgement.parameter)).collect()
    };
    let of = |verdict: Verdict| with(&|judgement| judgement.verdict == verdict && !answer::is_given(judgement));
    let given = with(&answer::is_given);
    let (good, weak, none) = (of(Verdict::Identified), of(Verdict::Weak), of(Verdict::NotIdentifiable));
    html! {
        (capitalized(&in_words(good.len()))) " of " (count(found.parameters.len(), "parameter")) " identified"
        @if !given.is_empty() { "; given: " (list(&given)) }
        @if !weak.is_empty() { "; weak: " (list(&weak)) }
        @if !none.is_empty() { "; not identifiable from this log: " (list(&none)) }
        ". "
        (fitted(found))
    }
}

/// To what the motor was fitted, in a sentence.
fn fitted(found: &Identification) -> Markup {
    html! {
        @if let Some(fit) = &found.output {
            @let (rms, rows) = (fit.residual_rms(), fit.residuals.len() / 2);
            "Simulated currents miss the measured ones by " (currents::amperes(rms.d)) " (d) and " (currents::amperes(rms.q)) " (q), root mean square "
            "over " (grouped(rows as u64)) " rows."
        } @else {
            "Fitted to the means of " (count(found.operating_points().len(), "operating point")) "."
        }
    }
}
