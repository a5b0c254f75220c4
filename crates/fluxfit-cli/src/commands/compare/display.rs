//! A study: the paper's Table 2, the ranking by cost above the minimum, and its Fig. 4 in characters.

use crate::terminal::{self, DIM, HEADING, plot, table, wrapped};
use fluxfit::study::comparison::Comparison;
use fluxfit::{
    motor::{Motor, Parameter},
    optimizer::Method,
    study::{MethodStudy, error_percent, fitness::Fitness},
};
use fluxfit_units::{Scale, significant, small};

/// Shows a study.
pub(crate) fn show(name: &str, facts: &Comparison, methods: &[(MethodStudy, f64)]) -> std::io::Result<()> {
    let fitness = &facts.problem.fitness;
    let (minimum, index) = (fitness.minimum_label(), fitness.minimum_subscript());
    let rows: Vec<String> = facts.problem.rows.iter().map(ToString::to_string).collect();
    let reading = fitness.voltage_timing().map(|reading| format!(", voltages read as {reading}")).unwrap_or_default();
    let asked = format!(
        "{} on {} rows{reading}; {} runs of each method, population {}, {} iterations, seed {}",
        fitness.label(),
        rows.join(" + "),
        facts.runs,
        facts.settings.population,
        facts.settings.iterations,
        facts.settings.seed,
    );
    let mut text =
        format!("{HEADING}{name}{HEADING:#}\n{}{}", wrapped("", &asked), wrapped("", &format!("search box {}", search_box(facts))));
    if methods.is_empty() {
        return terminal::print(&text);
    }
    text += &format!("\n{HEADING}Mean of the runs' estimates{HEADING:#} (Table 2 of the paper)\n{}", table_2(facts, methods));
    let cost = format!(
        "{HEADING}Cost above the {minimum}{HEADING:#}, F - F_{index}, {}, median over the runs; F_{index} = {}",
        fitness.unit(),
        small(fitness.minimum().1),
    );
    text += &format!("\n{}{}", wrapped("", &cost), ranking(methods));
    text += &format!("\n{HEADING}Convergence{HEADING:#} of the median F - F_{index} (Fig. 4 of the paper)\n{}", plot::convergence(methods));
    text += &format!("\n{DIM}{}{DIM:#}\n", wrapped("", remark(fitness)).trim_end());
    terminal::print(&text)
}

/// Prints how many runs an interrupted study has finished.
pub(crate) fn interrupted(comparison: &Comparison) {
    let of = |method: &Method| {
        let finished = comparison.studies.iter().find(|study| study.method == *method).map_or(0, |study| study.motors.len());
        format!("{} {finished}", method.label())
    };
    let finished: Vec<String> = comparison.asked.iter().map(of).collect();
    terminal::warn_of(
        "interrupted",
        &format!("of {} runs of each method these are finished: {}; a report is not written", comparison.runs, finished.join(", ")),
    );
}

/// What the minimum is.
fn remark(fitness: &Fitness) -> &'static str {
    match fitness {
        Fitness::VoltageError(_) => {
            "Fitness (11) is linear least squares: its minimum is exact and costs microseconds. The swarms approach the same answer."
        }
        Fitness::OutputError { minimum, .. } if minimum.converged => {
            "The output error simulates the currents. Its minimum is the lowest that a Levenberg-Marquardt polish has found, in some tens of evaluations."
        }
        Fitness::OutputError { .. } => {
            "The output error simulates the currents. Its Levenberg-Marquardt polish did not converge: F_LM is the lowest cost found, and may be no minimum."
        }
    }
}

fn search_box(facts: &Comparison) -> String {
    let intervals = Parameter::ALL.into_iter().zip(facts.bounds.iter()).map(|(parameter, (lower, upper))| {
        let scale = Scale::for_value(parameter, upper);
        let short = |value: f64| significant_or_zero(value, &scale);
        format!("{} {}..{} {}", parameter.symbol(), short(lower), short(upper), scale.unit(parameter.unit()))
    });
    intervals.collect::<Vec<_>>().join(", ")
}

fn significant_or_zero(value: f64, scale: &Scale) -> String {
    if value == 0.0 { "0".to_owned() } else { scale.format(value, value.abs() * 0.05) }
}

/// Rows as the paper has them: a parameter's estimates, then their errors where the truth is known.
fn table_2(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> String {
    let (lowest, _) = facts.problem.fitness.minimum();
    let mut rows = Vec::new();
    for parameter in Parameter::ALL {
        let scale = Scale::for_value(parameter, facts.truth.as_ref().unwrap_or(&lowest).get(parameter));
        let estimate = |motor: &Motor| {
            let value = motor.get(parameter);
            scale.format(value, value.abs() * 2e-5)
        };
        let mut row = vec![format!("{} {}", parameter.symbol(), scale.unit(parameter.unit()))];
        row.extend(methods.iter().map(|(study, _)| estimate(&study.mean())));
        row.push(estimate(&lowest));
        rows.push(row);
        if let Some(truth) = &facts.truth {
            let mut row = vec!["error %".to_owned()];
            row.extend(methods.iter().map(|(study, _)| percent(study.mean_error_percent(truth)[parameter as usize])));
            row.push(percent(error_percent(&lowest, truth, parameter)));
            rows.push(row);
        }
    }
    let labels = methods.iter().map(|(study, _)| study.method.label());
    let heading: Vec<&str> = [""].into_iter().chain(labels).chain([facts.problem.fitness.solver()]).collect();
    table(&heading, 1, rows)
}

/// An error, where there is one.
fn percent(error: Option<f64>) -> String {
    error.map_or_else(|| "-".to_owned(), |error| significant(error, 3))
}

/// Iterations at which the ranking is shown: a sixth, a third, two thirds and all of them; 50, 100, 200 and 300 of the paper's.
const MILESTONES: [(usize, usize); 4] = [(1, 6), (1, 3), (2, 3), (1, 1)];

fn ranking(methods: &[(MethodStudy, f64)]) -> String {
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len()).max().unwrap_or(1) - 1;
    let milestones = MILESTONES.map(|(numerator, denominator)| last * numerator / denominator);
    let rows = methods.iter().map(|(study, seconds)| {
        let at = |iteration: &usize| {
            study.convergence.quartiles.get(*iteration).or(study.convergence.quartiles.last()).map_or(0.0, |quartiles| quartiles[1])
        };
        let mut row = vec![study.method.label().to_owned()];
        row.extend(milestones.iter().map(|iteration| small(at(iteration))));
        row.extend([small(study.worst()), study.evaluations_per_run.to_string(), significant(1e3 * seconds, 2)]);
        row
    });
    let titles = milestones.map(|iteration| format!("iteration\n{iteration}"));
    let mut heading = vec![""];
    heading.extend(titles.iter().map(String::as_str));
    heading.extend(["worst\nrun", "evalua-\ntions", "ms per\nrun"]);
    table(&heading, 1, rows)
}
