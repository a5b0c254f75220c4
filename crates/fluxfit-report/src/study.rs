//! Methods compared: how far the swarms end above the minimum, and how they get there.

use crate::{
    figure::{convergence, courses},
    frame, table_2,
    typography::{DASH, capitalized, count, grouped, list, number, power, symbol},
};
use fluxfit::{
    motor::Parameter,
    optimizer::Method,
    study::{MethodStudy, facts::StudyFacts, fitness::Fitness},
};
use fluxfit_files::number::significant;
use maud::{Markup, html};

/// The section; parameters that are not excited are chance, and left out.
pub(crate) fn section(facts: &StudyFacts, methods: &[(MethodStudy, f64)]) -> Markup {
    let fitness = &facts.problem.fitness;
    let (minimum, index, unexcited) = (fitness.minimum_label(), fitness.minimum_index(), facts.problem.unexcited.as_slice());
    html! {
        p {
            "Every method minimizes the same sum of squares, " (what(fitness)) ", over " (rows(facts)) " rows: "
            (count(facts.runs, "run")) " each, population " (facts.settings.population) ", " (facts.settings.iterations) " iterations. "
            (its_minimum(fitness)) " So the methods are judged by how far above it they end."
        }
        @if !unexcited.is_empty() {
            div.warnings role="note" aria-label="Not excited" {
                p {
                    "This log does not excite " (list(&unexcited.iter().copied().map(symbol).collect::<Vec<_>>()))
                    ": what any method says of it is chance, and is not shown."
                }
            }
        }
        h3 { "Cost above the " (minimum) }
        (ranking(fitness, methods))
        @if has_courses(methods) {
            (frame::live_figure(|size| convergence::draw(fitness, methods, size), &convergence::live(fitness, methods), &html! {
                "Fig. 4 of the paper on a logarithmic scale: F\u{a0}−\u{a0}F" sub { (index) } " against iteration; lines are medians over the runs, bands reach from the lower to the upper quartile."
                @if convergence::has_values_below_floor(methods) {
                    " Values below 10" sup { "\u{2212}12" } " " (fitness.unit()) ", zero included, are rounding and drawn at that floor."
                }
            }))
        }
        h3 { "Mean of the runs’ estimates" }
        (table_2::section(facts, methods, unexcited))
        (courses(facts, methods, unexcited))
    }
}

/// What came out, for the heading.
pub(crate) fn in_a_line(facts: &StudyFacts, methods: &[(MethodStudy, f64)]) -> Markup {
    html! {
        @if let [(only, _)] = methods { (only.method.label()) " ran " } @else { (capitalized(&count(methods.len(), "method"))) " ran " }
        @if facts.runs == 1 { "once" } @else { (facts.runs) " times" } @if methods.len() != 1 { " each" } "; median cost above the " (facts.problem.fitness.minimum_label()) ": "
        @for (k, (study, _)) in methods.iter().enumerate() {
            @if k > 0 { ", " }
            (study.method.label()) "\u{a0}" (power(study.median()))
        }
        "."
    }
}

fn what(fitness: &Fitness) -> &'static str {
    match fitness {
        Fitness::VoltageError(_) => "fitness (11) of the paper",
        Fitness::OutputError { .. } => "the output error (Fig. 1 of the paper: simulated currents against measured ones)",
    }
}

/// What is known of the minimum.
fn its_minimum(fitness: &Fitness) -> Markup {
    let cost = html! { "F" sub { (fitness.minimum_index()) } " = " (power(fitness.minimum().1)) "\u{a0}" (fitness.unit()) };
    match fitness {
        Fitness::VoltageError(_) => html! {
            "This fitness is linear least squares: it has one minimum, " (cost) ", which a factorization finds exactly in microseconds."
        },
        Fitness::OutputError { minimum, .. } => html! {
            "The voltages were read as " (fitness.voltage_reading().unwrap_or_default()) ". "
            @if minimum.converged {
                "The lowest minimum known, " (cost) ", is that of a Levenberg–Marquardt polish, which is no proof that there is no lower one."
            } @else {
                "The Levenberg–Marquardt polish did not converge: the lowest cost known, " (cost) ", may be no minimum."
            }
        },
    }
}

fn rows(facts: &StudyFacts) -> String {
    facts.problem.rows.iter().map(|rows| grouped(*rows as u64)).collect::<Vec<_>>().join(" + ")
}

/// Iterations at which the ranking is shown: a sixth, a third, two thirds and all of them; 50, 100, 200 and 300 of the paper's.
const MILESTONES: [(usize, usize); 4] = [(1, 6), (1, 3), (2, 3), (1, 1)];

fn ranking(fitness: &Fitness, methods: &[(MethodStudy, f64)]) -> Markup {
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len().saturating_sub(1)).max().unwrap_or(0);
    let mut milestones: Vec<usize> = MILESTONES.iter().map(|(numerator, denominator)| last * numerator / denominator).collect();
    milestones.dedup();
    html! {
        (frame::scrolling("Cost above the minimum", &html! {
            table {
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Method" }
                        th scope="colgroup" colspan=(milestones.len()) { "Median F\u{a0}−\u{a0}F" sub { (fitness.minimum_index()) } ", " (fitness.unit()) ", at iteration" }
                        th scope="col" rowspan="2" { "Worst run" } th scope="col" rowspan="2" { "Evaluations" }
                        th scope="col" rowspan="2" { "ms per run" }
                    }
                    tr { @for iteration in &milestones { th scope="col" { (iteration) } } }
                }
                tbody { @for (study, seconds) in methods {
                    tr {
                        th scope="row" { (study.method.label()) }
                        @for iteration in &milestones { td { (median_at(study, *iteration)) } }
                        td { (power(study.worst())) }
                        td { (grouped(study.evaluations_per_run)) }
                        td { (number(1e3 * seconds, |ms| significant(ms, 2))) }
                    }
                } }
            }
        }))
        p.small { "Time is that of all runs divided by their number, on all cores; it alone is not the same the next time." }
    }
}

/// A run that stopped early keeps its last value.
fn median_at(study: &MethodStudy, iteration: usize) -> Markup {
    let quartiles = &study.convergence.quartiles;
    match quartiles.get(iteration).or(quartiles.last()) {
        Some([_, median, _]) => power(*median),
        None => html! { (DASH) },
    }
}

/// Whether some method has a course that Fig. 4 can show.
pub(crate) fn has_courses(methods: &[(MethodStudy, f64)]) -> bool {
    methods.iter().any(|(study, _)| !study.convergence.quartiles.is_empty())
}

/// Whose parameters Fig. 5 shows: those of the paper's own method where it ran; none where there is nothing to be seen.
pub(crate) fn shown<'a>(methods: &'a [(MethodStudy, f64)], unexcited: &[Parameter]) -> Option<&'a MethodStudy> {
    let papers = methods.iter().find(|(study, _)| matches!(study.method, Method::Tgfpa(_)));
    let (study, _) = papers.or(methods.first())?;
    (!study.convergence.parameters_median.is_empty() && unexcited.len() < Parameter::ALL.len()).then_some(study)
}

/// Fig. 5.
fn courses(facts: &StudyFacts, methods: &[(MethodStudy, f64)], unexcited: &[Parameter]) -> Markup {
    let Some(study) = shown(methods, unexcited) else { return html! {} };
    html! {
        (frame::figure(|size| courses::draw(study, facts.truth, unexcited, size), &html! {
            "Fig. 5 of the paper: the parameters under " (study.method.label()) " against iteration, medians over the runs."
            @if facts.truth.is_some() { " Dashed: the true value." }
        }))
    }
}
