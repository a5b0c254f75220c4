//! The comparison of methods: final cost above the minimum, and convergence.

use crate::{
    report::Report,
    section::Section,
    table,
    typography::{DASH, count, grouped, list, number, power, symbol},
};
use fluxfit::study::{MethodStudy, comparison::Comparison, fitness::Fitness};
use fluxfit_units::significant;
use maud::{Markup, html};

/// The section.
pub(crate) fn section(report: &Report) -> Option<Section> {
    let (facts, methods) = report.study?;
    let (fitness, unexcited) = (&facts.problem.fitness, facts.problem.unexcited.as_slice());
    let content = html! {
        p {
            "All methods minimize the same sum of squares, " (fitness_name(fitness)) ", over " (rows(facts)) " rows: "
            (count(facts.runs, "run")) " each, population " (facts.settings.population) ", " (facts.settings.iterations) " iterations. "
            (minimum(fitness)) " The methods are compared by their costs above it."
        }
        @if !unexcited.is_empty() {
            div.warnings role="note" aria-label="Not excited" {
                p {
                    "This log does not excite " (list(&unexcited.iter().copied().map(symbol).collect::<Vec<_>>()))
                    ": the estimates of the methods are random, and are not shown."
                }
            }
        }
        h3 { "Cost above the " (fitness.minimum_label()) }
        (ranking(facts, methods))
    };
    Some(Section { anchor: "study", heading: "Comparison of methods", content })
}

fn fitness_name(fitness: &Fitness) -> &'static str {
    match fitness {
        Fitness::VoltageError(_) => "fitness (11) of the paper",
        Fitness::OutputError { .. } => "the output error (Fig. 1 of the paper: measured less simulated currents)",
    }
}

/// The minimum of the fitness.
fn minimum(fitness: &Fitness) -> Markup {
    let cost = html! { "F" sub { (fitness.minimum_subscript()) } " = " (power(fitness.minimum().1)) "\u{a0}" (fitness.unit()) };
    match fitness {
        Fitness::VoltageError(_) => html! {
            "This fitness is a linear least-squares problem, whose single minimum, " (cost) ", a factorization finds exactly in microseconds."
        },
        Fitness::OutputError { minimum, .. } => html! {
            "The voltage timing is " (fitness.voltage_timing().unwrap_or_default()) ". "
            @if minimum.converged {
                "The lowest minimum known, " (cost) ", was found by the Levenberg-Marquardt method (polish); a lower one may exist."
            } @else {
                "The Levenberg-Marquardt method (polish) did not converge: the lowest cost known, " (cost) ", is perhaps not a minimum."
            }
        },
    }
}

fn rows(facts: &Comparison) -> String {
    facts.problem.rows.iter().map(|rows| grouped(*rows as u64)).collect::<Vec<_>>().join(" + ")
}

/// Iterations at which the ranking is shown, as fractions of their number: 50, 100, 200 and 300 of the paper's 300.
const MILESTONES: [(usize, usize); 4] = [(1, 6), (1, 3), (2, 3), (1, 1)];

/// The methods, the best first.
fn ranking(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> Markup {
    let (fitness, noise) = (&facts.problem.fitness, facts.problem.noise());
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len().saturating_sub(1)).max().unwrap_or(0);
    let mut milestones: Vec<usize> = MILESTONES.iter().map(|(numerator, denominator)| last * numerator / denominator).collect();
    milestones.dedup();
    html! {
        (table::scrolling("Cost above the minimum", &html! {
            table {
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Method" }
                        th scope="colgroup" colspan=(milestones.len()) { "Median F\u{a0}−\u{a0}F" sub { (fitness.minimum_subscript()) } ", " (fitness.unit()) ", at iteration" }
                        th scope="col" rowspan="2" { "Worst run" } th scope="col" rowspan="2" { "Runs within the noise" }
                        th scope="col" rowspan="2" { "Evaluations to the noise" } th scope="col" rowspan="2" { "Evaluations" }
                        th scope="col" rowspan="2" { "ms per run" }
                    }
                    tr { @for iteration in &milestones { th scope="col" { (iteration) } } }
                }
                tbody { @for (study, seconds) in facts.ranking().into_iter().filter_map(|place| methods.get(place)) {
                    tr {
                        th scope="row" { (study.method.label()) }
                        @for iteration in &milestones { td { (median_at(study, *iteration)) } }
                        td { (power(study.worst())) }
                        td { (format!("{:.0} %", 100.0 * study.share_within(noise))) }
                        td { (facts.evaluations_to_noise(study).map_or_else(|| DASH.to_string(), grouped)) }
                        td { (grouped(study.evaluations_per_run)) }
                        td { (number(1e3 * seconds, |ms| significant(ms, 2))) }
                    }
                } }
            }
        }))
        p.small {
            "The best stands first. The noise of the data is " (power(noise)) "\u{a0}" (fitness.unit()) ": so far above the minimum lies the true "
            "motor on average, if the residuals are white noise. Ends within it are equally good; the evaluations to it are those of the median run."
        }
        p.small { "The time is that of all runs divided by their number, on all cores. It is the only number here that is not reproducible." }
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
